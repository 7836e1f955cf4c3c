#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/csv.hpp"
#include "input/units.hpp"

namespace riven {

/// A function of one variable given by points, linear between them: what formulas call as "pull(t)".
class TableFunction {
 public:
  /// A column of the file it comes from.
  struct Column {
    std::string name;  // as written, with its unit: "time [ms]"
    Dimension dimension;
    std::vector<double> values;  // SI
  };

  /// `argument` rises strictly, and both columns have two values at least. `hold`: beyond its ends the table
  /// keeps its first and last value.
  TableFunction(std::string name, std::filesystem::path file, Column argument, Column value, bool hold);

  /// Whether the table has a value there; the ends count with a billionth of the range for rounding.
  [[nodiscard]] bool covers(double argument) const;
  /// The value there, beyond the ends the first or the last one. `interval`: where to look first; moves to
  /// where the argument was found.
  [[nodiscard]] double value(double argument, std::size_t& interval) const;
  /// Another function of the same dimensions, which has no zeros, corners or ends: tells how a formula
  /// depends on its units whatever the points are. Strictly rising in the size of the argument.
  [[nodiscard]] double stand_in(double argument) const;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] const Column& argument() const { return argument_; }
  [[nodiscard]] const Column& value() const { return value_; }
  [[nodiscard]] bool holds() const { return hold_; }

 private:
  std::string name_;
  std::filesystem::path file_;
  Column argument_, value_;
  bool hold_;
  double argument_size_, value_size_;  // the largest magnitudes; 1 where all are 0
};

/// A column in SI, by the unit in the brackets that end its name. Throws InputError (file, line).
TableFunction::Column read_value_column(const CsvTable& csv, std::size_t index);

/// Reads two columns of a CSV file whose names may end in a unit in brackets; empty names: the first and the
/// second. Throws InputError (file, line) for what is no table.
TableFunction read_table(const std::string& name, const std::filesystem::path& file,
                         const std::string& argument, const std::string& value, bool hold);

/// "time" of "time [ms]".
std::string without_unit(const std::string& column);

}  // namespace riven
