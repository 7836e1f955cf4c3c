#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "input/material_format.hpp"
#include "peridynamics/bond_membrane.hpp"
#include "peridynamics/correspondence.hpp"
#include "peridynamics/lps.hpp"
#include "peridynamics/membrane.hpp"
#include "peridynamics/pmb.hpp"
#include "simulation/build_parts.hpp"

namespace riven {

namespace {

/// Limit of stretch that a material or an interface gives, if one.
template <class Input>
std::optional<double> limit_of(const Input& in, const BreakingModel& model, std::size_t a, std::size_t b) {
  if (in.critical_stretch) return in.critical_stretch;
  if (!in.critical_energy_release_rate) return std::nullopt;
  return model.critical_stretch(*in.critical_energy_release_rate, a, b);
}

std::size_t material_number(const Case& in, const std::string& name) {
  const auto found = std::find_if(in.materials.begin(), in.materials.end(),
                                  [&](const MaterialInput& material) { return material.name == name; });
  return static_cast<std::size_t>(found - in.materials.begin());
}

/// Where an interface says nothing, its bonds break as those of the weaker side.
void set_limits(const Case& in, BreakingModel& model) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const std::size_t count = in.materials.size();
  FailureLimits limits = FailureLimits::uniform(kNever, count);
  for (std::size_t a = 0; a < count; ++a) {
    const double own = limit_of(in.materials[a], model, a, a).value_or(kNever);
    for (std::size_t b = 0; b < count; ++b)
      for (double* limit : {&limits.stretch[a * count + b], &limits.stretch[b * count + a]})
        *limit = std::min(*limit, own);
    limits.damage.push_back(in.materials[a].critical_damage.value_or(kNever));
    limits.energy_density.push_back(in.materials[a].critical_energy_density.value_or(kNever));
  }
  for (const InterfaceInput& interface : in.interfaces) {
    const std::size_t a = material_number(in, interface.between[0]);
    const std::size_t b = material_number(in, interface.between[1]);
    limits.stretch[a * count + b] = limits.stretch[b * count + a] = limit_of(interface, model, a, b).value();
  }
  const auto some = [](const std::vector<double>& of) {
    return std::any_of(of.begin(), of.end(), [](double limit) { return std::isfinite(limit); });
  };
  if (!some(limits.energy_density)) limits.energy_density.clear();
  if (some(limits.stretch) || some(limits.energy_density)) model.set_limits(std::move(limits));
}

std::unique_ptr<PointModel> with_limits(const Case& in, std::unique_ptr<BreakingModel> model) {
  set_limits(in, *model);
  return model;
}

BondMembraneSettings bond_settings(const ModelInput& in) {
  Loading loading = Loading::equibiaxial;
  if (in.loading == "planar") loading = Loading::planar;
  if (in.loading == "uniaxial") loading = Loading::uniaxial;
  if (in.loading == "uniaxial-compression") loading = Loading::uniaxial_compression;
  return {loading, in.variant == "zero-residual", in.surface_correction == "on"};
}

Plane plane_of(const Case& in) {
  return in.model.plane == "strain" ? Plane::strain : Plane::stress;
}

Influence influence_of(const Case& in) {
  return in.model.influence == "constant" ? Influence::constant : Influence::inverse;
}

void refuse_inclusions(const Case& in) {
  if (in.inclusions.empty()) return;
  throw InputError(
      in.inclusions.front().at,
      fmt::format("inclusion: the model \"{}\" has no rigid inclusions; expected holes and cracks only, or a "
                  "material of its own on a set of points",
                  in.model.kind));
}

/// Poisson's ratio is the model's; one that the user gave must be it.
void check_poissons_ratio(const MaterialInput& in, const Pmb& model) {
  constexpr double kRounded = 0.005;  // 0.33 for 1/3
  const auto given = in.number("poissons_ratio");
  if (model.body().dimension == 1 || !given) return;
  if (std::abs(*given - model.poissons_ratio()) <= kRounded) return;
  throw InputError(in.at,
                   fmt::format("material.{}.poissons_ratio: found {:g}; the model \"pmb\" has {:.4g} here "
                               "(1/3 in plane stress, 1/4 otherwise)",
                               in.name, *given, model.poissons_ratio()));
}

std::unique_ptr<PointModel> make_pmb(const Case& in, Body body) {
  std::vector<PmbSettings> settings;
  for (const MaterialInput& material : in.materials)
    settings.push_back({.youngs_modulus = material.number("youngs_modulus").value(),
                        .density = material.density,
                        .plane = plane_of(in)});
  auto model = std::make_unique<Pmb>(std::move(body), std::move(settings));
  for (const MaterialInput& material : in.materials) check_poissons_ratio(material, *model);
  return with_limits(in, std::move(model));
}

std::unique_ptr<PointModel> make_lps(const Case& in, Body body) {
  std::vector<LpsSettings> settings;
  for (const MaterialInput& material : in.materials)
    settings.push_back({.youngs_modulus = material.number("youngs_modulus").value(),
                        .poissons_ratio = material.number("poissons_ratio").value(),
                        .density = material.density,
                        .plane = plane_of(in),
                        .influence = influence_of(in)});
  return with_limits(in, std::make_unique<Lps>(std::move(body), std::move(settings)));
}

CorrespondenceSettings correspondence_settings(const Case& in) {
  CorrespondenceSettings settings{.material = make_material(in.materials.front()),
                                  .plane = plane_of(in),
                                  .influence = influence_of(in),
                                  .factor = in.model.stabilisation.value_or(0)};
  for (std::size_t m = 1; m < in.materials.size(); ++m)
    settings.further.push_back(make_material(in.materials[m]));
  if (in.model.variant == "published") settings.stabilisation = Stabilisation::published;
  if (in.model.variant == "bond-associated") settings.stabilisation = Stabilisation::bond_associated;
  return settings;
}

std::unique_ptr<PointModel> make_correspondence(const Case& in, Body body) {
  return with_limits(in, std::make_unique<Correspondence>(std::move(body), correspondence_settings(in)));
}

/// Names of the laws of which something holds.
template <class Holds>
std::string laws_that(const Holds& holds) {
  std::string names;
  for_each_law([&]<class L>(const L& law) {
    if (holds(law)) names.append(names.empty() ? "\"" : ", \"").append(L::name).append("\"");
  });
  return names;
}

/// Linear solids take Hooke's law, membranes what is incompressible and a function of the invariants,
/// correspondence all.
void check_law(const Case& in, const MaterialInput& material) {
  if (in.model.kind == "correspondence") return;
  const bool springs = in.model.kind == "pmb" || in.model.kind == "lps";
  const auto fits = [springs]<class L>(const L&) {
    return springs ? std::is_same_v<L, LinearElastic> : OfInvariants<L>;
  };
  for_each_law([&]<class L>(const L& law) {
    if (material.law != L::name || fits(law)) return;
    throw InputError(material.at,
                     fmt::format("material.{}.law: the model \"{}\" has no law \"{}\"; expected {}",
                                 material.name, in.model.kind, material.law, laws_that(fits)));
  });
  if (material.bulk_modulus)
    throw InputError(material.at,
                     fmt::format("material.{}.bulk_modulus: the model \"{}\" keeps its volume; expected no "
                                 "bulk_modulus",
                                 material.name, in.model.kind));
}

void check_membrane(const Case& in) {
  if (in.materials.size() > 1)
    throw InputError(in.materials[1].at, fmt::format("the model \"{}\" has one material; expected kind = "
                                                     "\"pmb\", \"lps\" or \"correspondence\"",
                                                     in.model.kind));
}

}  // namespace

std::unique_ptr<PointModel> make_model(const Case& in, Body body) {
  for (const MaterialInput& material : in.materials) check_law(in, material);
  const bool membrane = in.model.kind == "membrane" || in.model.kind == "membrane-bond";
  if (membrane)
    check_membrane(in);
  else
    refuse_inclusions(in);
  try {
    if (in.model.kind == "pmb") return make_pmb(in, std::move(body));
    if (in.model.kind == "lps") return make_lps(in, std::move(body));
    if (in.model.kind == "correspondence") return make_correspondence(in, std::move(body));
    const Material material = make_material(in.materials.front());
    if (in.model.kind == "membrane-bond")
      return with_limits(in,
                         std::make_unique<BondMembrane>(std::move(body), material, bond_settings(in.model)));
    return with_limits(in,
                       std::make_unique<Membrane>(std::move(body), material, in.model.stabilisation.value()));
  } catch (const InputError& error) {
    const std::string what = error.what();
    if (what.starts_with(in.file.string())) throw;
    throw InputError(in.model.at, "model: " + what);
  }
}

void mark_points(const Case& in, const std::vector<PointSet>& sets, Body& body) {
  std::vector<std::uint8_t> taken;
  for (std::size_t m = 0; m < in.materials.size(); ++m)
    for (const Named& on : in.materials[m].on) {
      const std::vector<std::size_t>& points = find_set(sets, on.text).points;
      for (const std::size_t number : points)
        if (!taken.empty() && taken[body.points[number]] != 0)
          throw InputError(on.at, fmt::format("material.{}: points of \"{}\" have another material already; "
                                              "expected sets without common points",
                                              in.materials[m].name, on.text));
      body.mark(taken, points, 1);
      body.mark(body.material, points, static_cast<std::uint8_t>(m));
    }
  // All others have the one material without a set.
  const auto rest = std::find_if(in.materials.begin(), in.materials.end(),
                                 [](const MaterialInput& material) { return material.on.empty(); });
  const auto number = static_cast<std::uint8_t>(rest - in.materials.begin());
  for (std::size_t i = 0; i < body.material.size(); ++i)
    if (taken[i] == 0) body.material[i] = number;
  for (const Named& on : in.failure.not_in) body.mark(body.unbreakable, find_set(sets, on.text).points, 1);
}

}  // namespace riven
