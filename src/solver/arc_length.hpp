#pragma once

#include <array>
#include <optional>
#include <vector>

#include "solver/corrections.hpp"
#include "solver/load_steps.hpp"
#include "solver/path_tangent.hpp"

namespace riven {

struct ArcLengthSettings {
  /// `increment`: of the parameter in the first step; later ones are as long on the path, or shorter.
  /// `max_iterations` is not used.
  LoadStepSettings loads;
  long max_steps = 1000;
};

/// Follows the path of equilibria of a model with a tangent through points where the loads, scaled by the
/// parameter, have a maximum or minimum. Unknowns are displacements and parameter; a step's end lies on the
/// plane normal to the path's direction at its start, a given length ahead (Keller 1977), in the metric in
/// which parameter and displacements change alike at the start of the path. Newton's method on the bordered
/// tangent, which need not be definite: the path may be unstable. The direction goes on as it came, so no
/// determinant is asked which way leads ahead.
///
/// Steps are halved that do not converge or turn by more than some 37 degrees. The numbers of negative
/// eigenvalues of the tangent tell where the path loses stability, and where others leave it: observers are
/// told of such points. The path ends at the last target, reached for the first time, or after `max_steps`.
class ArcLength {
 public:
  ArcLength(Model& model, Constraints& constraints, const ArcLengthSettings& settings, Observer& observer);

  /// Begins at the equilibrium under the loads of the start, or where a snapshot was taken. Throws
  /// SolverFailure when steps have become too small.
  State run(const Snapshot* from);

 private:
  /// The path at an equilibrium, per unit of its length.
  struct Direction {
    std::vector<double> u;  // of free entries (m)
    double parameter = 0;
  };
  /// Of the part of a step, 0 to 1.
  struct Cubic {
    std::array<double, 4> c{};
    [[nodiscard]] double value(double x) const { return c[0] + x * (c[1] + x * (c[2] + x * c[3])); }
    [[nodiscard]] double slope(double x) const { return c[1] + x * (2 * c[2] + x * 3 * c[3]); }
  };
  template <class Self, class Each>
  static void each_member(Self& self, const Each& each) {
    State::each_member(self.state_, "state", each);
    each("arc.start", self.start_);
    each("arc.direction", self.direction_.u);
    each("arc.rise", self.direction_.parameter);
    each("arc.metric", self.metric_);
    each("arc.path", self.path_);
    each("arc.negative", self.negative_);
    each("arc.target", self.target_);
    each("arc.stepping", self.stepping_);
    each("arc.held", self.held_);
    each("arc.next", self.next_);
    each("arc.iteration", self.iteration_);
    Corrections::each_member(self.corrections_, "arc.corrections", each);
    each("arc.length", self.length_);
    each("arc.longest", self.longest_);
    each("arc.scale", self.scale_);
    PathTangent::each_member(self.tangent_, each);
    FreeForces::each_member(self.forces_, each);
  }
  [[nodiscard]] Snapshot save() const;
  void restore(const Snapshot& from);

  /// Whether the start of the path is known, so that a direction leads on.
  [[nodiscard]] bool under_way() const { return metric_ > 0; }
  void begin_step();
  void begin_iterations();
  void iterate();
  [[nodiscard]] std::optional<std::string> correct();
  void move(std::span<const double> du, double dp, double part = 1);
  [[nodiscard]] double product(const Direction& a, const Direction& b) const;
  [[nodiscard]] Direction travelled() const;
  void arrive();
  [[nodiscard]] bool passed_target();
  [[nodiscard]] std::optional<std::string> find_direction(Direction& to);
  void set_metric(const Direction& first);
  void set_out(Direction first);
  void accept(Direction next, double length);
  void adapt(double cosine);
  void balance();
  void retreat(const std::string& failure);
  [[noreturn]] void give_up(const std::string& failure) const;
  void report() const;

  void watch(const Direction& next, double length);
  [[nodiscard]] Cubic parameter_on(const Direction& next, double length) const;
  void tell_limit(const Direction& next, double length);
  void tell_branches(const Direction& next, double length, int count);

  Model& model_;
  Constraints& constraints_;
  ArcLengthSettings settings_;
  Observer& observer_;
  FreeForces forces_;
  PathTangent tangent_;
  WorkIntegral work_{WorkIntegral::Rule::parabolic};  // along the path's length
  State state_;                                       // its parameter: that of the last equilibrium
  std::vector<double> start_;                         // displacements there
  Direction direction_;                               // there
  int negative_ = 0;                                  // eigenvalues of the tangent there
  double metric_ = 0;        // (1/m)^2: what displacements count against the parameter; 0: not known yet
  double path_ = 0;          // length so far
  std::size_t target_ = 0;   // number of the target that is aimed at
  bool stepping_ = false;    // in the middle of a step
  bool held_ = true;         // this step is to a given parameter instead of a given length
  double next_ = 0;          // parameter that goes with the displacements of the state
  long iteration_ = 0;       // of this step
  Corrections corrections_;  // over the longest step
  double length_ = 0, longest_ = 0;  // of steps
  double scale_ = 0;                 // largest of the residual's so far (N)
};

/// Follows a model's path of equilibria, see ArcLength.
State follow_path(Model& model, Constraints& constraints, const ArcLengthSettings& settings,
                  Observer& observer, const Snapshot* from = nullptr);

}  // namespace riven
