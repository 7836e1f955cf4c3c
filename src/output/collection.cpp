#include "output/collection.hpp"

#include <fmt/format.h>

#include <charconv>
#include <pugixml.hpp>
#include <string_view>

#include "base/error.hpp"
#include "output/atomic_file.hpp"

namespace riven {

void Collection::add(double value, const std::filesystem::path& file) {
  entries_.push_back({value, file});
  write();
}

void Collection::replace(std::vector<CollectionEntry> entries) {
  entries_ = std::move(entries);
  // A run that has no state yet has no series.
  if (entries_.empty())
    std::filesystem::remove(path_);
  else
    write();
}

void Collection::write() const {
  pugi::xml_document document;
  auto root = document.append_child("VTKFile");
  root.append_attribute("type") = "Collection";
  root.append_attribute("version") = "1.0";
  root.append_attribute("byte_order") = "LittleEndian";
  auto series = root.append_child("Collection");
  for (const CollectionEntry& entry : entries_) {
    auto node = series.append_child("DataSet");
    node.append_attribute("timestep") = fmt::format("{}", entry.value).c_str();
    node.append_attribute("part") = "0";
    node.append_attribute("file") = entry.file.generic_string().c_str();
  }
  AtomicFile target(path_);
  document.save(target.stream(), "  ");
  target.commit();
}

std::vector<CollectionEntry> read_collection(const std::filesystem::path& path) {
  const Location at{path.string()};
  pugi::xml_document document;
  const auto status = document.load_file(path.c_str());
  if (status.status == pugi::status_file_not_found) throw InputError(at, "there is no such file");
  if (!status)
    throw InputError(at, fmt::format("damaged: {} at byte {}", status.description(), status.offset));
  const auto series = document.child("VTKFile").child("Collection");
  if (!series) throw InputError(at, "not a series of field files: expected <VTKFile> with a <Collection>");

  std::vector<CollectionEntry> entries;
  for (const auto& node : series.children("DataSet")) {
    const std::string_view number = node.attribute("timestep").value();
    const std::string file = node.attribute("file").value();
    CollectionEntry entry{0, path.parent_path() / file};
    const auto [end, problem] = std::from_chars(number.data(), number.data() + number.size(), entry.value);
    if (problem != std::errc{} || end != number.data() + number.size() || file.empty()) {
      throw InputError(
          at, fmt::format("state {}: expected a number as timestep and a file, found \"{}\" and \"{}\"",
                          entries.size() + 1, number, file));
    }
    entries.push_back(std::move(entry));
  }
  return entries;
}

}  // namespace riven
