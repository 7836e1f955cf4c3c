#pragma once

#include <string>

#include "output/vtu.hpp"
#include "report/colour_map.hpp"
#include "report/result.hpp"
#include "report/ticks.hpp"

namespace riven {

/// What a picture shows where the user leaves the choice to the program.

/// A field of a cloud, or nothing.
const PointField* find_field(const PointCloud& cloud, const std::string& name);

/// The field that tells most about a state: damage where it has grown since the first state, else the first
/// there is of strain energy density, stress and displacement. Throws InputError when there are no fields.
std::string telling_field(const PointCloud& state, const PointCloud& first);

/// From the least to the greatest value.
Range range_of(const std::vector<double>& values);

/// The range of colours of a field: its values, without the outermost points if a few of them would leave one
/// colour for all others. A field of both signs is shown from -a to a, a constant one from 0.
Range colour_range(const Scalar& scalar, bool all_values = false);

/// The map of a range: one with a middle of its own for values of both signs.
const ColourMap& natural_map(const Range& colours);

}  // namespace riven
