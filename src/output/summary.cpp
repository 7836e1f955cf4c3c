#include "output/summary.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "output/atomic_file.hpp"

namespace riven {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no NaN or infinity.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

double number(const Json& object, const char* key) {
  const Json& value = object.at(key);
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

/// 0 where a result of an earlier version says nothing.
double optional_number(const Json& object, const char* key) {
  return object.contains(key) ? number(object, key) : 0;
}

Json to_json(const Metrics& metrics) {
  Json object = Json::object();
  for (const auto& [name, metric] : metrics)
    object[name] = {{"value", number(metric.value)}, {"unit", metric.unit}};
  return object;
}

Metrics metrics_from(const Json& object) {
  Metrics metrics;
  for (const auto& [name, metric] : object.items()) {
    metrics[name] = {number(metric, "value"), metric.at("unit").get<std::string>()};
  }
  return metrics;
}

Json to_json(const TimingSummary& timing) {
  Json object = {{"wall_s", number(timing.wall_s)}, {"steps", timing.steps}};
  if (timing.iterations) object["iterations"] = *timing.iterations;
  object["points"] = timing.points;
  object["bonds"] = timing.bonds;
  object["bond_evaluations_per_second"] = number(timing.bond_evaluations_per_second);
  return object;
}

TimingSummary timing_from(const Json& object) {
  TimingSummary timing;
  timing.wall_s = number(object, "wall_s");
  timing.steps = object.at("steps").get<std::int64_t>();
  if (object.contains("iterations")) timing.iterations = object["iterations"].get<std::int64_t>();
  timing.points = object.at("points").get<std::int64_t>();
  timing.bonds = object.at("bonds").get<std::int64_t>();
  timing.bond_evaluations_per_second = number(object, "bond_evaluations_per_second");
  return timing;
}

Json to_json(const EnergySummary& energy) {
  return {{"kinetic", number(energy.kinetic)},
          {"strain", number(energy.strain)},
          {"dissipated", number(energy.dissipated)},
          {"damped", number(energy.damped)},
          {"held", number(energy.held)},
          {"external_work", number(energy.external_work)},
          {"balance_error", number(energy.balance_error)}};
}

EnergySummary energy_from(const Json& object) {
  return {number(object, "kinetic"),         number(object, "strain"),        number(object, "dissipated"),
          optional_number(object, "damped"), optional_number(object, "held"), number(object, "external_work"),
          number(object, "balance_error")};
}

RunStatus status_from(const std::string& text) {
  for (const RunStatus status : {RunStatus::finished, RunStatus::failed, RunStatus::interrupted}) {
    if (text == name(status)) return status;
  }
  throw std::runtime_error(fmt::format("unknown status \"{}\"", text));
}

void read_states(const Json& list, Summary& summary) {
  for (const Json& object : list) {
    for (const Parameter parameter : {Parameter::stretch, Parameter::time, Parameter::cycle}) {
      if (object.contains(name(parameter))) summary.parameter = parameter;
    }
    const std::string key(name(summary.parameter));
    summary.states.push_back({number(object, key.c_str()), metrics_from(object.at("metrics"))});
  }
}

Summary summary_from(const Json& object) {
  Summary summary;
  summary.status = status_from(object.at("status").get<std::string>());
  summary.case_name = object.at("case").get<std::string>();
  summary.version = object.at("version").get<std::string>();
  summary.instruction_set = object.value("instruction_set", std::string());
  summary.metrics = metrics_from(object.at("metrics"));
  read_states(object.at("states"), summary);
  summary.energy = energy_from(object.at("energy"));
  summary.timing = timing_from(object.at("timing"));
  summary.memory_peak_bytes = object.at("memory_peak_bytes").get<std::int64_t>();
  return summary;
}

}  // namespace

void write_summary(const std::filesystem::path& path, const Summary& summary) {
  Json object;
  object["status"] = name(summary.status);
  object["case"] = summary.case_name;
  object["version"] = summary.version;
  object["instruction_set"] = summary.instruction_set;
  object["metrics"] = to_json(summary.metrics);
  object["states"] = Json::array();
  for (const SummaryState& state : summary.states) {
    object["states"].push_back(
        {{std::string(name(summary.parameter)), number(state.value)}, {"metrics", to_json(state.metrics)}});
  }
  object["energy"] = to_json(summary.energy);
  object["timing"] = to_json(summary.timing);
  object["memory_peak_bytes"] = summary.memory_peak_bytes;

  AtomicFile file(path);
  // Names come from the user's file: bytes that are not UTF-8 are replaced rather than stopping the run.
  file.stream() << object.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  file.commit();
}

Summary read_summary(const std::filesystem::path& path) {
  const Location at{path.string()};
  std::ifstream in(path);
  if (!in) throw InputError(at, "there is no such file");
  try {
    return summary_from(Json::parse(in));
  } catch (const std::exception& error) {
    throw InputError(at, fmt::format("not a readable summary of a run: {}", error.what()));
  }
}

std::int64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
}

}  // namespace riven
