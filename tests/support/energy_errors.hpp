#pragma once

#include <cmath>
#include <vector>

#include "solver/velocity_verlet.hpp"
#include "support/pmb_bodies.hpp"

namespace riven::testing {

/// A small plate with a slit.
inline Body slit_plate() {
  LatticeBodyInput in = cells_of({9, 8}, 2);
  in.defects.cracks.push_back({{-0.6, 0.01, 0}, {-0.2, 0.01, 0}});
  return make_lattice_body(in);
}

/// Errors of the energy of a free plate that moves in its lowest modes, over the energy, at so many
/// times.
inline std::vector<double> energy_errors(PointModel& model, double amplitude, double part_of_limit,
                                         long steps, int times) {
  struct Energies : Observer {
    std::vector<double> error;
    void reached(const State& state, const Constraints&, bool) override {
      error.push_back(state.energy.error());
    }
  } energies;
  const Body& body = model.body();
  Constraints none(model.dofs(), 7);
  const double step = part_of_limit * stable_step(model, none, std::vector<double>(model.dofs()));
  const double end = static_cast<double>(steps) * step;
  VelocityVerletSettings motion{.until = end, .every = end, .history_every = end / times, .step = step};
  motion.initial_u.assign(model.dofs(), 0.0);
  for (const std::size_t i : body.points) {
    const Point x = body.position(i);
    motion.initial_u[i] = amplitude * std::sin(3 * x[0]) * std::cos(2 * x[1]);
    motion.initial_u[body.size() + i] = amplitude * std::cos(2 * x[0] + x[1]);
  }
  march(model, none, motion, energies);
  return energies.error;
}

inline double root_mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Mean of the last tenth less that of the first.
inline double drift(const std::vector<double>& values) {
  const std::size_t tenth = values.size() / 10;
  double change = 0;
  for (std::size_t n = 0; n < tenth; ++n)
    change += (values[values.size() - 1 - n] - values[n]) / static_cast<double>(tenth);
  return change;
}

}  // namespace riven::testing
