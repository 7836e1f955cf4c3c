#pragma once

namespace riven {

/// How much the bonds of a family count by their length.
enum class Influence {
  inverse,   // horizon / length
  constant,  // 1
};

inline double influence(Influence kind, double length, double horizon) {
  return kind == Influence::inverse ? horizon / length : 1;
}

}  // namespace riven
