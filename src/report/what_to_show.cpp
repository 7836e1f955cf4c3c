#include "report/what_to_show.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace riven {

namespace {

/// Beyond zero by more than rounding, to both sides.
bool of_both_signs(const Range& range) {
  constexpr double kPart = 0.01;
  return range.low < -kPart * range.high && range.high > -kPart * range.low;
}

/// What all but the outermost points have, if a few of them have far more: the field elsewhere would show in
/// one colour. Numbers without a unit, such as damage, keep their range.
Range typical_range(const Scalar& scalar) {
  const Range whole = range_of(scalar.values);
  constexpr double kOutermost = 0.002, kFar = 0.6;
  std::vector<double> values = scalar.values;
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (!scalar.unit.empty() && !values.empty()) {
    const auto last = static_cast<std::ptrdiff_t>(values.size()) - 1;
    const auto cut = static_cast<std::ptrdiff_t>(kOutermost * static_cast<double>(last));
    const auto at = [&](std::ptrdiff_t place) {
      std::nth_element(values.begin(), values.begin() + place, values.end());
      return values[static_cast<std::size_t>(place)];
    };
    const Range most{at(cut), at(last - cut)};
    if (most.width() > 0 && most.width() < kFar * whole.width()) return most;
  }
  return whole;
}

}  // namespace

const PointField* find_field(const PointCloud& cloud, const std::string& name) {
  for (const PointField& field : cloud.fields)
    if (field.name == name) return &field;
  return nullptr;
}

std::string telling_field(const PointCloud& state, const PointCloud& first) {
  constexpr double kGrown = 0.01;  // of a point's bonds
  const PointField *now = find_field(state, "damage"), *before = find_field(first, "damage");
  if (now != nullptr && before != nullptr)
    for (std::size_t i = 0; i < std::min(now->values.size(), before->values.size()); ++i)
      if (now->values[i] > before->values[i] + kGrown) return "damage";
  for (const char* name : {"strain_energy_density", "nominal_stress", "displacement"})
    if (find_field(state, name) != nullptr) return name;
  if (state.fields.empty())
    throw InputError("the result has no fields to show; expected some in output.fields of its case");
  return state.fields.front().name;
}

Range range_of(const std::vector<double>& values) {
  Range range;
  for (const double value : values) range.include(value);
  return range;
}

Range colour_range(const Scalar& scalar, bool all_values) {
  const Range values = all_values ? range_of(scalar.values) : typical_range(scalar);
  const double largest = values.empty() ? 0 : std::max(std::abs(values.low), std::abs(values.high));
  if (largest == 0) return {0, 1};
  if (of_both_signs(values)) return {-largest, largest};
  constexpr double kConstant = 1e-6;  // of the value: what is less is rounding
  if (values.width() > kConstant * largest) return values;
  return values.high > 0 ? Range{0, values.high} : Range{values.low, 0};
}

const ColourMap& natural_map(const Range& colours) {
  return of_both_signs(colours) ? colour_map("purple-orange") : colour_maps().front();
}

}  // namespace riven
