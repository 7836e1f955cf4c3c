#pragma once

#include <optional>
#include <span>
#include <vector>

#include "load/external_force.hpp"
#include "solver/solver.hpp"
#include "spacetime/slab_scheme.hpp"

namespace riven {

/// One slab of a scheme for a model under its constraints: what its unknowns say of states, forces, residual
/// and work. The unknowns are kept as what they add to the slab's start, so that inertia has no rounding but
/// that of the motion. All vectors have the model's layout. Prescribed entries follow the slab's parabola
/// through their values at its nodes, so that their motion is one of the scheme's and its work is known as
/// exactly as all else.
class Slab {
 public:
  /// `inertia`: without, the body is in equilibrium at all stages.
  Slab(Model& model, Constraints& constraints, SlabScheme scheme, const ExternalForces& external,
       bool inertia = true);

  /// A slab from a state to the time `end` (s). `internal`: the model's force in that state (N). The
  /// constraints must be at its time; they are left where `end` is.
  void begin(const State& from, std::span<const double> internal, double end);
  /// First guess of the unknowns: the start's velocity goes on, or everything stays.
  void guess(bool moving);
  /// Adds a part of a direction to the unknowns `from`; prescribed entries keep what they have.
  void set(const std::array<std::vector<double>, 2>& from,
           const std::array<std::vector<double>, 2>& direction, double part);

  /// Forces at all stages and the residual; what is wrong with a stage's state if anything.
  std::optional<Breakdown> evaluate();
  /// Takes the model's memory to a stage, by way of the one before, whose forces must be the last ones.
  void lead_model_to(std::size_t stage);
  /// Takes it to slab time s, by way of all stages before. Returns how many forces that took.
  std::size_t lead_model_to_time(double s);
  [[nodiscard]] const std::array<std::vector<double>, 2>& residual() const { return residual_; }
  [[nodiscard]] double residual_norm() const { return residual_norm_; }
  /// Norm of what the residual is a difference of (N): inertia, reactions and external forces.
  [[nodiscard]] double residual_scale() const { return residual_scale_; }
  /// Norms of the unknowns, and of the displacements that they are added to (m).
  [[nodiscard]] double motion() const;
  [[nodiscard]] double start_norm() const;

  [[nodiscard]] const SlabScheme& scheme() const { return scheme_; }
  [[nodiscard]] const std::array<std::vector<double>, 2>& unknowns() const { return z_; }
  [[nodiscard]] double length() const { return h_; }
  /// At slab time s (s).
  [[nodiscard]] double time(double s) const { return start_ + s * h_; }
  /// Of the free entries (kg); 0 elsewhere.
  [[nodiscard]] std::span<const double> mass() const { return mass_; }

  /// Displacements of a stage.
  void stage(std::size_t number, std::span<double> u) const {
    add_up(1, scheme_.stages[number].displacement, u);
  }
  /// On the slab's parabola at slab time s. Velocities are continuous: theirs is corrected by what is left of
  /// the jump at the start.
  void displacement(double s, std::span<double> u) const;
  void velocity(double s, std::span<double> v) const;

  /// Of the loads up to slab time s (J), by the last evaluation.
  [[nodiscard]] double work(double s) const;
  /// Energy that the scheme takes (J): that of the jumps at the slab's start, theory (13); of displacements
  /// that jump, to second order in the jump.
  [[nodiscard]] double dissipated() const;

 private:
  /// `start` times the slab's first displacement, and the unknowns by their weights.
  void add_up(double start, const SlabWeights& weights, std::span<double> out) const;
  void constrain();
  void add_stage(std::size_t number, std::span<const double> internal);
  void add_inertia();
  [[nodiscard]] double power_of_constraints(const SlabWeights& velocity) const;

  Model& model_;
  Constraints& constraints_;
  SlabScheme scheme_;
  ExternalForces external_;
  std::vector<double> mass_;
  double start_ = 0, h_ = 0;                           // s
  std::array<Constraints::Prescribed, 3> prescribed_;  // at the parabola's nodes
  std::vector<double> u_, v_, internal_;               // at the slab's start
  std::array<std::vector<double>, 2> z_;               // x - u (m)
  std::array<std::vector<double>, 2> residual_;        // N
  double residual_norm_ = 0, residual_scale_ = 0;
  std::array<double, 2> row_scale_{};
  std::vector<double> power_;           // of the loads at the stages (W)
  std::vector<double> start_internal_;  // the model's force, extrapolated to the slab's start
  std::vector<double> state_, stage_internal_, applied_, force_, stage_v_;
};

}  // namespace riven
