#pragma once

#include <concepts>
#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>

#include "material/arruda_boyce.hpp"
#include "material/compressible_neo_hookean.hpp"
#include "material/gent.hpp"
#include "material/linear_elastic.hpp"
#include "material/mooney_rivlin.hpp"
#include "material/neo_hookean.hpp"
#include "material/ogden.hpp"
#include "material/polynomial.hpp"
#include "material/st_venant_kirchhoff.hpp"
#include "material/yeoh.hpp"

namespace riven {

/// All laws. A new one is a header with the struct, and one more name here.
using Law = std::variant<NeoHookean, MooneyRivlin, Polynomial, Yeoh, ArrudaBoyce, Gent, Ogden, LinearElastic,
                         StVenantKirchhoff, CompressibleNeoHookean>;

/// A law is one of three kinds, by what it can be called with.
/// The strain energy density W(I1, I2) of an incompressible material, or of the isochoric part of one.
template <class L>
concept OfInvariants = requires(const L& law) {
  { law(3.0, 3.0) } -> std::same_as<InvariantEnergy>;
};
/// The same as a sum over the principal stretches.
template <class L>
concept OfStretches = requires(const L& law) {
  { law(1.0) } -> std::same_as<StretchEnergy>;
};
/// Energy, stress and (unless null) tangent of any deformation gradient, shape and volume together.
template <class L>
concept OfGradient = requires(const L& law, const Eigen::Matrix3d& f, Eigen::Matrix3d& stress,
                              Response::Tangent* tangent) {
  { law(f, stress, tangent) } -> std::same_as<double>;
};

/// Calls visit(law) with an empty law of each type.
template <class Visit>
void for_each_law(const Visit& visit) {
  [&]<std::size_t... n>(std::index_sequence<n...>) {
    (visit(std::variant_alternative_t<n, Law>{}), ...);
  }
  (std::make_index_sequence<std::variant_size_v<Law>>());
}

namespace detail {
template <class... L>
struct InvariantLaws;
template <class... L>
struct InvariantLaws<std::variant<L...>> {
  template <class One>
  using Kept = std::conditional_t<OfInvariants<One>, std::tuple<One>, std::tuple<>>;
  template <class... Left>
  static std::variant<Left...> as_variant(std::tuple<Left...>);
  using type = decltype(as_variant(std::tuple_cat(std::declval<Kept<L>>()...)));
};
}  // namespace detail

/// The laws W(I1, I2) among them.
using InvariantLaw = detail::InvariantLaws<Law>::type;

/// The law as one of those, if it is one.
inline std::optional<InvariantLaw> invariant_law(const Law& law) {
  return std::visit(
      [](const auto& l) -> std::optional<InvariantLaw> {
        if constexpr (OfInvariants<std::decay_t<decltype(l)>>) {
          return l;
        } else {
          return std::nullopt;
        }
      },
      law);
}

}  // namespace riven
