// Elements of materials that relax: against the point's law, tangents, what is remembered and when.

#include <gtest/gtest.h>
#include <omp.h>

#include <numeric>

#include "base/error.hpp"
#include "fem/finite_elements.hpp"
#include "material/viscoelastic.hpp"
#include "support/finite_element_bodies.hpp"
#include "support/tangents.hpp"

namespace riven::testing {
namespace {

using Eigen::Matrix3d;

constexpr unsigned kSeed = 20261130;

Material rubber(bool incompressible = false) {
  Material material{.name = "rubber", .law = MooneyRivlin{1, 0.5}, .density = 2.5};
  if (!incompressible) material.volumetric = Volumetric{20};
  material.relaxation = {{0.3, 0.7}, {0.2, 5}};
  return material;
}

struct Way {
  Plane plane;
  std::optional<Dilatation> dilatation;
  bool incompressible = false;
};

/// Runs body(shape, way) for all elements and ways to use the law.
template <class Body>
void for_all(const Body& body) {
  for (const ElementShape shape : element_shapes())
    for (const Way& way : {Way{Plane::strain, Dilatation::full}, Way{Plane::strain, Dilatation::mean},
                           Way{Plane::stress, {}}, Way{Plane::stress, {}, true}}) {
      if (dimension_of(shape) == 3 && way.plane == Plane::stress) continue;
      SCOPED_TRACE(::testing::Message()
                   << name_of(shape) << ", plane " << static_cast<int>(way.plane)
                   << (way.dilatation == Dilatation::mean ? ", mean" : "")
                   << (way.incompressible ? ", incompressible" : "") << ", seed " << kSeed);
      body(shape, way);
    }
}

std::unique_ptr<FiniteElements> block(ElementShape shape, const Way& way, Random& random) {
  return elements_of(distorted(shape, random), rubber(way.incompressible), way.plane, way.dilatation);
}

/// Through two states, the second half a second after the first.
void give_past(FiniteElements& model, Random& random) {
  for (const double dt : {0.0, 0.5}) {
    model.go_on(dt);
    auto u = moved(model, random_gradient_in(random, model.mesh().dimension(), 0.2), 0.01, random);
    std::vector<double> force = force_in(model, u);
    static_cast<void>(model.advance(u, force));
  }
}

TEST(ViscousElements, TangentIsTheDerivativeOfTheStepsForce) {
  Random random(kSeed);
  for_all([&](ElementShape shape, const Way& way) {
    const auto model = block(shape, way, random);
    give_past(*model, random);
    model->go_back();
    model->go_on(0.8);
    const auto u = moved(*model, random_gradient_in(random, model->mesh().dimension(), 0.2), 0.01, random);
    expect_tangent_of_force(*model, u, moved(*model, Matrix3d::Zero(), 1, random), 1e-4);
  });
}

TEST(ViscousElements, HomogeneousStatesAreThoseOfThePoint) {
  Random random(kSeed);
  for_all([&](ElementShape shape, const Way& way) {
    const auto model = block(shape, way, random);
    const Viscoelastic law(rubber(way.incompressible));
    std::vector<double> memory(law.memory()), next = memory;
    law.forget(memory.data());
    const int dimension = model->mesh().dimension();
    const std::vector<std::size_t> inner = inner_entries(model->mesh());
    for (const double dt : {0.0, 0.3, 2.0}) {
      const Matrix3d g = random_gradient_in(random, dimension, 0.2);
      const auto u = moved(*model, g, 0, random);
      model->go_on(dt);
      std::vector<double> force = force_in(*model, u);
      const Viscoelastic::Step step = law.step(memory.data(), dt);
      Matrix3d f = Matrix3d::Identity() + g;
      if (dimension == 2 && way.plane == Plane::stress)
        f(2, 2) = law.thickness_stretch(f.topLeftCorner<2, 2>(), step);
      Matrix3d stress;
      if (way.incompressible) {
        stress.setZero();
        stress.topLeftCorner<2, 2>() = law.plane_stress(f.topLeftCorner<2, 2>(), step).stress;
      } else {
        stress = law.solid(f, step).stress;
      }
      const double work = law.remember(memory.data(), dt, f, next.data());
      const std::vector<double> lumped = model->mesh().lumped_volumes();
      const double volume = std::accumulate(lumped.begin(), lumped.end(), 0.0);
      double first_moment = 0;  // sum of f_x X = - P_xX V
      for (std::size_t n = 0; n < model->mesh().node.size(); ++n)
        first_moment += force[n] * model->mesh().node[n][0];
      EXPECT_NEAR(first_moment, -stress(0, 0) * volume, 1e-9 * 20);
      for (const std::size_t i : inner) EXPECT_NEAR(force[i], 0, 1e-10 * 20);
      EXPECT_NEAR(model->strain_energy(u), work * volume, 1e-9 * 20);
      static_cast<void>(model->advance(u, force));
      EXPECT_NEAR(model->strain_energy(u), work * volume, 1e-9 * 20);
      const ModelField fields = model->fields(u)[1];
      ASSERT_EQ(fields.name, "nominal_stress");
      for (std::size_t at = 0; at < fields.values.size(); at += 9)
        EXPECT_NEAR(fields.values[at], stress(0, 0), 1e-10 * 20);
      memory = next;
    }
  });
}

TEST(ViscousElements, TriedStatesLeaveNoTrace) {
  Random random(kSeed);
  const Way way{Plane::stress, {}};
  const auto model = block(ElementShape::q4, way, random);
  give_past(*model, random);
  const auto u = moved(*model, random_gradient_in(random, 2, 0.2), 0.01, random);
  model->go_on(0.4);
  const std::vector<double> expected = force_in(*model, u);
  const auto other = moved(*model, random_gradient_in(random, 2, 0.2), 0.01, random);
  model->go_on(3);
  EXPECT_NE(force_in(*model, other), expected);
  model->go_back();
  model->go_on(0.4);
  EXPECT_EQ(force_in(*model, u), expected);
}

TEST(ViscousElements, StagesFollowEachOther) {
  // Two stages of a step are two steps that are passed one by one.
  Random random(kSeed);
  const Way way{Plane::strain, Dilatation::mean};
  const auto model = block(ElementShape::q4, way, random);
  give_past(*model, random);
  const auto u = moved(*model, random_gradient_in(random, 2, 0.2), 0.01, random),
             v = moved(*model, random_gradient_in(random, 2, 0.2), 0.01, random);
  model->go_on(0.2);
  static_cast<void>(force_in(*model, u));
  model->go_on(0.6);
  const std::vector<double> in_stages = force_in(*model, v);
  model->go_back();
  model->go_on(0.2);
  std::vector<double> force = force_in(*model, u);
  static_cast<void>(model->advance(u, force));
  model->go_on(0.6);
  EXPECT_EQ(force_in(*model, v), in_stages);
  model->go_back();
  model->go_on(0.6);
  EXPECT_EQ(force_in(*model, v), in_stages);
}

TEST(ViscousElements, RememberWhatWasSavedOnAnyThreads) {
  Random random(kSeed), again(kSeed);
  const Way way{Plane::stress, {}};
  const auto model = block(ElementShape::q4, way, random), other = block(ElementShape::q4, way, again);
  give_past(*model, random);
  Snapshot snapshot;
  model->save(snapshot);
  other->restore(snapshot);
  const auto u = moved(*model, random_gradient_in(random, 2, 0.2), 0.01, random);
  model->go_on(0.4);
  other->go_on(0.4);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const std::vector<double> expected = force_in(*model, u);
  omp_set_num_threads(3);
  EXPECT_EQ(force_in(*other, u), expected);
  omp_set_num_threads(threads);
}

TEST(ViscousElements, RefuseLawsWithoutAPartOfTheShape) {
  Random random(kSeed);
  Material material{
      .name = "rubber", .law = StVenantKirchhoff{{.youngs_modulus = 1, .poissons_ratio = 0.3}}, .density = 1};
  material.relaxation = {{0.5, 1}};
  EXPECT_THROW(elements_of(distorted(ElementShape::q4, random), material, Plane::stress), InputError);
}

}  // namespace
}  // namespace riven::testing
