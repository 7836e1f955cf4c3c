#include "output/history.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "base/error.hpp"

namespace riven {
namespace {

std::string title(const std::string& name, std::string_view unit) {
  return csv_cell(unit.empty() ? name : fmt::format("{} [{}]", name, unit));
}

}  // namespace

HistoryWriter::HistoryWriter(const std::filesystem::path& path, Parameter parameter,
                             const std::vector<HistoryColumn>& columns)
    : path_(path.string()), stream_(path, std::ios::binary | std::ios::trunc), columns_(columns.size()) {
  std::string line = title(std::string(name(parameter)), unit(parameter));
  for (const HistoryColumn& column : columns) line += ',' + title(column.name, column.unit);
  write_line(line);
}

HistoryWriter::HistoryWriter(const std::filesystem::path& path, std::size_t columns, std::uintmax_t bytes)
    : path_(path.string()), columns_(columns), bytes_(bytes) {
  std::error_code problem;
  const std::uintmax_t there = std::filesystem::file_size(path, problem);
  if (problem || there < bytes)
    throw InputError({path_},
                     fmt::format("has lost rows since the run stopped: expected {} bytes at least", bytes));
  std::filesystem::resize_file(path, bytes);
  stream_.open(path, std::ios::binary | std::ios::app);
}

void HistoryWriter::add(double parameter, std::span<const double> values) {
  if (values.size() != columns_) {
    throw std::invalid_argument(
        fmt::format("a history row of {} values for {} columns", values.size(), columns_));
  }
  std::string line = fmt::format("{}", parameter);
  for (const double value : values) fmt::format_to(std::back_inserter(line), ",{}", value);
  write_line(line);
}

void HistoryWriter::write_line(const std::string& line) {
  stream_ << line << '\n' << std::flush;
  if (!stream_) throw RunError(fmt::format("cannot write {}: is the disk full?", path_));
  bytes_ += line.size() + 1;
}

History History::read(const std::filesystem::path& path) {
  History history;
  history.table_ = CsvTable::read(path, true);
  return history;
}

}  // namespace riven
