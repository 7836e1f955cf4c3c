#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/snapshot.hpp"
#include "geometry/shape.hpp"

namespace riven {

/// A prescribed quantity as a function of the undeformed position (m) and the load parameter: the stretch in
/// statics, the time (s) in dynamics.
using LoadFunction = std::function<double(const Point& position, double parameter)>;

/// One prescribed displacement component that enters a constraint, `factor` times.
struct PrescribedTerm {
  LoadFunction displacement;  // m, or its rate (m/s)
  Point position{};           // where it is taken
  int axis = 0;
  double factor = 1;
  std::size_t load = 0;  // number of the load; its reaction collects this constraint's force
  bool rate = false;     // the displacement is the integral of a velocity from time 0
};

/// u[slave] = sign * u[master] + sum of factor * displacement. Without master: a prescribed entry. Ghost
/// points of a mirrored edge are slaves of the points that they mirror (peridynamics theory, 5a rule 1).
struct Constraint {
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::size_t slave = 0;
  std::size_t master = kNone;
  double sign = 1;
  std::vector<PrescribedTerm> terms;
  bool chain_rule = true;  // the slave's force acts on its master too, so that force stays a gradient
};

/// Displacement change of the prescribed places between two parameters, fitted by du_i = gradient_ij X_j +
/// shift_i.
struct AffineIncrement {
  std::array<std::array<double, 3>, 3> gradient{};
  Point shift{};
};

/// All constraints on a state vector, with the forces that they need.
class Constraints {
 public:
  Constraints(std::size_t dofs, std::size_t loads) : free_(dofs, true), reaction_(loads) {}

  /// A slave is no master of another one, but a prescribed entry may be a master.
  void add(Constraint constraint);

  /// Evaluates the prescribed displacements; `apply` then uses them. Velocities are integrated from the
  /// parameter before, by Simpson's rule; at parameter 0 they have moved nothing.
  void set_parameter(double parameter);
  [[nodiscard]] double parameter() const { return parameter_; }
  /// What the last `set_parameter` gave, to be put back: solvers that go to and fro in time evaluate it once.
  struct Prescribed {
    double parameter = 0;
    std::vector<double> travelled, offset;  // m
  };
  [[nodiscard]] Prescribed prescribed() const { return {parameter_, travelled_, offset_}; }
  void set(const Prescribed& to);
  /// Makes a state obey the constraints.
  void apply(std::span<double> u) const;
  /// Takes the internal force out of the slaves: adds it to their masters where the chain rule holds, keeps
  /// what the constraints must supply (reactions), and leaves 0 there.
  void reduce(std::span<double> force);
  /// Adds a slave's row bound to its master's and leaves 0 at slaves: the bound of the constrained system.
  void fold(std::span<double> bound) const;

  [[nodiscard]] bool is_free(std::size_t dof) const { return free_[dof]; }
  /// What an entry of the state moves with: sign times a free entry, or nothing (kNone).
  struct Image {
    std::size_t entry = Constraint::kNone;
    double sign = 1;
  };
  /// Of all entries.
  [[nodiscard]] std::vector<Image> images() const;
  /// External force (N) along x, y, z that a load exerts on the body in the state of the last `reduce`;
  /// positive pulls towards positive coordinates.
  [[nodiscard]] const Point& reaction(std::size_t load) const { return reaction_[load]; }
  /// External force (N) on a prescribed entry in that state; 0 for others.
  [[nodiscard]] double external_force(std::size_t dof) const;
  /// L2 norm of the constraint forces of the last `reduce` (N).
  [[nodiscard]] double reaction_norm() const { return reaction_norm_; }

  /// Prescribed part of every constraint (m) and the external force on its slave (N), in one order: the work
  /// of the loads is the integral of force over offset.
  [[nodiscard]] std::span<const double> offsets() const { return offset_; }
  [[nodiscard]] std::span<const double> forces() const { return external_; }

  [[nodiscard]] AffineIncrement affine_increment(double from, double to) const;

  /// The values of the last `set_parameter` and `reduce`.
  void save(Snapshot& to) const { each_member(*this, to.saving()); }
  void restore(const Snapshot& from) { each_member(*this, from.restoring()); }

 private:
  template <class Self, class Each>
  static void each_member(Self& self, const Each& each) {
    each("constraints.offset", self.offset_);
    each("constraints.parameter", self.parameter_);
    each("constraints.travelled", self.travelled_);
    each("constraints.external", self.external_);
    each("constraints.reaction_norm", self.reaction_norm_);
    for (std::size_t n = 0; n < self.reaction_.size(); ++n)
      each("constraints.reaction." + std::to_string(n), self.reaction_[n]);
  }

  std::vector<Constraint> prescribed_;  // without master: applied first, reduced last
  std::vector<Constraint> mirrored_;
  std::unordered_map<std::size_t, std::size_t> prescribed_at_;  // number in prescribed_ by its slave
  std::vector<bool> free_;
  double parameter_ = 0;
  std::vector<double> travelled_;          // by velocities, in the same order (m)
  std::vector<double> offset_, external_;  // of prescribed_, then mirrored_
  std::vector<Point> reaction_;
  double reaction_norm_ = 0;
};

}  // namespace riven
