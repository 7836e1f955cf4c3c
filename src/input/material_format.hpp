#pragma once

#include "input/case.hpp"
#include "material/material.hpp"

namespace riven {

/// The material that a case describes. Throws InputError unless its shear modulus is positive.
Material make_material(const MaterialInput& in);

}  // namespace riven
