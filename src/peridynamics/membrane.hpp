#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "material/material.hpp"
#include "peridynamics/point_model.hpp"
#include "peridynamics/weights.hpp"

namespace riven {

/// A bond as the membrane sees it: from a body point to another stored point or to a rigid inclusion.
struct MembraneBond {
  Eigen::Vector2d reference;  // bond vector (m), shortened to the surface for an inclusion
  double weight = 0;          // sum over the family is 1
  std::uint32_t end = 0;      // stored point, or body().size() plus the number of the interface bond
  int inclusion = -1;         // number of the inclusion, or -1
};

/// Force law of a point, times its volume: bond j carries weight/|xi|^2 ((a + b s^2) Y + n xi), where xi and
/// Y are the undeformed and deformed bond and s their ratio. Every kind of point has this form.
struct PointForce {
  double a = 0;  // N m, as are b and n
  double b = 0;
  Eigen::Matrix2d n = Eigen::Matrix2d::Zero();
};

/// Ordinary state-based incompressible membrane for any isotropic W(I1, I2) and any loading: peridynamics
/// theory, section 5, with the boundary, defect and folding rules of 5a. The force on ghost points is the
/// gradient of the body's energy.
class Membrane final : public PointModel {
 public:
  /// `stabilisation`: factor G of the energy against short waves and folding (theory 5a, rule 5).
  /// Throws InputError unless the body is two-dimensional.
  Membrane(Body body, Material material, double stabilisation);

  [[nodiscard]] std::optional<Breakdown> internal_force(std::span<const double> u,
                                                        std::span<double> force) override;
  [[nodiscard]] double strain_energy(std::span<const double> u) override;
  [[nodiscard]] bool conservative() const override { return true; }
  void stiffness_bound(std::span<const double> u, std::span<double> bound) override;
  [[nodiscard]] std::optional<Breakdown> inspect(std::span<const double> u) override;
  [[nodiscard]] std::vector<ModelField> fields(std::span<const double> u) override;
  [[nodiscard]] std::string remedies() const override {
    return "a larger model.stabilisation or a finer lattice";
  }
  [[nodiscard]] std::vector<std::string> describe() const override;
  [[nodiscard]] std::size_t bytes() const override;

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
  /// A point whose family does not follow the lattice's formula: those of listed bodies, and on a lattice
  /// those with repaired weights or bonds to inclusions.
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
  void make_stencil_weights();
  void make_families();
  void add_listed_family(std::size_t point, const FamilyWeights& weights, std::vector<MembraneBond> bonds);
  void sort_incoming();
  [[nodiscard]] std::vector<MembraneBond> bonds_of(std::size_t point) const;
  [[nodiscard]] std::vector<PlaneBond> unshortened_bonds_of(std::size_t point) const;
  [[nodiscard]] MembraneBond listed_bond(std::size_t number) const;
  [[nodiscard]] double stabilisation_modulus(std::size_t point) const;

  void update_points(std::span<const double> u);
  void average_row(const LatticeBonds& on, std::size_t row, std::span<const double> u);
  template <class Law>
  void respond_row(const Law& law, const Lattice& lattice, std::size_t row);
  void respond_listed(const ListedFamily& family, std::span<const double> u);
  void set_point(std::size_t point, double energy, const PointForce& force);
  [[nodiscard]] PointForce point_force(std::size_t point) const;
  void gather_row(const LatticeBonds& on, std::size_t row, std::span<const double> u,
                  std::span<double> force) const;
  void pull_listed(const ListedFamily& family, std::span<const double> u, std::span<double> force);
  void push_far_ends(std::span<double> force) const;
  [[nodiscard]] std::optional<Breakdown> first_collapsed() const;
  [[nodiscard]] Eigen::Matrix2d gradient(std::size_t point) const;
  [[nodiscard]] const ListedFamily* gradient_family(std::size_t point) const;
  [[nodiscard]] std::array<double, 3> family_curvature(std::size_t point) const;

  Material material_;
  double stabilisation_ = 0;
  std::vector<ListedFamily> listed_;  // in order of their points
  ListedFamilyBonds listed_bonds_;
  std::vector<std::ptrdiff_t> listed_index_;  // per stored point, -1 for formula points

  using Plane = std::vector<double>;
  std::array<Plane, kMoments> coefficient_;  // of the angular functions; 0 for listed points
  Plane kappa_;                              // modulus of the stabilisation (Pa)
  Plane smallest_weight_;                    // of the family over its base weight, before any repair
  // Family averages <s^2>, <s^4>, <Y xi^T / |xi|^2>, then what follows from them; valid for one state.
  Plane mean_s2_, mean_s4_;
  std::array<Plane, 4> mean_gradient_;
  Plane energy_density_, force_a_, force_b_;
  std::array<Plane, 4> force_n_;
  std::vector<std::ptrdiff_t> collapsed_in_row_;  // first point of the row whose J^2 collapsed, or -1

  /// Constants of one bond of the stencil.
  struct StencilBond {
    std::ptrdiff_t shift;
    double x, y;      // m
    double inverse2;  // 1/length^2
    Moments weight;   // angular functions / length
  };
  std::vector<StencilBond> stencil_;  // empty for listed bodies
};

template <class Visit>
void Membrane::for_each_bond(std::size_t point, const Visit& visit) const {
  if (listed_index_[point] >= 0) {
    const ListedFamily& family = listed_[static_cast<std::size_t>(listed_index_[point])];
    for (std::size_t b = family.begin; b < family.end; ++b) visit(listed_bond(b));
    return;
  }
  const LatticeBonds& on = *body().on_lattice();
  for (std::size_t k = 0; k < stencil_.size(); ++k) {
    if (!on.bonds.exists(k, point)) continue;
    double weight = 0;
    for (std::size_t m = 0; m < kMoments; ++m) weight += coefficient_[m][point] * stencil_[k].weight[m];
    visit(MembraneBond{{stencil_[k].x, stencil_[k].y},
                       weight,
                       static_cast<End>(BondPlanes::neighbour(on.stencil, k, point)),
                       -1});
  }
}

}  // namespace riven
