#pragma once

#include <Eigen/LU>
#include <vector>

#include "support/states.hpp"

namespace riven::testing {

/// Energy and force of a membrane by plain loops over bonds, from the equations of the theory alone:
/// peridynamics, (7)-(9) and 5a rule 5. Needs of the membrane its bonds and weights.
class PlainMembrane {
 public:
  PlainMembrane(const Membrane& membrane, double stabilisation)
      : membrane_(membrane), stabilisation_(stabilisation) {}

  struct Result {
    double energy = 0;
    State2 force;
  };

  [[nodiscard]] Result evaluate(const State2& u) const {
    Result result{0, State2(membrane_.dofs(), 0.0)};
    for (const std::size_t i : membrane_.body().points) add_point(i, u, result);
    return result;
  }

  /// Whether no weights with the right moments exist and the point goes by its deformation gradient.
  [[nodiscard]] bool by_gradient(std::size_t point) const {
    Eigen::Vector4d moments = Eigen::Vector4d::Zero();
    membrane_.for_each_bond(point, [&](const MembraneBond& bond) {
      const double t = std::atan2(bond.reference.y(), bond.reference.x());
      moments +=
          bond.weight * Eigen::Vector4d(std::cos(2 * t), std::sin(2 * t), std::cos(4 * t), std::sin(4 * t));
    });
    return moments.cwiseAbs().maxCoeff() > 1e-6;
  }

 private:
  struct Bond {
    MembraneBond bond;
    Eigen::Vector2d xi, y;
  };

  [[nodiscard]] std::vector<Bond> family(std::size_t i, const State2& u) const {
    const Body& body = membrane_.body();
    const std::size_t n = body.size();
    const Eigen::Vector2d x = plane(body.position(i)), here = x + Eigen::Vector2d(u[i], u[n + i]);
    std::vector<Bond> bonds;
    membrane_.for_each_bond(i, [&](const MembraneBond& bond) {
      Eigen::Vector2d there;
      if (bond.inclusion < 0) {
        const std::size_t j = bond.end;
        there = plane(body.position(j)) + Eigen::Vector2d(u[j], u[n + j]);
      } else {
        const auto c = static_cast<std::size_t>(bond.inclusion);
        const std::size_t dof = membrane_.inclusion_dof(c);
        const Eigen::Vector2d center = center_of(body.defects.inclusions[c]);
        there = center + Eigen::Vector2d(u[dof], u[dof + 1]) + turn(c, u) * (x + bond.reference - center);
      }
      bonds.push_back({bond, bond.reference, there - here});
    });
    return bonds;
  }

  [[nodiscard]] Eigen::Matrix2d turn(std::size_t inclusion, const State2& u) const {
    const double gyration = gyration_of(membrane_.body().defects.inclusions[inclusion]);
    return Eigen::Rotation2Dd(u[membrane_.inclusion_dof(inclusion) + 2] / gyration).toRotationMatrix();
  }

  void add_point(std::size_t i, const State2& u, Result& result) const {
    const Body& body = membrane_.body();
    const std::vector<Bond> bonds = family(i, u);
    double a = 0, b = 0;
    Eigen::Matrix2d m = Eigen::Matrix2d::Zero(), k = m;
    for (const auto& [bond, xi, y] : bonds) {
      const double s = y.norm() / xi.norm();
      a += bond.weight * s * s;
      b += bond.weight * std::pow(s, 4);
      m += bond.weight * y * xi.transpose() / xi.squaredNorm();
      k += bond.weight * xi * xi.transpose() / xi.squaredNorm();
    }
    if (bonds.empty()) return;  // a point whose bonds all lie on one line has no energy
    const Eigen::Matrix2d f = m * k.inverse();
    const bool whole = body.complete[i];
    const bool gradient = by_gradient(i);
    const double j2 = 3 * a * a - 2 * b, j4 = j2 * j2;
    const double at_rest =
        stabilisation_ * 0.5 * membrane_.material().small_strain().shear * (whole ? 1 : 0.1);
    const double excess = gradient ? 0 : std::max(0.0, a / j4 - 1);  // architecture.md, The membrane
    const double kappa = at_rest * (1 + 3 * excess * excess), slope = at_rest * 6 * excess;
    double z2 = 0;
    for (const auto& [bond, xi, y] : bonds) z2 += bond.weight * (y - f * xi).squaredNorm() / xi.squaredNorm();
    const InvariantEnergy e =
        std::visit([&](const auto& law) { return law(2 * a + 1 / j2, j2 + 2 * a / j2); },
                   invariant_law(membrane_.material().law).value());
    const double wa = e.w1 * (2 - 6 * a / j4) + e.w2 * (6 * a + 2 / j2 - 12 * a * a / j4) +
                      z2 * slope * (1 / j4 - 12 * a * a / (j4 * j2));
    const double wb = e.w1 * 2 / j4 + e.w2 * (-2 + 4 * a / j4) + z2 * slope * 4 * a / (j4 * j2);
    double density = e.w;
    Eigen::Matrix2d stress = Eigen::Matrix2d::Zero();
    if (gradient) {
      const PlaneResponse response = membrane_.material().plane_stress(f);
      density = response.energy;
      stress = response.stress * k.inverse();
    }
    for (const auto& [bond, xi, y] : bonds) {
      const Eigen::Vector2d z = y - f * xi;
      density += kappa * bond.weight * z.squaredNorm() / xi.squaredNorm();
      const double s = y.norm() / xi.norm();
      Eigen::Vector2d t =
          gradient
              ? Eigen::Vector2d(bond.weight / xi.squaredNorm() * stress * xi)
              : Eigen::Vector2d(bond.weight / xi.norm() * (2 * s * wa + 4 * s * s * s * wb) * y.normalized());
      t += 2 * kappa * bond.weight / xi.squaredNorm() * z;
      add_bond(i, bond, body.volume[i] * t, u, result.force);
    }
    result.energy += body.volume[i] * density;
  }

  /// t: force on the point, -t on the other end.
  void add_bond(std::size_t i, const MembraneBond& bond, const Eigen::Vector2d& t, const State2& u,
                State2& force) const {
    const std::size_t n = membrane_.body().size();
    force[i] += t.x();
    force[n + i] += t.y();
    if (bond.inclusion < 0) {
      force[bond.end] -= t.x();
      force[n + bond.end] -= t.y();
      return;
    }
    const auto c = static_cast<std::size_t>(bond.inclusion);
    const Shape& shape = membrane_.body().defects.inclusions[c];
    const Eigen::Vector2d x = plane(membrane_.body().position(i));
    const Eigen::Vector2d arm = turn(c, u) * (x + bond.reference - center_of(shape));
    const std::size_t dof = membrane_.inclusion_dof(c);
    force[dof] -= t.x();
    force[dof + 1] -= t.y();
    force[dof + 2] -= (arm.x() * t.y() - arm.y() * t.x()) / gyration_of(shape);
  }

  const Membrane& membrane_;
  double stabilisation_;
};

}  // namespace riven::testing
