#pragma once

#include <vector>

#include "output/history.hpp"
#include "output/summary.hpp"
#include "simulation/crack_probes.hpp"
#include "simulation/largest_values.hpp"
#include "simulation/simulation.hpp"
#include "solver/solver.hpp"

namespace riven {

/// The numbers that a case asks for, evaluated at a state. A probe "force" of kind reaction gives the metrics
/// force_x, force_y; a nominal stress of a face gives its traction stress_x, stress_y, that of a set the mean
/// tensor stress_xx, stress_xy, stress_yx, stress_yy; a displacement "crown" gives displacement_crown_x, _y;
/// a stretch, a strain and a largest value give their own name, as do a probe of one component and those of
/// cracks (CrackProbes).
class Probes {
 public:
  /// Throws InputError for a place outside of the body.
  explicit Probes(const Simulation& simulation);

  [[nodiscard]] const std::vector<HistoryColumn>& columns() const { return columns_; }
  /// One value per column, in its order. `constraints` hold the forces of this state. States come in their
  /// order: some probes remember.
  [[nodiscard]] std::vector<double> evaluate(const State& state, const Constraints& constraints);
  [[nodiscard]] Metrics metrics(const std::vector<double>& values) const;

  /// What the probes remember.
  void save(Snapshot& to) const {
    cracks_.save(to);
    LargestValues::each_member(largest_, "probes.largest", to.saving());
  }
  void restore(const Snapshot& from) {
    cracks_.restore(from);
    LargestValues::each_member(largest_, "probes.largest", from.restoring());
  }

 private:
  void add_columns(const ProbeInput& probe);
  [[nodiscard]] Point force_on(std::size_t face, const State& state, const Constraints& constraints) const;
  void add_largest(const ProbeInput& probe);
  [[nodiscard]] Point reaction_of(const PointSet& set, const Constraints& constraints) const;
  [[nodiscard]] std::vector<Point> impactor_of(const ProbeInput& probe, const State& state) const;
  [[nodiscard]] std::array<double, 9> mean_stress(const PointSet& set, std::span<const double> u) const;

  const Simulation& simulation_;
  CrackProbes cracks_;
  std::vector<HistoryColumn> columns_;
  LargestValues largest_;
};

}  // namespace riven
