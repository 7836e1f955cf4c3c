// Statics of sheets that nobody drew: whatever the holes, slots, slits and inclusions, a relaxation either
// ends in a sound equilibrium or says where, when and why it stopped.

#include <gtest/gtest.h>

#include <limits>

#include "solver/dynamic_relaxation.hpp"
#include "support/bodies.hpp"
#include "support/laws.hpp"
#include "support/loads.hpp"
#include "support/states.hpp"

namespace riven::testing {
namespace {

/// Displacement of a bond's far end.
Eigen::Vector2d far_displacement(const Membrane& membrane, const MembraneBond& bond, const State2& u) {
  if (bond.inclusion < 0) return {u[bond.end], u[membrane.body().size() + bond.end]};
  const auto inclusion = static_cast<std::size_t>(bond.inclusion);
  const std::size_t dof = membrane.inclusion_dof(inclusion);
  const Eigen::Rotation2Dd turn(u[dof + 2] / gyration_of(membrane.body().defects.inclusions[inclusion]));
  const Eigen::Vector2d arm = plane(membrane.body().interface[bond.end - membrane.body().size()].end) -
                              center_of(membrane.body().defects.inclusions[inclusion]);
  return Eigen::Vector2d(u[dof], u[dof + 1]) + turn * arm - arm;
}

/// Smallest determinant of the deformation gradient over all points, by plain least squares over their bonds:
/// not by the weighted averages that `inspect` looks at. Bonds nearly on one line tell nothing of a gradient.
double least_determinant(const Membrane& membrane, const State2& u) {
  const std::size_t n = membrane.body().size();
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : membrane.body().points) {
    Eigen::Matrix2d moment = Eigen::Matrix2d::Zero(), shape = moment;
    membrane.for_each_bond(i, [&](const MembraneBond& bond) {
      const Eigen::Vector2d& xi = bond.reference;
      const Eigen::Vector2d y = xi + far_displacement(membrane, bond, u) - Eigen::Vector2d(u[i], u[n + i]);
      moment += y * xi.transpose();
      shape += xi * xi.transpose();
    });
    const double scale = 0.5 * shape.trace();
    if (shape.determinant() > 0.1 * scale * scale)
      least = std::min(least, moment.determinant() / shape.determinant());
  }
  return least;
}

struct SheetLoad {
  std::string name;
  FaceLoads loads;
  Faces mirrored;
};
void PrintTo(const SheetLoad& load, std::ostream* out) {
  *out << load.name;
}

std::string loading_name(const ::testing::TestParamInfo<SheetLoad>& info) {
  return info.param.name;
}

class RandomBodies : public ::testing::TestWithParam<SheetLoad> {};
INSTANTIATE_TEST_SUITE_P(Loadings, RandomBodies,
                         ::testing::Values(SheetLoad{"equibiaxial", equibiaxial(), all_edges()},
                                           SheetLoad{"planar", planar(), all_edges()},
                                           SheetLoad{"uniaxial", uniaxial(), Faces(0b0011)}),
                         loading_name);

TEST_P(RandomBodies, StretchToThreeOrSayWhyNot) {
  constexpr unsigned kBodies = 24;
  int converged = 0, stopped = 0;
  double least = std::numeric_limits<double>::infinity();
  for (unsigned seed = 1; seed <= kBodies; ++seed) {
    Random random(seed);
    LatticeBodyInput in = random_body(random, {.ghosts = false});
    in.mirrored = GetParam().mirrored;
    Membrane membrane(make_lattice_body(in), unit_laws()[0].material(), 4);
    Constraints constraints = constrain(membrane, GetParam().loads);
    Observer silent;
    try {
      const State state = relax(membrane, constraints, {.targets = {3}, .max_iterations = 5000}, silent);
      const double determinant = least_determinant(membrane, state.u);
      EXPECT_GT(determinant, 0) << "seed " << seed;
      least = std::min(least, determinant);
      ++converged;
    } catch (const SolverFailure& failure) {
      const std::string what = failure.what();
      for (const char* part : {"no equilibrium beyond ", " at (", "the sheet has folded over itself"})
        EXPECT_NE(what.find(part), std::string::npos) << "seed " << seed << ": " << what;
      ++stopped;
    }
  }
  RecordProperty("converged", converged);
  RecordProperty("stopped", stopped);
  RecordProperty("least_determinant_percent", static_cast<int>(100 * least));
  // Measured: equibiaxial and planar all converge; uniaxial, seeds 1 and 11 fold where the faces of a slit,
  // the flank of an inclusion, are compressed to less than half their length. Of 100 bodies 0, 0 and 3 stop.
  EXPECT_LE(stopped, GetParam().name == "uniaxial" ? 2 : 0);
}

}  // namespace
}  // namespace riven::testing
