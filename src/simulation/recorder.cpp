#include "simulation/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "output/vtu.hpp"
#include "simulation/interrupt.hpp"

namespace riven {

Recorder::Recorder(const Simulation& simulation, const Probes& probes, const ResultFolder& folder,
                   Progress& screen, Log& log)
    : simulation_(simulation),
      probes_(probes),
      folder_(folder),
      screen_(screen),
      log_(log),
      history_(folder.history(), simulation.parameter, probes.columns()),
      collection_(folder.collection()) {}

void Recorder::progressed(const SolverProgress& progress) {
  evaluations_ = progress.evaluations;
  if (interrupt_requested()) throw Interrupted();
  ProgressState state;
  state.parameter = simulation_.parameter;
  state.value = progress.parameter;
  state.fraction = (progress.reached - progress.begin) / (progress.end - progress.begin);
  state.iterations = simulation_.parameter == Parameter::time ? progress.step : progress.iteration;
  state.balance_error = last_.energy.error();
  if (simulation_.parameter != Parameter::time) {
    state.load_step = static_cast<int>(progress.step);
    state.load_steps = static_cast<int>(progress.steps);
    state.residual = progress.residual;
    state.step_done = progress.residual <= progress.tolerance;
  }
  screen_.update(state);
}

void Recorder::reached(const State& state, const Constraints& constraints, bool output) {
  last_ = state;
  evaluations_ = state.evaluations;
  last_written_ = false;
  const std::vector<double> values = probes_.evaluate(state, constraints);
  metrics_ = probes_.metrics(values);
  history_.add(state.parameter, values);
  log_.detail(fmt::format("{} {:.6g}: {} force evaluations, strain energy {:.8g} J, energy balance {:.2e}",
                          name(simulation_.parameter), state.parameter, state.evaluations,
                          state.energy.strain, state.energy.error()));
  if (output) write_fields();
}

void Recorder::remarked(const std::string& message) {
  log_.warning(message);
}

void Recorder::write_fields() {
  PointCloud cloud;
  cloud.positions = simulation_.model->positions();
  const auto asked = [&](const std::string& field) {
    const auto& fields = simulation_.input.output.fields;
    return std::find(fields.begin(), fields.end(), field) != fields.end();
  };
  if (asked("displacement")) {
    PointField field{"displacement", 3, {}};
    for (const Point& u : simulation_.model->displacements(last_.u))
      field.values.insert(field.values.end(), u.begin(), u.end());
    cloud.fields.push_back(std::move(field));
  }
  for (ModelField& field : simulation_.model->fields(last_.u))
    if (asked(field.name)) cloud.fields.push_back({field.name, field.components, std::move(field.values)});
  const auto file = ResultFolder::field(static_cast<int>(states_.size()));
  write_vtu(folder_.path() / file, cloud);
  collection_.add(last_.parameter, file);
  states_.push_back({last_.parameter, metrics_});
  last_written_ = true;
}

void Recorder::keep_last() {
  if (!last_written_) write_fields();
}

Summary Recorder::summary() const {
  Summary summary;
  summary.parameter = simulation_.parameter;
  summary.metrics = metrics_;
  summary.states = states_;
  const EnergyBalance& energy = last_.energy;
  summary.energy = {energy.kinetic, energy.strain, energy.dissipated, energy.external_work, energy.error()};
  summary.timing.steps = last_.steps;
  summary.timing.points = static_cast<std::int64_t>(simulation_.model->points());
  summary.timing.bonds = static_cast<std::int64_t>(simulation_.model->bonds());
  return summary;
}

}  // namespace riven
