#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "body/body.hpp"

namespace riven {

/// Points of a two-dimensional body that lie beside cracks.
struct CrackPoints {
  std::vector<Point> position;  // m, undeformed
  std::vector<bool> old;        // beside a crack from the start
  std::vector<bool> at_edge;    // something is missing in its family, if no crack had cut it
};

/// The points, numbers in the body's list in ascending order, that have lost the share `threshold` of their
/// bonds; `before`, `now`: the shares of all points.
CrackPoints crack_points(const Body& body, std::span<const std::size_t> among, std::span<const double> before,
                         std::span<const double> now, double threshold);

/// Cracks as paths: how far it is to each of their points, along the cracks, from where they began
/// (docs/theory/cracks.md). New cracks begin at old ones, and what is not connected to any is left out.
/// Without old ones a crack begins at the end of its longest path that is at an edge, else at the one stored
/// first.
class CrackPaths {
 public:
  /// `spacing` of the body (m).
  CrackPaths(CrackPoints points, double spacing);

  /// Length (m) of the longest path; 0 without a new crack.
  [[nodiscard]] double length() const { return length_; }
  /// Where it ends; nothing without a new crack.
  [[nodiscard]] std::optional<Point> tip() const;
  /// Ends of paths that are at least so long (m), counted from where they leave a longer path.
  [[nodiscard]] int ends(double least) const;
  /// Angle (rad) from the x axis at which the longest path goes between two distances from its beginning (m):
  /// of the line that fits best the points on both sides of it; nothing as long as they are fewer than six.
  [[nodiscard]] std::optional<double> angle(double from, double to) const;

 private:
  void find_neighbours();
  std::vector<std::uint32_t> spread(const std::vector<std::uint32_t>& from);
  void start_new_crack(std::uint32_t anywhere);

  CrackPoints points_;
  double spacing_;
  std::vector<std::vector<std::uint32_t>> neighbours_;
  std::vector<double> distance_;       // from the beginning (m); 0 of what is left out
  std::vector<std::uint32_t> before_;  // point before this one on its path; itself at the beginning
  std::optional<std::uint32_t> top_;   // the farthest point
  double length_ = 0;
};

}  // namespace riven
