#include "output/vtu.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <numeric>
#include <pugixml.hpp>
#include <span>
#include <stdexcept>

#include "base/error.hpp"
#include "output/atomic_file.hpp"
#include "output/vtk_array.hpp"

namespace riven {
namespace {

constexpr std::uint8_t kVertexCell = 1;
constexpr const char* kUnitKey = "UNITS_LABEL";
constexpr std::size_t kMostPoints = std::size_t{1}
                                    << 40;  // far more than fits a machine; products do not overflow

std::string escape(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

template <typename T>
void write_array(std::ostream& out, const char* type, const std::string& name, int components,
                 std::span<const T> values, const std::string& unit = {}) {
  out << fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">\n",
                     type, escape(name), components)
      << encode_vtk_array(std::as_bytes(values)) << "\n";
  // How VTK keeps the unit of an array. VTK's reader takes for values what comes first.
  if (!unit.empty())
    out << fmt::format("<InformationKey name=\"{}\" location=\"vtkDataArray\">{}</InformationKey>\n",
                       kUnitKey, escape(unit));
  out << "</DataArray>\n";
}

void write_cells(std::ostream& out, std::size_t points) {
  std::vector<std::int64_t> numbers(points);
  out << "<Cells>\n";
  std::iota(numbers.begin(), numbers.end(), std::int64_t{0});
  write_array<std::int64_t>(out, "Int64", "connectivity", 1, numbers);
  std::iota(numbers.begin(), numbers.end(), std::int64_t{1});
  write_array<std::int64_t>(out, "Int64", "offsets", 1, numbers);
  const std::vector<std::uint8_t> types(points, kVertexCell);
  write_array<std::uint8_t>(out, "UInt8", "types", 1, types);
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

PointField read_field(const pugi::xml_node& node, std::size_t points) {
  PointField field;
  field.name = node.attribute("Name").value();
  field.components = node.attribute("NumberOfComponents").as_int(1);
  field.unit = node.find_child_by_attribute("InformationKey", "name", kUnitKey).text().get();
  if (field.components < 1)
    throw std::runtime_error(fmt::format("array \"{}\" has no components", field.name));
  const std::size_t count = points * static_cast<std::size_t>(field.components);
  try {
    expect_attribute(node, "type", "Float64");
    expect_attribute(node, "format", "binary");
    std::string_view text = node.text().get();
    const auto first = text.find_first_not_of(" \t\r\n");
    if (first == std::string::npos) throw std::runtime_error("it is empty");
    text = text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
    const auto bytes = decode_vtk_array(text, count * sizeof(double));
    field.values.resize(count);
    if (!bytes.empty()) std::memcpy(field.values.data(), bytes.data(), bytes.size());
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("array \"{}\": {}", field.name, error.what()));
  }
  return field;
}

PointCloud read_grid(const pugi::xml_node& file) {
  expect_attribute(file, "type", "UnstructuredGrid");
  expect_attribute(file, "byte_order", "LittleEndian");
  expect_attribute(file, "header_type", "UInt64");
  expect_attribute(file, "compressor", "vtkZLibDataCompressor");
  const auto piece = child(child(file, "UnstructuredGrid"), "Piece");
  const auto points = static_cast<std::size_t>(piece.attribute("NumberOfPoints").as_ullong());
  if (points > kMostPoints) throw std::runtime_error("its number of points is damaged");

  const PointField positions = read_field(child(child(piece, "Points"), "DataArray"), points);
  if (positions.components != 3) throw std::runtime_error("its points do not have 3 components");
  PointCloud cloud;
  cloud.positions.resize(points);
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t c = 0; c < 3; ++c) cloud.positions[i][c] = positions.values[3 * i + c];
  }
  for (const auto& node : child(piece, "PointData").children("DataArray"))
    cloud.fields.push_back(read_field(node, points));
  return cloud;
}

}  // namespace

void write_vtu(const std::filesystem::path& path, const PointCloud& cloud) {
  check(cloud);
  AtomicFile file(path);
  auto& out = file.stream();
  const std::size_t points = cloud.positions.size();
  out << "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\" "
         "compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n"
      << fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<PointData>\n", points, points);
  for (const PointField& field : cloud.fields) {
    write_array<double>(out, "Float64", field.name, field.components, field.values, field.unit);
  }
  out << "</PointData>\n<Points>\n";
  const double* first = points > 0 ? cloud.positions.front().data() : nullptr;
  write_array<double>(out, "Float64", "Points", 3, {first, 3 * points});
  out << "</Points>\n";
  write_cells(out, points);
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
