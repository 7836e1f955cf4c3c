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

Format describe(MaterialInput& m, const Case& c) {
  const auto law = [&m](std::vector<std::string> laws) { return When{"law", &m.law, std::move(laws)}; };
  const auto modulus = [](std::optional<double>& to, Range range) {
    return Quantity{&to, dimension::pressure, range};
  };
  return {
      .doc = "A constitutive law and its parameters. For now a case has exactly one material.",
      .at = &m.at,
      .keys =
          {Key{"law", Text{&m.law, {"neo-hookean", "mooney-rivlin", "yeoh", "linear-elastic"}},
               "The constitutive law; `linear-elastic` belongs to the models `pmb` and `lps`, the others to "
               "membranes."}
               .required(),
           Key{"density", Quantity{&m.density, dimension::density, positive}, "Needed where inertia counts."}
               .required_if(When{"solver.method", &c.solver.method, {"verlet"}}),
           Key{"youngs_modulus", modulus(m.youngs_modulus, positive), "Young's modulus."}
               .applies(law({"neo-hookean", "linear-elastic"}))
               .required_if(law({"linear-elastic"})),
           Key{"poissons_ratio", Quantity{&m.poissons_ratio, dimension::none, any_number},
               "Needed by the model `lps`; with `pmb` to be checked, which has one of its own."}
               .applies(law({"linear-elastic"})),
           Key{"critical_stretch", Quantity{&m.critical_stretch, dimension::none, positive},
               "Elongation over length at which a bond breaks for good; without it none breaks."}
               .applies(law({"linear-elastic"})),
           Key{"shear_modulus", modulus(m.shear_modulus, positive), "Shear modulus."}.applies(
               law({"neo-hookean"})),
           Key{"c10", modulus(m.c10, any_number), "First parameter of the law."}.required_if(
               law({"mooney-rivlin", "yeoh"})),
           Key{"c01", modulus(m.c01, any_number), "Second parameter."}
               .applies(law({"mooney-rivlin"}))
               .required(),
           Key{"c20", modulus(m.c20, any_number), "Second parameter."}.applies(law({"yeoh"})).otherwise("0"),
           Key{"c30", modulus(m.c30, any_number), "Third parameter."}.applies(law({"yeoh"})).otherwise("0")},
      .groups = {{{"youngs_modulus", "shear_modulus", "c10"}, true, law({"neo-hookean"})}},
      .finish = [&m, &c](const Check& check) {
        if (c.model.kind == "membrane-bond" && m.law != "neo-hookean")
          check.fail("law", fmt::format("found \"{}\" with model.kind = \"membrane-bond\", whose bonds are "
                                        "neo-Hookean; expected \"neo-hookean\"",
                                        m.law));
        const double shear = 2 * (m.c10.value_or(1) + m.c01.value_or(0));
        if (shear <= 0)
          check.fail("c10", "gives a shear modulus of zero or less; expected c10 + c01 above 0");
      }};
}

}  // namespace riven
