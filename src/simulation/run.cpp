#include "simulation/run.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <chrono>
#include <fstream>
#include <iostream>
#include <sstream>

#include "input/case_writer.hpp"
#include "simulation/interrupt.hpp"
#include "simulation/recorder.hpp"
#include "solver/dynamic_relaxation.hpp"
#include "solver/velocity_verlet.hpp"

namespace riven {

namespace {

State solve(const Simulation& simulation, Observer& observer) {
  const SolverInput& in = simulation.input.solver;
  if (simulation.parameter == Parameter::time) {
    const OutputInput& out = simulation.input.output;
    VelocityVerletSettings settings{.until = in.until, .step = in.step, .safety = in.safety};
    settings.every = out.every.value_or(in.until);
    settings.history_every = out.history_every.value_or(settings.every);
    return march(*simulation.model, *simulation.constraints, settings, observer);
  }
  const DynamicRelaxationSettings settings{.targets = in.stretch,
                                           .increment = in.increment,
                                           .tolerance = in.tolerance,
                                           .max_iterations = in.max_iterations};
  return relax(*simulation.model, *simulation.constraints, settings, observer);
}

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string last_state(const Recorder& recorder, const Simulation& simulation) {
  return fmt::format("{} {:.6g}", name(simulation.parameter), recorder.last().parameter);
}

}  // namespace

Summary run_case(const Case& input, const RunOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const Simulation simulation = build_simulation(input);
  const Probes probes(simulation);
  ResultFolder folder = ResultFolder::create(options.folder, options.force);
  folder.publish(contents(input.file), resolved_case(input));

  Progress screen;
  Log log(std::cerr, [&] { screen.clear(); });
  log.open(folder.log());
  log.info(fmt::format("{}: {} points, {} bonds, {} threads -> {}", input.title, simulation.model->points(),
                       simulation.model->bonds(), omp_get_max_threads(), options.folder.string()));
  Recorder recorder(simulation, probes, folder, screen, log);
  watch_interrupts();
  RunStatus status = RunStatus::finished;
  try {
    static_cast<void>(solve(simulation, recorder));
    screen.finish();
  } catch (const Interrupted&) {
    status = RunStatus::interrupted;
    log.warning(fmt::format("interrupted; the last good state, {}, is in {}", last_state(recorder, simulation),
                            options.folder.string()));
  } catch (const SolverFailure& failure) {
    status = RunStatus::failed;
    log.error(fmt::format("{}: {}. The last good state, {}, is in {}", input.file.string(), failure.what(),
                          last_state(recorder, simulation), options.folder.string()));
  }
  recorder.keep_last();

  Summary summary = recorder.summary();
  summary.status = status;
  summary.case_name = options.case_name;
  summary.timing.wall_s = seconds_since(start);
  if (simulation.parameter == Parameter::stretch) summary.timing.iterations = recorder.last().evaluations;
  summary.timing.bond_evaluations_per_second =
      static_cast<double>(recorder.last().evaluations) * static_cast<double>(summary.timing.bonds) / summary.timing.wall_s;
  summary.memory_peak_bytes = peak_memory_bytes();
  write_summary(folder.summary(), summary);
  log.info(fmt::format("{} in {:.1f} s, {} force evaluations, {:.0f} million bonds/s, energy balance {:.1e}",
                       name(status), summary.timing.wall_s, recorder.last().evaluations,
                       1e-6 * summary.timing.bond_evaluations_per_second, summary.energy.balance_error));
  return summary;
}

}  // namespace riven
