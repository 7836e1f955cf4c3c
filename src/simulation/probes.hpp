#pragma once

#include <vector>

#include "output/history.hpp"
#include "output/summary.hpp"
#include "simulation/largest_values.hpp"
#include "simulation/simulation.hpp"
#include "solver/solver.hpp"

namespace riven {

/// The numbers that a case asks for, evaluated at a state. A probe "force" of kind reaction gives the metrics
/// force_x, force_y; a nominal stress of a face gives its traction stress_x, stress_y, that of a set the mean
/// tensor stress_xx, stress_xy, stress_yx, stress_yy; a displacement "crown" gives displacement_crown_x, _y;
/// a stretch, a strain and a largest value give their own name, as does a probe of one component.
class Probes {
 public:
  /// Throws InputError for a place outside of the body.
  explicit Probes(const Simulation& simulation);

  [[nodiscard]] const std::vector<HistoryColumn>& columns() const { return columns_; }
  /// One value per column, in its order. `constraints` hold the forces of this state; `largest` keeps what
  /// the states before had, and looks at this one.
  [[nodiscard]] std::vector<double> evaluate(const State& state, const Constraints& constraints,
                                             LargestValues& largest) const;
  [[nodiscard]] Metrics metrics(const std::vector<double>& values) const;
  /// The columns of kind largest.
  [[nodiscard]] const std::vector<LargestColumn>& largest() const { return largest_; }

 private:
  void add_columns(const ProbeInput& probe);
  void add_largest(const ProbeInput& probe);
  [[nodiscard]] Point reaction_of(const PointSet& set, const Constraints& constraints) const;
  [[nodiscard]] std::array<double, 9> mean_stress(const PointSet& set, std::span<const double> u) const;

  const Simulation& simulation_;
  std::vector<HistoryColumn> columns_;
  std::vector<LargestColumn> largest_;
};

}  // namespace riven
