#include "solver/tangent_matrix.hpp"

#include <algorithm>

#include "base/parallel.hpp"

namespace riven {

namespace {

constexpr std::size_t kBatch = 128;  // parts of the tangent that are in memory at a time
constexpr std::size_t kPiece = 4;    // of those, how many a thread takes
// Rows are dealt to so many shares, whatever the number of threads: neighbours, which come in the same
// blocks, to different ones.
constexpr int kShares = 64;

}  // namespace

template <class Visit>
void TangentMatrix::for_each_batch(std::span<const double> u, const Visit& visit) const {
  const std::size_t parts = model_.tangent_parts();
  std::vector<TangentBlocks> pieces(kBatch / kPiece);
  for (std::size_t first = 0; first < parts; first += kBatch) {
    parallel_for(static_cast<std::ptrdiff_t>(pieces.size()), [&](std::ptrdiff_t n) {
      TangentBlocks& piece = pieces[static_cast<std::size_t>(n)];
      piece.begin.assign(1, 0);
      piece.dofs.clear();
      piece.values.clear();
      const std::size_t begin = first + static_cast<std::size_t>(n) * kPiece;
      if (begin < parts) model_.tangent(u, begin, std::min(begin + kPiece, parts), piece);
    });
    visit(pieces);
  }
}

TangentMatrix::TangentMatrix(const Model& model, const Constraints& constraints, std::span<const double> u,
                             std::span<const double> mass)
    : model_(model), unknowns_(model.dofs()) {
  number_unknowns(constraints.images(), u, mass);
  find_pattern(u);
}

void TangentMatrix::number_unknowns(const std::vector<Constraints::Image>& images, std::span<const double> u,
                                    std::span<const double> mass) {
  std::vector<bool> used(unknowns_.size());
  for (std::size_t i = 0; i < mass.size(); ++i) used[i] = images[i].entry == i && mass[i] > 0;
  for_each_batch(u, [&](const std::vector<TangentBlocks>& pieces) {
    for (const TangentBlocks& piece : pieces)
      for (const std::size_t dof : piece.dofs)
        if (images[dof].entry != Constraint::kNone) used[images[dof].entry] = true;
  });
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    unknowns_[i].number = static_cast<int>(entries_.size());
    entries_.push_back(i);
  }
  for (std::size_t i = 0; i < images.size(); ++i)
    if (images[i].entry != Constraint::kNone)
      unknowns_[i] = {unknowns_[images[i].entry].number, images[i].sign};
}

/// The rows of every block that belong to unknowns, ascending by their number.
std::vector<std::vector<TangentMatrix::Row>> TangentMatrix::rows_of(
    const std::vector<TangentBlocks>& pieces) const {
  std::vector<std::vector<Row>> lists;
  for (const TangentBlocks& piece : pieces)
    for (std::size_t b = 0; b + 1 < piece.begin.size(); ++b) {
      std::vector<Row>& rows = lists.emplace_back();
      for (std::size_t n = piece.begin[b]; n < piece.begin[b + 1]; ++n) {
        const Unknown unknown = unknowns_[piece.dofs[n]];
        if (unknown.number >= 0) rows.push_back({unknown.number, n - piece.begin[b], unknown.sign});
      }
      std::stable_sort(rows.begin(), rows.end(),
                       [](const Row& x, const Row& y) { return x.number < y.number; });
    }
  return lists;
}

/// Row i of the lower triangle: the unknowns up to i that share a block with it.
void TangentMatrix::find_pattern(std::span<const double> u) {
  std::vector<std::vector<int>> rows(entries_.size());
  for_each_batch(u, [&](const std::vector<TangentBlocks>& pieces) {
    const std::vector<std::vector<Row>> lists = rows_of(pieces);
    parallel_for(kShares, [&](std::ptrdiff_t share) {
      std::vector<int> numbers, merged;
      for (const std::vector<Row>& list : lists) {
        numbers.clear();
        for (const Row& row : list)
          if (numbers.empty() || numbers.back() != row.number) numbers.push_back(row.number);
        for (std::size_t n = 0; n < numbers.size(); ++n) {
          if (numbers[n] % kShares != share) continue;
          std::vector<int>& row = rows[static_cast<std::size_t>(numbers[n])];
          merged.clear();
          std::set_union(row.begin(), row.end(), numbers.begin(),
                         numbers.begin() + static_cast<std::ptrdiff_t>(n + 1), std::back_inserter(merged));
          if (merged.size() > row.size()) row = merged;
        }
      }
    });
  });
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<int>& row = rows[i];
    if (row.empty()) row.push_back(static_cast<int>(i));  // mass without bonds
    matrix_.column.insert(matrix_.column.end(), row.begin(), row.end());
    matrix_.begin.push_back(matrix_.column.size());
  }
  matrix_.value.assign(matrix_.column.size(), 0.0);
}

void TangentMatrix::assemble(std::span<const double> u) {
  std::fill(matrix_.value.begin(), matrix_.value.end(), 0.0);
  for_each_batch(u, [&](const std::vector<TangentBlocks>& pieces) { add(pieces); });
}

void TangentMatrix::assemble(std::span<const double> u, const ExternalForces& external, double parameter) {
  assemble(u);
  std::vector<TangentBlocks> pieces(1);
  for (const auto& force : external) force->tangent(u, parameter, pieces.front());
  if (!pieces.front().dofs.empty()) add(pieces);
}

void TangentMatrix::add(const std::vector<TangentBlocks>& pieces) {
  const std::vector<std::vector<Row>> lists = rows_of(pieces);
  parallel_for(kShares, [&](std::ptrdiff_t share) {
    auto list = lists.begin();
    for (const TangentBlocks& piece : pieces) {
      const double* block = piece.values.data();
      for (std::size_t b = 0; b + 1 < piece.begin.size(); ++b, ++list) {
        const std::size_t size = piece.begin[b + 1] - piece.begin[b];
        add(*list, block, size, static_cast<int>(share));
        block += size * size;
      }
    }
  });
}

/// Adds the rows of one share: every row belongs to one thread, and its terms come in the order of the
/// blocks.
void TangentMatrix::add(const std::vector<Row>& rows, const double* block, std::size_t size, int share) {
  for (const Row& row : rows) {
    if (row.number % kShares != share) continue;
    std::size_t place = matrix_.begin[static_cast<std::size_t>(row.number)];
    for (const Row& column : rows) {
      if (column.number > row.number) break;
      while (matrix_.column[place] < column.number) ++place;
      matrix_.value[place] += row.sign * column.sign * block[row.place * size + column.place];
    }
  }
}

}  // namespace riven
