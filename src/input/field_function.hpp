#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "geometry/cubes.hpp"
#include "input/point_list.hpp"
#include "input/table_function.hpp"

namespace riven {

/// Values at places: what formulas read under its name at the point that they are evaluated for.
class FieldFunction {
 public:
  /// A value for each place; it holds within half a `spacing` (m).
  FieldFunction(std::string name, PointList places, TableFunction::Column value, double spacing);
  FieldFunction(const FieldFunction&) = delete;  // the search points at the places
  FieldFunction& operator=(const FieldFunction&) = delete;

  /// The value of the nearest place; nothing if none is within reach. Of places equally near the first one.
  [[nodiscard]] std::optional<double> at(const Point& x) const;
  /// A value of the same dimension that is not zero: tells how a formula depends on its units.
  [[nodiscard]] double stand_in() const { return stand_in_; }

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& file() const { return places_.file; }
  [[nodiscard]] const TableFunction::Column& value() const { return value_; }
  [[nodiscard]] double reach() const { return reach_; }  // m

 private:
  std::string name_;
  PointList places_;
  TableFunction::Column value_;
  double reach_, stand_in_;
  Cubes cubes_;
};

/// Reads the columns x, y, z, as many as `dimension`, and `value`, of a CSV file; empty: the only other one.
/// Throws InputError (file, line) for what is no field on points `spacing` (m) apart.
std::shared_ptr<const FieldFunction> read_field(const std::string& name, const std::filesystem::path& file,
                                                const std::string& value, int dimension, double spacing);

}  // namespace riven
