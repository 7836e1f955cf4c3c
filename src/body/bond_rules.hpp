#pragma once

#include <optional>

#include "body/body.hpp"

namespace riven {

/// Decides which bonds a body has where defects are in the way (peridynamics theory, 5a rules 3 and 4).
class BondRules {
 public:
  /// `body`: its faces, spacing, horizon and defects are set.
  explicit BondRules(const Body& body);

  enum class Verdict {
    joined,
    none,       // holes are in the way, or the inside of an inclusion
    cracked,    // only a crack is in the way
    interface,  // it ends on an inclusion
  };
  struct Bond {
    Verdict verdict = Verdict::joined;
    std::size_t inclusion = 0;  // of `interface`
    Point end{};                // of `interface` (m)
  };

  /// The bond from a body point at x to a point of the given kind at y; `mirrored`: the faces a ghost at y is
  /// mirrored at, for the mirror images of defects are in the way too.
  [[nodiscard]] Bond between(const Point& x, const Point& y, PointKind kind, const Faces& mirrored) const;

  /// Whether defects, or their mirror images, may be in the way of a point's bonds.
  [[nodiscard]] bool near_defect(const Point& x) const;

  /// The inclusion that a point at x is part of.
  [[nodiscard]] std::optional<std::size_t> rigid_inclusion(const Point& x) const;

 private:
  [[nodiscard]] bool cut(const Defects& defects, const Point& x, const Point& y, const Faces& mirrored) const;

  const Body& body_;
  Defects holes_, cracks_;
  double touch_;  // m
};

}  // namespace riven
