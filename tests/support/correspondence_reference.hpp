#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "peridynamics/correspondence.hpp"
#include "support/laws.hpp"
#include "support/random.hpp"

namespace riven::testing {

/// Nominal stress in the kinematics of a body of so many dimensions; what goes on across a plane is left out.
inline Eigen::MatrixXd stress_of(const CorrespondenceSettings& s, const Eigen::MatrixXd& f) {
  if (f.rows() == 3) return s.material.solid(f).stress;
  return s.plane == Plane::stress ? s.material.plane_stress(f).stress : s.material.plane_strain(f).stress;
}

/// The correspondence model as the theory writes it, eq. (5), (6) and (6a), family by family: each force
/// state pushes its point and pulls the other end.
inline std::vector<double> plain_force(const Correspondence& model, const CorrespondenceSettings& settings,
                                       const std::vector<double>& u) {
  using Eigen::MatrixXd;
  using Eigen::VectorXd;
  const Body& body = model.body();
  const int dim = body.dimension;
  std::vector<double> volume = body.volume, force(model.dofs(), 0.0);
  for (const GhostPoint& ghost : body.ghosts) volume[ghost.point] = body.volume[ghost.master];
  const auto vector = [&](const std::vector<double>& from, std::size_t i) {
    VectorXd v(dim);
    for (int d = 0; d < dim; ++d) v[d] = from[static_cast<std::size_t>(d) * body.size() + i];
    return v;
  };
  const auto position = [&](std::size_t i) {
    return VectorXd(Eigen::Vector3d(body.position(i).data()).head(dim));
  };
  const MatrixXd one = MatrixXd::Identity(dim, dim);
  // Shear modulus; bulk modulus of the dimensions for the published stabilisation.
  const SmallStrain moduli = settings.material.small_strain();
  const double mu = moduli.shear, nu = moduli.poissons_ratio();
  const double bulk = dim == 3                          ? moduli.bulk
                      : settings.plane == Plane::stress ? 2 * mu * (1 + nu) / (2 * (1 - nu))
                                                        : mu / (1 - 2 * nu);
  struct Bond {
    std::size_t end;
    VectorXd xi, y;
    double omega, volume;
  };
  for (const std::size_t i : body.points) {
    std::vector<Bond> family;
    MatrixXd shape = MatrixXd::Zero(dim, dim), m = shape;
    double weights = 0;
    body.for_each_neighbour(i, [&](std::size_t j) {
      const VectorXd xi = position(j) - position(i), y = xi + vector(u, j) - vector(u, i);
      const double omega = settings.influence == Influence::inverse ? body.horizon / xi.norm() : 1;
      family.push_back({j, xi, y, omega, volume[j]});
      shape += omega * volume[j] * xi * xi.transpose();
      m += omega * volume[j] * y * xi.transpose();
      weights += omega * volume[j];
    });
    const Eigen::JacobiSVD<MatrixXd> svd(shape);
    if (family.size() <= static_cast<std::size_t>(dim) ||
        svd.singularValues()[0] >= 1e4 * svd.singularValues()[dim - 1])
      continue;
    const MatrixXd inverse = shape.inverse(), f = m * inverse;
    std::vector<VectorXd> t;
    if (settings.stabilisation == Stabilisation::bond_associated) {
      MatrixXd q = MatrixXd::Zero(dim, dim);
      std::vector<MatrixXd> p;
      for (const Bond& b : family) {
        const VectorXd n = b.xi.normalized();
        const MatrixXd across = one - n * n.transpose();
        p.push_back(stress_of(settings, f * across + b.y * b.xi.transpose() / b.xi.squaredNorm()));
        q += b.omega * b.volume / weights * p.back() * across;
      }
      for (std::size_t k = 0; k < family.size(); ++k) {
        const Bond& b = family[k];
        t.emplace_back(b.omega * (p[k] * b.xi / (weights * b.xi.squaredNorm()) + q * inverse * b.xi));
      }
    } else {
      double spring = settings.factor * 4.0 / 3 * mu * dim / shape.trace();
      if (settings.stabilisation == Stabilisation::published) {
        const double c = dim == 3
                             ? 18 * bulk / (std::numbers::pi * std::pow(body.horizon, 4))
                             : 12 * bulk / (std::numbers::pi * body.thickness * std::pow(body.horizon, 3));
        spring = settings.factor * c / weights;
      }
      const MatrixXd p = stress_of(settings, f);
      for (const Bond& b : family) t.emplace_back(b.omega * (p * inverse * b.xi + spring * (b.y - f * b.xi)));
    }
    for (std::size_t k = 0; k < family.size(); ++k)
      for (int d = 0; d < dim; ++d) {
        const double pull = volume[i] * family[k].volume * t[k][d];
        force[static_cast<std::size_t>(d) * body.size() + i] += pull;
        force[static_cast<std::size_t>(d) * body.size() + family[k].end] -= pull;
      }
  }
  return force;
}

inline constexpr Stabilisation kStabilisations[] = {Stabilisation::energy, Stabilisation::published,
                                                    Stabilisation::bond_associated};

inline const LawCase& law_case(const std::string& name) {
  for (const LawCase& c : law_cases())
    if (c.name == name) return c;
  throw std::logic_error("no law " + name);
}

/// Any law that the dimensions and the plane take; an objective one if asked for.
inline CorrespondenceSettings random_correspondence(Random& random, int dimension, bool objective = true) {
  static const std::vector<std::string> names = {
      "neo_hookean",         "mooney_rivlin", "ogden", "compressible_neo_hookean",
      "st_venant_kirchhoff", "linear_elastic"};
  const int last = static_cast<int>(names.size()) - (objective ? 2 : 1);
  const LawCase& law = law_case(names[static_cast<std::size_t>(random.integer(0, last))]);
  CorrespondenceSettings settings{.material = law.compressible(),
                                  .plane = random.chance(0.5) ? Plane::stress : Plane::strain,
                                  .influence = random.chance(0.5) ? Influence::inverse : Influence::constant};
  if (dimension == 2 && settings.plane == Plane::stress && law.is_rubber() && random.chance(0.7))
    settings.material = law.material();
  settings.stabilisation = kStabilisations[random.integer(0, 2)];
  // As published, numbers depend on the unit of length: the springs of these bodies of 0.1 m are then like
  // the others'.
  settings.factor =
      settings.stabilisation == Stabilisation::published ? random.between(0, 0.02) : random.between(0, 2);
  return settings;
}

}  // namespace riven::testing
