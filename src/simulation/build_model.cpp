#include <fmt/format.h>

#include <cmath>

#include "input/material_format.hpp"
#include "peridynamics/bond_membrane.hpp"
#include "peridynamics/correspondence.hpp"
#include "peridynamics/lps.hpp"
#include "peridynamics/membrane.hpp"
#include "peridynamics/pmb.hpp"
#include "simulation/build_parts.hpp"

namespace riven {

namespace {

BondMembraneSettings bond_settings(const ModelInput& in) {
  Loading loading = Loading::equibiaxial;
  if (in.loading == "planar") loading = Loading::planar;
  if (in.loading == "uniaxial") loading = Loading::uniaxial;
  if (in.loading == "uniaxial-compression") loading = Loading::uniaxial_compression;
  return {loading, in.variant == "zero-residual", in.surface_correction == "on"};
}

PmbSettings pmb_settings(const Case& in) {
  const MaterialInput& material = in.materials.front();
  PmbSettings settings{.youngs_modulus = material.number("youngs_modulus").value(),
                       .density = material.density};
  if (material.critical_stretch) settings.critical_stretch = *material.critical_stretch;
  settings.plane = in.model.plane == "strain" ? Plane::strain : Plane::stress;
  return settings;
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
  if (!in.inclusions.empty())
    throw InputError(in.inclusions.front().at,
                     "inclusion: the model \"pmb\" has no rigid inclusions; expected holes and cracks only");
  auto model = std::make_unique<Pmb>(std::move(body), pmb_settings(in));
  check_poissons_ratio(in.materials.front(), *model);
  return model;
}

LpsSettings lps_settings(const Case& in) {
  const MaterialInput& material = in.materials.front();
  if (material.critical_stretch)
    throw InputError(material.at,
                     fmt::format("material.{}.critical_stretch: bonds of the model \"lps\" do not break yet; "
                                 "expected none, or kind = \"pmb\"",
                                 material.name));
  return {.youngs_modulus = material.number("youngs_modulus").value(),
          .poissons_ratio = material.number("poissons_ratio").value(),
          .density = material.density,
          .plane = in.model.plane == "strain" ? Plane::strain : Plane::stress,
          .influence = in.model.influence == "constant" ? Influence::constant : Influence::inverse};
}

std::unique_ptr<PointModel> make_lps(const Case& in, Body body) {
  if (!in.inclusions.empty())
    throw InputError(in.inclusions.front().at,
                     "inclusion: the model \"lps\" has no rigid inclusions; expected holes and cracks only");
  const LpsSettings settings = lps_settings(in);
  try {
    return std::make_unique<Lps>(std::move(body), settings);
  } catch (const InputError& error) {
    throw InputError(in.model.at, std::string("model: ") + error.what());
  }
}

CorrespondenceSettings correspondence_settings(const Case& in) {
  CorrespondenceSettings settings{
      .material = make_material(in.materials.front()),
      .plane = in.model.plane == "strain" ? Plane::strain : Plane::stress,
      .influence = in.model.influence == "constant" ? Influence::constant : Influence::inverse,
      .factor = in.model.stabilisation.value_or(0)};
  if (in.model.variant == "published") settings.stabilisation = Stabilisation::published;
  if (in.model.variant == "bond-associated") settings.stabilisation = Stabilisation::bond_associated;
  return settings;
}

std::unique_ptr<PointModel> make_correspondence(const Case& in, Body body) {
  if (!in.inclusions.empty())
    throw InputError(
        in.inclusions.front().at,
        "inclusion: the model \"correspondence\" has no rigid inclusions; expected holes and cracks only");
  const MaterialInput& material = in.materials.front();
  if (material.critical_stretch)
    throw InputError(material.at, fmt::format("material.{}.critical_stretch: bonds of the model "
                                              "\"correspondence\" do not break yet; expected none, or kind = "
                                              "\"pmb\"",
                                              material.name));
  try {
    return std::make_unique<Correspondence>(std::move(body), correspondence_settings(in));
  } catch (const InputError& error) {
    throw InputError(in.model.at, std::string("model: ") + error.what());
  }
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
void check_law(const Case& in) {
  if (in.model.kind == "correspondence") return;
  const MaterialInput& material = in.materials.front();
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

}  // namespace

std::unique_ptr<PointModel> make_model(const Case& in, Body body) {
  check_law(in);
  if (in.model.kind == "pmb") return make_pmb(in, std::move(body));
  if (in.model.kind == "lps") return make_lps(in, std::move(body));
  if (in.model.kind == "correspondence") return make_correspondence(in, std::move(body));
  const Material material = make_material(in.materials.front());
  try {
    if (in.model.kind == "membrane-bond")
      return std::make_unique<BondMembrane>(std::move(body), material, bond_settings(in.model));
    return std::make_unique<Membrane>(std::move(body), material, in.model.stabilisation.value());
  } catch (const InputError& error) {
    throw InputError(in.model.at, std::string("model: ") + error.what());
  }
}

}  // namespace riven
