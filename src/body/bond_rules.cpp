#include "body/bond_rules.hpp"

namespace riven {

namespace {

constexpr double kTouch = 1e-9;  // of the spacing: below it, touching is no crossing
// Rigid points reach a little beyond the surface so that the bonds that cross it keep a length (5a rule 4).
constexpr double kRigidMargin = 0.15;

}  // namespace

BondRules::BondRules(const Body& body)
    : body_(body),
      holes_{body.defects.holes, {}, {}, {}},
      cracks_{{}, body.defects.cracks, {}, body.defects.crack_surfaces},
      touch_(kTouch * body.spacing) {}

bool BondRules::cut(const Defects& defects, const Point& x, const Point& y, const Faces& mirrored) const {
  if (defects.cuts(x, y, touch_)) return true;
  return mirrored.any() && defects.cuts(reflected(body_, mirrored, x), reflected(body_, mirrored, y), touch_);
}

BondRules::Bond BondRules::between(const Point& x, const Point& y, PointKind kind,
                                   const Faces& mirrored) const {
  const auto& inclusions = body_.defects.inclusions;
  for (std::size_t n = 0; n < inclusions.size(); ++n) {
    const auto inside = chord(inclusions[n], x, y, touch_);
    if (!inside) continue;
    Point end;
    for (std::size_t a = 0; a < 3; ++a) end[a] = x[a] + inside->from * (y[a] - x[a]);
    if (holes_.cuts(x, end, touch_) || cracks_.cuts(x, end, touch_)) return {Verdict::none, 0, {}};
    return {Verdict::interface, n, end};
  }
  if (kind == PointKind::rigid || cut(holes_, x, y, mirrored)) return {Verdict::none, 0, {}};
  return {cut(cracks_, x, y, mirrored) ? Verdict::cracked : Verdict::joined, 0, {}};
}

bool BondRules::near_defect(const Point& x) const {
  if (body_.defects.distance_to_edge(x) <= 2 * body_.horizon) return true;
  // A bond to a ghost may touch the mirror image of a defect, which the distance to the defect does not tell.
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(body_.dimension); ++axis)
    if (x[axis] - body_.faces[2 * axis] <= body_.horizon ||
        body_.faces[2 * axis + 1] - x[axis] <= body_.horizon)
      return true;
  return false;
}

std::optional<std::size_t> BondRules::rigid_inclusion(const Point& x) const {
  for (std::size_t n = 0; n < body_.defects.inclusions.size(); ++n)
    if (signed_distance(body_.defects.inclusions[n], x) < kRigidMargin * body_.spacing) return n;
  return std::nullopt;
}

}  // namespace riven
