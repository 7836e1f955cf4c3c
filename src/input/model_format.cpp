#include "input/model_format.hpp"

#include <fmt/format.h>

namespace riven {

using kind::Quantity;
using kind::Text;

Format describe(ModelInput& model) {
  const auto kind = [&model](const char* name) { return When{"kind", &model.kind, {name}}; };
  return {
      .doc = "How points interact.",
      .at = &model.at,
      .keys = {
          Key{"kind", Text{&model.kind, {"membrane", "membrane-bond", "pmb", "lps"}},
              "`membrane`: rubber sheets, state-based, for any loading and law. `membrane-bond`: the "
              "published bond-based one, to compare with. `pmb`: linear springs that break, for brittle "
              "bodies in one, two or three dimensions. `lps`: linear peridynamic solid, state-based, for "
              "linear "
              "elasticity with any Poisson's ratio in two or three dimensions."}
              .otherwise("\"membrane\""),
          Key{"stabilisation", Quantity{&model.stabilisation, dimension::none, not_negative},
              "Factor of the stabilisation energy; 0 switches it off."}
              .otherwise("4")
              .applies(kind("membrane")),
          Key{"loading", Text{&model.loading, {"equibiaxial", "planar", "uniaxial", "uniaxial-compression"}},
              "The loading that the bonds' law was fitted to; it holds for this one only."}
              .applies(kind("membrane-bond"))
              .required(),
          Key{"variant", Text{&model.variant, {"published", "zero-residual"}},
              "Constants of the bonds: as published, or fitted so that bonds at rest have no force."}
              .applies(kind("membrane-bond"))
              .required(),
          Key{"surface_correction", Text{&model.surface_correction, {"on", "off"}},
              "Whether bonds are scaled so that each point has the local energy at stretch 4 (for "
              "compression: 0.5)."}
              .otherwise("\"on\"")
              .applies(kind("membrane-bond")),
          Key{"plane", Text{&model.plane, {"stress", "strain"}},
              "What holds a body in two dimensions across: nothing (with `pmb` Poisson's ratio is 1/3), or "
              "rigid walls (1/4)."}
              .otherwise("\"stress\"")
              .applies(When{"kind", &model.kind, {"pmb", "lps"}}),
          Key{"influence", Text{&model.influence, {"inverse", "constant"}},
              "How much a bond counts by its length: as horizon over length, or all the same."}
              .otherwise("\"inverse\"")
              .applies(kind("lps"))}};
}

}  // namespace riven
