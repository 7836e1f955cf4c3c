#include "simulation/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "body/fragments.hpp"
#include "output/atomic_file.hpp"
#include "output/vtu.hpp"
#include "simulation/interrupt.hpp"
#include "simulation/materials.hpp"
#include "simulation/resume.hpp"

namespace riven {

namespace {

constexpr const char* kHistoryBytes = "recorder.history_bytes";
constexpr const char* kEnergyBytes = "recorder.energy_bytes";

/// A history that begins, or one that goes on behind the length that the checkpoint knows under `key`.
HistoryWriter open_history(const std::filesystem::path& path, Parameter parameter,
                           const std::vector<HistoryColumn>& columns, const Checkpoint* from,
                           const char* key) {
  if (from == nullptr) return {path, parameter, columns};
  std::uintmax_t bytes = 0;
  from->state.restoring()(key, bytes);
  return {path, columns.size(), bytes};
}

const std::vector<HistoryColumn> kEnergyColumns = {
    {"kinetic", "J"}, {"strain", "J"},        {"dissipated", "J"},  {"damped", "J"},
    {"held", "J"},    {"external_work", "J"}, {"balance_error", ""}};

/// Fragments in the order of the points that are shown: the body's, then those of the inclusions.
std::vector<double> of_shown_points(const Body& body, const std::vector<std::uint32_t>& fragment) {
  std::vector<double> values(fragment.begin(),
                             fragment.begin() + static_cast<std::ptrdiff_t>(body.points.size()));
  for (std::size_t n = 0; n < body.rigid_points.size(); ++n)
    values.insert(values.end(), body.rigid_points[n].size(), fragment[body.points.size() + n]);
  return values;
}

/// The elements by their corners.
std::vector<Cells> cells_of(const MeshBody& mesh) {
  Cells cells;
  switch (mesh.shape) {
    case ElementShape::t3:
      cells.kind = CellKind::triangle;
      break;
    case ElementShape::t4:
      cells.kind = CellKind::tetrahedron;
      break;
    case ElementShape::h8:
      cells.kind = CellKind::hexahedron;
      break;
    default:
      cells.kind = CellKind::quad;
  }
  for (std::size_t e = 0; e < mesh.elements(); ++e) {
    const auto nodes = mesh.nodes(e).first(corners(cells.kind));
    cells.nodes.insert(cells.nodes.end(), nodes.begin(), nodes.end());
  }
  return {std::move(cells)};
}

double seconds_since(Recorder::Clock::time_point start) {
  return std::chrono::duration<double>(Recorder::Clock::now() - start).count();
}

}  // namespace

Recorder::Recorder(const Simulation& simulation, Probes& probes, const ResultFolder& folder, Progress& screen,
                   Log& log, Clock::time_point start, const Checkpoint* from)
    : simulation_(simulation),
      probes_(probes),
      folder_(folder),
      screen_(screen),
      log_(log),
      history_(open_history(folder.history(), simulation.parameter, probes.columns(), from, kHistoryBytes)),
      energy_(open_history(folder.energy(), simulation.parameter, kEnergyColumns, from, kEnergyBytes)),
      collection_(folder.collection()),
      start_(start),
      last_checkpoint_(Clock::now()),
      case_values_(decisive_values(simulation.input)) {
  if (from != nullptr) go_on(from->state);
}

template <class Self, class Each>
void Recorder::each_member(Self& self, const Each& each) {
  State::each_member(self.last_, "recorder.last", each);
  each("recorder.last_values", self.last_values_);
  each("recorder.evaluations", self.evaluations_);
  each("recorder.iterations", self.iterations_);
  each("recorder.last_written", self.last_written_);
  each("recorder.states", self.state_values_);
}

void Recorder::go_on(const Snapshot& from) {
  const auto each = from.restoring();
  each_member(*this, each);
  each("recorder.wall_s", wall_before_s_);
  probes_.restore(from);
  screen_.add_elapsed(wall_before_s_);
  const std::vector<double> rows = std::exchange(state_values_, {});
  const std::size_t width = 1 + probes_.columns().size();
  std::vector<CollectionEntry> files;
  for (std::size_t begin = 0; begin + width <= rows.size(); begin += width) {
    files.push_back({rows[begin], ResultFolder::field(static_cast<int>(states_.size()))});
    const auto first = rows.begin() + static_cast<std::ptrdiff_t>(begin);
    add_state(*first, {first + 1, first + static_cast<std::ptrdiff_t>(width)});
  }
  // In this order a killed program leaves a folder that can be read, and resumed again.
  std::filesystem::remove(folder_.summary());
  collection_.replace(std::move(files));
  folder_.cut_off(static_cast<int>(states_.size()));
}

void Recorder::safe_point(const std::function<Snapshot()>& take) {
  const CheckpointInterval& every = simulation_.input.output.checkpoint_every;
  ++steps_since_checkpoint_;
  const bool due = (every.steps > 0 && steps_since_checkpoint_ >= every.steps) ||
                   (every.seconds > 0 && seconds_since(last_checkpoint_) >= every.seconds);
  const bool stop = interrupt_requested();
  if (!due && !stop) return;
  try {
    write_checkpoint(take());
  } catch (const RunError& problem) {
    log_.warning(fmt::format("{} The run has no newer checkpoint", problem.what()));
  }
  steps_since_checkpoint_ = 0;
  last_checkpoint_ = Clock::now();
  if (stop) throw Interrupted();
}

void Recorder::write_checkpoint(Snapshot state) {
  bring_results_to_disk();
  const auto each = state.saving();
  each_member(*this, each);
  each(kHistoryBytes, history_.bytes());
  each(kEnergyBytes, energy_.bytes());
  each("recorder.wall_s", wall_s());
  probes_.save(state);
  riven::write_checkpoint(folder_.checkpoint(), {.case_values = case_values_, .state = std::move(state)});
  log_.detail(fmt::format("checkpoint at {} {:.6g}", name(simulation_.parameter), last_.parameter));
}

/// A checkpoint counts on the files that were written before it.
void Recorder::bring_results_to_disk() {
  sync_to_disk(folder_.history());
  sync_to_disk(folder_.energy());
  if (states_on_disk_ == states_.size()) return;
  for (; states_on_disk_ < states_.size(); ++states_on_disk_)
    sync_to_disk(folder_.path() / ResultFolder::field(static_cast<int>(states_on_disk_)));
  sync_to_disk(folder_.collection());
  sync_to_disk(folder_.path() / "fields");
}

double Recorder::wall_s() const {
  return wall_before_s_ + seconds_since(start_);
}

void Recorder::progressed(const SolverProgress& progress) {
  evaluations_ = progress.evaluations;
  iterations_ = progress.iterations;
  ProgressState state;
  state.parameter = simulation_.parameter;
  state.value = progress.parameter;
  state.fraction = (progress.reached - progress.begin) / (progress.end - progress.begin);
  state.iterations = simulation_.parameter == Parameter::time ? progress.step : progress.iteration;
  state.balance_error = energy().balance_error;
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
  last_model_ = {};
  simulation_.model->save(last_model_);
  evaluations_ = state.evaluations;
  iterations_ = state.iterations;
  last_written_ = false;
  last_values_ = probes_.evaluate(state, constraints);
  history_.add(state.parameter, last_values_);
  const EnergySummary now = energy();
  energy_.add(state.parameter, std::array{now.kinetic, now.strain, now.dissipated, now.damped, now.held,
                                          now.external_work, now.balance_error});
  log_.detail(fmt::format("{} {:.6g}: {} force evaluations, strain energy {:.8g} J, energy balance {:.2e}",
                          name(simulation_.parameter), state.parameter, state.evaluations, now.strain,
                          now.balance_error));
  if (output) write_fields();
}

void Recorder::remarked(const std::string& message) {
  log_.warning(message);
}

void Recorder::write_fields() {
  PointCloud cloud;
  cloud.positions = simulation_.model->positions();
  if (simulation_.mesh != nullptr) cloud.cells = cells_of(*simulation_.mesh);
  const auto asked = [&](const std::string& field) {
    const auto& fields = simulation_.input.output.fields;
    return std::find(fields.begin(), fields.end(), field) != fields.end();
  };
  if (asked("displacement")) {
    PointField field{"displacement", 3, {}, "m"};
    for (const Point& u : simulation_.model->displacements(last_.u))
      field.values.insert(field.values.end(), u.begin(), u.end());
    cloud.fields.push_back(std::move(field));
  }
  for (ModelField& field : simulation_.model->fields(last_.u)) {
    if (field.name == "deformation_gradient") look_at_rotations(field);
    if (asked(field.name))
      cloud.fields.push_back({field.name, field.components, std::move(field.values), field.unit});
  }
  if (asked("fragment")) {
    const std::vector<std::uint32_t> numbers = find_fragments(*simulation_.body).number;
    cloud.fields.push_back({"fragment", 1, of_shown_points(*simulation_.body, numbers), ""});
  }
  const auto file = ResultFolder::field(static_cast<int>(states_.size()));
  write_vtu(folder_.path() / file, cloud);
  collection_.add(last_.parameter, file);
  add_state(last_.parameter, last_values_);
  last_written_ = true;
}

/// Tells the first state in which rotations are too large for the law.
void Recorder::look_at_rotations(const ModelField& gradient) {
  if (rotations_told_) return;
  if (const auto warning = rotation_warning(simulation_.input, gradient)) {
    log_.warning(fmt::format("at {} {:.6g} {}", name(simulation_.parameter), last_.parameter, *warning));
    rotations_told_ = true;
  }
}

void Recorder::add_state(double parameter, const std::vector<double>& values) {
  states_.push_back({parameter, probes_.metrics(values)});
  state_values_.push_back(parameter);
  state_values_.insert(state_values_.end(), values.begin(), values.end());
}

/// What the model has gone through since, such as bonds that broke on the way to a state that was not
/// reached, is no part of that state.
void Recorder::keep_last() {
  if (last_written_) return;
  if (!last_model_.arrays.empty()) simulation_.model->restore(last_model_);
  write_fields();
}

EnergySummary Recorder::energy() const {
  const EnergyBalance& is = last_.energy;
  const double error =
      simulation_.model->conservative() ? is.error() : std::numeric_limits<double>::quiet_NaN();
  return {is.kinetic, is.strain, is.dissipated, is.damped, is.held, is.external_work, error};
}

Summary Recorder::summary() const {
  Summary summary;
  summary.parameter = simulation_.parameter;
  if (!last_values_.empty()) summary.metrics = probes_.metrics(last_values_);
  summary.timing.wall_s = wall_s();
  summary.states = states_;
  summary.energy = energy();
  summary.timing.steps = last_.steps;
  summary.timing.points = static_cast<std::int64_t>(simulation_.model->points());
  summary.timing.bonds = static_cast<std::int64_t>(simulation_.model->bonds());
  return summary;
}

}  // namespace riven
