// [[interface]] and [failure]: when bonds break.

#include "input/failure_format.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/nearest_name.hpp"

namespace riven {

using kind::Parts;
using kind::Quantity;
using kind::Texts;

namespace {

std::vector<std::string> material_names(const Case& c) {
  std::vector<std::string> names;
  for (const MaterialInput& material : c.materials) names.push_back(material.name);
  return names;
}

void check_sets(const char* key, const std::vector<Named>& on, const Case& c, const Check& check) {
  const std::vector<std::string> edges = edge_names(c);
  for (const Named& name : on)
    if (std::find(edges.begin(), edges.end(), name.text) != edges.end())
      check.fail(key, fmt::format("\"{}\" is an edge, and edges have no points; expected a set", name.text));
}

}  // namespace

void check_limits(const MaterialInput& material, const Case& c, const Check& check) {
  check_sets("on", material.on, c, check);
  if (material.critical_stretch && material.critical_energy_release_rate)
    check.fail("critical_energy_release_rate",
               "given together with critical_stretch, which follows from it; expected one of both");
}

std::vector<Key> limit_keys(std::optional<double>& stretch, std::optional<double>& energy_release_rate) {
  return {
      Key{"critical_stretch", Quantity{&stretch, dimension::none, positive},
          "Elongation over length at which a bond breaks for good."},
      Key{"critical_energy_release_rate", Quantity{&energy_release_rate, dimension::surface_energy, positive},
          "Energy per area of a crack (both faces together), from which the critical stretch follows."}};
}

Format describe(InterfaceInput& interface, const Case& c) {
  std::vector<Key> keys = {
      Key{"between", Texts{&interface.between, {}}, "The names of two materials."}.required()};
  for (Key& key : limit_keys(interface.critical_stretch, interface.critical_energy_release_rate))
    keys.push_back(std::move(key));
  return {
      .doc = "When bonds between two materials break; unless given, as those of the weaker one.",
      .at = &interface.at,
      .keys = std::move(keys),
      .groups = {{{"critical_stretch", "critical_energy_release_rate"}}},
      .finish = [&interface, &c](const Check& check) {
        if (interface.between.size() != 2 || interface.between[0] == interface.between[1])
          check.fail("between", "expected the names of two materials");
        const std::vector<std::string> names = material_names(c);
        for (const std::string& name : interface.between)
          if (std::find(names.begin(), names.end(), name) == names.end())
            check.fail("between", fmt::format("there is no material \"{}\"; expected two of {}{}", name,
                                              listed(names), did_you_mean(name, names)));
        for (const InterfaceInput& other : c.interfaces)
          if (&other != &interface && std::is_permutation(other.between.begin(), other.between.end(),
                                                          interface.between.begin(), interface.between.end()))
            check.fail("between", fmt::format("is the same pair as at {}", other.at.text()));
      }};
}

Format describe(FailureInput& failure, const Case& c) {
  return {.doc = "Where bonds do not break, and how late they may.",
          .at = &failure.at,
          .keys = {Key{"not_in", Parts{&failure.not_in},
                       "The set whose points keep all their bonds, or a list of sets."},
                   Key{"excess", Quantity{&failure.excess, dimension::none, positive},
                       "Share of their energy that the bonds which break in a step may hold beyond the limit "
                       "on average; with more, the next steps are halved, to an eighth at the least."}
                       .applies(When{"solver.method", &c.solver.method, {"verlet"}})},
          .finish = [&failure, &c](const Check& check) { check_sets("not_in", failure.not_in, c, check); }};
}

void check_failure(const Case& c, const Check& check) {
  if (c.materials.empty())
    check.fail("material", "missing; expected one material, such as [material.rubber]");
  const MaterialInput* rest = nullptr;
  for (const MaterialInput& material : c.materials) {
    if (!material.on.empty()) continue;
    if (rest != nullptr)
      check.fail("material",
                 fmt::format("both {} and {} are without `on`, at {}; expected one material for all "
                             "points that the others do not have",
                             rest->name, material.name, material.at.text()));
    rest = &material;
  }
  if (rest == nullptr)
    check.fail("material", "all materials have `on`; expected one without, for all other points");
}

}  // namespace riven
