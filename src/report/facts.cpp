#include "report/facts.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/text.hpp"

namespace riven {

namespace {

std::string program_of(const Summary& summary) {
  const std::string set =
      summary.instruction_set.empty() ? "" : fmt::format(" ({})", summary.instruction_set);
  return fmt::format("Riven {}{}", summary.version, set);
}

void add_timing(const Summary& summary, std::vector<Fact>& facts) {
  const TimingSummary& timing = summary.timing;
  facts.push_back({"wall time", duration_text(timing.wall_s)});
  facts.push_back(
      {summary.parameter == Parameter::time ? "time steps" : "load steps", grouped(timing.steps)});
  if (timing.iterations) facts.push_back({"iterations", grouped(*timing.iterations)});
  facts.push_back({"points", grouped(timing.points)});
  facts.push_back({"directed bonds", grouped(timing.bonds)});
  if (std::isfinite(timing.bond_evaluations_per_second))
    facts.push_back(
        {"rate", fmt::format("{:.0f} million bonds/s", 1e-6 * timing.bond_evaluations_per_second)});
  facts.push_back({"memory at the peak", bytes_text(static_cast<double>(summary.memory_peak_bytes))});
}

void add_energies(const EnergySummary& energy, std::vector<Fact>& facts) {
  const auto add = [&](const char* label, double joules) {
    if (std::isfinite(joules)) facts.push_back({label, fmt::format("{:.6g} J", joules)});
  };
  add("kinetic energy", energy.kinetic);
  add("strain energy", energy.strain);
  add("dissipated energy", energy.dissipated);
  if (energy.damped != 0) add("damped energy", energy.damped);
  if (energy.held != 0) add("energy held by external forces", energy.held);
  add("initial energy and work of the loads", energy.external_work);
  if (std::isfinite(energy.balance_error))
    facts.push_back({"error of the energy balance", fmt::format("{:.1e}", energy.balance_error)});
}

}  // namespace

std::string_view status_of(const Result& result) {
  return result.summary ? name(result.summary->status) : "unfinished";
}

std::vector<Fact> facts_of(const Result& result) {
  std::vector<Fact> facts = {{"status", std::string(status_of(result))}, {"case", result.name()}};
  if (!result.summary) return facts;
  facts.push_back({"program", program_of(*result.summary)});
  add_timing(*result.summary, facts);
  add_energies(result.summary->energy, facts);
  return facts;
}

}  // namespace riven
