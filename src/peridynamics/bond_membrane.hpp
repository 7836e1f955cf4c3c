#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "material/material.hpp"
#include "peridynamics/bond_membrane_kernels.hpp"
#include "peridynamics/breaking_model.hpp"

namespace riven {

struct BondMembraneSettings {
  Loading loading = Loading::equibiaxial;
  bool zero_residual = false;      // the corrected constants instead of the published ones
  bool surface_correction = true;  // theory, section 2: factors from a homogeneous state
};

/// Bond-based neo-Hookean membrane of Bang (2016), as published: kept for comparison, `Membrane` is the model
/// to use. Its force is not the gradient of its energy where bonds turn, the planar and uniaxial laws of the
/// published variant are not free of stress at rest, and a law holds for one loading only.
///
/// Ghost points are the source's fictitious layers: they pull at the body with whole bonds, and nothing of
/// that returns to the points that they mirror. The force on a ghost is half of what it exerts, so that a
/// reaction is the section force.
class BondMembrane final : public BreakingModel {
 public:
  /// Throws InputError unless the body is two-dimensional and the material neo-Hookean.
  BondMembrane(Body body, Material material, const BondMembraneSettings& settings);

  [[nodiscard]] std::optional<Breakdown> internal_force(std::span<const double> u,
                                                        std::span<double> force) override;
  [[nodiscard]] double strain_energy(std::span<const double> u) override;
  [[nodiscard]] bool conservative() const override { return false; }
  void stiffness_bound(std::span<const double> u, std::span<double> bound) override;
  [[nodiscard]] std::optional<Breakdown> inspect(std::span<const double> u) override;
  [[nodiscard]] std::vector<ModelField> fields(std::span<const double> u) override;
  [[nodiscard]] std::vector<std::string> describe() const override;
  [[nodiscard]] std::size_t bytes() const override;
  [[nodiscard]] double family_energy(std::size_t point, std::span<const double> u) const override;

  [[nodiscard]] const BondLaw& law() const { return law_; }
  /// Surface correction factors of a body point along x and y.
  [[nodiscard]] Eigen::Vector2d correction(std::size_t point) const;
  /// Nominal stress of a body point (Pa): half the sum of f times xi over its bonds.
  [[nodiscard]] Eigen::Matrix2d nominal_stress(std::size_t point, std::span<const double> u) const;

 private:
  struct Bond {
    Eigen::Vector2d reference;         // m, shortened to the surface of an inclusion
    double length = 0;                 // m, of the whole bond: its influence is not shortened
    double far_volume = 0;             // m^3
    Eigen::Vector2d correction{1, 1};  // of the far end
    End end = 0;
  };
  /// Calls visit(bond) for the bonds of a body point, those to inclusions last.
  template <class Visit>
  void for_each_bond(std::size_t point, const Visit& visit) const;
  [[nodiscard]] Bond bond_between(std::size_t point, std::size_t neighbour) const;
  [[nodiscard]] Bond bond_to_inclusion(const InterfaceBond& at) const;
  [[nodiscard]] Eigen::Vector2d deformed(std::size_t point, const Bond& bond,
                                         std::span<const double> u) const;
  /// Correction factor of a bond: an ellipse through the means of both ends, eq. (43) of the source.
  [[nodiscard]] double bond_correction(std::size_t point, const Bond& bond) const;
  /// Force density on the point over the deformed bond: f V_far = this times Y (N/m^4).
  [[nodiscard]] double pull(std::size_t point, const Bond& bond, const Eigen::Vector2d& y) const;
  [[nodiscard]] double energy_density(std::size_t point, std::span<const double> u) const;
  void refit(std::span<const std::size_t> points) override;
  [[nodiscard]] double equal_stretch_energy(double stretch, std::size_t a, std::size_t b) const override;
  [[nodiscard]] double share_left(const WholeFamily& family, const std::vector<bool>& exists,
                                  std::size_t material) const override;
  void make_lattice_kernel(const LatticeBonds& on);
  void find_corrections();
  void gather_point(std::size_t point, std::span<const double> u, std::span<double> force) const;
  void pull_inclusions(std::span<const double> u, std::span<double> force) const;

  Material material_;
  BondMembraneSettings settings_;
  BondLaw law_;
  double c0_ = 0;               // N/m^5
  std::vector<double> volume_;  // m^3, of ghosts that of the point they mirror
  std::vector<double> share_;   // of a bond's force that the point's entry gets: 1, ghosts 1/2
  std::array<std::vector<double>, 2> correction_;
  BondMembraneKernel kernel_;
  BondMembraneLattice lattice_;  // unused for listed bodies
};

}  // namespace riven
