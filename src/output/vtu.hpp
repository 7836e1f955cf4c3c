#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace riven {

/// One field of a point cloud; `values` is point-major: values[point * components + component].
struct PointField {
  std::string name;
  int components = 1;  // 3: a vector, 9: a tensor (row by row), which is how ParaView knows them
  std::vector<double> values;
  std::string unit = {};  // SI, empty if dimensionless
};

/// What a cell of a mesh is; a bare point is none.
enum class CellKind { line, triangle, quad, tetrahedron, hexahedron };

/// "line", "triangle", "quad", "tetrahedron" or "hexahedron".
constexpr std::string_view name(CellKind kind) {
  constexpr std::string_view kNames[] = {"line", "triangle", "quad", "tetrahedron", "hexahedron"};
  return kNames[static_cast<std::size_t>(kind)];
}

constexpr std::size_t corners(CellKind kind) {
  constexpr std::size_t kCorners[] = {2, 3, 4, 4, 8};
  return kCorners[static_cast<std::size_t>(kind)];
}

/// Cells of one kind: the numbers of the points at their corners, cell by cell.
struct Cells {
  CellKind kind = CellKind::line;
  std::vector<std::uint32_t> nodes;
};

/// Points at their reference positions (m) with the fields there. Warp by the field `displacement` to see the
/// deformed body.
struct PointCloud {
  std::vector<std::array<double, 3>> positions;
  std::vector<PointField> fields;
  std::vector<Cells> cells = {};  // of a mesh; empty: bare points
};

/// Writes the cloud as one VTK XML unstructured grid, of vertex cells where it has none of its own:
/// compressed, 64-bit values. The file appears under its name only when it is complete.
/// Throws std::invalid_argument when the size of a field or the corners of cells do not fit the points,
/// RunError when the file cannot be written.
void write_vtu(const std::filesystem::path& path, const PointCloud& cloud);

/// Reads a file that `write_vtu` wrote; values come back bit by bit, neighbouring cells of one kind as one
/// list. Throws InputError when the file is missing, damaged or not of this kind.
PointCloud read_vtu(const std::filesystem::path& path);

}  // namespace riven
