#pragma once

namespace riven {

/// What holds a body in two dimensions across: nothing, or rigid walls.
enum class Plane { stress, strain };

}  // namespace riven
