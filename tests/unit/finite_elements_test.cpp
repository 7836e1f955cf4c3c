#include "fem/finite_elements.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <numeric>

#include "base/error.hpp"
#include "support/finite_element_bodies.hpp"
#include "support/tangents.hpp"

namespace riven::testing {
namespace {

using Eigen::Matrix3d;

double largest(const std::vector<double>& v) {
  return std::abs(
      *std::max_element(v.begin(), v.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
}

/// Stress of a homogeneous deformation, from the law alone.
Matrix3d stress_of(const Material& material, int dimension, Plane plane, const Matrix3d& f) {
  Matrix3d stress = Matrix3d::Zero();
  if (dimension == 3 || plane == Plane::strain) return material.solid(f).stress;
  stress.topLeftCorner<2, 2>() = material.plane_stress(f.topLeftCorner<2, 2>()).stress;
  return stress;
}

/// A law for every way that elements treat: with a volumetric part, with one energy for all, incompressible.
struct Way {
  std::string law;
  Plane plane;
  std::optional<Dilatation> dilatation;
  bool incompressible = false;

  [[nodiscard]] Material material() const {
    const auto& cases = law_cases();
    const auto found =
        std::find_if(cases.begin(), cases.end(), [this](const LawCase& c) { return c.name == law; });
    return incompressible ? found->material(2.5) : found->compressible(2.5);
  }
};

const std::vector<Way>& ways() {
  static const std::vector<Way> all{{"mooney_rivlin", Plane::strain, {}},
                                    {"yeoh_cubic", Plane::strain, Dilatation::full},
                                    {"ogden", Plane::strain, Dilatation::mean},
                                    {"mooney_rivlin", Plane::strain, Dilatation::selective},
                                    {"compressible_neo_hookean", Plane::strain, {}},
                                    {"st_venant_kirchhoff", Plane::stress, {}},
                                    {"mooney_rivlin", Plane::stress, {}},
                                    {"neo_hookean", Plane::stress, {}, true},
                                    {"linear_elastic", Plane::strain, {}}};
  return all;
}

/// Runs body(shape, way) for all elements and ways; in space the planes make no difference, and there are no
/// sheets.
template <class Body>
void for_all(const Body& body) {
  for (const ElementShape shape : element_shapes())
    for (const Way& way : ways()) {
      if (dimension_of(shape) == 3 && (way.incompressible || way.plane == Plane::stress)) continue;
      SCOPED_TRACE(name_of(shape) + " " + way.law);
      body(shape, way);
    }
}

// A homogeneous deformation of any size has the law's stress in every element of a distorted mesh, and pulls
// at no node inside; on the faces forces are stress times area.
TEST(FiniteElements, PassThePatchTest) {
  Random random(1);
  for_all([&](ElementShape shape, const Way& way) {
    const int dimension = dimension_of(shape);
    const auto model =
        elements_of(distorted(shape, random, false), way.material(), way.plane, way.dilatation);
    const Matrix3d g = random_gradient_in(random, dimension, 0.2), f = Matrix3d::Identity() + g;
    const auto u = moved(*model, g, 0, random);
    const auto force = force_in(*model, u);
    const auto inside = inner_entries(model->mesh());
    ASSERT_FALSE(inside.empty());
    for (const std::size_t i : inside) EXPECT_LT(std::abs(force[i]), 1e-12 * largest(force));
    const Matrix3d stress = stress_of(way.material(), dimension, way.plane, f);
    for (const ModelField& field : model->fields(u))
      for (std::size_t n = 0; n < model->points() && field.name == "nominal_stress"; ++n) {
        const Matrix3d own =
            Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(field.values.data() + 9 * n);
        ASSERT_LT((own - stress).norm(), 1e-11 * stress.norm());
      }
    // Moments of the forces: sum of f_i x_J = -P_iJ V.
    Matrix3d moment = Matrix3d::Zero();
    for (std::size_t i = 0; i < force.size(); ++i)
      moment.row(static_cast<Eigen::Index>(i / model->points())) -=
          force[i] * Eigen::RowVector3d(model->place(i).data());
    const double volume = dimension == 2 ? 0.7 : 1;
    EXPECT_LT((moment - volume * stress).topLeftCorner(dimension, dimension).norm(), 1e-12 * stress.norm());
  });
}

TEST(FiniteElements, ForceIsMinusTheGradientOfTheEnergy) {
  Random random(2);
  for_all([&](ElementShape shape, const Way& way) {
    const auto model = elements_of(distorted(shape, random), way.material(), way.plane, way.dilatation);
    const auto u = moved(*model, random_gradient_in(random, dimension_of(shape), 0.15), 0.02, random);
    const auto direction = moved(*model, Matrix3d::Zero(), 1, random);
    const auto force = force_in(*model, u);
    const double work = -std::inner_product(force.begin(), force.end(), direction.begin(), 0.0);
    const auto energy = [&](double t) {
      auto there = u;
      for (std::size_t i = 0; i < u.size(); ++i) there[i] += t * direction[i];
      return model->strain_energy(there);
    };
    // Rounding of the energy over the step.
    EXPECT_NEAR(derivative(energy, 0, 1e-4), work, 1e-11 * energy(0) / 1e-4 + 1e-9 * std::abs(work));
  });
}

TEST(FiniteElements, TangentIsThatOfTheForce) {
  Random random(3);
  for_all([&](ElementShape shape, const Way& way) {
    const auto model = elements_of(distorted(shape, random), way.material(), way.plane, way.dilatation);
    const auto u = moved(*model, random_gradient_in(random, dimension_of(shape), 0.15), 0.02, random);
    expect_tangent_of_force(*model, u, moved(*model, Matrix3d::Zero(), 1, random), 1e-4);
  });
}

// Rotation after deformation turns forces and leaves the energy; translation does nothing.
TEST(FiniteElements, DoNotSeeRigidMotions) {
  Random random(4);
  for_all([&](ElementShape shape, const Way& way) {
    if (!way.material().objective()) return;
    const int dimension = dimension_of(shape);
    const auto model = elements_of(distorted(shape, random), way.material(), way.plane, way.dilatation);
    const auto u = moved(*model, random_gradient_in(random, dimension, 0.15), 0.02, random);
    const auto force = force_in(*model, u);
    Matrix3d turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    if (dimension == 3)
      turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -2).normalized()).toRotationMatrix() * turn;
    auto turned = u;
    const std::size_t nodes = model->points();
    const auto vector = [&](const std::vector<double>& of, std::size_t n) {
      Eigen::Vector3d v = Eigen::Vector3d::Zero();
      for (int d = 0; d < dimension; ++d) v(d) = of[static_cast<std::size_t>(d) * nodes + n];
      return v;
    };
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), moment = sum;
    for (std::size_t n = 0; n < nodes; ++n) {
      const Eigen::Vector3d x(model->mesh().node[n].data()), y = turn * (x + vector(u, n)) - x;
      for (int d = 0; d < dimension; ++d) turned[static_cast<std::size_t>(d) * nodes + n] = y(d) + 0.3;
      sum += vector(force, n);
      moment += (x + vector(u, n)).cross(vector(force, n));
    }
    EXPECT_LT(sum.norm(), 1e-12 * largest(force));
    EXPECT_LT(moment.norm(), 1e-12 * largest(force));
    // The bulk modulus is 30 times the shear modulus: what rounding does to J counts as much.
    EXPECT_NEAR(model->strain_energy(turned), model->strain_energy(u), 1e-11 * model->strain_energy(u));
    const auto there = force_in(*model, turned);
    for (std::size_t n = 0; n < nodes; ++n)
      EXPECT_LT((vector(there, n) - turn * vector(force, n)).norm(), 1e-11 * largest(force));
  });
}

// Nothing but rigid motions is free of stiffness.
TEST(FiniteElements, HaveNoSpuriousModes) {
  for_all([&](ElementShape shape, const Way& way) {
    Random random(5);
    const auto model = elements_of(distorted(shape, random), way.material(), way.plane, way.dilatation);
    const std::vector<double> rest(model->dofs(), 0.0);
    static_cast<void>(force_in(*model, rest));
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(assembled(*model, rest), Eigen::EigenvaluesOnly)
            .eigenvalues();
    const long rigid = dimension_of(shape) == 2 ? 3 : 6;
    EXPECT_LT(values.head(rigid).cwiseAbs().maxCoeff(), 1e-12 * values.maxCoeff());
    EXPECT_GT(values(rigid), 1e-4 * values.maxCoeff());
  });
}

TEST(FiniteElements, BoundTheRowsOfTheTangent) {
  Random random(6);
  for_all([&](ElementShape shape, const Way& way) {
    const auto model = elements_of(distorted(shape, random), way.material(), way.plane, way.dilatation);
    const auto u = moved(*model, random_gradient_in(random, dimension_of(shape), 0.15), 0.02, random);
    static_cast<void>(force_in(*model, u));
    const Eigen::MatrixXd k = assembled(*model, u);
    std::vector<double> bound(model->dofs());
    model->stiffness_bound(u, bound);
    const Eigen::VectorXd rows = k.cwiseAbs().rowwise().sum();
    for (std::size_t i = 0; i < bound.size(); ++i) {
      EXPECT_GE(bound[i], rows(static_cast<Eigen::Index>(i)) * (1 - 1e-12));
      EXPECT_LE(bound[i], 4 * rows(static_cast<Eigen::Index>(i)));  // not useless
    }
  });
}

TEST(FiniteElements, HaveTheirMassInPositiveParts) {
  Random random(7);
  for (const ElementShape shape : element_shapes()) {
    const auto model = elements_of(distorted(shape, random, false),
                                   Way{"neo_hookean", Plane::stress, {}}.material(), Plane::strain);
    std::vector<double> mass(model->dofs());
    model->mass(mass);
    const auto dimension = static_cast<std::size_t>(model->body().dimension);
    EXPECT_GT(*std::min_element(mass.begin(), mass.end()), 0);
    EXPECT_NEAR(std::accumulate(mass.begin(), mass.end(), 0.0),
                2.5 * static_cast<double>(dimension) * (dimension == 2 ? 0.7 : 1), 1e-13);
    for (std::size_t n = 0; n < model->points(); ++n) EXPECT_EQ(mass[n], mass[model->points() + n]);
  }
}

TEST(FiniteElements, GiveTheSameBitsOnAnyNumberOfThreads) {
  const int before = omp_get_max_threads();
  for_all([&](ElementShape shape, const Way& way) {
    std::vector<std::vector<double>> results;
    for (const int threads : {1, 2, 5}) {
      omp_set_num_threads(threads);
      Random random(8);
      const auto model =
          elements_of(distorted(shape, random, true, 17), way.material(), way.plane, way.dilatation);
      const auto u = moved(*model, random_gradient_in(random, dimension_of(shape), 0.1), 0.004, random);
      auto& result = results.emplace_back(force_in(*model, u));
      result.push_back(model->strain_energy(u));
      std::vector<double> bound(model->dofs());
      model->stiffness_bound(u, bound);
      result.insert(result.end(), bound.begin(), bound.end());
    }
    EXPECT_EQ(results[0], results[1]);
    EXPECT_EQ(results[0], results[2]);
  });
  omp_set_num_threads(before);
}

// Elements of two materials: those of one that is stretched alone carry its stress.
TEST(FiniteElements, KnowTheirMaterials) {
  MeshBody mesh = make_mesh(ElementShape::q4, {40, 1}, 1, [](const Point& x) { return x; });
  for (std::size_t e = 0; e < 40; ++e) mesh.material.push_back(e % 3 == 0 ? 1 : 0);
  const Material soft = Way{"neo_hookean", Plane::strain, {}}.material();
  Material stiff = soft;
  stiff.law = NeoHookean{5};
  stiff.density = 10;
  FiniteElements model(std::move(mesh), {.materials = {soft, stiff}, .plane = Plane::stress});
  Random random(9);
  const auto u = moved(model, 0.1 * Matrix3d::Identity(), 0, random);
  const double low = soft.plane_stress(1.1 * Eigen::Matrix2d::Identity()).energy,
               high = stiff.plane_stress(1.1 * Eigen::Matrix2d::Identity()).energy;
  EXPECT_NEAR(model.strain_energy(u), (26 * low + 14 * high) / 40, 1e-12);
  std::vector<double> mass(model.dofs());
  model.mass(mass);
  EXPECT_NEAR(std::accumulate(mass.begin(), mass.end(), 0.0), 2 * (26 * 2.5 + 14 * 10) / 40, 1e-12);
}

TEST(FiniteElements, NameElementsThatAreTurnedOver) {
  MeshBody mesh = make_mesh(ElementShape::q4, {2, 2}, 1, [](const Point& x) { return x; });
  const auto model =
      elements_of(mesh, Way{"compressible_neo_hookean", Plane::strain, {}}.material(), Plane::strain);
  std::vector<double> u(model->dofs(), 0.0), force(model->dofs());
  EXPECT_FALSE(model->inspect(u));
  for (const std::uint32_t n : model->mesh().nodes_on(1)) u[n] = -0.7;  // right edge, beyond its neighbours
  const auto seen = model->inspect(u), hit = model->internal_force(u, force);
  ASSERT_TRUE(seen && hit);
  EXPECT_EQ(seen->what, "element 2 is turned inside out");
  EXPECT_EQ(hit->what, seen->what);
  EXPECT_EQ(seen->position, (Point{0.75, 0.25, 0}));
  std::swap(mesh.corner[0], mesh.corner[1]);
  EXPECT_THROW(elements_of(mesh, Way{"neo_hookean", Plane::stress, {}}.material(), Plane::strain),
               InputError);
}

TEST(FiniteElements, RefuseWhatHasNoMeaning) {
  const MeshBody mesh = make_mesh(ElementShape::q4, {1, 1}, 1, [](const Point& x) { return x; });
  const Material rubber = law_cases().front().material(), solid = law_cases().back().compressible();
  EXPECT_THROW(elements_of(mesh, rubber, Plane::strain), InputError);
  EXPECT_THROW(elements_of(mesh, solid, Plane::strain, Dilatation::mean), InputError);
  EXPECT_THROW(elements_of(mesh, solid, Plane::strain, Dilatation::selective), InputError);
  EXPECT_THROW(elements_of(mesh, law_cases().front().compressible(), Plane::strain, Dilatation::linear),
               InputError);
  for (const Dilatation dilatation : {Dilatation::mean, Dilatation::selective})
    EXPECT_THROW(elements_of(mesh, law_cases().front().compressible(), Plane::stress, dilatation),
                 InputError);
}

// ---- accuracy ----

/// Displacements of a linear problem: those of the faces prescribed, the others in equilibrium.
std::vector<double> solve_with_faces(FiniteElements& model, std::vector<double> u,
                                     const std::vector<std::size_t>& free) {
  const std::vector<double> rest(model.dofs(), 0.0);
  static_cast<void>(force_in(model, rest));
  const Eigen::MatrixXd k = assembled(model, rest);
  for (const std::size_t i : free) u[i] = 0;
  const Eigen::VectorXd load = -k * Eigen::Map<const Eigen::VectorXd>(u.data(), k.rows());
  const auto n = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd inner(n, n);
  Eigen::VectorXd right(n);
  for (Eigen::Index r = 0; r < n; ++r) {
    const auto row = static_cast<Eigen::Index>(free[static_cast<std::size_t>(r)]);
    right(r) = load(row);
    for (Eigen::Index c = 0; c < n; ++c)
      inner(r, c) = k(row, static_cast<Eigen::Index>(free[static_cast<std::size_t>(c)]));
  }
  const Eigen::VectorXd x = inner.ldlt().solve(right);
  for (Eigen::Index r = 0; r < n; ++r) u[free[static_cast<std::size_t>(r)]] = x(r);
  return u;
}

/// Mean square error of the displacement against the gradient of exp(x) sin(y), which is in equilibrium
/// without body force, on a mesh whose inside is bent.
double error_of(ElementShape shape, int along) {
  const auto exact = [](double x, double y) {
    return Eigen::Vector2d(std::exp(x) * std::sin(y), std::exp(x) * std::cos(y));
  };
  const auto bent = [](const Point& x) {
    const double bump = 0.3 * x[0] * (1 - x[0]) * x[1] * (1 - x[1]);
    return Point{x[0] + bump, x[1] - 2 * bump, 0};
  };
  const auto model = elements_of(make_mesh(shape, {along, along}, 1, bent),
                                 Way{"linear_elastic", Plane::strain, {}}.material(), Plane::strain);
  const MeshBody& mesh = model->mesh();
  std::vector<double> u(model->dofs());
  for (std::size_t n = 0; n < mesh.node.size(); ++n)
    for (std::size_t d = 0; d < 2; ++d)
      u[d * mesh.node.size() + n] = exact(mesh.node[n][0], mesh.node[n][1])(static_cast<Eigen::Index>(d));
  u = solve_with_faces(*model, u, inner_entries(mesh));
  double square = 0;
  with_element(shape, [&]<class E>(E) {
    for (std::size_t e = 0; e < mesh.elements(); ++e)
      for (const auto& point : gauss<2, 3>()) {
        if constexpr (E::D == 2) {
          const auto value =
              E::at(E::N == 3 ? Eigen::Vector2d(Eigen::Vector2d::Constant(1.0 / 3)) : point.at).value;
          Eigen::Vector2d x = Eigen::Vector2d::Zero(), found = x;
          for (int a = 0; a < E::N; ++a) {
            const std::size_t n = mesh.nodes(e)[static_cast<std::size_t>(a)];
            x += value(a) * Eigen::Vector2d(mesh.node[n][0], mesh.node[n][1]);
            found += value(a) * Eigen::Vector2d(u[n], u[mesh.node.size() + n]);
          }
          square += (found - exact(x(0), x(1))).squaredNorm() * point.weight;
        }
      }
  });
  return std::sqrt(square / 4 / static_cast<double>(mesh.elements()));
}

// Linear elements are of second order in the displacement, serendipity ones of third.
TEST(FiniteElements, ConvergeAtTheirOrder) {
  struct Expected {
    ElementShape shape;
    double order;
  };
  for (const auto [shape, order] :
       {Expected{ElementShape::t3, 2}, Expected{ElementShape::q4, 2}, Expected{ElementShape::q8, 3}}) {
    const double coarse = error_of(shape, 4), fine = error_of(shape, 8);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.15) << name_of(shape) << " " << coarse << " " << fine;
  }
}

/// Tip of a cantilever 4 by 1 in plane strain under a dead force across its end, linear, over the beam's.
double tip_of_cantilever(ElementShape shape, int across, Dilatation dilatation, double bulk) {
  Material rubber = law_cases().front().compressible();  // shear modulus 1
  rubber.volumetric->bulk_modulus = bulk;
  const auto model = elements_of(make_mesh(shape, {4 * across, across}, 1,
                                           [](const Point& x) {
                                             return Point{4 * x[0], x[1], 0};
                                           }),
                                 rubber, Plane::strain, dilatation);
  const std::vector<double> rest(model->dofs(), 0.0);
  static_cast<void>(force_in(*model, rest));
  Eigen::MatrixXd k = assembled(*model, rest);
  const auto nodes = static_cast<Eigen::Index>(model->points());
  Eigen::VectorXd load = Eigen::VectorXd::Zero(k.rows());
  for (const NodeShare& share : model->mesh().face_shares(1)) load(nodes + share.node) = share.extent;
  for (const std::uint32_t n : model->mesh().nodes_on(0))
    for (const Eigen::Index i : {Eigen::Index(n), nodes + n}) {
      k.row(i).setZero();
      k.col(i).setZero();
      k(i, i) = 1;
      load(i) = 0;
    }
  const Eigen::VectorXd u = k.ldlt().solve(load);
  double tip = 0;
  for (const std::uint32_t n : model->mesh().nodes_on(1)) tip = std::max(tip, u(nodes + n));
  return tip;
}

// Nearly incompressible: the full rule locks, a mean dilatation does not, and nothing is lost where there is
// nothing to lock.
TEST(FiniteElements, DoNotLockWithAMeanDilatation) {
  const double exact = tip_of_cantilever(ElementShape::q8, 8, Dilatation::mean, 1e4);
  const double mean = tip_of_cantilever(ElementShape::q4, 8, Dilatation::mean, 1e4),
               full = tip_of_cantilever(ElementShape::q4, 8, Dilatation::full, 1e4);
  EXPECT_LT(full, 0.5 * exact);
  EXPECT_NEAR(mean, exact, 0.06 * exact);  // the bending error of bilinear elements
  EXPECT_NEAR(tip_of_cantilever(ElementShape::q4, 8, Dilatation::full, 1),
              tip_of_cantilever(ElementShape::q4, 8, Dilatation::mean, 1), 0.05 * exact);
}

}  // namespace
}  // namespace riven::testing
