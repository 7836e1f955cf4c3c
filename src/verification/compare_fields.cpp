#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/error.hpp"
#include "output/collection.hpp"
#include "output/vtu.hpp"
#include "verification/compare.hpp"
#include "verification/deviation.hpp"
#include "verification/interpolate.hpp"

namespace riven {
namespace {

double norm(const Point& u, int dimension) {
  double square = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) square += u[k] * u[k];
  return std::sqrt(square);
}

const PointField* find_field(const PointCloud& cloud, std::string_view name, int components) {
  const auto fits = [&](const PointField& field) {
    return field.name == name && field.components == components;
  };
  const auto found = std::find_if(cloud.fields.begin(), cloud.fields.end(), fits);
  return found == cloud.fields.end() ? nullptr : &*found;
}

ResultState read_state(const CollectionEntry& entry) {
  const PointCloud cloud = read_vtu(entry.file);
  const PointField* displacement = find_field(cloud, "displacement", 3);
  if (!displacement) {
    throw InputError(Location{entry.file.string(), 0, 0},
                     "expected the field displacement; add it to `fields` under [output] and run again");
  }
  const PointField* damage = find_field(cloud, "damage", 1);
  ResultState state{entry.value, {}, {}};
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    if (damage && damage->values[i] >= 1) continue;
    const double* u = &displacement->values[3 * i];
    state.positions.push_back(cloud.positions[i]);
    state.displacements.push_back({u[0], u[1], u[2]});
  }
  return state;
}

bool agree(double a, double b) {
  return std::abs(a - b) <= 1e-6 * std::max(std::abs(a), std::abs(b));
}

const CollectionEntry* find_state(const std::vector<CollectionEntry>& entries, std::optional<double> value) {
  if (!value) return &entries.back();
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [&](const CollectionEntry& entry) { return agree(entry.value, *value); });
  return found == entries.end() ? nullptr : &*found;
}

// A reference without states is compared with the last one, and says nothing of others.
std::vector<double> uncompared(const std::vector<CollectionEntry>& entries,
                               const ReferencePoints& reference) {
  const auto in_reference = [&](const CollectionEntry& entry) {
    return std::any_of(reference.states.begin(), reference.states.end(), [&](const ReferenceState& state) {
      return !state.value || agree(entry.value, *state.value);
    });
  };
  std::vector<double> values;
  for (const CollectionEntry& entry : entries)
    if (!in_reference(entry)) values.push_back(entry.value);
  return values;
}

std::string values_text(const std::vector<CollectionEntry>& entries) {
  std::string text;
  for (const CollectionEntry& entry : entries)
    text += fmt::format("{}{:.9g}", text.empty() ? "" : ", ", entry.value);
  return text;
}

}  // namespace

StateDeviation compare_state(const ResultState& state, const std::vector<ReferencePoint>& points,
                             int dimension, const CompareSettings& settings) {
  if (!(settings.spacing > 0)) throw std::invalid_argument("a comparison needs the spacing");
  const Interpolation interpolation(state.positions, state.displacements, settings.defects, settings.spacing,
                                    settings.horizon);
  // Points stated at this very distance are not left out by rounding.
  const double too_near = settings.exclude_within - 1e-6 * settings.spacing;
  StateDeviation result;
  result.value = state.value;
  DeviationSum sum;
  for (const ReferencePoint& point : points) {
    if (settings.defects.distance_to_edge(point.position) < too_near) {
      ++result.excluded;
      continue;
    }
    const auto u = interpolation.at(point.position);
    if (!u) {
      ++result.outside;
      continue;
    }
    ++result.used;
    const Point& v = point.displacement;
    const Point difference{(*u)[0] - v[0], (*u)[1] - v[1], (*u)[2] - v[2]};
    if (sum.add(norm(difference, dimension), norm(v, dimension))) result.maximum_at = point.position;
  }
  if (result.used == 0) {
    throw InputError(
        fmt::format("state {:.9g}: none of the {} reference points can be compared: {} are nearer to a "
                    "defect than {:g} m, {} are where the result has no points",
                    state.value, points.size(), result.excluded, settings.exclude_within, result.outside));
  }
  result.relative_l2 = sum.relative_l2();
  result.maximum = sum.maximum();
  return result;
}

FieldDeviation compare_fields(const std::filesystem::path& folder, const ReferencePoints& reference,
                              const CompareSettings& settings) {
  const auto entries = read_collection(folder / "fields.pvd");
  if (entries.empty()) throw InputError(Location{(folder / "fields.pvd").string(), 0, 0}, "has no states");
  FieldDeviation result;
  result.uncompared = uncompared(entries, reference);
  for (const ReferenceState& state : reference.states) {
    const CollectionEntry* entry = find_state(entries, state.value);
    if (!entry) {
      result.missing.push_back(*state.value);
      continue;
    }
    try {
      result.states.push_back(compare_state(read_state(*entry), state.points, reference.dimension, settings));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{} against {}: {}", entry->file.string(), reference.file, error.what()));
    }
  }
  if (result.states.empty()) {
    throw InputError(Location{reference.file, 0, 0},
                     fmt::format("has no state of the result, which has {}", values_text(entries)));
  }
  return result;
}

}  // namespace riven
