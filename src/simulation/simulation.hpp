#pragma once

#include <memory>
#include <string>
#include <vector>

#include "input/case.hpp"
#include "load/constraints.hpp"
#include "output/parameter.hpp"
#include "peridynamics/membrane.hpp"

namespace riven {

/// Body points that the user gave a name.
struct PointSet {
  std::string name;
  std::vector<std::size_t> points;  // storage indices
};

/// Everything a run needs, built from a case. Loads are numbered 0 to 5 for the faces, then one per set, then
/// one for the inclusions that are held.
struct Simulation {
  Case input;
  Parameter parameter = Parameter::stretch;  // what the solver marches
  std::unique_ptr<Membrane> model;
  std::unique_ptr<Constraints> constraints;
  std::vector<PointSet> sets;

  /// Number of a face by its name, or nothing.
  static std::optional<std::size_t> face(const std::string& name);
  /// A declared set. The input layer has checked that it exists.
  [[nodiscard]] const PointSet& set(const std::string& name) const;
  /// Where the reactions of a load on a face or set are collected.
  [[nodiscard]] std::size_t load_number(const std::string& name) const;
  /// Reference area (m^2) of a face of the box.
  [[nodiscard]] double face_area(std::size_t face) const;
};

/// Throws InputError where the case can't be built: an empty set, overlapping defects, a load that the model
/// can't carry.
Simulation build_simulation(const Case& input);

}  // namespace riven
