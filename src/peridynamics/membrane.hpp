#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <vector>

#include "material/material.hpp"
#include "peridynamics/breaking_model.hpp"
#include "peridynamics/family_energy.hpp"
#include "peridynamics/membrane_kernels.hpp"
#include "peridynamics/weights.hpp"

namespace riven {

/// A bond as the membrane sees it: from a body point to another stored point or to a rigid inclusion.
struct MembraneBond {
  Eigen::Vector2d reference;  // bond vector (m), shortened to the surface for an inclusion
  double weight = 0;          // sum over the family is 1
  std::uint32_t end = 0;      // stored point, or body().size() plus the number of the interface bond
  int inclusion = -1;         // number of the inclusion, or -1
};

/// Ordinary state-based incompressible membrane for any isotropic W(I1, I2) and any loading: peridynamics
/// theory, section 5, with the boundary, defect and folding rules of 5a. The force on ghost points is the
/// gradient of the body's energy.
///
/// Where bonds break, the averages are those over the bonds left, and the family keeps the share of its
/// energy that their base weights have (section 5, broken bonds). A family whose area ratio falls towards
/// zero goes on with its deformation gradient, and one that is turned inside out then is debris without
/// energy. A family that cracks have cut at the start is a sound one with a free edge.
class Membrane final : public BreakingModel {
 public:
  /// `stabilisation`: factor G of the energy against short waves and folding (theory 5a, rule 5).
  /// Throws InputError unless the body is two-dimensional and the material incompressible, a law W(I1, I2).
  Membrane(Body body, Material material, double stabilisation);

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
  [[nodiscard]] std::string remedies() const override {
    return "a larger model.stabilisation or a finer lattice";
  }
  [[nodiscard]] std::vector<std::string> describe() const override;
  [[nodiscard]] std::size_t bytes() const override;
  [[nodiscard]] double family_energy(std::size_t point, std::span<const double> u) const override;

  [[nodiscard]] const Material& material() const { return material_; }
  /// First Piola-Kirchhoff stress of a body point (Pa) in the state of the last force or energy evaluation.
  [[nodiscard]] Eigen::Matrix2d nominal_stress(std::size_t point, std::span<const double> u) const;

  /// Calls visit(bond) for the family of a body point, whatever kind of point it is: the plain counterpart of
  /// the kernels.
  template <class Visit>
  void for_each_bond(std::size_t point, const Visit& visit) const;

  /// Points whose weights were found by least squares, and those that use the deformation gradient.
  [[nodiscard]] std::size_t points_by_least_squares() const;
  [[nodiscard]] std::size_t points_by_gradient() const;

 private:
  /// A point whose weights have no formula: repaired ones, bonds to inclusions, the deformation gradient as
  /// a fall-back.
  struct ListedFamily {
    Eigen::Matrix2d inverse_shape = Eigen::Matrix2d::Zero();  // (sum w n n^T)^-1, for by_gradient
    std::size_t point = 0;
    // Its bonds; none if all lie on one line, so that the point has no strain energy of its own.
    std::size_t begin = 0, end = 0;
    bool by_least_squares = false;
    bool by_gradient = false;
  };
  /// Bonds of the listed families, and in which of them each point is the far end.
  struct ListedFamilyBonds {
    std::vector<double> x, y;    // reference bond (m)
    std::vector<double> weight;  // sum over a family is 1
    std::vector<End> end;
    std::vector<double> force_x, force_y;  // on the family's point, for one state (N)
    std::vector<std::uint32_t> target;     // points with bonds that end on them, ascending
    std::vector<std::size_t> incoming_begin;
    std::vector<std::uint32_t> incoming;  // numbers of those bonds
    std::vector<std::uint32_t> surface;   // bonds that end on inclusions
  };

  /// Deformed bond from a body point (m).
  [[nodiscard]] Eigen::Vector2d deformed(std::size_t point, const MembraneBond& bond,
                                         std::span<const double> u) const;
  /// The part of a bond's force that belongs to one end: weight/|xi|^2 ((a + b s^2) Y + n xi) (N).
  static Eigen::Vector2d bond_force(const PointForce& law, const MembraneBond& bond,
                                    const Eigen::Vector2d& y);
  void look_at_bonds();
  void make_families();
  void fit(std::size_t point);
  void refit(std::span<const std::size_t> points) override;
  [[nodiscard]] std::vector<std::size_t> changed_by(std::vector<std::size_t> points) const override {
    return with_neighbours(points);
  }
  [[nodiscard]] bool stiffens() const override { return true; }
  void limits_set() override;
  [[nodiscard]] double crushed_energy(std::size_t point, std::span<const double> u) const override;
  [[nodiscard]] bool is_at_crack(std::size_t point) const;
  [[nodiscard]] std::vector<std::size_t> with_neighbours(std::span<const std::size_t> points) const;
  [[nodiscard]] double equal_stretch_energy(double stretch, std::size_t a, std::size_t b) const override;
  [[nodiscard]] double share_left(const WholeFamily& family, const std::vector<bool>& exists,
                                  std::size_t material) const override;
  /// Of a body point's energy, since bonds broke.
  [[nodiscard]] double energy_share(std::size_t point) const {
    return energy_volume_[point] / body().volume[point];
  }
  [[nodiscard]] bool is_sound(std::size_t point) const {
    return energy_share(point) == 1 && times_crushed(point) == 0;
  }
  void set_coefficients(std::size_t point, const Moments& coefficients);
  [[nodiscard]] Moments coefficients(std::size_t point) const;
  void find_intact_blocks(const Moments& whole);
  void add_listed_family(std::size_t point, const FamilyWeights& weights, const Eigen::Matrix2d& shape,
                         std::vector<MembraneBond> bonds);
  void keep_listed_family(ListedFamily family, const ListedFamilyBonds& bonds);
  void sort_incoming();
  [[nodiscard]] std::vector<MembraneBond> bonds_of(std::size_t point) const;
  [[nodiscard]] std::vector<PlaneBond> unshortened_bonds_of(std::size_t point) const;
  [[nodiscard]] MembraneBond listed_bond(std::size_t number) const;
  [[nodiscard]] double stabilisation_modulus(std::size_t point) const;

  void update_points(std::span<const double> u);
  /// Averages over a family: <s^2>, <s^4> and <Y xi^T / |xi|^2>.
  struct FamilyAverages {
    double a = 0, b = 0;
    Eigen::Matrix2d m = Eigen::Matrix2d::Zero();
  };
  struct FamilyResponse {
    double energy = 0;  // J/m^3
    PointForce force;
    Eigen::Matrix2d f;  // deformation gradient
  };
  [[nodiscard]] FamilyEnergy energy_by_averages(double a, double b) const {
    return std::visit([&](const auto& law) { return riven::family_energy(law, a, b); }, law_);
  }
  [[nodiscard]] FamilyAverages averages(std::size_t point, std::span<const double> u) const;
  [[nodiscard]] FamilyResponse respond(std::size_t point, const FamilyAverages& of) const;
  [[nodiscard]] FamilyResponse respond(const ListedFamily& by_gradient, const FamilyAverages& of) const;
  void respond_listed(const ListedFamily& family, std::span<const double> u);
  void rest(std::size_t point);
  void find_crushed();
  void set_point(std::size_t point, double energy, const PointForce& force);
  [[nodiscard]] PointForce point_force(std::size_t point) const {
    return body().on_lattice() != nullptr ? lattice_.law(point) : list_.law(point);
  }
  void pull_listed(const ListedFamily& family, std::span<const double> u, std::span<double> force);
  void push_far_ends(std::span<double> force) const;
  [[nodiscard]] std::optional<Breakdown> first_collapsed() const;
  [[nodiscard]] Eigen::Matrix2d gradient(std::size_t point) const;
  /// The family of a point without formula, or null.
  [[nodiscard]] const ListedFamily* listed_family(std::size_t point) const;
  [[nodiscard]] bool by_gradient(std::size_t point) const;
  [[nodiscard]] std::array<double, 3> family_curvature(std::size_t point) const;
  /// Second derivatives of a point's energy (J) by the sums a, b and M = <Y xi^T / |xi|^2>, row by row.
  using SumHessian = Eigen::Matrix<double, 6, 6>;
  [[nodiscard]] SumHessian sum_hessian(std::size_t point) const;
  [[nodiscard]] SumHessian sum_hessian(const ListedFamily& by_gradient) const;

  Material material_;
  InvariantLaw law_;  // the material's
  double stabilisation_ = 0;
  std::vector<ListedFamily> listed_;  // in order of their points
  ListedFamilyBonds listed_bonds_;

  MembraneKernels kernels_;
  MembranePlanes planes_;
  MembraneLattice lattice_;  // one of both is in use
  MembraneList list_;
  std::vector<double> smallest_weight_;  // of the family over its base weight, before any repair
  std::vector<double> base_weight_;      // of the family at the start (1/m)
  std::vector<double> base_trace_;       // trace of its inverse shape tensor by its base weights
  std::vector<double> energy_volume_;    // volume times the share of the energy left (m^3)
  FamilyWeights whole_;                  // of a whole stencil, once one was met
  double most_energy_density_ = 0;       // of a family all of whose bonds have the limit of stretch (J/m^3)
  std::size_t collapsed_ = 0;            // families with a formula, in the present state
};

template <class Visit>
void Membrane::for_each_bond(std::size_t point, const Visit& visit) const {
  if (const ListedFamily* family = listed_family(point)) {
    for (std::size_t b = family->begin; b < family->end; ++b) visit(listed_bond(b));
    return;
  }
  const Moments c = coefficients(point);
  const auto visit_bond = [&](double x, double y, std::size_t end) {
    const Moments terms = WeightFormula::terms(angular_functions({x, y}));
    double weight = 0;
    for (std::size_t m = 0; m < kMoments; ++m) weight += c[m] * terms[m];
    visit(MembraneBond{{x, y}, weight / std::sqrt(x * x + y * y), static_cast<End>(end), -1});
  };
  if (const LatticeBonds* on = body().on_lattice()) {
    for (std::size_t k = 0; k < lattice_.stencil.size(); ++k)
      if (on->bonds.exists(k, point))
        visit_bond(lattice_.stencil[k].x, lattice_.stencil[k].y,
                   BondPlanes::neighbour(on->stencil, k, point));
    return;
  }
  const Point from = body().position(point);
  body().for_each_neighbour(point, [&](std::size_t j) {
    const Point to = body().position(j);
    visit_bond(to[0] - from[0], to[1] - from[1], j);
  });
}

}  // namespace riven
