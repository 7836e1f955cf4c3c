#pragma once

#include <Eigen/Core>
#include <vector>

#include "material/plane.hpp"
#include "peridynamics/breaking_model.hpp"
#include "peridynamics/pmb_kernels.hpp"

namespace riven {

struct PmbSettings {
  double youngs_modulus = 0;    // Pa
  double density = 0;           // kg/m^3
  Plane plane = Plane::stress;  // in two dimensions
};

/// Prototype microelastic brittle material (Silling and Askari 2005): bonds are linear springs,
/// f = c s e with the stretch s = (r - L) / L, that break for good beyond a critical stretch. Poisson's ratio
/// is 1/4 in three dimensions and in plane strain, 1/3 in plane stress. A bond between two materials has the
/// harmonic mean of their c, as two halves in a row.
///
/// The micromodulus c gives a complete family the continuum's energy under equal strain in all directions, as
/// the family is: summed over its bonds, so that small horizons need no correction. Ghost points count with
/// half their volume, and what pulls at them goes on to the points that they mirror: the force is the
/// gradient of the body's energy.
class Pmb final : public BreakingModel {
 public:
  /// `settings` of each of the body's materials, in the same plane. Throws InputError for a body with
  /// inclusions.
  Pmb(Body body, std::vector<PmbSettings> settings);
  Pmb(Body body, const PmbSettings& settings) : Pmb(std::move(body), std::vector{settings}) {}

  [[nodiscard]] std::optional<Breakdown> internal_force(std::span<const double> u,
                                                        std::span<double> force) override;
  [[nodiscard]] Passage advance(std::span<const double> u, std::span<double> force) override;
  [[nodiscard]] double strain_energy(std::span<const double> u) override;
  [[nodiscard]] bool conservative() const override { return true; }
  void stiffness_bound(std::span<const double> u, std::span<double> bound) override;
  /// A part is the bonds of a stored point to those that are stored behind it, a block each.
  [[nodiscard]] std::size_t tangent_parts() const override { return body().size(); }
  void tangent(std::span<const double> u, std::size_t first, std::size_t last,
               TangentBlocks& to) const override;
  [[nodiscard]] std::optional<Breakdown> inspect(std::span<const double> u) override;
  [[nodiscard]] std::vector<ModelField> fields(std::span<const double> u) override;
  [[nodiscard]] std::vector<std::string> describe() const override;
  [[nodiscard]] std::size_t bytes() const override;

  [[nodiscard]] double family_energy(std::size_t point, std::span<const double> u) const override;

  /// c of a material (N/m^6): force density is c s V of the other end.
  [[nodiscard]] double micromodulus(std::size_t material = 0) const { return micromodulus_[material]; }
  [[nodiscard]] double poissons_ratio() const;

  /// The forces again, bond by bond in plain loops: what the kernels must agree with.
  void plain_force(std::span<const double> u, std::span<double> force) const;

 private:
  struct Pull {
    std::size_t neighbour = 0;
    Eigen::Vector3d reference, deformed;  // bond vectors (m)
    double micromodulus = 0;
    double energy = 0;      // c s^2 L / 2 (N/m^5)
    double per_length = 0;  // f = per_length * deformed (N/m^7)
  };
  template <class Visit>
  void for_each_pull(std::size_t point, std::span<const double> u, const Visit& visit) const;
  [[nodiscard]] double full_volume(std::size_t point) const;
  [[nodiscard]] double family_moment() const;
  void refit(std::span<const std::size_t> points) override;
  void limits_set() override;
  [[nodiscard]] double equal_stretch_energy(double stretch, std::size_t a, std::size_t b) const override;
  [[nodiscard]] double share_left(const WholeFamily& family, const std::vector<bool>& exists,
                                  std::size_t material) const override;
  [[nodiscard]] double micromodulus_between(std::size_t point, std::size_t end) const;
  [[nodiscard]] std::vector<double> half_compliances() const;
  void make_lattice_kernel(const LatticeBonds& on);
  void make_list_kernel(const ListedBonds& list);
  void look_at(std::span<const double> u, std::span<double> out);
  void pull(std::size_t begin, std::size_t end);

  std::vector<PmbSettings> settings_;
  PmbKernels kernels_;
  std::vector<double> micromodulus_;     // of each material
  std::vector<double> half_compliance_;  // 1 / (2 c) of stored points, if there are several materials
  std::vector<double> weight_;           // volume, half of it for ghosts (m^3)
  PmbLattice lattice_;                   // one of both is in use
  PmbList list_;
};

}  // namespace riven
