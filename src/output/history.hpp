#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/csv.hpp"
#include "output/parameter.hpp"

namespace riven {

/// A column of `history.csv`: a probe and its SI unit, empty if dimensionless.
struct HistoryColumn {
  std::string name;
  std::string unit;
};

/// Writes `history.csv`: the parameter, then one column per probe. Each row is flushed as it comes; numbers
/// have all digits that it takes to read the same double back.
class HistoryWriter {
 public:
  /// Throws RunError when the file cannot be created.
  HistoryWriter(const std::filesystem::path& path, Parameter parameter,
                const std::vector<HistoryColumn>& columns);

  /// Goes on with a history, of which only the first bytes are kept. Throws InputError when it has fewer.
  HistoryWriter(const std::filesystem::path& path, std::size_t columns, std::uintmax_t bytes);

  /// Adds a row. Throws std::invalid_argument when the number of values is not that of the columns, RunError
  /// when the row cannot be written.
  void add(double parameter, std::span<const double> values);

  /// Length of the file.
  [[nodiscard]] std::uintmax_t bytes() const { return bytes_; }

 private:
  void write_line(const std::string& line);

  std::string path_;
  std::ofstream stream_;
  std::size_t columns_;
  std::uintmax_t bytes_ = 0;
};

/// A history read back.
class History {
 public:
  /// A last row that a killed program left unfinished is dropped. Throws InputError when the file is missing,
  /// empty or damaged.
  static History read(const std::filesystem::path& path);

  /// The first column: stretch, time (s) or cycle.
  [[nodiscard]] std::vector<double> parameter() const { return table_.numbers(0); }
  /// A column by name, with or without unit. Throws InputError that lists the columns there are.
  [[nodiscard]] std::vector<double> column(std::string_view name) const {
    return table_.numbers(table_.column(name));
  }
  /// Its name with unit, as in the file.
  [[nodiscard]] const std::string& column_name(std::string_view name) const {
    return table_.columns()[table_.column(name)];
  }
  /// Column names with units, as in the file.
  [[nodiscard]] const std::vector<std::string>& columns() const { return table_.columns(); }

 private:
  CsvTable table_;
};

}  // namespace riven
