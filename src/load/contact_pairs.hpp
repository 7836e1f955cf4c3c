#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "body/body.hpp"

namespace riven {

/// Finds the pairs of points that are in each other's reach: exposed points without a bond between them,
/// nearer than min(L, distance), L being their undeformed distance.
///
/// Exposed is a point that lacks a bond to one of its nearest neighbours on a lattice, or any bond in a list:
/// nothing reaches a point without coming near those. A list holds all pairs that can come so near before a
/// point has moved by half a skin; it is made anew then, or when more points are exposed. What is found
/// follows from the displacements and bonds alone, never from when the list was made: nothing needs to be
/// kept to go on later with the same bits.
class ContactPairs {
 public:
  /// `distance` in m, up to the horizon. Keeps a reference to the body, whose bonds may break.
  ContactPairs(const Body& body, double distance);

  /// Brings the list up to the displacements u (m, a plane of the body's size per component).
  void update(std::span<const double> u);

  /// The exposed points, ascending, and the number of pairs listed, from both ends.
  [[nodiscard]] const std::vector<std::size_t>& points() const { return points_; }
  [[nodiscard]] std::size_t listed() const { return pairs_.size(); }
  /// How often the list was made.
  [[nodiscard]] long lists() const { return lists_; }

  struct Contact {
    std::size_t other = 0;  // a stored point
    Point towards{};        // unit vector from the point to the other one
    double gap = 0;         // distance less reach, below 0 (m)
    double distance = 0;    // m
  };
  /// Calls visit(contact) for the contacts of points()[n], by ascending number of the other point. Two points
  /// in the same place have no direction and no contact.
  template <class Visit>
  void for_each_contact(std::size_t n, const Visit& visit) const {
    const Point& x = at_[n];
    for (std::size_t p = begin_[n]; p < begin_[n + 1]; ++p) {
      const Pair& pair = pairs_[p];
      const Point& y = at_[pair.other];
      const Point d{y[0] - x[0], y[1] - x[1], y[2] - x[2]};
      const double r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
      if (r2 >= pair.reach * pair.reach || r2 == 0 || bonded(points_[n], pair.bond)) continue;
      const double r = std::sqrt(r2);
      visit(Contact{points_[pair.other], {d[0] / r, d[1] / r, d[2] / r}, r - pair.reach, r});
    }
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  struct Pair {
    std::uint32_t other = 0;  // its place in points_
    std::uint32_t bond = 0;   // offset of the stencil, or number in the list of bonds; kNone
    double reach = 0;         // m
  };

  [[nodiscard]] std::uint8_t exposed_bits(std::size_t block) const;
  [[nodiscard]] bool is_exposed_in_list(std::size_t point) const;
  [[nodiscard]] bool still_holds() const;
  void make_list(std::span<const double> u);
  void list_pairs();
  [[nodiscard]] std::uint32_t bond_between(std::size_t n, std::size_t other) const;
  [[nodiscard]] bool bonded(std::size_t point, std::uint32_t bond) const {
    if (bond == kNone) return false;
    if (const LatticeBonds* on = body_.on_lattice()) return on->bonds.exists(bond, point);
    return std::get<ListedBonds>(body_.bonds).exists(point, bond);
  }
  void place(std::span<const double> u);

  const Body& body_;
  double distance_, skin_;
  std::vector<std::size_t> near_;        // offsets of the stencil to the nearest neighbours
  std::vector<std::uint8_t> body_bits_;  // a bit per stored point: a body point
  std::vector<std::uint8_t> exposed_;    // the same: in points_
  std::vector<std::size_t> points_;
  std::vector<Point> rest_, at_;  // of points_: undeformed, and in the state of the last update (m)
  std::vector<Point> made_at_;    // when the list was made
  std::vector<std::size_t> begin_{0};
  std::vector<Pair> pairs_;
  long lists_ = 0;
};

}  // namespace riven
