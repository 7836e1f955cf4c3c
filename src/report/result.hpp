#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "output/collection.hpp"
#include "output/history.hpp"
#include "output/summary.hpp"
#include "output/vtu.hpp"

namespace riven {

/// What a result folder holds. Fields are read when they are asked for.
struct Result {
  std::filesystem::path folder;
  std::string title;               // of the case, else the folder's name
  std::optional<Summary> summary;  // none while the run goes on, or when it was killed
  std::optional<History> history, energy;
  double spacing = 0;                   // mean distance of points (m), by the case
  std::vector<CollectionEntry> states;  // field files, in order

  /// Throws InputError when the folder is no result of Riven.
  static Result open(const std::filesystem::path& folder);

  /// Name of the case, else of the folder.
  [[nodiscard]] std::string name() const;
  /// What numbers the states: stretch, time (s) or cycle.
  [[nodiscard]] Parameter parameter() const;
};

/// One number per point, made of a field: a scalar itself, a component or the magnitude of a vector or
/// tensor.
struct Scalar {
  std::string label;  // "nominal_stress xx", "displacement magnitude"
  std::string unit;   // SI, empty if dimensionless
  std::vector<double> values;
};

/// By name: "damage"; "displacement" for the magnitude; "displacement_x", "nominal_stress_xy" for components.
/// Throws InputError that lists the names there are and the nearest one.
Scalar scalar_of(const PointCloud& cloud, const std::string& name);

/// The names that `scalar_of` takes, in the order of the fields.
std::vector<std::string> scalar_names(const PointCloud& cloud);

}  // namespace riven
