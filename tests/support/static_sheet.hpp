#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "solver/load_steps.hpp"
#include "support/bodies.hpp"
#include "support/laws.hpp"
#include "support/loads.hpp"
#include "support/states.hpp"

namespace riven::testing {

/// What a static solver told.
struct StaticLog : Observer {
  void progressed(const SolverProgress& progress) override {
    if (progress.iteration == 0) residuals.emplace_back();
    residuals.back().push_back(progress.residual);
  }
  void reached(const State& state, const Constraints&, bool output) override {
    steps.push_back(state.parameter);
    if (output) outputs.push_back(state.parameter);
  }
  void remarked(const std::string& remark) override { remarks.push_back(remark); }
  [[nodiscard]] bool says(const char* what) const {
    return std::any_of(remarks.begin(), remarks.end(),
                       [&](const std::string& remark) { return remark.find(what) != std::string::npos; });
  }

  std::vector<std::vector<double>> residuals;  // of each load step, as far as they were told
  std::vector<double> steps, outputs;
  std::vector<std::string> remarks;
};

using StaticSolver = State (*)(Model&, Constraints&, const LoadStepSettings&, Observer&, const Snapshot*);

/// A sheet with a hole and an inclusion, for a static solver.
struct StaticSheet {
  StaticSheet(StaticSolver solver, const LawCase& law, const FaceLoads& loads = planar(),
              Faces mirrored = all_edges())
      : membrane(make_lattice_body(sheet(20, 20, 0.05, mirrored,
                                         {{Disc{{0.2, 0.15, 0}, 0.13}}, {}, {Disc{{-0.2, -0.2, 0}, 0.1}}})),
                 law.material(), 4),
        constraints(constrain(membrane, loads)),
        solve_by(solver) {}

  State solve(const LoadStepSettings& settings) {
    return solve_by(membrane, constraints, settings, log, nullptr);
  }

  Membrane membrane;
  Constraints constraints;
  StaticSolver solve_by;
  StaticLog log;
};

/// Largest difference of two states' entries (m).
inline double distance(const State2& a, const State2& b) {
  double worst = 0;
  for (std::size_t e = 0; e < a.size(); ++e) worst = std::max(worst, std::abs(a[e] - b[e]));
  return worst;
}

}  // namespace riven::testing
