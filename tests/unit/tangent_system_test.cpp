#include "solver/tangent_system.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Dense>
#include <cmath>

#include "support/bodies.hpp"
#include "support/laws.hpp"
#include "support/loads.hpp"
#include "support/states.hpp"
#include "support/tangents.hpp"

namespace riven::testing {
namespace {

/// A sheet with a hole, a slit and an inclusion that is free, pulled at mirrored edges, one entry held.
struct Problem {
  Problem()
      : membrane(make_lattice_body(make_sheet()), unit_laws()[1].material(), 4),
        constraints(constrain(membrane, uniaxial())) {
    constraints.add({.slave = membrane.body().size() + membrane.body().points[5], .terms = {}});
    constraints.set_parameter(1.2);
    u = affine_state(membrane, Eigen::Matrix2d{{1.2, 0.02}, {0, 0.95}});
    constraints.apply(u);
    force = force_of(membrane, u);
    constraints.reduce(force);
  }
  static LatticeBodyInput make_sheet() {
    LatticeBodyInput in =
        sheet(14, 12, 0.05, Faces(0b0011), {{Disc{{0.13, 0.1, 0}, 0.08}}, {}, {Disc{{-0.1, -0.1, 0}, 0.09}}});
    in.defects.cracks.push_back({{-0.3, 0.15, 0}, {-0.1, 0.17, 0}});
    return in;
  }
  /// The constrained change of a state per change of each free entry.
  [[nodiscard]] Eigen::MatrixXd moves() const {
    const auto n = static_cast<Eigen::Index>(membrane.dofs());
    Eigen::MatrixXd t(n, n);
    std::vector<double> zero(membrane.dofs()), one(membrane.dofs());
    constraints.apply(zero);
    for (Eigen::Index c = 0; c < n; ++c) {
      one.assign(one.size(), 0.0);
      const auto entry = static_cast<std::size_t>(c);
      if (constraints.is_free(entry)) one[entry] = 1;
      constraints.apply(one);
      for (Eigen::Index r = 0; r < n; ++r)
        t(r, c) = one[static_cast<std::size_t>(r)] - zero[static_cast<std::size_t>(r)];
    }
    return t;
  }

  Membrane membrane;
  Constraints constraints;
  std::vector<double> u, force;
};

TEST(TangentSystem, IsTheConstrainedTangent) {
  Problem p;
  TangentSystem system(p.membrane, p.constraints, p.u);
  system.assemble(p.u, {}, 1);
  const std::vector<double> diagonal(p.membrane.dofs(), 3.0);
  const double shift = 0.2;
  ASSERT_TRUE(system.factor(shift, diagonal));
  std::vector<double> x(p.membrane.dofs());
  system.solve(p.force, x);

  const Eigen::MatrixXd t = p.moves();
  Eigen::MatrixXd k = t.transpose() * assembled(p.membrane, p.u) * t;
  std::size_t unknowns = 0;
  for (Eigen::Index i = 0; i < k.rows(); ++i) {
    unknowns += k(i, i) != 0 ? 1 : 0;
    k(i, i) = k(i, i) != 0 ? k(i, i) + shift * 3 : 1;
  }
  EXPECT_EQ(system.unknowns(), unknowns);
  const Eigen::Map<const Eigen::VectorXd> f(p.force.data(), k.rows()), solution(x.data(), k.rows());
  const Eigen::VectorXd expected = k.ldlt().solve(f);
  EXPECT_LT((solution - expected).norm(), 1e-10 * expected.norm());  // condition 1e4 times rounding
}

TEST(TangentSystem, ForgetsTheShift) {
  Problem p;
  TangentSystem system(p.membrane, p.constraints, p.u);
  system.assemble(p.u, {}, 1);
  const std::vector<double> diagonal(p.membrane.dofs(), 1.0);
  std::vector<double> once(p.membrane.dofs()), again(p.membrane.dofs());
  ASSERT_TRUE(system.factor(0.1, diagonal));
  system.solve(p.force, once);
  ASSERT_TRUE(system.factor(5, diagonal));
  ASSERT_TRUE(system.factor(0.1, diagonal));
  system.solve(p.force, again);
  EXPECT_EQ(once, again);
}

TEST(TangentSystem, HasTheSameBitsOnAnyNumberOfThreads) {
  std::vector<std::vector<double>> results;
  for (const int threads : {1, 2, 3, 5}) {
    omp_set_num_threads(threads);
    Problem p;
    TangentSystem system(p.membrane, p.constraints, p.u);
    system.assemble(p.u, {}, 1);
    ASSERT_TRUE(system.factor(1e-3, std::vector<double>(p.membrane.dofs(), 1.0)));
    system.solve(p.force, results.emplace_back(p.membrane.dofs()));
  }
  omp_set_num_threads(1);
  for (const auto& result : results) EXPECT_EQ(result, results.front());
}

// Large enough that an ordering by several threads, or by chance, would show.
TEST(TangentSystem, HasTheSameBitsEveryTime) {
  std::vector<std::vector<double>> results;
  for (int time = 0; time < 3; ++time) {
    Membrane membrane(make_lattice_body(sheet(90, 90, 0.01)), unit_laws()[0].material(), 4);
    const Constraints free(membrane.dofs(), 7);
    const std::vector<double> rest(membrane.dofs());
    std::vector<double> force(membrane.dofs());
    for (const std::size_t i : membrane.body().points) force[i] = std::sin(static_cast<double>(i));
    TangentSystem system(membrane, free, rest);
    static_cast<void>(force_of(membrane, rest));
    system.assemble(rest, {}, 1);
    ASSERT_TRUE(system.factor(1e-3, std::vector<double>(membrane.dofs(), 1.0)));
    system.solve(force, results.emplace_back(membrane.dofs()));
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

}  // namespace
}  // namespace riven::testing
