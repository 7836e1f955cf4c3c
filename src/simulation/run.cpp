#include "simulation/run.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <new>
#include <sstream>

#include "base/instruction_set.hpp"
#include "base/machine.hpp"
#include "base/text.hpp"
#include "input/case_writer.hpp"
#include "simulation/estimate.hpp"
#include "simulation/interrupt.hpp"
#include "simulation/preflight.hpp"
#include "simulation/recorder.hpp"
#include "simulation/resume.hpp"
#include "solver/arc_length.hpp"
#include "solver/dynamic_relaxation.hpp"
#include "solver/generalised_alpha.hpp"
#include "solver/newton.hpp"
#include "solver/space_time.hpp"
#include "solver/velocity_verlet.hpp"

namespace riven {

namespace {

/// Of implicit motion, what its methods have in common.
void fill(const Simulation& simulation, TimeStepSettings& settings) {
  const SolverInput& in = simulation.input.solver;
  const OutputInput& out = simulation.input.output;
  settings.until = in.until;
  settings.every = out.every.value_or(in.until);
  settings.history_every = out.history_every.value_or(settings.every);
  settings.step = in.step;
  settings.tolerance = in.tolerance.value();
  settings.step_tolerance = in.step_tolerance;
  settings.inertia = in.inertia;
  if (in.start == "equilibrium") settings.rest_tolerance = in.start_tolerance;
  settings.initial_u = simulation.initial_u;
  settings.initial_v = simulation.initial_v;
  settings.external = simulation.external;
}

State move_implicitly(const Simulation& simulation, Observer& observer, const Snapshot* from) {
  const SolverInput& in = simulation.input.solver;
  if (in.method == "generalised-alpha") {
    GeneralisedAlphaSettings settings;
    fill(simulation, settings);
    settings.spectral_radius = in.spectral_radius;
    return generalised_alpha(*simulation.model, *simulation.constraints, settings, observer, from);
  }
  SpaceTimeSettings settings;
  fill(simulation, settings);
  settings.scheme = in.scheme == "single-field" ? SlabKind::single_field : SlabKind::two_field;
  settings.gauss_points = static_cast<std::size_t>(in.gauss_points);
  return march_slabs(*simulation.model, *simulation.constraints, settings, observer, from);
}

State solve(const Simulation& simulation, Observer& observer, const Snapshot* from) {
  const SolverInput& in = simulation.input.solver;
  if (in.is_implicit_motion()) return move_implicitly(simulation, observer, from);
  if (simulation.parameter == Parameter::time) {
    const OutputInput& out = simulation.input.output;
    VelocityVerletSettings settings{.until = in.until, .step = in.step, .safety = in.safety};
    settings.every = out.every.value_or(in.until);
    settings.history_every = out.history_every.value_or(settings.every);
    settings.initial_u = simulation.initial_u;
    settings.initial_v = simulation.initial_v;
    settings.external = simulation.external;
    settings.damping = in.damping;
    settings.excess = simulation.input.failure.excess;
    if (in.start == "equilibrium") settings.rest_tolerance = in.start_tolerance;
    return march(*simulation.model, *simulation.constraints, settings, observer, from);
  }
  const LoadStepSettings settings{.targets = in.stretch,
                                  .increment = in.increment,
                                  .tolerance = in.tolerance.value(),
                                  .max_iterations = in.max_iterations,
                                  .external = simulation.external};
  if (in.control == "arc-length")
    return follow_path(*simulation.model, *simulation.constraints, {settings, in.max_steps}, observer, from);
  const auto solve_statics = in.method == "newton" ? newton : relax;
  return solve_statics(*simulation.model, *simulation.constraints, settings, observer, from);
}

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Where a run that stopped has left what it reached.
std::string last_state(const Recorder& recorder, const Simulation& simulation, const RunOptions& options) {
  const std::string folder = options.folder.string();
  if (recorder.last().u.empty()) return fmt::format("No state was reached; {} has the log", folder);
  return fmt::format("The last good state, {} {:.6g}, is in {}", name(simulation.parameter),
                     recorder.last().parameter, folder);
}

/// Marches to the end, or to where the run stops, and says why.
RunStatus march_on(const Simulation& simulation, Recorder& recorder, Progress& screen, Log& log,
                   const RunOptions& options, const Snapshot* from) {
  try {
    static_cast<void>(solve(simulation, recorder, from));
    screen.finish();
    return RunStatus::finished;
  } catch (const Interrupted&) {
    log.warning(fmt::format("interrupted. {}. To go on: {}", last_state(recorder, simulation, options),
                            options.resume_command));
    return RunStatus::interrupted;
  } catch (const std::bad_alloc&) {
    log.error(fmt::format("not enough memory for the run; try a larger spacing. {}",
                          last_state(recorder, simulation, options)));
  } catch (const std::exception& problem) {
    log.error(fmt::format("{}: {}. {}", simulation.input.file.string(), problem.what(),
                          last_state(recorder, simulation, options)));
  }
  return RunStatus::failed;
}

/// The result keeps the tables, fields, points, mesh and surfaces that it came from: it runs again wherever
/// it is moved, whatever becomes of the files.
void keep_tables(Case& input, const std::filesystem::path& folder) {
  const bool cracks = std::any_of(input.cracks.begin(), input.cracks.end(),
                                  [](const CrackInput& crack) { return crack.file.has_value(); });
  auto& elements = input.geometry.elements;
  const bool meshed = elements && elements->mesh;
  if (!input.tables.empty() || !input.fields.empty() || input.geometry.points || input.geometry.surface ||
      meshed || cracks)
    std::filesystem::create_directories(folder / "tables");
  for (std::size_t n = 0; n < input.cracks.size(); ++n)  // no table has such a name
    if (auto& crack = input.cracks[n].file) {
      const std::string copy = fmt::format("tables/crack-{}.stl", n + 1);
      std::filesystem::copy_file(input.file.parent_path() / crack->file, folder / copy);
      crack->file = copy;
    }
  if (auto& surface = input.geometry.surface) {
    const std::string copy = "tables/geometry-surface.stl";
    std::filesystem::copy_file(input.file.parent_path() / surface->file, folder / copy);
    surface->file = copy;
  }
  if (meshed) {
    const std::string copy = "tables/geometry-mesh.msh";
    std::filesystem::copy_file(input.file.parent_path() / elements->file, folder / copy);
    elements->file = copy;
  }
  if (input.geometry.points) {
    // No table has this name: formulas could not call it.
    const std::string copy =
        input.geometry.points->is_mesh() ? "tables/geometry-mesh.msh" : "tables/geometry-points.csv";
    std::filesystem::copy_file(input.geometry.points->list->file, folder / copy);
    input.geometry.points->file = copy;
  }
  for (TableInput& table : input.tables) {
    const std::string copy = fmt::format("tables/{}.csv", table.name);
    std::filesystem::copy_file(table.function->file(), folder / copy);
    table.file = copy;
  }
  for (FieldInput& field : input.fields) {  // its name is none of a table
    const std::string copy = fmt::format("tables/{}.csv", field.name);
    std::filesystem::copy_file(field.field->file(), folder / copy);
    field.file = copy;
  }
}

/// Where the resolved case stands, paths relative to the original one lead nowhere. Relative to the result
/// they survive a move of the folder that holds both.
Case with_paths_from(const std::filesystem::path& result, Case input) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::absolute(input.file).parent_path();
  const auto fix = [&](std::vector<ExpectInput>& expects) {
    for (ExpectInput& expect : expects)
      if (!expect.file.empty())
        expect.file = fs::weakly_canonical(folder / expect.file).lexically_relative(result).string();
  };
  fix(input.expects);
  if (input.short_run) fix(input.short_run->expect);
  return input;
}

Summary summary_of(const Recorder& recorder, const Simulation& simulation, RunStatus status,
                   const RunOptions& options) {
  Summary summary = recorder.summary();
  summary.status = status;
  summary.case_name = options.case_name;
  summary.instruction_set = name(instruction_set());
  if (simulation.parameter == Parameter::stretch) summary.timing.iterations = recorder.iterations();
  summary.timing.bond_evaluations_per_second = static_cast<double>(recorder.evaluations()) *
                                               static_cast<double>(summary.timing.bonds) /
                                               summary.timing.wall_s;
  summary.memory_peak_bytes = peak_memory_bytes();
  return summary;
}

/// A new result folder, published with the case in it.
ResultFolder new_folder(const Simulation& simulation, const RunOptions& options, bool replace) {
  ResultFolder folder = ResultFolder::create(options.folder, replace);
  check_disk(simulation, available_disk(folder.path()));
  Case resolved = with_paths_from(folder.target(), simulation.input);
  keep_tables(resolved, folder.path());
  folder.publish(contents(simulation.input.file), resolved_case(resolved));
  return folder;
}

/// Where a run writes, and what it goes on from.
struct Start {
  std::optional<ResultFolder> folder;  // nothing: a new one is to be made
  Resumption resumption;
};

Start find_start(const Case& input, const RunOptions& options) {
  Start start;
  if (!options.resume) return start;
  start.folder.emplace(ResultFolder::go_on(options.folder));
  start.resumption = find_resumption(input, *start.folder);
  // Nothing is lost by starting over where no checkpoint was written.
  if (!start.resumption.finished && !start.resumption.checkpoint) start.folder.reset();
  return start;
}

/// What kind of start this is, for those who asked for --resume.
void tell_start(const Resumption& resumption, const Recorder& recorder, const Simulation& simulation,
                Log& log) {
  if (!resumption.checkpoint) return log.info("there is no checkpoint: the run starts over");
  log.info(fmt::format("going on at {} {:.6g}, after {} steps and {:.1f} s", name(simulation.parameter),
                       recorder.last().parameter, recorder.last().steps, recorder.wall_s()));
  if (resumption.checkpoint->version != this_program())
    log.warning(
        fmt::format("the checkpoint was written by Riven {}, this is Riven {}: the rest may differ in "
                    "the last digits from what an uninterrupted run would give",
                    resumption.checkpoint->version, this_program()));
}

/// Writes what remains to be written. Each part is worth trying: what fails here fails on a full disk,
/// mostly.
Summary conclude(Recorder& recorder, const Simulation& simulation, const ResultFolder& folder, Log& log,
                 const RunOptions& options, RunStatus status) {
  const auto try_to = [&](const auto& write) {
    try {
      write();
    } catch (const std::exception& problem) {
      log.error(problem.what());
      status = RunStatus::failed;
    }
  };
  try_to([&] { recorder.keep_last(); });
  Summary summary = summary_of(recorder, simulation, status, options);
  try_to([&] { write_summary(folder.summary(), summary); });
  summary.status = status;
  std::error_code ignored;
  if (status == RunStatus::finished) std::filesystem::remove(folder.checkpoint(), ignored);
  return summary;
}

/// How large the body is.
std::string size_text(const Simulation& simulation) {
  return simulation.mesh != nullptr
             ? fmt::format("{} nodes, {} elements", simulation.model->points(), simulation.mesh->elements())
             : fmt::format("{} points, {} bonds", simulation.model->points(), simulation.model->bonds());
}

void tell_end(const Summary& summary, const Recorder& recorder, const Simulation& simulation, Log& log,
              const RunOptions& options) {
  const std::string balance =
      simulation.model->conservative()
          ? fmt::format("energy balance {:.1e}", summary.energy.balance_error)
          : std::string("no energy balance: this model's force is not the gradient of its energy");
  const std::string rate =
      simulation.mesh != nullptr
          ? std::string()
          : fmt::format("{:.0f} million bonds/s, ", 1e-6 * summary.timing.bond_evaluations_per_second);
  log.info(fmt::format("{} in {:.1f} s, {} force evaluations, {}{}", name(summary.status),
                       summary.timing.wall_s, recorder.evaluations(), rate, balance));
  if (summary.status == RunStatus::finished)
    log.info(fmt::format("results: {}/ (fields.pvd opens in ParaView; history.csv, summary.json)",
                         options.folder.string()));
}

}  // namespace

Summary run_case(const Case& input, const RunOptions& options) {
  const auto begin = Recorder::Clock::now();
  Progress screen;
  Log log(std::cerr, [&] { screen.clear(); });
  Start start = find_start(input, options);
  if (start.resumption.finished) {
    log.info(fmt::format("{}: the run is finished, there is nothing to resume", options.folder.string()));
    return read_summary(start.folder->summary());
  }
  const Simulation simulation = build_simulation(input);
  Probes probes(simulation);
  check_before_run(simulation, probes);
  if (!start.folder) start.folder.emplace(new_folder(simulation, options, options.force || options.resume));
  const ResultFolder& folder = *start.folder;
  const Checkpoint* from = start.resumption.checkpoint ? &*start.resumption.checkpoint : nullptr;
  Recorder recorder(simulation, probes, folder, screen, log, begin, from);

  log.open(folder.log());
  log.info(fmt::format("{}: {}, {}, about {} of memory and {} -> {}", input.title, size_text(simulation),
                       count_text(omp_get_max_threads(), "thread"), bytes_text(memory_estimate(input)),
                       duration_text(time_estimate(simulation).total_s()), options.folder.string()));
  for (const std::string& warning : warnings(simulation)) log.warning(warning);
  if (options.resume) tell_start(start.resumption, recorder, simulation, log);
  watch_interrupts();
  const RunStatus status =
      march_on(simulation, recorder, screen, log, options, from != nullptr ? &from->state : nullptr);
  const Summary summary = conclude(recorder, simulation, folder, log, options, status);
  tell_end(summary, recorder, simulation, log, options);
  return summary;
}

}  // namespace riven
