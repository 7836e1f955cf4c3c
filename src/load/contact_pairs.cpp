#include "load/contact_pairs.hpp"

#include <algorithm>
#include <cstring>

#include "base/parallel.hpp"
#include "geometry/cubes.hpp"

namespace riven {

namespace {

constexpr std::size_t kBits = 8;
constexpr double kSkin = 0.3;   // of the distance: with it, only nearest neighbours of a lattice are listed
constexpr double kNear = 1.75;  // spacings: the neighbours around a cell, those at its corners included
constexpr std::size_t kPiece = 256;  // points that a thread takes at a time

double square(const Point& a, const Point& b) {
  double sum = 0;
  for (std::size_t d = 0; d < 3; ++d) sum += (a[d] - b[d]) * (a[d] - b[d]);
  return sum;
}

bool all_set(const std::uint8_t* bytes, std::size_t count) {
  std::uint64_t all = ~std::uint64_t{0};
  std::size_t n = 0;
  for (; n + sizeof(all) <= count; n += sizeof(all)) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, bytes + n, sizeof(eight));
    all &= eight;
  }
  std::uint8_t rest = 0xff;
  for (; n < count; ++n) rest &= bytes[n];
  return all == ~std::uint64_t{0} && rest == 0xff;
}

}  // namespace

ContactPairs::ContactPairs(const Body& body, double distance)
    : body_(body), distance_(distance), skin_(kSkin * distance) {
  if (const LatticeBonds* on = body_.on_lattice())
    for (std::size_t k = 0; k < on->stencil.size(); ++k)
      if (on->stencil.length[k] <= kNear * body_.spacing) near_.push_back(k);
  body_bits_.assign((body_.size() + kBits - 1) / kBits, 0);
  for (const std::size_t i : body_.points)
    body_bits_[i / kBits] |= static_cast<std::uint8_t>(1U << (i % kBits));
  exposed_.assign(body_bits_.size(), 0);
}

/// Of eight points.
std::uint8_t ContactPairs::exposed_bits(std::size_t block) const {
  if (body_bits_[block] == 0) return 0;
  unsigned whole = 0xff;
  if (const LatticeBonds* on = body_.on_lattice()) {
    const std::uint8_t* masks = on->bonds.masks(block);
    if (all_set(masks, on->stencil.size())) return 0;  // the usual case
    for (const std::size_t k : near_) whole &= masks[k];
  } else {
    for (std::size_t n = 0; n < kBits; ++n)
      if ((body_bits_[block] >> n & 1U) != 0 && is_exposed_in_list(kBits * block + n)) whole &= ~(1U << n);
  }
  return static_cast<std::uint8_t>(body_bits_[block] & ~whole);
}

bool ContactPairs::is_exposed_in_list(std::size_t point) const {
  const auto& list = std::get<ListedBonds>(body_.bonds);
  const std::size_t bonds = list.begin[point + 1] - list.begin[point];
  if (!body_.complete[point] || bonds < body_.whole_family[point]) return true;
  const std::uint8_t* masks = list.masks.data() + list.begin[point] / kBits + point;
  if (!all_set(masks, bonds / kBits)) return true;
  const auto rest = static_cast<std::uint8_t>((1U << (bonds % kBits)) - 1);
  return (masks[bonds / kBits] & rest) != rest;
}

void ContactPairs::update(std::span<const double> u) {
  place(u);
  if (lists_ == 0 || !still_holds()) make_list(u);
}

/// Where the exposed points are.
void ContactPairs::place(std::span<const double> u) {
  parallel_pieces(
      points_.size(),
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n)
          for (std::size_t d = 0; d < static_cast<std::size_t>(body_.dimension); ++d)
            at_[n][d] = rest_[n][d] + u[d * body_.size() + points_[n]];
      },
      kPiece);
}

bool ContactPairs::still_holds() const {
  const double far = 0.25 * skin_ * skin_;
  const double moved = ordered_sum_of(
      points_.size(), [&](std::size_t n) { return square(at_[n], made_at_[n]) < far ? 0. : 1.; });
  if (moved > 0) return false;
  return ordered_sum<long>(exposed_.size(), [&](std::size_t begin, std::size_t end) {
           long changed = 0;
           for (std::size_t b = begin; b < end; ++b) changed += exposed_bits(b) != exposed_[b] ? 1 : 0;
           return changed;
         }) == 0;
}

void ContactPairs::make_list(std::span<const double> u) {
  ++lists_;
  parallel_pieces(exposed_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) exposed_[b] = exposed_bits(b);
  });
  points_.clear();
  rest_.clear();
  for (std::size_t b = 0; b < exposed_.size(); ++b)
    for (std::size_t n = 0; exposed_[b] >> n != 0; ++n)
      if ((exposed_[b] >> n & 1U) != 0) {
        points_.push_back(kBits * b + n);
        rest_.push_back(body_.position(points_.back()));
      }
  at_ = rest_;
  place(u);
  made_at_ = at_;
  list_pairs();
}

/// Pieces of points list their pairs, which then follow one another.
void ContactPairs::list_pairs() {
  const Cubes cubes(at_, body_.dimension, distance_ + skin_);
  std::vector<std::vector<Pair>> found((points_.size() + kPiece - 1) / kPiece);
  begin_.assign(points_.size() + 1, 0);
  parallel_pieces(
      points_.size(),
      [&](std::size_t begin, std::size_t end) {
        std::vector<Pair>& pairs = found[begin / kPiece];
        std::vector<std::size_t> near;
        for (std::size_t n = begin; n < end; ++n) {
          cubes.within(at_[n], distance_ + skin_, near);
          for (const std::size_t other : near)
            if (other != n)
              pairs.push_back({static_cast<std::uint32_t>(other), bond_between(n, other),
                               std::min(distance_, std::sqrt(square(rest_[n], rest_[other])))});
          begin_[n + 1] = near.size() - 1;  // as many as near ones but the point itself
        }
      },
      kPiece);
  for (std::size_t n = 0; n < points_.size(); ++n) begin_[n + 1] += begin_[n];
  pairs_.clear();
  for (const std::vector<Pair>& piece : found) pairs_.insert(pairs_.end(), piece.begin(), piece.end());
}

/// Between two of points_.
std::uint32_t ContactPairs::bond_between(std::size_t n, std::size_t other) const {
  const std::size_t i = points_[n], j = points_[other];
  if (const LatticeBonds* on = body_.on_lattice()) {
    const auto& shifts = on->stencil.shift;
    const auto shift = static_cast<std::ptrdiff_t>(j) - static_cast<std::ptrdiff_t>(i);
    const auto [first, last] = std::equal_range(shifts.begin(), shifts.end(), shift);
    // Offsets of one shift lead to the same place of the storage, from opposite ends of a row.
    for (auto k = static_cast<std::size_t>(first - shifts.begin());
         k < static_cast<std::size_t>(last - shifts.begin()); ++k) {
      const Point& bond = on->stencil.bond[k];
      const Point end{rest_[n][0] + bond[0], rest_[n][1] + bond[1], rest_[n][2] + bond[2]};
      if (square(end, rest_[other]) < 0.25 * body_.spacing * body_.spacing)
        return static_cast<std::uint32_t>(k);
    }
    return kNone;
  }
  const auto& list = std::get<ListedBonds>(body_.bonds);
  const auto first = list.neighbour.begin() + static_cast<std::ptrdiff_t>(list.begin[i]);
  const auto last = list.neighbour.begin() + static_cast<std::ptrdiff_t>(list.begin[i + 1]);
  const auto found = std::lower_bound(first, last, j);
  return found == last || *found != j ? kNone : static_cast<std::uint32_t>(found - list.neighbour.begin());
}

}  // namespace riven
