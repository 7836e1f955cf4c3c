// What the correspondence model does seldom, family by family in plain loops: fields and tangent.

#include <fmt/format.h>
#include <Eigen/Dense>
#include <algorithm>

#include "base/parallel.hpp"
#include "peridynamics/correspondence.hpp"

namespace riven {

namespace {

/// A tensor in the plane with what goes on across it.
template <int D>
Eigen::Matrix3d in_space(const Eigen::Matrix<double, D, D>& t, double across) {
  Eigen::Matrix3d whole = Eigen::Matrix3d::Zero();
  whole(2, 2) = across;
  whole.topLeftCorner<D, D>() = t;
  return whole;
}

}  // namespace

std::vector<ModelField> Correspondence::fields(std::span<const double> u) {
  const std::vector<std::size_t>& points = body().points;
  ModelField energy{"strain_energy_density", 1, std::vector<double>(points.size()), "J/m^3"};
  ModelField stress{"nominal_stress", 9, std::vector<double>(9 * points.size()), "Pa"};
  ModelField gradient{"deformation_gradient", 9, std::vector<double>(9 * points.size()), ""};
  const auto answer = [&]<int D>(std::size_t n) {
    using Tensors = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
    Tensors p(stress.values.data() + 9 * n), f(gradient.values.data() + 9 * n);
    const Family<D> own = family<D>(points[n], u);
    if (own.end.empty()) f.setIdentity();
    const Constitution& law = laws_[body().material_of(points[n])];
    for (const Gauge<D>& gauge : gauges(own)) {
      const ResponseIn<D> response = law.respond<D>(gauge.f);
      Eigen::Matrix3d whole = in_space<D>(gauge.f, 1);
      if (law.kinematics == Kinematics::plane_stress && D == 2)
        whole(2, 2) = law.material.thickness_stretch(whole.topLeftCorner<2, 2>());
      const double across =
          law.kinematics == Kinematics::plane_strain ? law.material.solid(whole).stress(2, 2) : 0;
      energy.values[n] += gauge.share * response.energy;
      p += gauge.share * in_space<D>(response.stress, across);
      f += (gauge.bond < 0 ? 1 : gauge.share) * whole;
      if (gauge.bond < 0) {
        const auto z = own.eta - (gauge.f - Eigen::Matrix<double, D, D>::Identity()) * own.xi;
        energy.values[n] += 0.5 * own.spring * own.weight.dot(z.colwise().squaredNorm());
      }
    }
  };
  parallel_for(static_cast<std::ptrdiff_t>(points.size()), [&](std::ptrdiff_t n) {
    in_dimension([&]<int D>(std::integral_constant<int, D>) {
      answer.template operator()<D>(static_cast<std::size_t>(n));
    });
  });
  return {damage(), std::move(energy), std::move(stress), std::move(gradient)};
}

double Correspondence::equal_stretch_energy(double stretch, std::size_t material,
                                            std::size_t /*other*/) const {
  return in_dimension([&]<int D>(std::integral_constant<int, D>) {
    const Constitution& law = laws_[material];
    return law.respond<D>((1 + stretch) * Eigen::Matrix<double, D, D>::Identity()).energy;
  });
}

/// As `find_shape` has it.
double Correspondence::share_left(const WholeFamily& family, const std::vector<bool>& exists,
                                  std::size_t /*material*/) const {
  const int dimension = body().dimension;
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(dimension, dimension), left = whole;
  double whole_weight = 0, left_weight = 0;
  for (std::size_t k = 0; k < exists.size(); ++k) {
    const Eigen::VectorXd xi = family.xi[k].head(dimension);
    const double weight = influence(settings_.influence, xi.norm(), body().horizon) * family.volume[k];
    whole += weight * xi * xi.transpose();
    whole_weight += weight;
    if (!exists[k]) continue;
    left += weight * xi * xi.transpose();
    left_weight += weight;
  }
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(left).eigenvalues();
  if (!(values[dimension - 1] < kFlat * values[0])) return 0;
  return std::min(left_weight / whole_weight, whole.inverse().trace() / left.inverse().trace());
}

double Correspondence::family_energy(std::size_t point, std::span<const double> u) const {
  return in_dimension([&]<int D>(std::integral_constant<int, D>) {
    const Family<D> own = family<D>(point, u);
    const Constitution& law = laws_[body().material_of(point)];
    double energy = 0;
    for (const Gauge<D>& gauge : gauges(own)) {
      const auto z = own.eta - (gauge.f - Eigen::Matrix<double, D, D>::Identity()) * own.xi;
      energy += gauge.share * law.respond<D>(gauge.f).energy +
                0.5 * own.spring * own.weight.dot(z.colwise().squaredNorm());
    }
    return own.volume * energy;
  });
}

void Correspondence::tangent(std::span<const double> u, std::size_t first, std::size_t last,
                             TangentBlocks& to) const {
  for (std::size_t n = first; n < last; ++n)
    in_dimension([&]<int D>(std::integral_constant<int, D>) { add_tangent<D>(u, body().points[n], to); });
}

/// The Hessian of a family's energy times V: g^T A g for each of its gradients, and the stabilisation's,
/// which is the same for each component.
template <int D>
void Correspondence::add_tangent(std::span<const double> u, std::size_t point, TangentBlocks& to) const {
  const Family<D> own = family<D>(point, u);
  const Constitution& law = laws_[body().material_of(point)];
  const auto bonds = static_cast<Eigen::Index>(own.end.size()), size = D * bonds;
  if (bonds == 0) return;
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(size, size);
  for (const Gauge<D>& gauge : gauges(own)) {
    const auto q = levers(own, gauge);
    Eigen::Matrix<double, D * D, Eigen::Dynamic> g = Eigen::MatrixXd::Zero(D * D, size);
    for (Eigen::Index b = 0; b < bonds; ++b)
      for (int d = 0; d < D; ++d) g.template block<D, 1>(D * d, D * b + d) = q.col(b);
    hessian += own.volume * gauge.share * g.transpose() * law.respond<D>(gauge.f).tangent * g;
  }
  if (own.spring > 0) {
    const Eigen::MatrixXd weighed = own.xi * own.weight.asDiagonal();
    Eigen::MatrixXd s = -weighed.transpose() * own.inverse_shape * weighed;
    s.diagonal() += own.weight;
    for (int d = 0; d < D; ++d)
      hessian(Eigen::seqN(d, bonds, D), Eigen::seqN(d, bonds, D)) += own.volume * own.spring * s;
  }
  const std::vector<End> ends(own.end.begin(), own.end.end());
  add_family_block(point, ends, {}, hessian, to);
}

std::vector<std::string> Correspondence::describe() const {
  std::vector<std::string> lines;
  for (const Constitution& law : laws_) {
    const SmallStrain moduli = law.material.small_strain();
    lines.push_back(fmt::format("material: shear modulus {:.6g} Pa{}", moduli.shear,
                                law.material.incompressible()
                                    ? ", incompressible"
                                    : fmt::format(", bulk modulus {:.6g} Pa", moduli.bulk)));
  }
  switch (settings_.stabilisation) {
    case Stabilisation::energy:
      lines.push_back(
          fmt::format("stabilisation: energy of what the deformation gradient does not explain, "
                      "factor {:g}{}",
                      settings_.factor, settings_.factor > 0 ? "" : ": off, short waves have no stiffness"));
      break;
    case Stabilisation::published:
      lines.push_back(
          fmt::format("stabilisation: as published, factor {:g}. Its unit is wrong, so that it "
                      "depends on the unit of length (here the metre): to compare only",
                      settings_.factor));
      break;
    case Stabilisation::bond_associated:
      lines.emplace_back("stabilisation: a deformation gradient and a stress per bond");
  }
  if (loose_ > 0)
    lines.push_back(fmt::format("points: {} have bonds in too few directions, and no stress", loose_));
  if (!std::all_of(laws_.begin(), laws_.end(),
                   [](const Constitution& law) { return law.material.objective(); }))
    lines.emplace_back("rotations: the law takes them for strain; expected small ones only");
  for (std::string& line : describe_limits()) lines.push_back(std::move(line));
  return lines;
}

}  // namespace riven
