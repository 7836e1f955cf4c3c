#include "simulation/resume.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <fstream>
#include <iterator>
#include <set>

#include "input/case_reader.hpp"
#include "input/case_values.hpp"
#include "output/summary.hpp"

namespace riven {

namespace {

constexpr std::size_t kMostListed = 8;  // differences in one message

std::string fingerprint(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const uLong sum = crc32_z(0, reinterpret_cast<const Bytef*>(text.data()), text.size());
  return fmt::format("contents of {} bytes with checksum {:08x}", text.size(), sum);
}

void check_same(const std::map<std::string, std::string>& then, const std::map<std::string, std::string>& now,
                const std::string& folder) {
  std::set<std::string> keys;
  for (const auto* values : {&then, &now})
    for (const auto& [key, value] : *values) keys.insert(key);
  const auto text = [](const std::map<std::string, std::string>& values, const std::string& key) {
    const auto found = values.find(key);
    return found == values.end() ? std::string("nothing") : found->second;
  };
  std::string differences;
  std::size_t count = 0;
  for (const std::string& key : keys)
    if (text(then, key) != text(now, key) && ++count <= kMostListed)
      differences +=
          fmt::format("{}{} (was {}, is {})", count == 1 ? "" : ", ", key, text(then, key), text(now, key));
  if (count > kMostListed) differences += fmt::format(" and {} more", count - kMostListed);
  if (count > 0)
    throw InputError(fmt::format(
        "{}: holds a run of another case: {}; expected the same case and the same --set, or --force "
        "instead of --resume to start over",
        folder, differences));
}

bool is_finished(const ResultFolder& folder) {
  return std::filesystem::exists(folder.summary()) &&
         read_summary(folder.summary()).status == RunStatus::finished;
}

}  // namespace

std::map<std::string, std::string> decisive_values(const Case& input) {
  std::map<std::string, std::string> values = case_values(input);
  std::erase_if(values, [](const auto& item) {
    const std::string& key = item.first;
    return key == "title" || key == "source" || key == "output.checkpoint_every" ||
           key.starts_with("expect.") || key.starts_with("short.") || key.starts_with("study.");
  });
  for (const TableInput& table : input.tables)
    values["table." + table.name + ".file"] = fingerprint(table.function->file());
  for (const FieldInput& field : input.fields)
    values["field." + field.name + ".file"] = fingerprint(field.field->file());
  if (const auto& points = input.geometry.points)
    values[points->is_mesh() ? "geometry.mesh.file" : "geometry.points.file"] =
        fingerprint(points->list->file);
  if (const auto& elements = input.geometry.elements; elements && elements->mesh)
    values["geometry.mesh.file"] = fingerprint(input.file.parent_path() / elements->file);
  for (std::size_t n = 0; n < input.cracks.size(); ++n)
    if (const auto& crack = input.cracks[n].file)
      values[fmt::format("crack.{}.surface.file", n)] = fingerprint(input.file.parent_path() / crack->file);
  if (const auto& surface = input.geometry.surface)
    values["geometry.surface.file"] = fingerprint(input.file.parent_path() / surface->file);
  return values;
}

Resumption find_resumption(const Case& input, const ResultFolder& folder) {
  Resumption found;
  found.finished = is_finished(folder);
  if (!found.finished && std::filesystem::exists(folder.checkpoint()))
    found.checkpoint = read_checkpoint(folder.checkpoint());
  check_same(found.checkpoint ? found.checkpoint->case_values : decisive_values(read_case(folder.resolved())),
             decisive_values(input), folder.path().string());
  return found;
}

}  // namespace riven
