// Forces of the membrane do not see where the observer stands, nor how the lattice is turned by right angles
// or mirrored.

#include <gtest/gtest.h>

#include "support/bodies.hpp"
#include "support/laws.hpp"
#include "support/states.hpp"

namespace riven::testing {
namespace {

constexpr double kStabilisation = 4;

class Symmetric : public ::testing::TestWithParam<LawCase> {
 protected:
  static Membrane make(const LatticeBodyInput& in) {
    return Membrane(make_lattice_body(in), GetParam().material(), kStabilisation);
  }
};
INSTANTIATE_TEST_SUITE_P(Membranes, Symmetric, ::testing::ValuesIn(unit_laws()), law_name);

TEST_P(Symmetric, ForceTurnsWithTheObserver) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Random random(seed);
    Membrane membrane = make(random_body(random));
    const Body& body = membrane.body();
    const std::size_t n = body.size();
    const State2 u = random_state(membrane, random), force = force_of(membrane, u);
    const double angle = random.between(-3, 3);
    const Eigen::Matrix2d q = Eigen::Rotation2Dd(angle).toRotationMatrix();
    State2 turned = u;
    const auto turn = [&](const Eigen::Vector2d& x, std::size_t ex, std::size_t ey) {
      const Eigen::Vector2d d = q * (x + Eigen::Vector2d(u[ex], u[ey])) - x;
      turned[ex] = d.x();
      turned[ey] = d.y();
    };
    for (const std::size_t i : live_points(body)) turn(plane(body.position(i)), i, n + i);
    for (std::size_t c = 0; c < body.defects.inclusions.size(); ++c) {
      const std::size_t dof = membrane.inclusion_dof(c);
      turn(center_of(body.defects.inclusions[c]), dof, dof + 1);
      turned[dof + 2] += angle * gyration_of(body.defects.inclusions[c]);
    }
    const double energy = membrane.strain_energy(u);
    EXPECT_NEAR(membrane.strain_energy(turned), energy, 1e-11 * energy) << "seed " << seed;  // 1e-15 measured
    const State2 force2 = force_of(membrane, turned);
    for (const std::size_t i : live_points(body)) {
      const Eigen::Vector2d expected = q * Eigen::Vector2d(force[i], force[n + i]);
      EXPECT_LT((expected - Eigen::Vector2d(force2[i], force2[n + i])).norm(), 1e-11 * largest(force))
          << seed;
    }
  }
}

/// Quarter turn or reflection of the plane: keeps the lattice.
struct Symmetry {
  Eigen::Matrix2d q;

  [[nodiscard]] Point operator()(const Point& p) const {
    const Eigen::Vector2d x = q * plane(p);
    return {x.x(), x.y(), 0};
  }
  [[nodiscard]] Shape operator()(const Shape& shape) const {
    if (const auto* disc = std::get_if<Disc>(&shape)) return Disc{(*this)(disc->center), disc->radius};
    const Box& box = std::get<Box>(shape);
    const Eigen::Vector2d half = (q * plane(box.half_size)).cwiseAbs();
    const Point c = (*this)(box.center);
    return rectangle(c[0], c[1], half.x(), half.y());
  }
};

TEST_P(Symmetric, ForceFollowsReflectionsAndQuarterTurnsOfTheBody) {
  const std::vector<Symmetry> symmetries = {{Eigen::Matrix2d{{0, -1}, {1, 0}}},
                                            {Eigen::Matrix2d{{-1, 0}, {0, 1}}}};
  for (unsigned seed = 1; seed <= 10; ++seed)
    for (const Symmetry& image : symmetries) {
      Random random(seed);
      const LatticeBodyInput in = random_body(random, {.inclusions = false, .ghosts = false});
      LatticeBodyInput moved = in;
      moved.shape = image(in.shape);
      for (Shape& hole : moved.defects.holes) hole = image(hole);
      for (Segment& crack : moved.defects.cracks) crack = {image(crack.a), image(crack.b)};
      Membrane membrane = make(in), other = make(moved);
      const State2 u = random_state(membrane, random);
      const std::size_t n = membrane.body().size();
      const auto partner = [&](std::size_t i) {
        const Point x = image(membrane.body().position(i)),
                    first = other.body().on_lattice()->lattice.position(Cell{0, 0, 0});
        const double d = other.body().spacing;
        return other.body().on_lattice()->lattice.index({static_cast<int>(std::lround((x[0] - first[0]) / d)),
                                                         static_cast<int>(std::lround((x[1] - first[1]) / d)),
                                                         0});
      };
      State2 v(other.dofs(), 0.0);
      ASSERT_EQ(other.points(), membrane.points());
      for (const std::size_t i : membrane.body().points) {
        const Eigen::Vector2d d = image.q * Eigen::Vector2d(u[i], u[n + i]);
        v[partner(i)] = d.x();
        v[other.body().size() + partner(i)] = d.y();
      }
      const State2 force = force_of(membrane, u), image_force = force_of(other, v);
      for (const std::size_t i : membrane.body().points) {
        const Eigen::Vector2d expected = image.q * Eigen::Vector2d(force[i], force[n + i]);
        const std::size_t j = partner(i);
        const Eigen::Vector2d found(image_force[j], image_force[other.body().size() + j]);
        ASSERT_LT((expected - found).norm(), 1e-10 * largest(force))
            << "seed " << seed;  // rounding of the weights
      }
    }
}

}  // namespace
}  // namespace riven::testing
