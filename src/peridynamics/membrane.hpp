#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "body/lattice_body.hpp"
#include "material/material.hpp"
#include "model/model.hpp"
#include "peridynamics/weights.hpp"

namespace riven {

/// A bond as the membrane's kernels see it: from a body point to a lattice point or to a rigid inclusion.
struct MembraneBond {
  Eigen::Vector2d reference;  // bond vector (m), shortened to the surface for an inclusion
  double weight = 0;          // sum over the family is 1
  std::size_t neighbour = 0;  // storage index; unused for an inclusion
  int inclusion = -1;         // number of the inclusion, or -1
  Eigen::Vector2d arm{0, 0};  // from the inclusion's centre to the bond's end (m)
};

/// Force law of a point, times its volume: bond j carries weight/|xi|^2 ((a + b s^2) Y + n xi), where xi and
/// Y are the undeformed and deformed bond and s their ratio. Every kind of point has this form.
struct PointForce {
  double a = 0;  // N m, as are b and n
  double b = 0;
  Eigen::Matrix2d n = Eigen::Matrix2d::Zero();
};

/// Ordinary state-based incompressible membrane for any isotropic W(I1, I2) and any loading: peridynamics
/// theory, section 5, with the boundary, defect and folding rules of 5a.
///
/// A state holds u_x of all stored lattice points, then u_y, then for each inclusion its translation (2) and
/// its rotation angle times its radius of gyration (m). Entries of ghost points are inputs (set by the
/// loads); the force there is the gradient of the body's energy.
class Membrane final : public Model {
 public:
  /// `stabilisation`: factor G of the energy against short waves and folding (theory 5a, rule 5).
  /// Throws InputError unless the body is two-dimensional.
  Membrane(LatticeBody body, Material material, double stabilisation);

  [[nodiscard]] std::size_t dofs() const override;
  [[nodiscard]] std::optional<Breakdown> internal_force(std::span<const double> u,
                                                        std::span<double> force) override;
  [[nodiscard]] double strain_energy(std::span<const double> u) override;
  void mass(std::span<double> mass) const override;
  void stiffness_bound(std::span<const double> u, std::span<double> bound) override;
  [[nodiscard]] double spacing() const override { return body_.lattice.spacing(); }
  [[nodiscard]] std::optional<Breakdown> inspect(std::span<const double> u) override;
  void move(std::span<double> u, const std::array<std::array<double, 3>, 3>& gradient,
            const Point& shift) const override;
  [[nodiscard]] std::vector<Point> positions() const override;
  [[nodiscard]] std::vector<Point> displacements(std::span<const double> u) const override;
  [[nodiscard]] std::vector<ModelField> fields(std::span<const double> u) override;
  [[nodiscard]] std::vector<std::string> describe() const override;
  [[nodiscard]] std::size_t points() const override { return body_.points.size(); }
  [[nodiscard]] std::size_t bonds() const override { return directed_bonds_; }

  [[nodiscard]] const LatticeBody& body() const { return body_; }
  [[nodiscard]] const Material& material() const { return material_; }
  /// First Piola-Kirchhoff stress of a body point (Pa) in the state of the last force or energy evaluation.
  [[nodiscard]] Eigen::Matrix2d nominal_stress(std::size_t point, std::span<const double> u) const;
  /// First of the three entries of an inclusion in a state.
  [[nodiscard]] std::size_t inclusion_dof(std::size_t inclusion) const;

  /// Calls visit(bond) for the family of a body point, whatever kind of point it is: the plain counterpart of
  /// the kernels.
  template <class Visit>
  void for_each_bond(std::size_t point, const Visit& visit) const;

  /// Memory that body and model hold, without state vectors (bytes).
  [[nodiscard]] std::size_t bytes() const;

  /// Points whose weights were found by least squares, and those that use the deformation gradient.
  [[nodiscard]] std::size_t points_by_least_squares() const;
  [[nodiscard]] std::size_t points_by_gradient() const;

 private:
  /// A point whose family does not follow the lattice's formula: repaired weights, bonds to inclusions.
  struct ListedFamily {
    std::size_t point = 0;
    bool by_least_squares = false;
    bool by_gradient = false;
    Eigen::Matrix2d inverse_shape = Eigen::Matrix2d::Zero();  // (sum w n n^T)^-1, for by_gradient
    std::vector<MembraneBond>
        bonds;  // none: all lie on one line, so the point has no strain energy of its own
  };
  struct Inclusion {
    [[nodiscard]] Eigen::Vector2d displacement(const Eigen::Vector2d& arm, std::span<const double> u,
                                               std::size_t dof) const {
      return Eigen::Vector2d(u[dof], u[dof + 1]) + rotation * arm - arm;
    }
    Eigen::Vector2d center;
    double gyration = 0;             // radius of gyration (m)
    double mass = 0;                 // kg
    Eigen::Rotation2Dd rotation{0};  // of the state seen last
  };

  /// Deformed bond from a body point (m).
  [[nodiscard]] Eigen::Vector2d deformed(std::size_t point, const MembraneBond& bond,
                                         std::span<const double> u) const;
  /// The part of a bond's force that belongs to one end: weight/|xi|^2 ((a + b s^2) Y + n xi) (N).
  static Eigen::Vector2d bond_force(const PointForce& law, const MembraneBond& bond,
                                    const Eigen::Vector2d& y);
  void make_inclusions();
  void make_families();
  [[nodiscard]] std::vector<MembraneBond> bonds_of(std::size_t point) const;
  [[nodiscard]] std::vector<PlaneBond> unshortened_bonds_of(std::size_t point) const;
  [[nodiscard]] double stabilisation_modulus(std::size_t point) const;

  void update_points(std::span<const double> u);
  void average_row(std::size_t row, std::span<const double> u);
  template <class Law>
  void respond_row(const Law& law, std::size_t row);
  void respond_listed(const ListedFamily& family, std::span<const double> u);
  void set_point(std::size_t point, double energy, const PointForce& force);
  [[nodiscard]] PointForce point_force(std::size_t point) const;
  void gather_row(std::size_t row, std::span<const double> u, std::span<double> force) const;
  void scatter_listed(std::span<const double> u, std::span<double> force) const;
  [[nodiscard]] std::optional<Breakdown> first_collapsed() const;
  void add_far_bound(const MembraneBond& bond, double row, std::span<double> bound) const;
  [[nodiscard]] const ListedFamily* gradient_family(std::size_t point) const;
  [[nodiscard]] std::array<double, 3> family_curvature(std::size_t point) const;

  LatticeBody body_;
  Material material_;
  double stabilisation_ = 0;
  std::size_t directed_bonds_ = 0;
  std::vector<Inclusion> inclusions_;
  std::vector<ListedFamily> listed_;          // in order of their points
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
  std::vector<StencilBond> stencil_;
};

template <class Visit>
void Membrane::for_each_bond(std::size_t point, const Visit& visit) const {
  if (listed_index_[point] >= 0) {
    for (const MembraneBond& bond : listed_[static_cast<std::size_t>(listed_index_[point])].bonds)
      visit(bond);
    return;
  }
  for (std::size_t k = 0; k < stencil_.size(); ++k) {
    if (!body_.bonds.exists(k, point)) continue;
    double weight = 0;
    for (std::size_t m = 0; m < kMoments; ++m) weight += coefficient_[m][point] * stencil_[k].weight[m];
    visit(MembraneBond{
        {stencil_[k].x, stencil_[k].y}, weight, BondPlanes::neighbour(body_.stencil, k, point), -1, {0, 0}});
  }
}

}  // namespace riven
