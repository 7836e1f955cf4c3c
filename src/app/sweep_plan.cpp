#include "app/sweep_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <numeric>
#include <set>
#include <sstream>

#include "base/error.hpp"
#include "base/machine.hpp"
#include "base/text.hpp"
#include "input/case_reader.hpp"
#include "input/case_values.hpp"
#include "simulation/estimate.hpp"
#include "simulation/preflight.hpp"
#include "simulation/resume.hpp"

namespace riven::app {

namespace {

constexpr std::size_t kMostVariants = 10000;

/// Every combination of one value of each key, the last key changing fastest.
std::vector<std::vector<std::string>> combinations(const std::vector<SweptKey>& keys) {
  std::vector<std::vector<std::string>> all(1);
  for (const SweptKey& key : keys) {
    std::vector<std::vector<std::string>> longer;
    for (const auto& begun : all)
      for (const std::string& value : key.values) {
        longer.push_back(begun);
        longer.back().push_back(value);
      }
    all = std::move(longer);
    if (all.size() > kMostVariants)
      throw InputError(fmt::format("a sweep of more than {} variants; expected fewer values", kMostVariants));
  }
  return all;
}

std::vector<SweptKey> read_keys(const std::vector<std::string>& texts) {
  std::vector<SweptKey> keys;
  for (const std::string& text : texts) {
    keys.push_back(swept_key(text));
    for (std::size_t n = 0; n + 1 < keys.size(); ++n)
      if (keys[n].name == keys.back().name)
        throw InputError(fmt::format("{}: the key stands there twice; expected all its values in one list",
                                     keys.back().name));
  }
  return keys;
}

std::vector<SweepVariant> make_variants(const std::vector<SweptKey>& keys,
                                        const std::vector<std::string>& set) {
  std::vector<SweepVariant> variants;
  std::set<std::string> names;
  for (auto& values : combinations(keys)) {
    SweepVariant variant{.values = std::move(values), .set = set};
    std::vector<std::string> parts;
    for (std::size_t n = 0; n < keys.size(); ++n)
      parts.push_back(fmt::format("{}={}", keys[n].name, variant.values[n]));
    variant.set.insert(variant.set.end(), parts.begin(), parts.end());
    const std::string name = file_word(fmt::format("{}", fmt::join(parts, ",")));
    variant.name = name;
    for (int number = 2; !names.insert(variant.name).second; ++number)
      variant.name = fmt::format("{}-{}", name, number);
    variants.push_back(std::move(variant));
  }
  return variants;
}

/// The case of a variant as `riven run` reads it.
Case case_of(const std::filesystem::path& file, const SweepVariant& variant) {
  Case input = read_case(file, variant.set);
  drop_unreached_expectations(input);
  return input;
}

void check_side_by_side(std::vector<double> needs, std::size_t jobs) {
  jobs = std::min(jobs, needs.size());
  std::partial_sort(needs.begin(), needs.begin() + static_cast<std::ptrdiff_t>(jobs), needs.end(),
                    std::greater<>());
  const double need = std::accumulate(needs.begin(), needs.begin() + static_cast<std::ptrdiff_t>(jobs), 0.0);
  const double available = available_memory();
  if (jobs > 1 && need > available)
    throw InputError(
        fmt::format("-j {}: {} runs side by side need about {} of memory, and {} are available; "
                    "expected fewer",
                    jobs, jobs, bytes_text(need), bytes_text(available)));
}

std::vector<HistoryColumn> columns_of_first_probe(Simulation& simulation) {
  if (simulation.input.probes.empty()) return {};
  simulation.input.probes.resize(1);
  return Probes(simulation).columns();
}

/// Runs `check` for each variant; what is wrong is told with its variant.
void for_each_checked(SweepPlan& plan, const std::function<void(SweepVariant&)>& check) {
  for (SweepVariant& variant : plan.variants) {
    try {
      check(variant);
    } catch (const InputError& wrong) {
      throw InputError(fmt::format("variant {}: {}", plan.text(variant), wrong.what()));
    }
  }
}

}  // namespace

SweptKey swept_key(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError(fmt::format("{}: expected KEY=a,b,c, as in geometry.horizon=\"3 dx\",\"4 dx\"", text));
  SweptKey key{text.substr(0, equals), split_at_commas(text.substr(equals + 1))};
  for (std::size_t n = 0; n < key.values.size(); ++n) {
    if (key.values[n].empty())
      throw InputError(
          fmt::format("{}: value {} is empty; expected values with commas between them", text, n + 1));
    if (std::find(key.values.begin(), key.values.begin() + static_cast<std::ptrdiff_t>(n), key.values[n]) !=
        key.values.begin() + static_cast<std::ptrdiff_t>(n))
      throw InputError(fmt::format("{}: the value {} stands there twice", text, key.values[n]));
  }
  return key;
}

std::optional<SiValue> value_in_si(const Case& input, const std::string& key) {
  // The user counts entries of lists from 1, the resolved case from 0.
  std::string path, name;
  for (std::istringstream names(key); std::getline(names, name, '.');) {
    const bool is_number = name.find_first_not_of("0123456789") == std::string::npos;
    path.append(path.empty() ? "" : ".").append(is_number ? std::to_string(std::stoul(name) - 1) : name);
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

std::string SweepPlan::text(const SweepVariant& variant) const {
  std::string text;
  for (std::size_t n = 0; n < keys.size(); ++n)
    text.append(n == 0 ? "" : ", ").append(keys[n].name).append("=").append(variant.values[n]);
  return text;
}

SweepPlan plan_sweep(const SweepOptions& options) {
  SweepPlan plan{.file = find_case(options.target), .keys = read_keys(options.keys)};
  plan.title = read_case(plan.file, options.set).title;
  plan.variants = make_variants(plan.keys, options.set);
  std::vector<double> needs;
  for_each_checked(plan, [&](SweepVariant& variant) {
    const Case input = case_of(plan.file, variant);
    for (const SweptKey& key : plan.keys) variant.si.push_back(value_in_si(input, key.name));
    needs.push_back(memory_estimate(input));
    for (const auto& [key, value] : decisive_values(input)) {
      const std::string line = key + "=" + value + "\n";
      plan.checksum =
          ::crc32(plan.checksum, reinterpret_cast<const Bytef*>(line.data()), static_cast<uInt>(line.size()));
    }
  });
  check_side_by_side(std::move(needs), static_cast<std::size_t>(options.jobs));
  for_each_checked(plan, [&](SweepVariant& variant) {
    Simulation simulation = build_simulation(case_of(plan.file, variant));
    check_before_run(simulation, Probes(simulation));
    if (plan.first_probe.empty()) plan.first_probe = columns_of_first_probe(simulation);
  });
  return plan;
}

}  // namespace riven::app
