#pragma once

#include <Eigen/Core>
#include <limits>

#include "base/snapshot.hpp"
#include "material/plane.hpp"
#include "peridynamics/pmb_kernels.hpp"
#include "peridynamics/point_model.hpp"

namespace riven {

struct PmbSettings {
  double youngs_modulus = 0;                                          // Pa
  double density = 0;                                                 // kg/m^3
  double critical_stretch = std::numeric_limits<double>::infinity();  // (r - L) / L at which a bond breaks
  Plane plane = Plane::stress;                                        // in two dimensions
};

/// Prototype microelastic brittle material (Silling and Askari 2005): bonds are linear springs,
/// f = c s e with the stretch s = (r - L) / L, that break for good beyond a critical stretch. Poisson's ratio
/// is 1/4 in three dimensions and in plane strain, 1/3 in plane stress.
///
/// The micromodulus c gives a complete family the continuum's energy under equal strain in all directions, as
/// the family is: summed over its bonds, so that small horizons need no correction. Ghost points count with
/// half their volume, and what pulls at them goes on to the points that they mirror: the force is the
/// gradient of the body's energy.
class Pmb final : public PointModel {
 public:
  /// Throws InputError for a body with inclusions.
  Pmb(Body body, const PmbSettings& settings);

  [[nodiscard]] std::optional<Breakdown> internal_force(std::span<const double> u,
                                                        std::span<double> force) override;
  [[nodiscard]] std::optional<Breakdown> advance(std::span<const double> u, std::span<double> force) override;
  [[nodiscard]] double dissipated_energy() const override { return dissipated_; }
  [[nodiscard]] double strain_energy(std::span<const double> u) override;
  [[nodiscard]] bool conservative() const override { return true; }
  void stiffness_bound(std::span<const double> u, std::span<double> bound) override;
  /// A part is the bonds of a stored point to those that are stored behind it, a block each.
  [[nodiscard]] std::size_t tangent_parts() const override { return body().size(); }
  void tangent(std::span<const double> u, std::size_t first, std::size_t last,
               TangentBlocks& to) const override;
  [[nodiscard]] std::optional<Breakdown> inspect(std::span<const double> u) override;
  [[nodiscard]] std::vector<ModelField> fields(std::span<const double> u) override;
  void save(Snapshot& to) const override;
  void restore(const Snapshot& from) override;
  [[nodiscard]] std::vector<std::string> describe() const override;
  [[nodiscard]] std::size_t bytes() const override;

  /// c (N/m^6): force density is c s V of the other end.
  [[nodiscard]] double micromodulus() const { return micromodulus_; }
  [[nodiscard]] double poissons_ratio() const;

  /// The forces again, bond by bond in plain loops: what the kernels must agree with.
  void plain_force(std::span<const double> u, std::span<double> force) const;

 private:
  struct Pull {
    std::size_t neighbour = 0;
    Eigen::Vector3d reference, deformed;  // bond vectors (m)
    double energy = 0;                    // c s^2 L / 2 (N/m^5)
    double per_length = 0;                // f = per_length * deformed (N/m^7)
  };
  template <class Visit>
  void for_each_pull(std::size_t point, std::span<const double> u, const Visit& visit) const;
  [[nodiscard]] double full_volume(std::size_t point) const;
  [[nodiscard]] double family_moment() const;
  template <class Self, class Each>
  static void each_member(Self& self, const Each& each) {
    each("pmb.masks", self.own_masks());
    each("pmb.dissipated", self.dissipated_);
  }
  /// The bits of the bonds: on a lattice or in a list.
  [[nodiscard]] const std::vector<std::uint8_t>& own_masks() const;
  [[nodiscard]] std::vector<std::uint8_t>& own_masks();
  void sort_blocks();
  void make_lattice_kernel(const LatticeBonds& on);
  void make_list_kernel(const ListedBonds& list);
  void look_at(std::span<const double> u, std::span<double> out);
  void evaluate(std::span<const double> u, std::span<double> force, bool breaks);

  PmbSettings settings_;
  PmbKernels kernels_;
  double micromodulus_ = 0;
  double dissipated_ = 0;
  std::vector<double> weight_;  // volume, half of it for ghosts (m^3)
  PmbLattice lattice_;          // one of both is in use
  PmbList list_;
};

}  // namespace riven
