#pragma once

#include <filesystem>
#include <vector>

#include "base/csv.hpp"
#include "base/error.hpp"
#include "geometry/shape.hpp"

namespace riven {

/// Points of a list under a name.
struct PointGroup {
  std::string name;
  std::vector<std::size_t> points;  // ascending
};

/// Material points that a file lists: the rows of a CSV file, or the elements of a mesh.
struct PointList {
  std::string file;
  int dimension = 2;
  std::vector<Point> position;       // m
  std::vector<double> volume;        // m^3, one per position
  std::vector<int> line;             // of a CSV file, one per position
  std::vector<std::size_t> element;  // of a mesh: its number in the file, one per position
  std::vector<PointGroup> groups;    // of a mesh

  /// Mean spacing (m): the edge of a square or cube that holds the mean volume.
  [[nodiscard]] double spacing(double thickness) const;
  /// "line 7" or "element 7".
  [[nodiscard]] std::string label(std::size_t point) const;
  /// For messages about a point: the file and its line, or its element.
  [[nodiscard]] Location at(std::size_t point) const;
  [[nodiscard]] bool of_mesh() const { return !element.empty(); }
};

/// The places alone, without volumes: the columns x, y, z, as many as `dimension`. Throws InputError (file,
/// line).
PointList read_places(const CsvTable& csv, int dimension);

/// Reads the columns x, y, in three dimensions z, and volume, or in two dimensions area instead, which is
/// multiplied by the thickness (m). Their names end in their units, as in "x [mm]"; other columns are
/// ignored. Throws InputError (file, line) where a column, a unit or a number is wrong.
PointList read_points(const std::filesystem::path& file, double thickness);

/// Throw InputError (file, line): for volumes that the points' extent cannot hold (a wrong unit, mostly), for
/// a point outside of the box, for two points at one place.
void check_volumes(const PointList& points, double thickness);
void check_inside(const PointList& points, const Box& box, double spacing);
void check_apart(const PointList& points, double spacing);

}  // namespace riven
