#include "simulation/crack_probes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "body/crack_extent.hpp"
#include "body/fragments.hpp"

namespace riven {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
// A straight crack lies half a spacing from the nearest points and up to 1.1 from the next ones (45 degrees).
constexpr double kBeside = 0.75;
constexpr double kBranch = 2;     // horizons: an end that is shorter is a ragged edge
constexpr double kWindow = 0.05;  // of the run

bool is_path(const ProbeInput& probe) {
  return probe.kind == "crack-length" || probe.kind == "crack-speed" || probe.kind == "crack-tip" ||
         probe.kind == "crack-angle" || probe.kind == "branches";
}

}  // namespace

CrackProbes::CrackProbes(const Simulation& simulation) : simulation_(simulation) {
  const std::vector<ProbeInput>& probes = simulation.input.probes;
  for (std::size_t n = 0; n < probes.size(); ++n) {
    if (!is_one(probes[n])) continue;
    check(probes[n]);
    memory_[n] = {};
  }
  if (memory_.empty()) return;
  before_ = damages(*simulation.body);
  depth_ = crack_depth(*simulation.body);
}

bool CrackProbes::is_one(const ProbeInput& probe) {
  return is_path(probe) || probe.kind == "crack-area" || probe.kind == "fragments";
}

std::vector<HistoryColumn> CrackProbes::columns(const ProbeInput& probe) {
  if (probe.kind == "crack-length") return {{probe.name, "m"}};
  if (probe.kind == "crack-area") return {{probe.name, "m^2"}};
  if (probe.kind == "crack-speed") return {{probe.name, "m/s"}};
  if (probe.kind == "crack-tip") return {{probe.name + "_x", "m"}, {probe.name + "_y", "m"}};
  if (probe.kind == "crack-angle") return {{probe.name, "deg"}};
  return {{probe.name, ""}};  // branches, fragments
}

void CrackProbes::check(const ProbeInput& probe) const {
  const auto fail = [&](const std::string& what) {
    throw InputError(probe.at, fmt::format("probe {}: {}", probe.name, what));
  };
  if (is_path(probe) && simulation_.body->dimension != 2)
    fail(
        fmt::format("a path of a crack belongs to bodies in two dimensions, this one has {}; expected kind = "
                    "\"crack-area\" or \"fragments\"",
                    simulation_.body->dimension));
  if (Simulation::face(probe.on.text))
    fail(
        fmt::format("\"{}\" is an edge, and edges have no points; expected a set, or nothing for the whole "
                    "body",
                    probe.on.text));
  if (probe.kind == "crack-angle" && probe.length && *probe.length < 2 * simulation_.body->horizon)
    fail(fmt::format(
        "the direction of a crack shows beyond a horizon of {:.4g} m from its beginning; expected "
        "length = \"2 horizon\" or more",
        simulation_.body->horizon));
  if (probe.kind != "crack-speed") return;
  const OutputInput& output = simulation_.input.output;
  const double until = simulation_.input.solver.until;
  const double row = output.history_every.value_or(output.every.value_or(until));
  if (probe.over && *probe.over < 2 * row)
    fail(
        fmt::format("a slope over {:.4g} s needs rows of the history in it, which are {:.4g} s apart; "
                    "expected over = \"{:g} s\" or more, or a shorter history_every",
                    *probe.over, row, 2 * row));
}

CrackProbes::View CrackProbes::view(const ProbeInput& probe) const {
  const Body& body = *simulation_.body;
  return {probe.on.text,
          probe.damage.value_or(share_beyond(body.dimension, kBeside * body.spacing / body.horizon))};
}

/// Numbers of the points of a set, or of all.
std::vector<std::size_t> CrackProbes::points(const std::string& on) const {
  if (!on.empty()) return simulation_.set(on).points;
  std::vector<std::size_t> all(now_.size());
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

CrackPaths CrackProbes::paths(const View& view) const {
  const Body& body = *simulation_.body;
  return {crack_points(body, points(view.on), before_, now_, view.damage), body.spacing};
}

void CrackProbes::look(double parameter) {
  if (memory_.empty()) return;
  now_ = damages(*simulation_.body);
  paths_.clear();
  for (auto& [number, memory] : memory_) {
    const ProbeInput& probe = simulation_.input.probes[number];
    if (!is_path(probe)) continue;
    const View mine = view(probe);
    if (!paths_.contains(mine)) paths_.emplace(mine, paths(mine));
    remember(probe, parameter, memory);
  }
}

void CrackProbes::remember(const ProbeInput& probe, double parameter, Memory& memory) const {
  // A crack that grows wider offers shorter ways: what it was long before, it stays.
  memory.longest = std::max(memory.longest, paths_.at(view(probe)).length());
  if (probe.kind != "crack-speed") return;
  memory.time.push_back(parameter);
  memory.length.push_back(memory.longest);
  const double since = parameter - probe.over.value_or(kWindow * simulation_.input.solver.until);
  // Two rows remain, however far apart: the slope between them is better than none.
  while (memory.time.size() > 2 && memory.time.front() < since) {
    memory.time.erase(memory.time.begin());
    memory.length.erase(memory.length.begin());
  }
}

/// Slope of the line that fits the lengths best.
double CrackProbes::speed(const Memory& memory) const {
  const auto count = static_cast<double>(memory.time.size());
  if (count < 2) return 0;
  const double time = std::accumulate(memory.time.begin(), memory.time.end(), 0.0) / count;
  double above = 0, below = 0;
  for (std::size_t n = 0; n < memory.time.size(); ++n) {
    // Any length may be subtracted; this one makes the speed of a crack at rest exactly 0.
    above += (memory.time[n] - time) * (memory.length[n] - memory.length.front());
    below += (memory.time[n] - time) * (memory.time[n] - time);
  }
  return above / below;
}

std::vector<double> CrackProbes::values(std::size_t number) const {
  const ProbeInput& probe = simulation_.input.probes[number];
  const Body& body = *simulation_.body;
  if (probe.kind == "crack-area") return {crack_area(body, depth_, points(probe.on.text), before_, now_)};
  if (probe.kind == "fragments")
    return {static_cast<double>(find_fragments(body).count(static_cast<std::size_t>(probe.least)))};
  const Memory& memory = memory_.at(number);
  const CrackPaths& now = paths_.at(view(probe));
  if (probe.kind == "crack-length") return {memory.longest};
  if (probe.kind == "crack-speed") return {speed(memory)};
  if (probe.kind == "branches")
    return {static_cast<double>(now.ends(probe.length.value_or(kBranch * body.horizon)))};
  if (probe.kind == "crack-angle") {
    // Nearer to its beginning than a horizon, an old crack takes part in the damage.
    const double to = probe.length.value_or(std::numeric_limits<double>::infinity());
    const auto angle = now.angle(body.horizon, to);
    return {angle ? *angle * 180 / std::numbers::pi : kNothing};
  }
  const Point tip = now.tip().value_or(Point{kNothing, kNothing, 0});
  return {tip[0], tip[1]};
}

template <class Self, class Each>
void CrackProbes::each_member(Self& self, const Each& each) {
  for (auto& [number, memory] : self.memory_) {
    each(fmt::format("probes.{}.longest", number), memory.longest);
    each(fmt::format("probes.{}.time", number), memory.time);
    each(fmt::format("probes.{}.length", number), memory.length);
  }
}

void CrackProbes::save(Snapshot& to) const {
  each_member(*this, to.saving());
}

void CrackProbes::restore(const Snapshot& from) {
  each_member(*this, from.restoring());
}

}  // namespace riven
