#pragma once

#include <vector>

#include "output/history.hpp"
#include "output/summary.hpp"
#include "simulation/simulation.hpp"
#include "solver/solver.hpp"

namespace riven {

/// The numbers that a case asks for, evaluated at a state. A probe "force" of kind reaction gives the metrics
/// force_x, force_y; a nominal stress of a face gives its traction stress_x, stress_y, that of a set the mean
/// tensor stress_xx, stress_xy, stress_yx, stress_yy; a displacement "crown" gives displacement_crown_x, _y;
/// a stretch gives its own name, as does a probe of one component.
class Probes {
 public:
  /// Throws InputError for a place outside of the body.
  explicit Probes(const Simulation& simulation);

  [[nodiscard]] const std::vector<HistoryColumn>& columns() const { return columns_; }
  /// One value per column, in its order. `constraints` hold the forces of this state.
  [[nodiscard]] std::vector<double> evaluate(const State& state, const Constraints& constraints) const;
  [[nodiscard]] Metrics metrics(const std::vector<double>& values) const;

 private:
  void add_columns(const ProbeInput& probe);
  [[nodiscard]] Point reaction_of(const PointSet& set, const Constraints& constraints) const;
  [[nodiscard]] std::array<Point, 3> impactor_of(const ProbeInput& probe, const State& state) const;
  [[nodiscard]] std::array<double, 9> mean_stress(const PointSet& set, std::span<const double> u) const;

  const Simulation& simulation_;
  std::vector<HistoryColumn> columns_;
};

}  // namespace riven
