#include "solver/tangent_system.hpp"

#include <algorithm>

#include "base/parallel.hpp"

namespace riven {

namespace {

constexpr std::size_t kBatch = 512;  // parts of the tangent that are in memory at a time
constexpr std::size_t kPiece = 16;   // of those, how many a thread takes
// Rows are dealt to so many shares, whatever the number of threads: neighbours, which come in the same
// blocks, to different ones.
constexpr int kShares = 64;

}  // namespace

template <class Visit>
void TangentSystem::for_each_batch(std::span<const double> u, const Visit& visit) const {
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

TangentSystem::TangentSystem(const Model& model, const Constraints& constraints, std::span<const double> u)
    : model_(model), unknowns_(model.dofs()) {
  number_unknowns(constraints.images(), u);
  find_pattern(u);
  cholesky_.analyse(matrix_);
}

void TangentSystem::number_unknowns(const std::vector<Constraints::Image>& images,
                                    std::span<const double> u) {
  std::vector<bool> used(unknowns_.size());
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

/// The unknowns of every block, ascending.
std::vector<std::vector<int>> TangentSystem::numbers_of(const std::vector<TangentBlocks>& pieces) const {
  std::vector<std::vector<int>> lists;
  for (const TangentBlocks& piece : pieces)
    for (std::size_t b = 0; b + 1 < piece.begin.size(); ++b) {
      std::vector<int>& numbers = lists.emplace_back();
      for (std::size_t n = piece.begin[b]; n < piece.begin[b + 1]; ++n)
        if (const int number = unknowns_[piece.dofs[n]].number; number >= 0) numbers.push_back(number);
      std::sort(numbers.begin(), numbers.end());
      numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    }
  return lists;
}

/// Row i of the lower triangle: the unknowns up to i that share a block with it.
void TangentSystem::find_pattern(std::span<const double> u) {
  std::vector<std::vector<int>> rows(entries_.size());
  for_each_batch(u, [&](const std::vector<TangentBlocks>& pieces) {
    const std::vector<std::vector<int>> lists = numbers_of(pieces);
    parallel_for(kShares, [&](std::ptrdiff_t share) {
      std::vector<int> merged;
      for (const std::vector<int>& numbers : lists)
        for (std::size_t n = 0; n < numbers.size(); ++n) {
          std::vector<int>& row = rows[static_cast<std::size_t>(numbers[n])];
          if (numbers[n] % kShares != share) continue;
          merged.clear();
          std::set_union(row.begin(), row.end(), numbers.begin(),
                         numbers.begin() + static_cast<std::ptrdiff_t>(n + 1), std::back_inserter(merged));
          if (merged.size() > row.size()) row = merged;
        }
    });
  });
  for (const std::vector<int>& row : rows) {
    matrix_.column.insert(matrix_.column.end(), row.begin(), row.end());
    matrix_.begin.push_back(matrix_.column.size());
  }
  matrix_.value.assign(matrix_.column.size(), 0.0);
}

void TangentSystem::assemble(std::span<const double> u) {
  std::fill(matrix_.value.begin(), matrix_.value.end(), 0.0);
  for_each_batch(u, [&](const std::vector<TangentBlocks>& pieces) {
    parallel_for(kShares, [&](std::ptrdiff_t share) {
      for (const TangentBlocks& piece : pieces) add(piece, static_cast<int>(share));
    });
  });
}

/// Adds the rows of one share: every row belongs to one thread, and its terms come in the order of the
/// blocks.
void TangentSystem::add(const TangentBlocks& blocks, int share) {
  std::size_t at = 0;  // of the block's first value
  for (std::size_t b = 0; b + 1 < blocks.begin.size(); ++b) {
    const std::size_t first = blocks.begin[b], size = blocks.begin[b + 1] - first;
    for (std::size_t r = 0; r < size; ++r) {
      const Unknown row = unknowns_[blocks.dofs[first + r]];
      if (row.number < 0 || row.number % kShares != share) continue;
      const auto begin = matrix_.begin[static_cast<std::size_t>(row.number)],
                 end = matrix_.begin[static_cast<std::size_t>(row.number) + 1];
      const int* columns = matrix_.column.data();
      for (std::size_t c = 0; c < size; ++c) {
        const Unknown column = unknowns_[blocks.dofs[first + c]];
        if (column.number < 0 || column.number > row.number) continue;
        const auto place = static_cast<std::size_t>(
            std::lower_bound(columns + begin, columns + end, column.number) - columns);
        matrix_.value[place] += row.sign * column.sign * blocks.values[at + r * size + c];
      }
    }
    at += size * size;
  }
}

bool TangentSystem::factor(double shift, std::span<const double> diagonal) {
  std::vector<double> unshifted(entries_.size());
  const auto own = [this](std::size_t i) -> double& { return matrix_.value[matrix_.begin[i + 1] - 1]; };
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    unshifted[i] = own(i);
    own(i) += shift * diagonal[entries_[i]];
  }
  const bool definite = cholesky_.factor(matrix_);
  for (std::size_t i = 0; i < entries_.size(); ++i) own(i) = unshifted[i];
  return definite;
}

void TangentSystem::solve(std::span<const double> force, std::span<double> increment) {
  std::vector<double> x(entries_.size());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = force[entries_[i]];
  cholesky_.solve(x);
  std::fill(increment.begin(), increment.end(), 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) increment[entries_[i]] = x[i];
}

double TangentSystem::bytes() const {
  return cholesky_.bytes() +
         static_cast<double>(matrix_.column.size()) * (2 * sizeof(double) + 3 * sizeof(int));
}

}  // namespace riven
