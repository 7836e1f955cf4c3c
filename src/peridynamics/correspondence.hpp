#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>

#include "material/plane.hpp"
#include "peridynamics/breaking_model.hpp"
#include "peridynamics/correspondence_kernels.hpp"
#include "peridynamics/correspondence_law.hpp"
#include "peridynamics/influence.hpp"

namespace riven {

/// What keeps a family from motions that its deformation gradient does not see.
enum class Stabilisation {
  energy,           // s/2 sum(omega |z|^2 V), s of the material's shear modulus
  published,        // the same with the s of Wada (2017), eq. (186) to (188): its unit is wrong
  bond_associated,  // the stress of a gradient per bond, eq. (6a) of the theory
};

struct CorrespondenceSettings {
  Material material;
  std::vector<Material> further{};  // materials 1, 2, ... of the body's points
  Plane plane = Plane::stress;      // in two dimensions
  Influence influence = Influence::inverse;
  Stabilisation stabilisation = Stabilisation::energy;
  double factor = 1;  // G of the stabilisation energy
};

/// Correspondence model (Silling et al. 2007) of any material: a family's deformation gradient
///
///   F = 1 + sum(omega eta xi V) K^-1,  K = sum(omega xi xi V),  eta = Y - xi,
///
/// and its energy W(F) + s/2 sum(omega |z|^2 V), with what F does not explain, z = Y - F xi. The force state
/// is omega (P K^-1 xi + s z); s = 4/3 G mu D / tr K in D dimensions. Bond-associated: the mean of W over
/// bonds, with gradients that have the bond's own stretch and direction. Force is the gradient of the sum of
/// energy times V over the body's points; ghosts have none. Families with bonds in too few directions have
/// none either. Bonds that break leave the sums, so that rotations stay rotations, and take their share of
/// the energy: W and s are multiplied by the share of sum(omega V) that is left, and by less where the bonds
/// left would be stiffer together than the undamaged family. A damaged family that
/// is crushed to next to nothing, or turned inside out, has no energy from then on: it is debris.
class Correspondence final : public BreakingModel {
 public:
  /// Throws InputError for a body with inclusions or in one dimension, and for an incompressible material in
  /// anything but plane stress. Limits of stretch are refused for bond-associated stabilisation.
  Correspondence(Body body, CorrespondenceSettings settings);

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

  /// s of a stored point's family (Pa/m^5).
  [[nodiscard]] double spring(std::size_t point) const { return spring_[point]; }
  /// Points whose bonds point in too few directions: they have no energy.
  [[nodiscard]] std::size_t loose_points() const { return loose_; }

 private:
  /// A family in a state, in plain numbers: column k is bond k.
  template <int D>
  struct Family {
    std::size_t point = 0;
    std::vector<std::size_t> end;
    Eigen::Matrix<double, D, Eigen::Dynamic> xi, eta;  // m
    Eigen::VectorXd weight;                            // omega V of the end (m^3)
    Eigen::Matrix<double, D, D> inverse_shape;         // 1/m^5
    double spring = 0, volume = 0;
    double share = 1;  // of its energy that broken bonds have left it
    std::size_t material = 0;
  };
  /// A deformation gradient whose energy is part of the family's.
  template <int D>
  struct Gauge {
    double share = 1;
    Eigen::Matrix<double, D, D> f;
    Eigen::Index bond = -1;  // the bond that it goes with, if one
  };

  template <class Visit>
  void for_each_bond(std::size_t point, const Visit& visit) const;
  template <int D>
  [[nodiscard]] Family<D> family(std::size_t point, std::span<const double> u) const;
  template <int D>
  [[nodiscard]] std::vector<Gauge<D>> gauges(const Family<D>& family) const;
  /// dF = sum(d eta_k q_k), q_k the columns.
  template <int D>
  [[nodiscard]] Eigen::Matrix<double, D, Eigen::Dynamic> levers(const Family<D>& family,
                                                                const Gauge<D>& gauge) const;
  /// Calls visit(std::integral_constant<int, D>) with the body's dimension.
  template <class Visit>
  auto in_dimension(const Visit& visit) const {
    return body().dimension == 2 ? visit(std::integral_constant<int, 2>{})
                                 : visit(std::integral_constant<int, 3>{});
  }

  void refit(std::span<const std::size_t> points) override;
  void limits_set() override;
  [[nodiscard]] double equal_stretch_energy(double stretch, std::size_t a, std::size_t b) const override;
  [[nodiscard]] double share_left(const WholeFamily& family, const std::vector<bool>& exists,
                                  std::size_t material) const override;
  void find_shapes();
  void find_shape(std::size_t point);
  void make_lattice(const LatticeBonds& on);
  void make_list(const ListedBonds& list);
  void make_bonds();
  [[nodiscard]] double spring_of(std::size_t point, double trace, double weights) const;

  void look_at(std::span<const double> u);
  template <class Visit>
  void for_each_row(std::size_t begin, std::size_t end, const Visit& visit) const;
  // The following take a law per material.
  template <class Law>
  bool force_by(const std::vector<Law>& laws, std::span<const double> u, std::span<double> force);
  template <class Bonds, class Law>
  bool sweep(Bonds& bonds, const CorrespondenceSweeps<Bonds>& kernels, const std::vector<Law>& laws);
  template <int D>
  void find_crushed(std::size_t begin, std::size_t end, const GradientRows& f);
  void find_crushed(std::size_t begin, std::size_t end, const GradientRows& f);
  template <class Law>
  bool respond(const std::vector<Law>& laws, std::size_t begin, std::size_t end, std::size_t rows,
               const GradientRows& f, const GradientRows& p, double* energy) const;
  template <int D, class Law>
  bool sweep_bonds(const std::vector<Law>& laws, std::span<const double> u, std::span<double> force);
  [[nodiscard]] std::optional<Breakdown> find_fault(std::span<const double> u) const;

  [[nodiscard]] double scale_of(double a);
  /// Of each material: its modulus is to a as those at rest are to the largest.
  template <int D>
  [[nodiscard]] std::vector<Majorant<D>> majorants(double a) const;
  /// Calls visit(F, material).
  template <int D>
  void for_each_gradient(std::size_t begin, std::size_t end, std::span<const double> u,
                         const std::function<void(const Eigen::Matrix<double, D, D>&, std::size_t)>& visit);
  template <int D>
  [[nodiscard]] double majorant_of(std::span<const double> u);
  template <int D>
  [[nodiscard]] double largest_eigenvalue_of(double a);
  template <int D>
  void add_tangent(std::span<const double> u, std::size_t point, TangentBlocks& to) const;

  static constexpr double kFlat = 1e4;  // condition of K beyond which bonds lie in too few directions
  struct Rest {
    double longitudinal = 0, shear = 0;  // of a material in its kinematics (Pa)
  };

  CorrespondenceSettings settings_;
  std::vector<Constitution> laws_;  // of each material
  std::vector<Rest> rest_;
  double stiffest_ = 0;  // longitudinal modulus of them
  CorrespondenceKernels kernels_;
  std::size_t loose_ = 0;
  // Of stored points, for what broken bonds leave: sum(omega V) (m^3) and tr K^-1 of the undamaged family.
  std::vector<double> whole_weight_, whole_trace_;
  std::vector<double> share_;
  bool damaged_ = false;
  std::vector<double> volume_;              // of stored points, for ghosts that of their master (m^3)
  std::vector<std::vector<double>> shape_;  // K^-1, upper half row by row
  std::vector<double> spring_;
  std::vector<std::vector<double>> reply_;  // see CorrespondenceLattice
  CorrespondenceLattice lattice_;           // one of both is in use, if bonds have no gradients of their own
  CorrespondenceList list_;
  // Bond-associated: forces of directed bonds on their points, by point, and the bonds that end on a point.
  std::vector<std::size_t> first_bond_, first_incoming_;
  std::vector<std::uint32_t> incoming_;
  std::vector<std::array<double, 3>> pull_;  // N
  std::map<int, double> eigenvalues_;        // of the majorants, by the step of their modulus (1/s^2)
  int looks_ = 0;                            // at the stiffness since bonds broke and these were found
};

template <class Visit>
void Correspondence::for_each_bond(std::size_t point, const Visit& visit) const {
  const Eigen::Vector3d x(body().position(point).data());
  body().for_each_neighbour(point, [&](std::size_t end) {
    const Eigen::Vector3d xi = Eigen::Vector3d(body().position(end).data()) - x;
    visit(end, xi, influence(settings_.influence, xi.norm(), body().horizon) * volume_[end]);
  });
}

template <int D>
Correspondence::Family<D> Correspondence::family(std::size_t point, std::span<const double> u) const {
  Family<D> family;
  family.point = point;
  family.spring = spring_[point];
  family.volume = volume_[point];
  family.share = share_[point];
  family.material = body().material_of(point);
  for (int r = 0, c = 0; r < D; ++r)
    for (int s = r; s < D; ++s, ++c)
      family.inverse_shape(r, s) = family.inverse_shape(s, r) = shape_[static_cast<std::size_t>(c)][point];
  if (family.inverse_shape(0, 0) == 0) return family;
  const auto bonds = static_cast<Eigen::Index>(body().family_size(point));
  family.xi.resize(D, bonds);
  family.eta.resize(D, bonds);
  family.weight.resize(bonds);
  for_each_bond(point, [&](std::size_t end, const Eigen::Vector3d& xi, double weight) {
    const auto k = static_cast<Eigen::Index>(family.end.size());
    family.end.push_back(end);
    family.weight[k] = weight;
    for (int d = 0; d < D; ++d) {
      const std::size_t plane = static_cast<std::size_t>(d) * body().size();
      family.xi(d, k) = xi[d];
      family.eta(d, k) = u[plane + end] - u[plane + point];
    }
  });
  return family;
}

template <int D>
std::vector<Correspondence::Gauge<D>> Correspondence::gauges(const Family<D>& family) const {
  using Tensor = Eigen::Matrix<double, D, D>;
  if (family.end.empty()) return {};
  const Tensor h = family.eta * family.weight.asDiagonal() * family.xi.transpose() * family.inverse_shape;
  const Tensor f = Tensor::Identity() + h;
  if (settings_.stabilisation != Stabilisation::bond_associated) return {{family.share, f, -1}};
  std::vector<Gauge<D>> gauges;
  const double whole = family.weight.sum();
  for (Eigen::Index k = 0; k < family.weight.size(); ++k) {
    const auto xi = family.xi.col(k);
    // F (1 - n n) + Y n / |xi| = F + z n / |xi|
    const Tensor own = f + (family.eta.col(k) - h * xi) * xi.transpose() / xi.squaredNorm();
    gauges.push_back({family.weight[k] / whole, own, k});
  }
  return gauges;
}

template <int D>
Eigen::Matrix<double, D, Eigen::Dynamic> Correspondence::levers(const Family<D>& family,
                                                                const Gauge<D>& gauge) const {
  Eigen::Matrix<double, D, Eigen::Dynamic> q = family.inverse_shape * family.xi * family.weight.asDiagonal();
  if (gauge.bond < 0) return q;
  const auto xi = family.xi.col(gauge.bond);
  q -= xi / xi.squaredNorm() * (xi.transpose() * q).eval();
  q.col(gauge.bond) += xi / xi.squaredNorm();
  return q;
}

}  // namespace riven
