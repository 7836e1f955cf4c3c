#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "model/model.hpp"

namespace riven {

/// A force on a body from outside of its model: a traction, a body force, a contact. Stands in no relation to
/// constraints: what it puts on a prescribed entry, the constraint carries.
class ExternalForce {
 public:
  virtual ~ExternalForce() = default;
  /// Adds the force (N) in a state to `force`. All three have the model's layout; `v` (m/s) is empty in
  /// statics. `parameter`: the time (s) in dynamics, the stretch in statics.
  virtual void add(std::span<const double> u, std::span<const double> v, double parameter,
                   std::span<double> force) = 0;
  /// Appends blocks of the derivative -d(force)/du (N/m) in a state; none for dead loads. They couple no
  /// entries that the model's tangent does not. Of forces without energy the symmetric part.
  virtual void tangent(std::span<const double> /*u*/, double /*parameter*/, TangentBlocks& /*to*/) const {}
  /// Work (J) that comes from outside on the way from one state, at parameter `before`, to the next.
  [[nodiscard]] virtual double work(std::span<const double> u_before, double before,
                                    std::span<const double> u, double parameter) const = 0;
  /// Potential energy (J) that the force holds in a state, as a contact does; none unless overridden.
  [[nodiscard]] virtual double held(std::span<const double> /*u*/, double /*parameter*/) const { return 0; }
  /// Adds upper bounds of the rows' sums of |d(force)/du| (N/m), as Model::stiffness_bound gives them.
  virtual void stiffness_bound(std::span<const double> /*u*/, double /*parameter*/,
                               std::span<double> /*bound*/) const {}
  /// The body goes through this state; all others are only tried. What the force remembers of its way is
  /// brought up to date, which changes no force in this state.
  virtual void advance(std::span<const double> /*u*/, double /*parameter*/) {}
  virtual void save(Snapshot&) const {}
  virtual void restore(const Snapshot&) {}
  /// Whether it remembers its way.
  [[nodiscard]] virtual bool has_memory() const { return false; }
};

using ExternalForces = std::vector<std::shared_ptr<ExternalForce>>;

/// Whether one of them does.
[[nodiscard]] inline bool have_memory(const ExternalForces& forces) {
  return std::any_of(forces.begin(), forces.end(), [](const auto& force) { return force->has_memory(); });
}

}  // namespace riven
