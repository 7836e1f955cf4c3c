#pragma once

#include <Eigen/Core>
#include <vector>

#include "material/plane.hpp"
#include "peridynamics/breaking_model.hpp"
#include "peridynamics/influence.hpp"
#include "peridynamics/lps_kernels.hpp"

namespace riven {

struct LpsSettings {
  double youngs_modulus = 0;    // Pa
  double poissons_ratio = 0;    // above -1, below 1/2
  double density = 0;           // kg/m^3
  Plane plane = Plane::stress;  // in two dimensions
  Influence influence = Influence::inverse;
};

/// Linear peridynamic solid (Silling et al. 2007; in the plane Le, Chan and Schwartz 2014): the energy of a
/// point is that of its dilatation theta and of the deviatoric extensions e - theta L / D of its bonds,
///
///   W = (kappa theta^2 + beta c sum(omega e^2 V)) / 2,  theta = c sum(omega L e V),  e = |Y| - L,
///   c = D / sum(omega L^2 V),  beta = mu (D + 2),  kappa = K - beta / D,
///
/// in D dimensions with their bulk modulus K. The force is the gradient of the sum of W V over the body's
/// points; ghosts have no energy. A uniform dilation has exact energy in every family, cut ones too. So that
/// any small strain has Hooke's stress in the complete families of a lattice, the influence omega has a
/// factor 1 + a h, with the harmonic of fourth order h of the bond's direction that a lattice has. Bonds that
/// break take their part of theta and of the extensions with them: c stays that of the undamaged family.
class Lps final : public BreakingModel {
 public:
  /// `settings` of each of the body's materials, in the same plane and with the same influence. Throws
  /// InputError for a body with inclusions or in one dimension, for a Poisson's ratio out of range,
  /// and where the horizon reaches too few directions for an isotropic solid.
  Lps(Body body, std::vector<LpsSettings> settings);
  Lps(Body body, const LpsSettings& settings) : Lps(std::move(body), std::vector{settings}) {}

  [[nodiscard]] std::optional<Breakdown> internal_force(std::span<const double> u,
                                                        std::span<double> force) override;
  [[nodiscard]] double strain_energy(std::span<const double> u) override;
  [[nodiscard]] bool conservative() const override { return true; }
  void stiffness_bound(std::span<const double> u, std::span<double> bound) override;
  /// A part is the family of a body point.
  [[nodiscard]] std::size_t tangent_parts() const override { return body().points.size(); }
  void tangent(std::span<const double> u, std::size_t first, std::size_t last,
               TangentBlocks& to) const override;
  [[nodiscard]] std::optional<Breakdown> inspect(std::span<const double> u) override;
  [[nodiscard]] std::vector<ModelField> fields(std::span<const double> u) override;
  [[nodiscard]] std::vector<std::string> describe() const override;
  [[nodiscard]] std::size_t bytes() const override;

  [[nodiscard]] double family_energy(std::size_t point, std::span<const double> u) const override;

  /// The factor a.
  [[nodiscard]] double anisotropy() const { return anisotropy_; }

 private:
  struct Bond {
    std::size_t end = 0;
    Eigen::Vector3d xi;  // m
    double length = 0;   // m
    double weight = 0;   // omega V of its end (m^3)
  };
  /// A bond in a state.
  struct Pull {
    Bond bond;
    Eigen::Vector3d direction;  // of Y
    double r = 0;               // |Y| (m)
    double extension = 0;       // m
  };
  /// Calls visit(Bond) for the bonds of a stored point.
  template <class Visit>
  void for_each_bond(std::size_t point, const Visit& visit) const;
  /// Calls visit(Pull).
  template <class Visit>
  void for_each_pull(std::size_t point, std::span<const double> u, const Visit& visit) const;

  void refit(std::span<const std::size_t> points) override;
  [[nodiscard]] double equal_stretch_energy(double stretch, std::size_t a, std::size_t b) const override;
  [[nodiscard]] double share_left(const WholeFamily& family, const std::vector<bool>& exists,
                                  std::size_t material) const override;
  void find_constants();
  [[nodiscard]] double omega(const Eigen::Vector3d& xi) const;
  void find_anisotropy();
  void make_stencil(const LatticeBonds& on);
  void make_list(const ListedBonds& list);
  void find_moments();
  void sort_blocks(const LatticeBonds& on);
  void look_at(std::span<const double> u, std::span<double> out);
  template <class Bonds>
  void sweep(Bonds& bonds, void (*first)(Bonds&, std::size_t, std::size_t),
             void (*second)(const Bonds&, std::size_t, std::size_t));

  [[nodiscard]] double dilatation(std::size_t point, std::span<const double> u) const;
  /// Force state of a point's family along a bond, over omega (N/m^6).
  [[nodiscard]] double tension(std::size_t point, double dilatation, const Pull& pull) const {
    return inverse_moment_[point] * kappa_[point] * dilatation * pull.bond.length +
           straight_[point] * pull.extension;
  }

  std::vector<LpsSettings> settings_;
  LpsKernels kernels_;
  double anisotropy_ = 0;
  std::vector<double> volume_;          // of stored points, for ghosts that of their master (m^3)
  std::vector<double> inverse_moment_;  // c of the body points with bonds, else 0 (1/m^5)
  std::vector<double> kappa_;           // of stored points (Pa)
  std::vector<double> straight_;        // c beta (Pa/m^5)
  std::vector<double> tension_;         // of one state, see LpsLattice
  LpsLattice lattice_;                  // one of both is in use
  LpsList list_;
};

template <class Visit>
void Lps::for_each_bond(std::size_t point, const Visit& visit) const {
  if (const LatticeBonds* on = body().on_lattice()) {
    for (std::size_t k = 0; k < lattice_.stencil.size(); ++k) {
      if (!on->bonds.exists(k, point)) continue;
      const LpsBond& bond = lattice_.stencil[k];
      const std::size_t end = BondPlanes::neighbour(on->stencil, k, point);
      visit(Bond{end, Eigen::Vector3d(bond.xi.data()), bond.length, bond.weight * volume_[end]});
    }
    return;
  }
  const auto& list = std::get<ListedBonds>(body().bonds);
  const Eigen::Vector3d x(list.position[point].data());
  for (std::size_t b = list.begin[point]; b < list.begin[point + 1]; ++b) {
    if (!list.exists(point, b)) continue;
    const std::size_t end = list.neighbour[b];
    visit(Bond{end, Eigen::Vector3d(list.position[end].data()) - x, list_.length[b], list_.weight[b]});
  }
}

template <class Visit>
void Lps::for_each_pull(std::size_t point, std::span<const double> u, const Visit& visit) const {
  for_each_bond(point, [&](const Bond& bond) {
    Eigen::Vector3d eta = Eigen::Vector3d::Zero();
    for (int d = 0; d < body().dimension; ++d) {
      const std::size_t plane = static_cast<std::size_t>(d) * body().size();
      eta[d] = u[plane + bond.end] - u[plane + point];
    }
    const Eigen::Vector3d y = bond.xi + eta;
    const double r = y.norm();
    // Without cancellation for small strains: r^2 - L^2 = eta (xi + Y).
    visit(Pull{bond, y / r, r, eta.dot(bond.xi + y) / (r + bond.length)});
  });
}

}  // namespace riven
