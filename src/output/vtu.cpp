#include "output/vtu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <pugixml.hpp>
#include <span>
#include <stdexcept>

#include "base/error.hpp"
#include "base/text.hpp"
#include "output/atomic_file.hpp"
#include "output/vtk_array.hpp"

namespace riven {
namespace {

constexpr std::uint8_t kVertexCell = 1;
constexpr const char* kUnitKey = "UNITS_LABEL";
// Points or cells: far more than fits a machine; products do not overflow.
constexpr std::size_t kMost = std::size_t{1} << 40;

template <typename T>
void write_array(std::ostream& out, const char* type, const std::string& name, int components,
                 std::span<const T> values, const std::string& unit = {}) {
  out << fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">\n",
                     type, escaped(name), components)
      << encode_vtk_array(std::as_bytes(values)) << "\n";
  // How VTK keeps the unit of an array. VTK's reader takes for values what comes first.
  if (!unit.empty())
    out << fmt::format("<InformationKey name=\"{}\" location=\"vtkDataArray\">{}</InformationKey>\n",
                       kUnitKey, escaped(unit));
  out << "</DataArray>\n";
}

/// Cells as VTK has them.
struct CellArrays {
  std::vector<std::int64_t> connectivity;  // of all cells, one after the other
  std::vector<std::int64_t> offsets;       // of each, where its part of the connectivity ends
  std::vector<std::uint8_t> types;
};

/// VTK_LINE, VTK_TRIANGLE, VTK_QUAD, VTK_TETRA, VTK_HEXAHEDRON
constexpr std::uint8_t vtk_type(CellKind kind) {
  constexpr std::uint8_t kTypes[] = {3, 5, 9, 10, 12};
  return kTypes[static_cast<std::size_t>(kind)];
}

CellArrays cell_arrays(const PointCloud& cloud) {
  CellArrays arrays;
  for (const Cells& cells : cloud.cells) {
    arrays.connectivity.insert(arrays.connectivity.end(), cells.nodes.begin(), cells.nodes.end());
    arrays.types.resize(arrays.types.size() + cells.nodes.size() / corners(cells.kind), vtk_type(cells.kind));
    while (arrays.offsets.size() < arrays.types.size())
      arrays.offsets.push_back((arrays.offsets.empty() ? 0 : arrays.offsets.back()) +
                               static_cast<std::int64_t>(corners(cells.kind)));
  }
  if (!cloud.cells.empty()) return arrays;
  arrays.connectivity.resize(cloud.positions.size());
  std::iota(arrays.connectivity.begin(), arrays.connectivity.end(), std::int64_t{0});
  arrays.offsets.resize(cloud.positions.size());
  std::iota(arrays.offsets.begin(), arrays.offsets.end(), std::int64_t{1});
  arrays.types.assign(cloud.positions.size(), kVertexCell);
  return arrays;
}

void write_cells(std::ostream& out, const CellArrays& arrays) {
  out << "<Cells>\n";
  write_array<std::int64_t>(out, "Int64", "connectivity", 1, arrays.connectivity);
  write_array<std::int64_t>(out, "Int64", "offsets", 1, arrays.offsets);
  write_array<std::uint8_t>(out, "UInt8", "types", 1, arrays.types);
  out << "</Cells>\n";
}

void check(const PointCloud& cloud) {
  for (const PointField& field : cloud.fields) {
    const auto components = static_cast<std::size_t>(field.components);
    if (field.components < 1 || field.values.size() != components * cloud.positions.size()) {
      throw std::invalid_argument(fmt::format("field {} has {} values for {} points of {} components",
                                              field.name, field.values.size(), cloud.positions.size(),
                                              field.components));
    }
  }
  for (const Cells& cells : cloud.cells) {
    const bool whole = cells.nodes.size() % corners(cells.kind) == 0;
    const bool inside = std::all_of(cells.nodes.begin(), cells.nodes.end(),
                                    [&](std::uint32_t node) { return node < cloud.positions.size(); });
    if (!whole || !inside)
      throw std::invalid_argument(
          fmt::format("cells of kind {} do not fit the {} points", name(cells.kind), cloud.positions.size()));
  }
}

pugi::xml_node child(const pugi::xml_node& parent, const char* name) {
  const auto node = parent.child(name);
  if (!node) throw std::runtime_error(fmt::format("it has no <{}>", name));
  return node;
}

void expect_attribute(const pugi::xml_node& node, const char* name, const std::string& expected) {
  const std::string found = node.attribute(name).value();
  if (found != expected)
    throw std::runtime_error(fmt::format("its {} is \"{}\", expected \"{}\"", name, found, expected));
}

/// The numbers of an array, which has `count` of them.
template <typename T>
std::vector<T> read_array(const pugi::xml_node& node, const char* type, std::size_t count) {
  try {
    expect_attribute(node, "type", type);
    expect_attribute(node, "format", "binary");
    std::string_view text = node.text().get();
    const auto first = text.find_first_not_of(" \t\r\n");
    if (first == std::string::npos) throw std::runtime_error("it is empty");
    text = text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
    const auto bytes = decode_vtk_array(text, count * sizeof(T));
    std::vector<T> values(count);
    if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("array \"{}\": {}", node.attribute("Name").value(), error.what()));
  }
}

PointField read_field(const pugi::xml_node& node, std::size_t points) {
  PointField field;
  field.name = node.attribute("Name").value();
  field.components = node.attribute("NumberOfComponents").as_int(1);
  field.unit = node.find_child_by_attribute("InformationKey", "name", kUnitKey).text().get();
  if (field.components < 1)
    throw std::runtime_error(fmt::format("array \"{}\" has no components", field.name));
  field.values = read_array<double>(node, "Float64", points * static_cast<std::size_t>(field.components));
  return field;
}

CellKind kind_of(std::uint8_t type) {
  for (const CellKind kind :
       {CellKind::line, CellKind::triangle, CellKind::quad, CellKind::tetrahedron, CellKind::hexahedron})
    if (vtk_type(kind) == type) return kind;
  throw std::runtime_error(fmt::format(
      "it has cells of VTK's type {}; expected bare vertices (1), or lines (3), triangles (5), quads (9), "
      "tetrahedra (10) and hexahedra (12)",
      type));
}

std::vector<Cells> read_cells(const pugi::xml_node& node, std::size_t count, std::size_t points) {
  const auto array = [&](const char* named) {
    return node.find_child_by_attribute("DataArray", "Name", named);
  };
  const auto types = read_array<std::uint8_t>(array("types"), "UInt8", count);
  const auto is_vertex = [](std::uint8_t type) { return type == kVertexCell; };
  if (std::all_of(types.begin(), types.end(), is_vertex)) return {};

  std::vector<Cells> all;
  std::size_t connections = 0;
  for (const std::uint8_t type : types) connections += corners(kind_of(type));
  const auto nodes = read_array<std::int64_t>(array("connectivity"), "Int64", connections);
  auto node_of = nodes.begin();
  for (const std::uint8_t type : types) {
    const CellKind kind = kind_of(type);
    if (all.empty() || all.back().kind != kind) all.push_back({kind, {}});
    for (std::size_t corner = 0; corner < corners(kind); ++corner, ++node_of) {
      if (*node_of < 0 || static_cast<std::size_t>(*node_of) >= points)
        throw std::runtime_error(fmt::format("a cell has point {} of {}", *node_of, points));
      all.back().nodes.push_back(static_cast<std::uint32_t>(*node_of));
    }
  }
  return all;
}

PointCloud read_grid(const pugi::xml_node& file) {
  expect_attribute(file, "type", "UnstructuredGrid");
  expect_attribute(file, "byte_order", "LittleEndian");
  expect_attribute(file, "header_type", "UInt64");
  expect_attribute(file, "compressor", "vtkZLibDataCompressor");
  const auto piece = child(child(file, "UnstructuredGrid"), "Piece");
  const auto number = [&](const char* of) {
    const auto found = static_cast<std::size_t>(piece.attribute(of).as_ullong());
    if (found > kMost) throw std::runtime_error(fmt::format("its {} is damaged", of));
    return found;
  };
  const std::size_t points = number("NumberOfPoints");

  const PointField positions = read_field(child(child(piece, "Points"), "DataArray"), points);
  if (positions.components != 3) throw std::runtime_error("its points do not have 3 components");
  if (!std::all_of(positions.values.begin(), positions.values.end(),
                   [](double x) { return std::isfinite(x); }))
    throw std::runtime_error("its points are not all at finite places");
  PointCloud cloud;
  cloud.positions.resize(points);
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t c = 0; c < 3; ++c) cloud.positions[i][c] = positions.values[3 * i + c];
  }
  for (const auto& node : child(piece, "PointData").children("DataArray"))
    cloud.fields.push_back(read_field(node, points));
  cloud.cells = read_cells(child(piece, "Cells"), number("NumberOfCells"), points);
  return cloud;
}

}  // namespace

void write_vtu(const std::filesystem::path& path, const PointCloud& cloud) {
  check(cloud);
  AtomicFile file(path);
  auto& out = file.stream();
  const std::size_t points = cloud.positions.size();
  const CellArrays cells = cell_arrays(cloud);
  out << "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\" "
         "compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n"
      << fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<PointData>\n", points,
                     cells.types.size());
  for (const PointField& field : cloud.fields) {
    write_array<double>(out, "Float64", field.name, field.components, field.values, field.unit);
  }
  out << "</PointData>\n<Points>\n";
  const double* first = points > 0 ? cloud.positions.front().data() : nullptr;
  write_array<double>(out, "Float64", "Points", 3, {first, 3 * points});
  out << "</Points>\n";
  write_cells(out, cells);
  out << "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  file.commit();
}

PointCloud read_vtu(const std::filesystem::path& path) {
  const Location at{path.string()};
  pugi::xml_document document;
  const auto status = document.load_file(path.c_str());
  if (status.status == pugi::status_file_not_found) throw InputError(at, "there is no such file");
  if (!status)
    throw InputError(at, fmt::format("damaged: {} at byte {}", status.description(), status.offset));
  try {
    return read_grid(child(document, "VTKFile"));
  } catch (const std::runtime_error& error) {
    throw InputError(at, fmt::format("not a readable field file of Riven: {}", error.what()));
  }
}

}  // namespace riven
