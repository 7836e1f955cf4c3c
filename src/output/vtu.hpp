#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace riven {

/// One field of a point cloud; `values` is point-major: values[point * components + component].
struct PointField {
  std::string name;
  int components = 1;  // 3: a vector, 9: a tensor (row by row), which is how ParaView knows them
  std::vector<double> values;
  std::string unit = {};  // SI, empty if dimensionless
};

/// Points at their reference positions (m) with the fields there. Warp by the field `displacement` to see the
/// deformed body.
struct PointCloud {
  std::vector<std::array<double, 3>> positions;
  std::vector<PointField> fields;
};

/// Writes the cloud as one VTK XML unstructured grid of vertex cells: compressed, 64-bit values. The file
/// appears under its name only when it is complete.
/// Throws std::invalid_argument when a field's size does not fit the number of points, RunError when the file
/// cannot be written.
void write_vtu(const std::filesystem::path& path, const PointCloud& cloud);

/// Reads a file that `write_vtu` wrote; values come back bit by bit.
/// Throws InputError when the file is missing, damaged or not of this kind.
PointCloud read_vtu(const std::filesystem::path& path);

}  // namespace riven
