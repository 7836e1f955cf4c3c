// [material.NAME]: keys from what the laws say of their parameters.

#include <fmt/format.h>

#include <algorithm>

#include "input/material_format.hpp"

#include "input/failure_format.hpp"
#include "input/format_lists.hpp"
#include "input/model_format.hpp"

namespace riven {

using kind::Parts;
using kind::Quantities;
using kind::Quantity;
using kind::Text;

namespace {

std::vector<std::string> law_names() {
  std::vector<std::string> names;
  for_each_law([&]<class L>(const L&) { names.emplace_back(L::name); });
  return names;
}

/// Laws whose volume is a matter of its own.
std::vector<std::string> isochoric_laws() {
  std::vector<std::string> names;
  for_each_law([&]<class L>(const L&) {
    if constexpr (!OfGradient<L>) names.emplace_back(L::name);
  });
  return names;
}

/// A key, with what the laws that have it say of it.
struct LawKey {
  std::string name;
  ParameterKind kind;
  bool is_list = false;
  std::vector<std::string> laws, needed_by;
  std::vector<std::string> docs;  // without repetition
  std::optional<double> fallback;
};

std::vector<LawKey> law_keys() {
  std::vector<LawKey> keys;
  for_each_law([&]<class L>(L law) {
    L::each_parameter(law, [&]<class Member>(const char* name, Member&, const ParameterKind& kind) {
      auto key = std::find_if(keys.begin(), keys.end(), [&](const LawKey& k) { return k.name == name; });
      if (key == keys.end()) {
        key = keys.insert(keys.end(), LawKey{.name = name, .kind = kind});
        key->is_list = !std::is_same_v<Member, double>;
      }
      key->laws.emplace_back(L::name);
      if (!kind.fallback && !kind.factor) key->needed_by.emplace_back(L::name);
      if (kind.fallback) key->fallback = kind.fallback;
      if (std::find(key->docs.begin(), key->docs.end(), kind.doc) == key->docs.end())
        key->docs.push_back(kind.doc);
    });
  });
  return keys;
}

/// Keys that are different ways to say the same, with their law.
std::vector<Group> alternatives(const MaterialInput& m) {
  std::vector<Group> groups;
  for_each_law([&]<class L>(L law) {
    Group group{{}, true, When{"law", &m.law, {L::name}}};
    L::each_parameter(law, [&](const char* name, auto&, const ParameterKind& kind) {
      if (kind.factor) group.keys.emplace_back(name);
    });
    if (!group.keys.empty()) groups.push_back(std::move(group));
  });
  return groups;
}

Range range_of(ParameterKind::Range range) {
  if (range == ParameterKind::Range::positive) return positive;
  if (range == ParameterKind::Range::poissons_ratio)
    return {.low = -1, .above_low = true, .high = 0.5, .below_high = true};
  return any_number;
}

Key key_of(const LawKey& from, MaterialInput& m) {
  const Dimension& unit =
      from.kind.unit == ParameterKind::Unit::pressure ? dimension::pressure : dimension::none;
  Kind kind = from.is_list ? Kind(Quantities{&m.lists[from.name], unit, range_of(from.kind.range)})
                           : Kind(Quantity{&m.numbers[from.name], unit, range_of(from.kind.range)});
  std::string doc;
  for (const std::string& one : from.docs) doc += (doc.empty() ? "" : " Or: ") + one;
  Key key = Key{from.name, std::move(kind), doc}.applies(When{"law", &m.law, from.laws});
  if (from.fallback) key.fallback = fmt::format("{:g}", *from.fallback);
  if (!from.needed_by.empty()) key.required_when = When{"law", &m.law, from.needed_by};
  // Springs have a Poisson's ratio of their own: a case need not give it.
  if (from.name == "poissons_ratio")
    key.required_when->among = {StVenantKirchhoff::name, CompressibleNeoHookean::name};
  return key;
}

Format describe(RelaxationInput& r) {
  return {
      .doc = "A branch of the series.",
      .keys = {
          Key{"share", Quantity{&r.share, dimension::none, {.low = 0, .above_low = true, .high = 1}},
              "Of the isochoric stress that follows a jump."}
              .required(),
          Key{"time", Quantity{&r.time, dimension::time, positive}, "In which it falls to 1/e."}.required()}};
}

void check_relaxation(const MaterialInput& m, const Case& c, const Check& check) {
  if (m.relaxation.empty()) return;
  if (c.model.kind != "finite-elements")
    check.fail("relaxation", fmt::format("the model \"{}\" has no memory; expected none, or kind = "
                                         "\"finite-elements\"",
                                         c.model.kind));
  double sum = 0;
  for (const RelaxationInput& branch : m.relaxation) sum += branch.share;
  if (sum >= 1)
    check.fail("relaxation", fmt::format("the shares sum to {:g}; expected less than 1, so that a stiffness "
                                         "stays",
                                         sum));
}

void check_material(const MaterialInput& m, const Case& c, const Check& check) {
  check_limits(m, c, check);
  check_relaxation(m, c, check);
  if (c.solver.in_time() && c.solver.inertia && !check.given("density"))
    check.fail("density", fmt::format("missing with solver.method = \"{}\", where inertia counts; expected a "
                                      "density, such as \"1100 kg/m^3\"",
                                      c.solver.method));
  if (c.model.kind == "membrane-bond" && m.law != NeoHookean::name)
    check.fail("law", fmt::format("found \"{}\" with model.kind = \"membrane-bond\", whose bonds are "
                                  "neo-Hookean; expected \"neo-hookean\"",
                                  m.law));
  if ((c.model.kind == "lps" || c.model.kind == "correspondence") && m.law == LinearElastic::name &&
      !m.number("poissons_ratio"))
    check.fail("poissons_ratio", "missing; expected a number above -1 and below 0.5");
  if (!m.volumetric.empty() && !m.bulk_modulus)
    check.fail("volumetric",
               "says how volume changes, which needs bulk_modulus; without it the law is incompressible");
  if (m.law == Ogden::name && m.lists.at("moduli").size() != m.lists.at("exponents").size())
    check.fail("exponents", fmt::format("{} exponents and {} moduli are given; expected as many of both",
                                        m.lists.at("exponents").size(), m.lists.at("moduli").size()));
}

}  // namespace

Format describe(MaterialInput& m, const Case& c) {
  std::vector<Key> keys = {
      Key{"law", Text{&m.law, law_names()},
          "The constitutive law. The models `pmb` and `lps` take `linear-elastic`, membranes a rubber W(I1, "
          "I2), `correspondence` any; in space and in plane strain a rubber needs `bulk_modulus` there."}
          .required(),
      Key{"density", Quantity{&m.density, dimension::density, positive}, "Needed where inertia counts."}};
  for (const LawKey& key : law_keys()) keys.push_back(key_of(key, m));
  keys.push_back(Key{"bulk_modulus", Quantity{&m.bulk_modulus, dimension::pressure, positive},
                     "Makes a rubber nearly incompressible; without it, it keeps its volume."}
                     .applies(When{"law", &m.law, isochoric_laws()}));
  keys.push_back(Key{"volumetric", Text{&m.volumetric, {"quadratic", "logarithmic"}},
                     "Energy of a change of volume: k/2 (J - 1)^2 unless given, or k/4 (J^2 - 1 - 2 ln J)."}
                     .applies(When{"law", &m.law, isochoric_laws()}));
  keys.push_back(Key{"relaxation",
                     tables(m.relaxation, [](RelaxationInput& r, std::size_t) { return describe(r); }),
                     "Prony series of the isochoric stress: it relaxes by these shares, with these times. "
                     "Only finite-elements."}
                     .applies(When{"law", &m.law, isochoric_laws()}));
  for (Key& key : limit_keys(m.critical_stretch, m.critical_energy_release_rate))
    keys.push_back(std::move(key));
  keys.push_back(Key{"critical_damage", Quantity{&m.critical_damage, dimension::none, fraction},
                     "Share of its bonds that a point has lost when all others break too."});
  keys.push_back(Key{"critical_energy_density",
                     Quantity{&m.critical_energy_density, dimension::pressure, positive},
                     "Strain energy per volume of a point beyond which all its bonds break."});
  keys.push_back(
      Key{"on", Parts{&m.on},
          "The set of points that are of this material, or a list of sets; one material has no `on` "
          "and all other points."});
  return {.doc = "A constitutive law and its parameters, and when its bonds break.",
          .at = &m.at,
          .keys = std::move(keys),
          .groups = alternatives(m),
          .finish = [&m, &c](const Check& check) { check_material(m, c, check); }};
}

Material make_material(const MaterialInput& in) {
  Material material{.name = in.name, .law = NeoHookean{}, .density = in.density};
  for_each_law([&]<class L>(L law) {
    if (in.law != L::name) return;
    L::each_parameter(law, [&]<class Member>(const char* name, Member& member, const ParameterKind& kind) {
      if constexpr (std::is_same_v<Member, double>) {
        if (const auto given = in.number(name)) member = kind.factor.value_or(1) * *given;
      } else {
        member = in.lists.at(name);
      }
    });
    material.law = law;
  });
  if (in.bulk_modulus)
    material.volumetric =
        Volumetric{*in.bulk_modulus, in.volumetric == "logarithmic" ? Volumetric::Form::logarithmic
                                                                    : Volumetric::Form::quadratic};
  for (const RelaxationInput& branch : in.relaxation)
    material.relaxation.push_back({branch.share, branch.time});
  const double shear = material.small_strain().shear;
  if (!(shear > 0))
    throw InputError(
        in.at, fmt::format("material.{}: the shear modulus is {:g} Pa; expected a law with a positive one",
                           in.name, shear));
  return material;
}

}  // namespace riven
