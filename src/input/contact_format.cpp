#include "input/contact_format.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/nearest_name.hpp"

namespace riven {

using kind::Components;
using kind::Place;
using kind::Quantities;
using kind::Quantity;
using kind::Table;
using kind::Text;

namespace {

// The middle of a face of a cubic lattice's cell is 0.71 spacings from the points at its corners.
constexpr double kLeastDistance = 0.75;
constexpr Dimension kMass{.kilogram = 1};

Key stiffness_key(double& stiffness) {
  return Key{"stiffness", Quantity{&stiffness, dimension::none, positive},
             "Times what follows from the bonds, or the elements: about as stiff as the body. More needs "
             "shorter steps of Verlet's method."}
      .otherwise("1");
}

Format describe(std::optional<SphereInput>& sphere) {
  if (!sphere) sphere.emplace();
  return {
      .doc = "A sphere; in two dimensions a disc.",
      .keys = {
          Key{"center", Place{&sphere->center}, "Its centre at the start."}.required(),
          Key{"radius", Quantity{&sphere->radius, dimension::length, positive}, "Its radius."}.required()}};
}

Format describe(std::optional<PlaneInput>& plane, const Case& c) {
  if (!plane) plane.emplace();
  return {.doc = "A half-space.",
          .keys = {Key{"point", Place{&plane->point}, "A place on its surface at the start."}.required(),
                   Key{"normal", Quantities{&plane->normal, dimension::none},
                       "The direction out of it, towards the body; of any length."}
                       .required()},
          .finish = [&plane, &c](const Check& check) {
            const auto count = static_cast<std::size_t>(c.geometry.dimension);
            if (plane->normal.size() != count)
              check.fail("normal", fmt::format("found {} entries; expected {}, one per direction",
                                               plane->normal.size(), count));
            if (std::all_of(plane->normal.begin(), plane->normal.end(), [](double n) { return n == 0; }))
              check.fail("normal", "is zero; expected a direction, such as that of an axis");
          }};
}

Format describe(std::optional<FlatInput>& flat) {
  if (!flat) flat.emplace();
  return {.doc = "The flat end of a punch, of a finite width, in two dimensions; on finite elements.",
          .keys = {Key{"from", Place{&flat->from}, "One end of the flat at the start."}.required(),
                   Key{"to", Place{&flat->to},
                       "The other one: the impactor is to the left of the way there, the body to the right."}
                       .required()},
          .finish = [&flat](const Check& check) {
            if (flat->from == flat->to) check.fail("to", "is the same place as from; expected two places");
          }};
}

void check_name(const ImpactorInput& impactor, const Case& c, const Check& check) {
  if (impactor.name.empty()) check.fail("name", "is empty; expected a name, such as \"ball\"");
  for (const ImpactorInput& other : c.impactors)
    if (&other != &impactor && other.name == impactor.name)
      check.fail("name", fmt::format("\"{}\" is the name of another one at {}; expected a new name",
                                     impactor.name, other.at.text()));
}

void check_motion(const ImpactorInput& impactor, const Check& check) {
  for (const ComponentInput& component : impactor.displacement)
    if (!component.value)
      check.fail("displacement", "has an entry \"free\"; expected a displacement, such as 0, in each");
  for (const ComponentInput& component : impactor.velocity) {
    if (!component.value)
      check.fail("velocity",
                 "has an entry \"free\"; expected a speed, such as 0, in each: an impactor with mass is free "
                 "in all directions, one without in none");
    if (impactor.mass && component.value->depends_on("t"))
      check.fail("velocity",
                 "depends on t, and with mass it is the velocity at the start; expected no t, or "
                 "no mass for a velocity that is prescribed");
  }
  if (impactor.mass && impactor.plane)
    check.fail("mass", "belongs to spheres; a plane's velocity is prescribed");
}

/// What impactors of peridynamic points have not, or those of elements.
void check_kind(const ImpactorInput& impactor, const Case& c, const Check& check) {
  const std::string elements = "belongs to the model \"finite-elements\"";
  if (!c.geometry.elements) {
    if (c.solver.method != "verlet")
      throw InputError(impactor.at,
                       fmt::format("impactor {}: method = \"{}\" moves none of peridynamic points; expected "
                                   "method = \"verlet\", or finite elements",
                                   impactor.name, c.solver.method));
    if (impactor.flat) check.fail("flat", elements + "; expected a sphere or a plane");
    if (!impactor.displacement.empty()) check.fail("displacement", elements + "; expected velocity");
    if (impactor.surface == "sticking") check.fail("surface", elements + "; expected \"frictionless\"");
    return;
  }
  if (impactor.mass)
    check.fail("mass",
               "belongs to peridynamic models: on finite elements impactors move as prescribed; "
               "expected velocity or displacement only");
  if (impactor.flat && c.geometry.dimension != 2)
    check.fail("flat", "belongs to two dimensions; expected a plane or a sphere");
  if (c.solver.control == "arc-length")
    throw InputError(impactor.at, fmt::format("impactor {}: a body has no path of equilibria before it is "
                                              "touched; expected control = \"load\"",
                                              impactor.name));
  if (!impactor.velocity.empty() && !c.solver.in_time())
    check.fail("velocity", "needs motion in time; expected displacement, a formula of stretch");
}

}  // namespace

Format describe(std::optional<ContactInput>& contact, const Case& c) {
  if (!contact) contact.emplace();
  return {
      .doc =
          "Repulsion between points of the body that no bond joins, or no longer: with it crack faces "
          "and fragments do not pass through each other. Without this table they do.",
      .at = &contact->at,
      .keys = {Key{"distance", Quantity{&contact->distance, dimension::length, positive},
                   "Points nearer than this, and nearer than in the undeformed body, repel."}
                   .otherwise("\"1 dx\""),
               stiffness_key(contact->stiffness)},
      .finish = [&contact, &c](const Check& check) {
        const double spacing = c.geometry.spacing;
        // Rounding must not refuse the ends.
        if (contact->distance < kLeastDistance * spacing * (1 - 1e-9))
          check.fail("distance",
                     fmt::format("{:.4g} m is below {} of the spacing, {:.4g} m: points could pass between "
                                 "others; expected \"1 dx\" or so",
                                 contact->distance, kLeastDistance, spacing));
        if (contact->distance > c.geometry.horizon * (1 + 1e-9))
          check.fail("distance", fmt::format("{:.4g} m is beyond the horizon, {:.4g} m; expected \"1 dx\" "
                                             "or so",
                                             contact->distance, c.geometry.horizon));
      }};
}

Format describe(ImpactorInput& impactor, const Case& c) {
  return {
      .doc =
          "A rigid body that does not turn and pushes points, or nodes on the sides of elements that face "
          "it, "
          "out of itself: a sphere, a plane or a flat. Its motion is prescribed; a sphere with mass is free "
          "and is pushed back. Of points it belongs to method = \"verlet\".",
      .at = &impactor.at,
      .keys =
          {Key{"name", Text{&impactor.name}, "Its name, for probes and messages."}.required(),
           Key{"sphere",
               Table{[&impactor] { return describe(impactor.sphere); },
                     [&impactor] { return impactor.sphere.has_value(); }},
               "A sphere."},
           Key{"plane",
               Table{[&impactor, &c] { return describe(impactor.plane, c); },
                     [&impactor] { return impactor.plane.has_value(); }},
               "A plane."},
           Key{"flat",
               Table{[&impactor] { return describe(impactor.flat); },
                     [&impactor] { return impactor.flat.has_value(); }},
               "A flat."},
           Key{"mass", Quantity{&impactor.mass, kMass, positive},
               "Of a sphere that is free to move; in two dimensions that of the disc, as thick as the "
               "body."},
           Key{"velocity", Components{&impactor.velocity, dimension::velocity},
               "One entry per direction: without mass what it moves with, a formula of t; with mass "
               "what it starts with. At rest unless given."},
           Key{"displacement", Components{&impactor.displacement},
               "On finite elements, instead of velocity: what it has moved by, a formula of t or stretch, "
               "0 at the start."},
           Key{"surface", Text{&impactor.surface, {"frictionless", "sticking"}},
               "On finite elements: whether nodes slide along it, or stay where they touched it until "
               "they come off."}
               .otherwise("\"frictionless\""),
           stiffness_key(impactor.stiffness)},
      .groups = {{{"sphere", "plane", "flat"}}, {{"velocity", "displacement"}, false}},
      .finish = [&impactor, &c](const Check& check) {
        check_name(impactor, c, check);
        check_motion(impactor, check);
        check_kind(impactor, c, check);
      }};
}

void check_impactor(const std::string& name, const Case& c, const Check& check) {
  std::vector<std::string> names;
  for (const ImpactorInput& impactor : c.impactors) names.push_back(impactor.name);
  if (std::find(names.begin(), names.end(), name) == names.end())
    check.fail("impactor", fmt::format("there is no impactor \"{}\"; known are {}{}", name,
                                       names.empty() ? "none" : listed(names), did_you_mean(name, names)));
}

}  // namespace riven
