#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace riven {

/// A CSV file: a row of column names, then rows of cells. Lines that start with `#` and blank lines are
/// skipped; line ends may be LF, CRLF or CR, cells may be quoted ("a, b", doubled quotes inside), text and
/// numbers may mix.
class CsvTable {
 public:
  /// Throws InputError (file and line) when the file is missing or empty, a row has another number of cells
  /// than the first, or a quote does not end on its line.
  /// `drop_torn_line`: leave out a last line without line end: what a killed program was writing.
  static CsvTable read(const std::filesystem::path& path, bool drop_torn_line = false);

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
  [[nodiscard]] std::size_t rows() const { return lines_.size(); }

  /// Line of the column names in the file, from 1.
  [[nodiscard]] int header_line() const { return header_line_; }
  /// The same of a row.
  [[nodiscard]] int line(std::size_t row) const { return lines_[row]; }

  /// Index of the column called `name`, `name [unit]` or `name[unit]`. Throws InputError when there are two.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;
  /// The same; throws InputError that lists the columns there are.
  [[nodiscard]] std::size_t column(std::string_view name) const;

  /// A cell as a number ("nan" is one). Throws InputError with file and line when it is none.
  [[nodiscard]] double number(std::size_t row, std::size_t column) const;
  /// A whole column as numbers.
  [[nodiscard]] std::vector<double> numbers(std::size_t column) const;

 private:
  std::string file_;
  int header_line_ = 0;
  std::vector<std::string> columns_;
  std::vector<int> lines_;
  std::vector<std::string> cells_;  // row-major
};

/// A cell as it stands in a file: quoted where it must be.
std::string csv_cell(const std::string& text);

}  // namespace riven
