#pragma once

#include "input/format.hpp"

namespace riven {

/// [study]: what `riven sweep` runs and draws if it is given no keys.
Format describe(std::optional<StudyInput>& study);

}  // namespace riven
