#pragma once

#include <numeric>

#include "body/crack_extent.hpp"
#include "body/crack_paths.hpp"
#include "body/listed_body.hpp"
#include "support/bodies.hpp"

namespace riven::testing {

/// A sheet before and after cracks have grown in it, as if bonds had broken along straight lines.
struct CrackedSheet {
  Body before, after;

  /// `old` cracks are there from the start, `grown` ones are added.
  CrackedSheet(LatticeBodyInput in, std::vector<Segment> old, const std::vector<Segment>& grown,
               bool in_list = false) {
    in.defects.cracks = std::move(old);
    before = make_lattice_body(in);
    in.defects.cracks.insert(in.defects.cracks.end(), grown.begin(), grown.end());
    after = make_lattice_body(in);
    if (in_list) {
      before = listed(before);
      after = listed(after);
    }
  }

  [[nodiscard]] std::vector<std::size_t> all() const {
    std::vector<std::size_t> numbers(after.points.size());
    std::iota(numbers.begin(), numbers.end(), 0U);
    return numbers;
  }
  [[nodiscard]] CrackPaths paths() const {
    const double threshold = share_beyond(2, 0.75 * after.spacing / after.horizon);
    return {crack_points(before, all(), damages(before), damages(after), threshold), after.spacing};
  }
  [[nodiscard]] double area() const {
    return crack_area(after, crack_depth(after), all(), damages(before), damages(after));
  }
};

/// A point `along` a direction from another one.
inline Point from(const Point& start, double angle, double along) {
  return {start[0] + along * std::cos(angle), start[1] + along * std::sin(angle), 0};
}

}  // namespace riven::testing
