#include "base/csv.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <sstream>

#include "base/error.hpp"
#include "base/nearest_name.hpp"

namespace riven {
namespace {

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  return first == std::string::npos ? std::string_view{}
                                    : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Reads the quoted cell that starts at `at` and moves `at` behind its closing quote.
std::string quoted_cell(const std::string& line, std::size_t& at, const Location& place) {
  std::string cell;
  for (++at; at < line.size(); ++at) {
    if (line[at] != '"') {
      cell += line[at];
    } else if (at + 1 < line.size() && line[at + 1] == '"') {
      cell += line[++at];
    } else {
      ++at;
      return cell;
    }
  }
  throw InputError(place, "expected a closing quote (\") on this line");
}

std::vector<std::string> split(const std::string& line, const Location& place) {
  std::vector<std::string> cells;
  std::size_t at = 0;
  while (true) {
    const auto first = std::min(line.find_first_not_of(" \t", at), line.size());
    std::string cell;
    if (first < line.size() && line[first] == '"') {
      at = first;
      cell = quoted_cell(line, at, place);
      const auto comma = std::min(line.find(',', at), line.size());
      if (!trim(std::string_view(line).substr(at, comma - at)).empty()) {
        throw InputError(place, "expected a comma after a quoted cell");
      }
      at = comma;
    } else {
      const auto comma = std::min(line.find(',', at), line.size());
      cell = trim(std::string_view(line).substr(at, comma - at));
      at = comma;
    }
    cells.push_back(std::move(cell));
    if (at == line.size()) return cells;
    ++at;
  }
}

/// A column's name without its unit: "x" of "x [mm]" and "x[mm]".
std::string_view bare(std::string_view column) {
  return column.ends_with(']') ? trim(column.substr(0, column.rfind('['))) : column;
}

/// The text of a file with LF as its only line end.
std::string read_lines(std::istream& in) {
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (text.find('\n') == std::string::npos) std::replace(text.begin(), text.end(), '\r', '\n');
  return text;
}

}  // namespace

CsvTable CsvTable::read(const std::filesystem::path& path, bool drop_torn_line) {
  CsvTable table;
  table.file_ = path.string();
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path))
    throw InputError(Location{table.file_}, "there is no such file");
  std::istringstream in(read_lines(file));
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (drop_torn_line && in.eof()) break;
    if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
    if (line.ends_with('\r')) line.pop_back();
    if (trim(line).empty() || line.starts_with('#')) continue;
    const Location place{table.file_, number};
    auto cells = split(line, place);
    if (table.columns_.empty()) {
      table.columns_ = std::move(cells);
      table.header_line_ = number;
      if (table.columns_.size() == 1 && table.columns_[0].find(';') != std::string::npos)
        throw InputError(place,
                         "found cells separated by semicolons; expected commas between cells, and "
                         "points in numbers");
      continue;
    }
    if (cells.size() != table.columns_.size()) {
      throw InputError(place, fmt::format("expected {} cells as in the first row, found {}",
                                          table.columns_.size(), cells.size()));
    }
    table.lines_.push_back(number);
    std::move(cells.begin(), cells.end(), std::back_inserter(table.cells_));
  }
  if (table.columns_.empty())
    throw InputError(Location{table.file_}, "expected a row of column names, found nothing");
  return table;
}

std::optional<std::size_t> CsvTable::find(std::string_view name) const {
  std::vector<std::size_t> exact, found;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i] == name) exact.push_back(i);
    if (bare(columns_[i]) == name) found.push_back(i);
  }
  if (!exact.empty()) found = exact;
  if (found.size() > 1)
    throw InputError(Location{file_, header_line_},
                     fmt::format("found the columns \"{}\" and \"{}\"; expected one of that name",
                                 columns_[found[0]], columns_[found[1]]));
  return found.empty() ? std::nullopt : std::make_optional(found[0]);
}

std::size_t CsvTable::column(std::string_view name) const {
  if (const auto found = find(name)) return *found;
  std::vector<std::string> known;
  for (const std::string& column : columns_) known.emplace_back(bare(column));
  throw InputError(Location{file_, header_line_},
                   fmt::format("expected a column \"{}\"; there are: {}{}", name, fmt::join(columns_, ", "),
                               did_you_mean(name, known)));
}

double CsvTable::number(std::size_t row, std::size_t column) const {
  const std::string& cell = cells_[row * columns_.size() + column];
  // from_chars reads no leading plus sign, which other programs write.
  const char* first = cell.data() + (cell.starts_with('+') ? 1 : 0);
  const char* last = cell.data() + cell.size();
  double value = 0;
  const auto [end, problem] = std::from_chars(first, last, value);
  if (problem != std::errc{} || end != last) {
    throw InputError(Location{file_, lines_[row]},
                     fmt::format("column \"{}\": expected a number, found \"{}\"", columns_[column], cell));
  }
  return value;
}

std::vector<double> CsvTable::numbers(std::size_t column) const {
  std::vector<double> values(rows());
  for (std::size_t row = 0; row < rows(); ++row) values[row] = number(row, column);
  return values;
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"#") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

}  // namespace riven
