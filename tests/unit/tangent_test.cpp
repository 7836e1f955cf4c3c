// The tangents of all models that have one, on random bodies in random states.

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <memory>

#include "body/listed_body.hpp"
#include "peridynamics/correspondence.hpp"
#include "peridynamics/lps.hpp"
#include "peridynamics/membrane.hpp"
#include "peridynamics/pmb.hpp"
#include "support/bodies.hpp"
#include "support/correspondence_reference.hpp"
#include "support/laws.hpp"
#include "support/pmb_bodies.hpp"
#include "support/states.hpp"
#include "support/tangents.hpp"

namespace riven::testing {
namespace {

/// A model in a state.
struct Sample {
  std::unique_ptr<PointModel> model;
  std::vector<double> u;
};

struct TangentCase {
  const char* name;
  std::function<Sample(Random&)> make;
};

Sample membrane(Random& random, const LawCase& law, bool lists) {
  const Body body = make_lattice_body(random_body(random));
  const double stabilisation = random.chance(0.3) ? 0 : 4;
  auto model = std::make_unique<Membrane>(lists ? listed(body) : body, law.material(), stabilisation);
  State2 u = random_state(*model, random);
  return {std::move(model), std::move(u)};
}

Body cells(Random& random, bool lists) {
  LatticeBodyInput in = random_cells(random, random.integer(2, 3), true);
  if (in.dimension == 3) in.shape = cells_of({5, 5, 4}).shape;
  in.horizon = std::max(in.horizon, 2.1 * in.spacing);  // LPS wants more directions than the nearest ones
  if (in.dimension == 3) in.horizon = std::min(in.horizon, 2.3 * in.spacing);
  const Body body = make_lattice_body(in);
  return lists ? listed(body) : body;
}

template <class Model, class Settings>
Sample spring_model(Random& random, bool lists, const Settings& settings) {
  auto model = std::make_unique<Model>(cells(random, lists), settings);
  auto u = random_displacements(*model, random, 0.08);
  return {std::move(model), std::move(u)};
}

/// A new model is one more row.
const std::vector<TangentCase>& cases() {
  static const std::vector<TangentCase> all = [] {
    std::vector<TangentCase> rows;
    for (const bool lists : {false, true}) {
      rows.push_back(
          {lists ? "MembraneListed" : "Membrane", [lists](Random& random) {
             const auto laws = unit_laws();
             return membrane(
                 random, laws[static_cast<std::size_t>(random.integer(0, static_cast<int>(laws.size()) - 1))],
                 lists);
           }});
      rows.push_back({lists ? "CorrespondenceListed" : "Correspondence", [lists](Random& random) {
                        const Body body = cells(random, lists);
                        CorrespondenceSettings settings =
                            random_correspondence(random, body.dimension, false);
                        settings.stabilisation = std::array{
                            Stabilisation::energy, Stabilisation::published,
                            Stabilisation::bond_associated}[static_cast<std::size_t>(random.integer(0, 2))];
                        auto model = std::make_unique<Correspondence>(body, settings);
                        auto u = random_displacements(*model, random, 0.03);
                        return Sample{std::move(model), std::move(u)};
                      }});
      rows.push_back({lists ? "PmbListed" : "Pmb", [lists](Random& random) {
                        return spring_model<Pmb>(random, lists,
                                                 PmbSettings{.youngs_modulus = 3, .density = 1});
                      }});
      rows.push_back({lists ? "LpsListed" : "Lps", [lists](Random& random) {
                        return spring_model<Lps>(
                            random, lists,
                            LpsSettings{.youngs_modulus = 3,
                                        .poissons_ratio = random.between(-0.3, 0.45),
                                        .density = 1,
                                        .plane = random.chance(0.5) ? Plane::strain : Plane::stress});
                      }});
    }
    return rows;
  }();
  return all;
}

class EveryTangent : public ::testing::TestWithParam<std::size_t> {};

TEST_P(EveryTangent, IsTheDerivativeOfTheForce) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Sample sample = cases()[GetParam()].make(random);
    std::vector<double> direction(sample.u.size());
    for (const std::size_t i : bonded_points(sample.model->body()))
      for (int axis = 0; axis < sample.model->body().dimension; ++axis)
        direction[static_cast<std::size_t>(axis) * sample.model->body().size() + i] = random.between(-1, 1);
    for (std::size_t i = sample.model->inclusion_dof(0); i < direction.size(); ++i)
      direction[i] = random.between(-1, 1);
    expect_tangent_of_force(*sample.model, sample.u, direction, 1e-4 * sample.model->spacing());
  }
}

INSTANTIATE_TEST_SUITE_P(Models, EveryTangent, ::testing::Range(std::size_t{0}, cases().size()),
                         [](const auto& row) { return std::string(cases()[row.param].name); });

}  // namespace
}  // namespace riven::testing
