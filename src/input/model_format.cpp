#include "input/model_format.hpp"

#include <fmt/format.h>

namespace riven {

using kind::Quantity;
using kind::Text;

namespace {

/// Variants are those of the kind, and so are defaults.
void finish_model(ModelInput& model, const Check& check) {
  const bool correspondence = model.kind == "correspondence";
  if (model.kind == "membrane-bond" && model.variant != "published" && model.variant != "zero-residual")
    check.fail("variant", fmt::format("found \"{}\", a variant of kind = \"correspondence\"; expected one of "
                                      "published, zero-residual",
                                      model.variant));
  if (correspondence && model.variant == "zero-residual")
    check.fail("variant",
               "found \"zero-residual\", a variant of kind = \"membrane-bond\"; expected one of "
               "stabilised, bond-associated, published");
  if (correspondence && model.variant.empty()) model.variant = "stabilised";
  if (correspondence && model.variant == "bond-associated" && model.stabilisation)
    check.fail("stabilisation", "the variant \"bond-associated\" needs none; expected none");
  if (correspondence && model.variant == "published" && !model.stabilisation)
    check.fail("stabilisation",
               "missing; the published stabilisation depends on the unit of length (here the "
               "metre), so that no factor suits all cases");
  if (!model.stabilisation && model.kind == "membrane") model.stabilisation = 4;
  if (!model.stabilisation && correspondence && model.variant == "stabilised") model.stabilisation = 1;
}

}  // namespace

Format describe(ModelInput& model) {
  const auto kind = [&model](const char* name) { return When{"kind", &model.kind, {name}}; };
  return {
      .doc = "How points interact.",
      .at = &model.at,
      .keys =
          {Key{"kind",
               Text{&model.kind,
                    {"membrane", "membrane-bond", "pmb", "lps", "correspondence", "finite-elements"}},
               "`membrane`: rubber sheets, state-based, for any loading and law. `membrane-bond`: the "
               "published bond-based one, to compare with. `pmb`: linear springs that break, for brittle "
               "bodies in one, two or three dimensions. `lps`: linear peridynamic solid, state-based, for "
               "linear "
               "elasticity with any Poisson's ratio in two or three dimensions. `correspondence`: any law, "
               "by a "
               "deformation gradient per point, in two or three dimensions. `finite-elements`: any law, by "
               "displacements of the nodes of a mesh (geometry with `elements`)."}
               .otherwise("\"membrane\""),
           Key{"stabilisation", Quantity{&model.stabilisation, dimension::none, not_negative},
               "Factor of the stabilisation energy; 0 switches it off. Unless given: 4 (`membrane`), 1 "
               "(`correspondence`, where long shear waves then run at the material's speed)."}
               .applies(When{"kind", &model.kind, {"membrane", "correspondence"}}),
           Key{"loading", Text{&model.loading, {"equibiaxial", "planar", "uniaxial", "uniaxial-compression"}},
               "The loading that the bonds' law was fitted to; it holds for this one only."}
               .applies(kind("membrane-bond"))
               .required(),
           Key{"variant",
               Text{&model.variant, {"published", "zero-residual", "stabilised", "bond-associated"}},
               "`membrane-bond`: constants of the bonds as published, or fitted so that bonds at rest have "
               "no "
               "force (`zero-residual`). `correspondence`: `stabilised` unless given; `bond-associated`, "
               "with "
               "a stress per bond; `published`, whose stabilisation depends on the unit of length."}
               .applies(When{"kind", &model.kind, {"membrane-bond", "correspondence"}})
               .required_if(kind("membrane-bond")),
           Key{"surface_correction", Text{&model.surface_correction, {"on", "off"}},
               "Whether bonds are scaled so that each point has the local energy at stretch 4 (for "
               "compression: 0.5)."}
               .otherwise("\"on\"")
               .applies(kind("membrane-bond")),
           Key{"plane", Text{&model.plane, {"stress", "strain"}},
               "What holds a body in two dimensions across: nothing (with `pmb` Poisson's ratio is 1/3), or "
               "rigid walls (1/4)."}
               .otherwise("\"stress\"")
               .applies(When{"kind", &model.kind, {"pmb", "lps", "correspondence", "finite-elements"}}),
           Key{"dilatation", Text{&model.dilatation, {"mean", "linear", "full", "selective"}},
               "The J of which the energy of the change of volume is taken: its `mean` over an element, or a "
               "`linear` fit (`q8` only), which do not lock where a rubber is nearly incompressible; each "
               "point's "
               "own (`full`); or that of the mean gradient, with `q4` that at the centre (`selective`, "
               "selective "
               "reduced integration). Unless given: `mean`, with `q8` `linear`, for laws with a bulk_modulus "
               "in "
               "plane strain and in space."}
               .applies(kind("finite-elements")),
           Key{"influence", Text{&model.influence, {"inverse", "constant"}},
               "How much a bond counts by its length: as horizon over length, or all the same."}
               .otherwise("\"inverse\"")
               .applies(When{"kind", &model.kind, {"lps", "correspondence"}})},
      .finish = [&model](const Check& check) { finish_model(model, check); }};
}

}  // namespace riven
