#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/snapshot.hpp"
#include "geometry/shape.hpp"

namespace riven {

/// A state that a model can't answer to: where, and what is wrong with it.
struct Breakdown {
  Point position{};
  std::string what;
};

/// What a body lost on its way through a state.
struct Passage {
  std::size_t broken = 0;  // bonds
  /// Their mean energy over that at which they break, less 1: how much too late a step found them.
  double excess = 0;
  bool stiffer = false;  // what is left may have a shorter stable step
  std::optional<Breakdown> breakdown{};
};

/// A result per point: `components` values each (9: a tensor row by row), point-major, in an SI unit, empty
/// if dimensionless.
struct ModelField {
  std::string name;
  int components = 1;
  std::vector<double> values;
  std::string unit;
};

/// Symmetric dense blocks whose sum is a tangent stiffness: block b couples the state's entries
/// dofs[begin[b]] to dofs[begin[b + 1] - 1], n of them, by n x n numbers (N/m) that follow those of block b -
/// 1 in `values`.
struct TangentBlocks {
  std::vector<std::size_t> begin{0};
  std::vector<std::size_t> dofs;
  std::vector<double> values;
};

/// Body and materials. A state is one vector of displacements u (m); its layout belongs to the model. Solvers
/// ask for forces and know no more than this interface.
class Model {
 public:
  virtual ~Model() = default;

  /// Length of a state vector. Entries that are no degree of freedom (padding) have zero force and mass.
  [[nodiscard]] virtual std::size_t dofs() const = 0;

  /// Internal force (N) at every entry, -dE/du if `conservative()`. Returns what is wrong if the state is
  /// outside the model's range; `force` is then not to be used.
  [[nodiscard]] virtual std::optional<Breakdown> internal_force(std::span<const double> u,
                                                                std::span<double> force) = 0;

  /// Of models whose force depends on the way: the next forces are of states `dt` (s) after the state of the
  /// last `internal_force`. Without a call they are of that state's own moment.
  virtual void go_on(double /*dt*/) {}
  /// The next forces start again from the state of the last `advance`, at its moment.
  virtual void go_back() {}

  /// The state of the last `internal_force` is one that the body goes through, not one that a solver only
  /// tried: what is irreversible happens, such as bonds that break. `force`: of that evaluation; brought up
  /// to date.
  [[nodiscard]] virtual Passage advance(std::span<const double> /*u*/, std::span<double> /*force*/) {
    return {};
  }
  /// Energy (J) that `advance` has taken from the body so far.
  [[nodiscard]] virtual double dissipated_energy() const { return 0; }
  /// How near a state is to failure: largest stretch of a bond over the one at which it breaks; 0 where
  /// nothing can.
  [[nodiscard]] virtual double overload(std::span<const double> /*u*/) const { return 0; }

  /// Strain energy E (J).
  [[nodiscard]] virtual double strain_energy(std::span<const double> u) = 0;

  /// Whether the force is the gradient of the energy; if not, an energy balance tells nothing about a run.
  [[nodiscard]] virtual bool conservative() const = 0;

  /// Lumped mass (kg) of every entry; 0 for padding.
  virtual void mass(std::span<double> mass) const = 0;

  /// Upper bound of the sum of |tangent stiffness| over a row (N/m), for stable steps and fictitious masses.
  virtual void stiffness_bound(std::span<const double> u, std::span<double> bound) = 0;

  /// Number of parts in which the tangent stiffness d(-force)/du comes, usually one per point; 0: the model
  /// has none. Only of models that are `conservative()`.
  [[nodiscard]] virtual std::size_t tangent_parts() const { return 0; }
  /// Appends the blocks of parts [first, last) in the state u, which must be that of the last force
  /// evaluation. Threads call it at once, each with parts and an output of its own.
  virtual void tangent(std::span<const double> /*u*/, std::size_t /*first*/, std::size_t /*last*/,
                       TangentBlocks& /*to*/) const {}

  /// Distance of neighbouring points (m): displacements far below it mean nothing.
  [[nodiscard]] virtual double spacing() const = 0;

  /// What a force balance does not show: folded points, for example. Asked at converged and output states.
  [[nodiscard]] virtual std::optional<Breakdown> inspect(std::span<const double> u) = 0;

  /// Adds the displacement field gradient X + shift (m) to a state, everywhere: a first guess for solvers.
  virtual void move(std::span<double> u, const std::array<std::array<double, 3>, 3>& gradient,
                    const Point& shift) const = 0;

  /// Undeformed positions, displacements (m) and other results of the points that are shown, in one order.
  [[nodiscard]] virtual std::vector<Point> positions() const = 0;
  [[nodiscard]] virtual std::vector<Point> displacements(std::span<const double> u) const = 0;
  [[nodiscard]] virtual std::vector<ModelField> fields(std::span<const double> u) = 0;

  /// Undeformed position (m) of what an entry of a state moves: to name a place in messages.
  [[nodiscard]] virtual Point place(std::size_t entry) const = 0;

  /// What might carry a body past a load that it does not stand, for messages.
  [[nodiscard]] virtual std::string remedies() const { return "a finer lattice"; }

  /// What the model remembers of the states before, such as broken bonds; a model without memory keeps these.
  virtual void save(Snapshot&) const {}
  virtual void restore(const Snapshot&) {}

  /// What follows from the case, a line each: constants of the material, kinds of points.
  [[nodiscard]] virtual std::vector<std::string> describe() const = 0;
  /// Points, and directed bonds that one force evaluation visits.
  [[nodiscard]] virtual std::size_t points() const = 0;
  [[nodiscard]] virtual std::size_t bonds() const = 0;

  /// Whether the force depends on the states before and the time between them, as `go_on` says.
  [[nodiscard]] virtual bool has_memory() const { return false; }
};

}  // namespace riven
