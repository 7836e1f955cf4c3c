#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geometry/shape.hpp"

namespace riven {

/// Displacement (m) that a reference solution has at an undeformed position (m).
struct ReferencePoint {
  Point position{};
  Point displacement{};
};

/// Reference points of one state; without value the file has only one state.
struct ReferenceState {
  std::optional<double> value;  // stretch, time (s) or cycle
  std::vector<ReferencePoint> points;
};

struct ReferencePoints {
  std::string file;
  int dimension = 2;  // components that the file gives; the others of a result are not compared
  std::vector<ReferenceState> states;  // in the order of the file
};

/// Reads a CSV file with the columns X_m, ux_m and, in pairs, Y_m, uy_m and Z_m, uz_m; a column lambda,
/// stretch, t_s, time or cycle tells the states apart; other columns are ignored. Throws InputError with file
/// and line, and what was expected there.
ReferencePoints read_reference_points(const std::filesystem::path& path);

}  // namespace riven
