#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "peridynamics/lps.hpp"

namespace riven::testing {

/// A material with its moduli in D dimensions.
struct Elastic {
  double youngs_modulus, poissons_ratio;
  int dimension;
  Plane plane = Plane::stress;

  [[nodiscard]] double shear() const { return youngs_modulus / (2 * (1 + poissons_ratio)); }
  /// Lame's first parameter; in plane stress the one that leaves no stress across.
  [[nodiscard]] double lame() const {
    const double e = youngs_modulus, nu = poissons_ratio;
    return dimension == 2 && plane == Plane::stress ? e * nu / (1 - nu * nu)
                                                    : e * nu / ((1 + nu) * (1 - 2 * nu));
  }
  [[nodiscard]] double bulk() const { return lame() + 2 * shear() / dimension; }
  /// Hooke's stress of a strain within the dimensions.
  [[nodiscard]] Eigen::Matrix3d stress(const Eigen::Matrix3d& strain) const {
    Eigen::Matrix3d sigma = 2 * shear() * strain;
    for (int d = 0; d < dimension; ++d) sigma(d, d) += lame() * strain.trace();
    return sigma;
  }
};

inline Elastic elastic(const LpsSettings& s, int dimension) {
  return {s.youngs_modulus, s.poissons_ratio, dimension, s.plane};
}

/// The linear peridynamic solid as Silling et al. (2007) write it, in its dilatation and deviatoric
/// extensions, family by family: each pushes its point and pulls the other ends.
inline std::vector<double> plain_force(const Lps& model, const LpsSettings& settings,
                                       const std::vector<double>& u) {
  const Body& body = model.body();
  const int dimension = body.dimension;
  const Elastic law = elastic(settings, dimension);
  std::vector<double> volume = body.volume, force(model.dofs(), 0.0);
  for (const GhostPoint& ghost : body.ghosts) volume[ghost.point] = body.volume[ghost.master];
  struct Bond {
    std::size_t end;
    double weight, length, extension;  // weight with the end's volume
    Eigen::Vector3d direction;
  };
  for (const std::size_t i : body.points) {
    std::vector<Bond> family;
    double m = 0, theta = 0;
    body.for_each_neighbour(i, [&](std::size_t j) {
      Eigen::Vector3d xi, y;
      for (std::size_t d = 0; d < 3; ++d) {
        xi[static_cast<int>(d)] = body.position(j)[d] - body.position(i)[d];
        y[static_cast<int>(d)] = xi[static_cast<int>(d)];
        if (static_cast<int>(d) < dimension)
          y[static_cast<int>(d)] += u[d * body.size() + j] - u[d * body.size() + i];
      }
      const double length = xi.norm();
      const Eigen::Vector3d n = xi / length;
      double fourth = 0;
      for (const double x : n) fourth += std::pow(x, 4);
      double weight = 1 + model.anisotropy() * (fourth - 3.0 / (2 + dimension));
      if (settings.influence == Influence::inverse) weight *= body.horizon / length;
      family.push_back({j, weight * volume[j], length, y.norm() - length, y.normalized()});
      m += family.back().weight * length * length;
    });
    for (const Bond& b : family) theta += dimension / m * b.weight * b.length * b.extension;
    for (const Bond& b : family) {
      const double deviatoric = b.extension - theta * b.length / dimension;
      const double alpha = dimension * (dimension + 2) * law.shear() / m;
      const double t = dimension * law.bulk() * theta / m * b.length + alpha * deviatoric;
      for (int d = 0; d < dimension; ++d) {
        const double pull = volume[i] * b.weight * t * b.direction[d];
        force[static_cast<std::size_t>(d) * body.size() + i] += pull;
        force[static_cast<std::size_t>(d) * body.size() + b.end] -= pull;
      }
    }
  }
  return force;
}

}  // namespace riven::testing
