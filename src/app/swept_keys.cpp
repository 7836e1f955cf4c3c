#include "app/swept_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <sstream>

#include "app/commands.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "input/case_values.hpp"
#include "input/units.hpp"

namespace riven::app {

namespace {

bool is_number(const std::string& word) {
  return word.find_first_not_of("0123456789") == std::string::npos;
}

/// The values of keys that change together: "(12, 6 mm)".
std::vector<std::string> values_together(const std::string& value, std::size_t count,
                                         const std::string& text) {
  if (!value.starts_with('(') || !value.ends_with(')'))
    throw InputError(
        fmt::format("{}: found the value {} for {} keys; expected one for each in round brackets, as in "
                    "number,radius=(12,\"6 mm\"),(24,\"4.2 mm\")",
                    text, value, count));
  std::vector<std::string> values = split_at_commas(value.substr(1, value.size() - 2));
  if (values.size() != count)
    throw InputError(fmt::format("{}: {} has {}; expected {}, one for each key", text, value,
                                 values.size() == 1 ? "1 value" : fmt::format("{} values", values.size()),
                                 count));
  return values;
}

}  // namespace

std::string SweptKeys::name() const {
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string SweptKeys::text(std::size_t row) const {
  return names.size() == 1 ? values[row].front() : fmt::format("({})", fmt::join(values[row], ", "));
}

bool SweptKeys::repeats() const {
  return std::all_of(names.begin(), names.end(),
                     [](const std::string& key) { return last_part(key) == "seed"; });
}

SweptKeys swept_keys(const std::string& text) {
  const std::size_t equals = std::min(text.find('='), text.size());
  SweptKeys keys{.names = split_at_commas(text.substr(0, equals)), .values = {}};
  if (equals == text.size() || std::count(keys.names.begin(), keys.names.end(), "") > 0)
    throw InputError(fmt::format("{}: expected KEY=a,b,c, as in geometry.horizon=\"3 dx\",\"4 dx\"", text));
  const std::size_t count = keys.names.size();
  for (const std::string& value : split_at_commas(text.substr(equals + 1))) {
    auto values = count == 1 || value.empty() ? std::vector{value} : values_together(value, count, text);
    if (std::count(values.begin(), values.end(), "") > 0)
      throw InputError(fmt::format("{}: value {} is empty; expected values with commas between them", text,
                                   keys.values.size() + 1));
    if (std::find(keys.values.begin(), keys.values.end(), values) != keys.values.end())
      throw InputError(fmt::format("{}: the value {} stands there twice", text, value));
    keys.values.push_back(std::move(values));
  }
  return keys;
}

std::vector<SweptKeys> all_swept_keys(const std::vector<std::string>& texts) {
  std::vector<SweptKeys> all;
  std::set<std::string> seen;
  for (const std::string& text : texts) {
    all.push_back(swept_keys(text));
    for (const std::string& name : all.back().names)
      if (!seen.insert(name).second)
        throw InputError(
            fmt::format("{}: the key stands there twice; expected all its values in one list", name));
  }
  return all;
}

std::string last_part(const std::string& key) {
  std::size_t dot = key.rfind('.');
  while (dot != std::string::npos && dot > 0 &&
         is_number(key.substr(dot + 1, key.find('.', dot + 1) - dot - 1)))
    dot = key.rfind('.', dot - 1);
  return dot == std::string::npos ? key : key.substr(dot + 1);
}

std::vector<std::string> short_names(const std::vector<std::string>& keys) {
  std::vector<std::string> names;
  for (const std::string& key : keys) names.push_back(last_part(key));
  const bool told_apart = std::set<std::string>(names.begin(), names.end()).size() == names.size();
  return told_apart ? names : keys;
}

std::optional<SiValue> value_in_si(const Case& input, const std::string& key) {
  // The user counts entries of lists from 1, the resolved case from 0.
  std::string path, name;
  for (std::istringstream names(key); std::getline(names, name, '.');) {
    path.append(path.empty() ? "" : ".")
        .append(is_number(name) ? std::to_string(std::stoul(name) - 1) : name);
  }
  const auto values = case_values(input);
  const auto found = values.find(path);
  if (found == values.end()) return std::nullopt;
  std::string text = found->second;
  std::erase(text, '\'');  // of a TOML string
  SiValue si;
  const char* const end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, si.value);
  if (number.ec != std::errc{}) return std::nullopt;
  if (number.ptr == end) return si;
  const std::string unit(number.ptr + 1, end);
  const auto match = match_unit(unit, 0);
  if (*number.ptr != ' ' || !match || match->length != unit.size()) return std::nullopt;
  si.unit = si_unit(match->unit.dimension);
  return si;
}

}  // namespace riven::app
