#include "load/contact_pairs.hpp"

#include <algorithm>

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
  if (!std::all_of(masks, masks + bonds / kBits, [](std::uint8_t mask) { return mask == 0xff; })) return true;
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
  const double moved =
      ordered_sum_of(points_.size(), [&](std::size_t n) { return square(at_[n], made_at_[n]) < far ? 0. : 1.; });
  if (moved > 0) return false;
  return ordered_sum_of(exposed_.size(),
                        [&](std::size_t b) { return exposed_bits(b) == exposed_[b] ? 0.0 : 1.0; }) == 0;
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
  const Cubes cubes(at_, body_.dimension, distance_ + skin_);
  std::vector<std::vector<Pair>> found(points_.size());
  parallel_pieces(
      points_.size(),
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n)
          for (const std::size_t other : cubes.within(at_[n], distance_ + skin_))
            if (other != n)
              found[n].push_back({static_cast<std::uint32_t>(other), bond_between(points_[n], points_[other]),
                                  std::min(distance_, std::sqrt(square(rest_[n], rest_[other])))});
      },
      kPiece);
  begin_.assign(1, 0);
  pairs_.clear();
  for (const std::vector<Pair>& of_point : found) {
    pairs_.insert(pairs_.end(), of_point.begin(), of_point.end());
    begin_.push_back(pairs_.size());
  }
}

std::uint32_t ContactPairs::bond_between(std::size_t point, std::size_t other) const {
  if (const LatticeBonds* on = body_.on_lattice()) {
    const Cell from = on->lattice.cell(point), to = on->lattice.cell(other);
    const Cell offset{to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    const auto& offsets = on->stencil.offset;
    const auto found = std::find(offsets.begin(), offsets.end(), offset);
    return found == offsets.end() ? kNone : static_cast<std::uint32_t>(found - offsets.begin());
  }
  const auto& list = std::get<ListedBonds>(body_.bonds);
  const auto first = list.neighbour.begin() + static_cast<std::ptrdiff_t>(list.begin[point]);
  const auto last = list.neighbour.begin() + static_cast<std::ptrdiff_t>(list.begin[point + 1]);
  const auto found = std::lower_bound(first, last, other);
  return found == last || *found != other ? kNone
                                          : static_cast<std::uint32_t>(found - list.neighbour.begin());
}

}  // namespace riven
