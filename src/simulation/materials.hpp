#pragma once

#include <optional>
#include <string>
#include <vector>

#include "input/case.hpp"
#include "material/material.hpp"
#include "model/model.hpp"

namespace riven {

/// What users are told of the materials of a case.

/// Whether the case says all of a material; springs (`pmb`) need no Poisson's ratio.
bool is_complete(const MaterialInput& in);

/// Moduli at small strain and, where a density is given, speeds of waves at rest: in space, or in a sheet of
/// an incompressible material.
std::string moduli_text(const Material& material);

/// A line for each instability of a law within the stretches that the case asks for; of a motion, which asks
/// for none, from 0.5 to 2.
std::vector<std::string> stability_warnings(const Case& input);

/// What is wrong where points turn by more than 1 % and the law takes that for strain. `gradient`: the field
/// of deformation gradients.
std::optional<std::string> rotation_warning(const Case& input, const ModelField& gradient);

}  // namespace riven
