#include "report/result.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "base/error.hpp"
#include "base/nearest_name.hpp"
#include "input/case_reader.hpp"
#include "output/result_folder.hpp"

namespace riven {

namespace fs = std::filesystem;

namespace {

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

/// "x" of a vector, "xy" of a tensor, nothing for what has no names of its own.
std::string component_name(int components, int component) {
  const auto c = static_cast<std::size_t>(component);
  if (components == 3) return kAxes[c];
  if (components == 9) return fmt::format("{}{}", kAxes[c / 3], kAxes[c % 3]);
  return std::to_string(component);
}

Scalar component_of(const PointField& field, int component) {
  Scalar scalar{field.name, field.unit, {}};
  if (field.components > 1) scalar.label += fmt::format(" {}", component_name(field.components, component));
  const auto stride = static_cast<std::size_t>(field.components);
  for (auto at = static_cast<std::size_t>(component); at < field.values.size(); at += stride)
    scalar.values.push_back(field.values[at]);
  return scalar;
}

/// Length of a vector, Frobenius norm of a tensor.
Scalar magnitude_of(const PointField& field) {
  Scalar scalar{field.name + " magnitude", field.unit, {}};
  const auto stride = static_cast<std::size_t>(field.components);
  for (std::size_t at = 0; at < field.values.size(); at += stride) {
    double square = 0;
    for (std::size_t c = 0; c < stride; ++c) square += field.values[at + c] * field.values[at + c];
    scalar.values.push_back(std::sqrt(square));
  }
  return scalar;
}

}  // namespace

Result Result::open(const fs::path& folder) {
  const ResultFolder files = ResultFolder::open(folder);
  Result result;
  result.folder = folder;
  const Case input = read_case(files.resolved());
  result.title = input.title;
  result.spacing = input.geometry.spacing;
  if (fs::exists(files.summary())) result.summary = read_summary(files.summary());
  if (fs::exists(files.history())) result.history = History::read(files.history());
  if (fs::exists(files.energy())) result.energy = History::read(files.energy());
  if (fs::exists(files.collection())) result.states = read_collection(files.collection());
  return result;
}

std::string Result::name() const {
  if (summary && !summary->case_name.empty()) return summary->case_name;
  return fs::weakly_canonical(folder).filename().string();
}

Parameter Result::parameter() const {
  if (summary) return summary->parameter;
  if (!history) return Parameter::stretch;
  const std::string& first = history->columns().front();
  return first.starts_with("time") ? Parameter::time
         : first == "cycle"        ? Parameter::cycle
                                   : Parameter::stretch;
}

std::vector<std::string> scalar_names(const PointCloud& cloud) {
  std::vector<std::string> names;
  for (const PointField& field : cloud.fields) {
    names.push_back(field.name);
    for (int c = 0; field.components > 1 && c < field.components; ++c)
      names.push_back(fmt::format("{}_{}", field.name, component_name(field.components, c)));
  }
  return names;
}

Scalar scalar_of(const PointCloud& cloud, const std::string& name) {
  for (const PointField& field : cloud.fields) {
    if (field.name == name) return field.components == 1 ? component_of(field, 0) : magnitude_of(field);
    for (int c = 0; field.components > 1 && c < field.components; ++c)
      if (name == fmt::format("{}_{}", field.name, component_name(field.components, c)))
        return component_of(field, c);
  }
  const std::vector<std::string> names = scalar_names(cloud);
  throw InputError(
      fmt::format("{}: no such field; the result has {}{}", name, listed(names), did_you_mean(name, names)));
}

}  // namespace riven
