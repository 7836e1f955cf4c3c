#include "solver/arc_length.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/norms.hpp"

namespace riven {

namespace {

constexpr long kMostIterations = 12;      // of a step
constexpr long kFewIterations = 4;        // after which a step may be longer
constexpr double kLeastCosine = 0.8;      // of the angle by which the path may turn in a step
constexpr double kStraight = 0.97;        // after which a step may be longer
constexpr double kLongestChord = 1.5;     // lengths of a step between its ends
constexpr double kLongestCorrection = 2;  // lengths of a step
constexpr int kMostHalvings = 14;         // of the longest step
constexpr double kDifference = 1e-5;      // of the parameter's range
constexpr double kSameParameter = 1e-12;
// Displacements of such a strain are next to none.
constexpr double kLeastStrain = 1e-6;

/// How the equilibria behind a point are, by the negative eigenvalues of their tangent.
std::string stability(int negative) {
  if (negative == 0) return "stable";
  return fmt::format("unstable in {} way{}", negative, negative == 1 ? "" : "s");
}

}  // namespace

ArcLength::ArcLength(Model& model, Constraints& constraints, const ArcLengthSettings& settings,
                     Observer& observer)
    : model_(model),
      constraints_(constraints),
      settings_(settings),
      observer_(observer),
      forces_(model, constraints, settings.loads.external),
      tangent_(model, constraints, settings.loads.external,
               kDifference * std::abs(settings.loads.targets.back() - settings.loads.start)) {
  state_.u.assign(model.dofs(), 0.0);
  state_.parameter = settings.loads.start;
  start_ = state_.u;
}

State ArcLength::run(const Snapshot* from) {
  if (from != nullptr)
    restore(*from);
  else
    constraints_.set_parameter(settings_.loads.start);
  const std::vector<double>& targets = settings_.loads.targets;
  while (target_ < targets.size() && state_.steps < settings_.max_steps) {
    if (!stepping_) begin_step();
    iterate();
    observer_.safe_point([this] { return save(); });
  }
  if (target_ < targets.size())
    observer_.remarked(
        fmt::format("the path ends at stretch {:.6g}, after {} steps (solver.max_steps), "
                    "before it has reached {:.6g}",
                    state_.parameter, state_.steps, targets[target_]));
  return std::move(state_);
}

Snapshot ArcLength::save() const {
  Snapshot to;
  each_member(*this, to.saving());
  work_.save(to);
  constraints_.save(to);
  model_.save(to);
  for (const auto& external : settings_.loads.external) external->save(to);
  return to;
}

void ArcLength::restore(const Snapshot& from) {
  each_member(*this, from.restoring());
  work_.restore(from);
  constraints_.restore(from);
  model_.restore(from);
  for (const auto& external : settings_.loads.external) external->restore(from);
}

/// A length ahead on the path; the first step finds the equilibrium that it starts from.
void ArcLength::begin_step() {
  start_ = state_.u;
  next_ = state_.parameter;
  held_ = !under_way();
  constraints_.apply(state_.u);
  if (under_way()) move(direction_.u, direction_.parameter, length_);
  begin_iterations();
}

void ArcLength::begin_iterations() {
  forces_.rescale(state_);
  iteration_ = 0;
  corrections_.begin();
  stepping_ = true;
}

void ArcLength::iterate() {
  if (const auto failure = forces_.evaluate(state_)) return retreat(*failure);
  if (const auto alarm = forces_.alarm(state_)) return retreat(*alarm);
  report();
  const double tolerance = settings_.loads.tolerance;
  const bool rests = norm(forces_.values()) <= tolerance * std::max(scale_, forces_.scale());
  ++state_.iterations;
  const bool unloaded = !under_way() && iteration_ == 0;  // at rest where it is, but for rounding
  if (rests && (unloaded || corrections_.left() <= tolerance)) return arrive();
  if (++iteration_ > kMostIterations)
    return retreat(
        fmt::format("not converged in {} iterations: {}", kMostIterations, forces_.unrest(tolerance)));
  if (const auto failure = correct()) retreat(*failure);
}

/// One iteration of Newton's method on the bordered system, K du - q dp = r, direction . (du, dp) = 0:
/// the first guess lies on the plane already.
std::optional<std::string> ArcLength::correct() {
  if (!tangent_.factor(state_.u, forces_.row_bounds())) return "the tangent is singular";
  Direction step{std::vector<double>(state_.u.size())};
  tangent_.solve(forces_.values(), step.u);
  if (!held_) {
    Direction response{std::vector<double>(state_.u.size()), 1};
    if (auto failure = tangent_.follow(state_, forces_, response.u)) return failure;
    step.parameter = -product(direction_, step) / product(direction_, response);
    for (std::size_t i = 0; i < step.u.size(); ++i) step.u[i] += step.parameter * response.u[i];
  }
  if (!under_way()) {
    move(step.u, 0);
    const double least = kLeastStrain * model_.spacing() * std::sqrt(static_cast<double>(step.u.size()));
    corrections_.add(norm(step.u) / (norm(state_.u) + least));
    return std::nullopt;
  }
  const double size = std::sqrt(product(step, step));
  if (!(size <= kLongestCorrection * length_)) return "Newton's method leads away from the path";
  move(step.u, step.parameter);
  corrections_.add(size / longest_);
  return std::nullopt;
}

/// Moves the state along a direction, and what is prescribed with it.
void ArcLength::move(std::span<const double> du, double dp, double part) {
  for (std::size_t i = 0; i < du.size(); ++i) state_.u[i] += part * du[i];
  next_ += part * dp;
  constraints_.set_parameter(next_);
  constraints_.apply(state_.u);
}

double ArcLength::product(const Direction& a, const Direction& b) const {
  return metric_ * dot(a.u, b.u) + a.parameter * b.parameter;
}

/// From the start of this step to the present state.
ArcLength::Direction ArcLength::travelled() const {
  Direction way{std::vector<double>(state_.u.size()), next_ - state_.parameter};
  for (std::size_t i = 0; i < way.u.size(); ++i)
    if (constraints_.is_free(i)) way.u[i] = state_.u[i] - start_[i];
  return way;
}

/// The body is at rest: on the path, unless Newton's method has led to another one.
void ArcLength::arrive() {
  if (const auto breakdown = model_.inspect(state_.u)) return retreat(text(*breakdown));
  if (passed_target()) return;
  Direction next{std::vector<double>(state_.u.size()), 1};
  if (const auto failure = find_direction(next)) return retreat(*failure);
  if (direction_.u.empty()) return set_out(std::move(next));
  const Direction way = travelled();
  const double length = std::sqrt(product(way, way)), cosine = product(direction_, next);
  if (cosine < kLeastCosine || length > kLongestChord * length_) return retreat("the path turns too sharply");
  watch(next, length);
  balance();
  accept(std::move(next), length);
  if (!held_) adapt(cosine);
}

/// Where the step has passed the next target, aims at it instead, from in between.
bool ArcLength::passed_target() {
  if (held_) return false;
  const double target = settings_.loads.targets[target_];
  const double onwards = settings_.loads.targets.back() < settings_.loads.start ? -1 : 1;
  if (onwards * (next_ - target) <= kSameParameter * std::abs(target)) return false;
  const Direction way = travelled();
  move(way.u, way.parameter, (target - next_) / way.parameter);
  next_ = target;
  constraints_.set_parameter(next_);
  constraints_.apply(state_.u);
  held_ = true;
  begin_iterations();
  return true;
}

/// Direction of the path at the present equilibrium, onwards from the last one.
std::optional<std::string> ArcLength::find_direction(Direction& to) {
  if (!tangent_.factor(state_.u, forces_.row_bounds())) return "the tangent is singular";
  if (auto failure = tangent_.follow(state_, forces_, to.u)) return failure;
  if (auto failure = forces_.evaluate(state_))
    return failure;  // what observers ask for is that of this state
  if (!under_way()) set_metric(to);
  double size = std::sqrt(product(to, to));
  const bool onwards = direction_.u.empty() ? settings_.loads.targets.front() > settings_.loads.start
                                            : product(direction_, to) > 0;
  if (!onwards) size = -size;
  for (double& value : to.u) value /= size;
  to.parameter /= size;
  return std::nullopt;
}

void ArcLength::set_metric(const Direction& first) {
  const double softness2 = dot(first.u, first.u);
  if (!(softness2 > 0))
    throw SolverFailure(
        "the loads do not change with the stretch, which arc-length control scales them by; expected loads "
        "such as \"-1 mm * (stretch - 1)\"");
  metric_ = 1 / softness2;
  length_ = longest_ = std::sqrt(2.0) * settings_.loads.increment;
}

/// The path begins at the equilibrium under the loads of the start. What has brought the body there is not
/// known, but that it is in the body now.
void ArcLength::set_out(Direction first) {
  stepping_ = false;
  direction_ = std::move(first);
  negative_ = tangent_.negative();
  scale_ = forces_.scale();
  work_.begin(constraints_, 0);
  for (const auto& external : settings_.loads.external) external->advance(state_.u, next_);
  EnergyBalance& energy = state_.energy;
  energy.strain = model_.strain_energy(state_.u);
  for (const auto& external : settings_.loads.external) energy.held += external->held(state_.u, next_);
  energy.external_work = energy.strain + energy.held;
  energy.largest = std::max(std::abs(energy.strain), forces_.least_energy());
}

void ArcLength::accept(Direction next, double length) {
  stepping_ = false;
  path_ += length;
  direction_ = std::move(next);
  scale_ = std::max(scale_, forces_.scale());
  state_.parameter = next_;
  for (const auto& external : settings_.loads.external) external->advance(state_.u, next_);
  ++state_.steps;
  const double target = settings_.loads.targets[target_];
  const bool there = std::abs(next_ - target) <= kSameParameter * std::abs(target);
  if (there) ++target_;
  observer_.reached(state_, constraints_, there || state_.steps == settings_.max_steps);
}

void ArcLength::adapt(double cosine) {
  if (cosine > kStraight && iteration_ <= kFewIterations) length_ = std::min(2 * length_, longest_);
}

/// Energies of the new state. The work of prescribed displacements is an integral along the path's length:
/// over the parameter it would have no end where the path turns.
void ArcLength::balance() {
  EnergyBalance& energy = state_.energy;
  const Direction way = travelled();
  energy.strain = model_.strain_energy(state_.u);
  energy.external_work += work_.since_last_call(constraints_, path_ + std::sqrt(product(way, way)));
  energy.held = 0;
  for (const auto& external : settings_.loads.external) {
    energy.external_work += external->work(start_, state_.parameter, state_.u, next_);
    energy.held += external->held(state_.u, next_);
  }
  energy.largest = std::max(
      {energy.largest, std::abs(energy.strain), std::abs(energy.external_work), forces_.least_energy()});
}

/// Back to the start of the step, to go on with half of it.
void ArcLength::retreat(const std::string& failure) {
  if (direction_.u.empty() || length_ < std::ldexp(longest_, -kMostHalvings)) give_up(failure);
  length_ *= 0.5;
  stepping_ = false;
  state_.u = start_;
  constraints_.set_parameter(state_.parameter);
}

[[noreturn]] void ArcLength::give_up(const std::string& failure) const {
  if (direction_.u.empty())
    throw SolverFailure(
        fmt::format("no equilibrium under the loads of stretch {:.6g}, where the path "
                    "begins: {}. Try loads that are less there, or {}",
                    state_.parameter, failure, model_.remedies()));
  throw SolverFailure(
      fmt::format("the path of equilibria is lost beyond stretch {:.6g} (step {}), even in steps {} times "
                  "shorter: {}. It may end there, as the law does not stand the state, or meet another one; "
                  "try {}, a smaller solver.tolerance, or a small load to one side, which takes paths apart",
                  state_.parameter, state_.steps + 1, 1 << kMostHalvings, failure, model_.remedies()));
}

/// Tells what the path has gone through since the last equilibrium. A limit point takes one eigenvalue of the
/// tangent through zero; what else goes through takes a branch with it.
void ArcLength::watch(const Direction& next, double length) {
  const int before = std::exchange(negative_, tangent_.negative()), change = negative_ - before;
  const bool turned = direction_.parameter * next.parameter < 0;
  if (turned) tell_limit(next, length);
  const int of_limit = !turned ? 0 : change < 0 ? -1 : 1;
  if (change != of_limit) tell_branches(next, length, change - of_limit);
}

/// The parameter on the way to the next equilibrium, by its values and slopes at the ends.
ArcLength::Cubic ArcLength::parameter_on(const Direction& next, double length) const {
  const double rise = next_ - state_.parameter, first = length * direction_.parameter,
               last = length * next.parameter;
  return {{state_.parameter, first, 3 * rise - 2 * first - last, first + last - 2 * rise}};
}

void ArcLength::tell_limit(const Direction& next, double length) {
  const Cubic parameter = parameter_on(next, length);
  double low = 0, high = 1;
  for (int n = 0; n < 40; ++n) {
    const double middle = 0.5 * (low + high);
    (parameter.slope(middle) * direction_.parameter > 0 ? low : high) = middle;
  }
  observer_.remarked(fmt::format("limit point at stretch {:.6g}, from where the path goes {}, {}",
                                 parameter.value(low), next.parameter > 0 ? "up" : "down",
                                 stability(negative_)));
}

/// `count`: of the eigenvalues that become negative, or, if it is negative, positive. A single one is zero
/// about where a line through its values at both ends is.
void ArcLength::tell_branches(const Direction& next, double length, int count) {
  const PathTangent::Mode after = tangent_.softest();
  const Constraints::Prescribed here = constraints_.prescribed();
  State last{.u = start_};
  constraints_.set_parameter(state_.parameter);
  static_cast<void>(forces_.evaluate(last));  // it has been at rest there
  static_cast<void>(tangent_.factor(last.u, forces_.row_bounds()));
  const double before = tangent_.softest().stiffness;
  constraints_.set(here);
  static_cast<void>(forces_.evaluate(state_));
  const bool crossed = before * after.stiffness < 0;
  const double part = crossed ? before / (before - after.stiffness) : 0.5;
  observer_.remarked(
      fmt::format("{} the path at stretch {:.{}g}, in a shape that moves {} most; the path goes on, {}",
                  std::abs(count) == 1 ? (count > 0 ? "a branch leaves" : "a branch meets")
                                       : fmt::format("{} branches leave or meet", std::abs(count)),
                  parameter_on(next, length).value(part), crossed ? 6 : 3,
                  text(model_.place(Watchdog::largest(after.shape))), stability(negative_)));
}

void ArcLength::report() const {
  const LoadStepSettings& loads = settings_.loads;
  const double begin = loads.start, end = loads.targets.back();
  const double by_steps = static_cast<double>(state_.steps) / static_cast<double>(settings_.max_steps);
  const double part = std::max(by_steps, (state_.parameter - begin) / (end - begin));
  observer_.progressed({.parameter = next_,
                        .reached = begin + part * (end - begin),
                        .begin = begin,
                        .end = end,
                        .step = state_.steps + 1,
                        .steps = settings_.max_steps,
                        .iteration = iteration_,
                        .iterations = state_.iterations,
                        .evaluations = state_.evaluations,
                        .residual = forces_.residual(),
                        .tolerance = loads.tolerance});
}

State follow_path(Model& model, Constraints& constraints, const ArcLengthSettings& settings,
                  Observer& observer, const Snapshot* from) {
  return ArcLength(model, constraints, settings, observer).run(from);
}

}  // namespace riven
