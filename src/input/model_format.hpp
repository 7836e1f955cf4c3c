#pragma once

#include "input/format.hpp"

namespace riven {

/// The tables [model] and [material.NAME].
Format describe(ModelInput& model);
Format describe(MaterialInput& material, const Case& of);

}  // namespace riven
