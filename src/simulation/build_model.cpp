#include <fmt/format.h>

#include <cmath>

#include "peridynamics/bond_membrane.hpp"
#include "peridynamics/lps.hpp"
#include "peridynamics/membrane.hpp"
#include "peridynamics/pmb.hpp"
#include "simulation/build_parts.hpp"

namespace riven {

namespace {

InvariantLaw make_law(const MaterialInput& in) {
  if (in.law == "neo-hookean") {
    if (in.youngs_modulus) return NeoHookean{*in.youngs_modulus / 6};  // E = 3 mu, mu = 2 C10
    if (in.shear_modulus) return NeoHookean{*in.shear_modulus / 2};
    return NeoHookean{*in.c10};
  }
  if (in.law == "mooney-rivlin") return MooneyRivlin{*in.c10, *in.c01};
  return Yeoh{*in.c10, in.c20.value_or(0), in.c30.value_or(0)};
}

Material make_material(const MaterialInput& in) {
  Material material{in.name, make_law(in), in.density};
  if (!(shear_modulus(material.law) > 0))
    throw InputError(
        in.at, fmt::format("material.{}: the shear modulus is {:g} Pa; expected a law with a positive one",
                           in.name, shear_modulus(material.law)));
  return material;
}

BondMembraneSettings bond_settings(const ModelInput& in) {
  Loading loading = Loading::equibiaxial;
  if (in.loading == "planar") loading = Loading::planar;
  if (in.loading == "uniaxial") loading = Loading::uniaxial;
  if (in.loading == "uniaxial-compression") loading = Loading::uniaxial_compression;
  return {loading, in.variant == "zero-residual", in.surface_correction == "on"};
}

PmbSettings pmb_settings(const Case& in) {
  const MaterialInput& material = in.materials.front();
  if (material.critical_stretch && in.solver.method != "verlet")
    throw InputError(
        material.at,
        fmt::format("material.{}.critical_stretch: bonds break in motion only; expected method = "
                    "\"verlet\" in [solver], or no critical_stretch",
                    material.name));
  PmbSettings settings{.youngs_modulus = *material.youngs_modulus, .density = material.density};
  if (material.critical_stretch) settings.critical_stretch = *material.critical_stretch;
  settings.plane = in.model.plane == "strain" ? Plane::strain : Plane::stress;
  return settings;
}

/// Poisson's ratio is the model's; one that the user gave must be it.
void check_poissons_ratio(const MaterialInput& in, const Pmb& model) {
  constexpr double kRounded = 0.005;  // 0.33 for 1/3
  if (model.body().dimension == 1 || !in.poissons_ratio) return;
  if (std::abs(*in.poissons_ratio - model.poissons_ratio()) <= kRounded) return;
  throw InputError(in.at,
                   fmt::format("material.{}.poissons_ratio: found {:g}; the model \"pmb\" has {:.4g} here "
                               "(1/3 in plane stress, 1/4 otherwise)",
                               in.name, *in.poissons_ratio, model.poissons_ratio()));
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
  const auto fail = [&](const char* key, const std::string& what) {
    throw InputError(material.at, fmt::format("material.{}.{}: {}", material.name, key, what));
  };
  if (!material.poissons_ratio)
    fail("poissons_ratio", "missing; expected a number above -1 and below 0.5 for the model \"lps\"");
  if (!(*material.poissons_ratio > -1 && *material.poissons_ratio < 0.5))
    fail("poissons_ratio",
         fmt::format("found {:g}; expected a number above -1 and below 0.5", *material.poissons_ratio));
  if (material.critical_stretch)
    fail("critical_stretch", "bonds of the model \"lps\" do not break yet; expected none, or kind = \"pmb\"");
  return {.youngs_modulus = *material.youngs_modulus,
          .poissons_ratio = *material.poissons_ratio,
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

/// Linear solids take the one law, membranes the others.
void check_law(const Case& in) {
  const MaterialInput& material = in.materials.front();
  const bool springs = in.model.kind == "pmb" || in.model.kind == "lps",
             elastic = material.law == "linear-elastic";
  if (springs != elastic)
    throw InputError(material.at,
                     fmt::format("material.{}.law: the model \"{}\" has no law \"{}\"; expected {}",
                                 material.name, in.model.kind, material.law,
                                 springs ? "\"linear-elastic\"" : "neo-hookean, mooney-rivlin or yeoh"));
}

}  // namespace

std::unique_ptr<PointModel> make_model(const Case& in, Body body) {
  check_law(in);
  if (in.model.kind == "pmb") return make_pmb(in, std::move(body));
  if (in.model.kind == "lps") return make_lps(in, std::move(body));
  const Material material = make_material(in.materials.front());
  try {
    if (in.model.kind == "membrane-bond")
      return std::make_unique<BondMembrane>(std::move(body), material, bond_settings(in.model));
    return std::make_unique<Membrane>(std::move(body), material, in.model.stabilisation);
  } catch (const InputError& error) {
    throw InputError(in.model.at, std::string("model: ") + error.what());
  }
}

}  // namespace riven
