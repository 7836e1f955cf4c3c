#include "peridynamics/bond_membrane.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/lanes.hpp"
#include "base/parallel.hpp"

namespace riven {

namespace {

// Stretch of the homogeneous states that give the correction factors; the compression law holds below 1 only.
constexpr double kCorrectionStretch = 4, kCorrectionCompression = 0.5;

Eigen::Vector2d plane(const Point& p) {
  return {p[0], p[1]};
}

/// Squared cosine between two vectors.
double squared_cosine(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double dot = a.dot(b);
  return dot * dot / (a.squaredNorm() * b.squaredNorm());
}

}  // namespace

BondMembrane::BondMembrane(Body body, Material material, const BondMembraneSettings& settings)
    : BreakingModel(std::move(body), {material.density}),
      material_(std::move(material)),
      settings_(settings),
      law_(settings.zero_residual ? zero_residual_law(settings.loading) : published_law(settings.loading)),
      kernel_(bond_membrane_kernel()) {
  const Body& b = this->body();
  if (b.dimension != 2)
    throw InputError("a membrane is two-dimensional: give the box two sizes and a thickness");
  const auto* rubber = std::get_if<NeoHookean>(&material_.law);
  if (rubber == nullptr)
    throw InputError("the bond-based membrane has neo-Hookean bonds: expected law = \"neo-hookean\"");
  c0_ = rubber->c10 / (std::numbers::pi * b.thickness * b.horizon * b.horizon);
  volume_ = b.volume;
  share_.assign(b.size(), 0.0);
  for (const std::size_t i : b.points) {
    share_[i] = 1;
  }
  for (const GhostPoint& ghost : b.ghosts) {
    volume_[ghost.point] = b.volume[ghost.master];
    share_[ghost.point] = 0.5;
  }
  for (auto& factor : correction_) factor.assign(b.size(), 1.0);
  if (settings_.surface_correction) find_corrections();
  if (const LatticeBonds* on = b.on_lattice()) make_lattice_kernel(*on);
}

void BondMembrane::make_lattice_kernel(const LatticeBonds& on) {
  for (std::size_t k = 0; k < on.stencil.size(); ++k) {
    const double x = on.stencil.bond[k][0], y = on.stencil.bond[k][1], length = on.stencil.length[k];
    lattice_.stencil.push_back({on.stencil.shift[k], x, y, 1 / (length * length),
                                4 * c0_ * body().horizon / (length * length * length),
                                x * x / (length * length), y * y / (length * length)});
  }
  for (std::size_t block = 0; block < body().size() / kLanes; ++block)
    lattice_.blocks.push_back(on.bonds.kind(block));
  lattice_.masks = on.bonds.masks(0);
  lattice_.law = law_;
  lattice_.correction = {correction_[0].data(), correction_[1].data()};
  lattice_.volume = volume_.data();
  lattice_.share = share_.data();
}

BondMembrane::Bond BondMembrane::bond_between(std::size_t point, std::size_t neighbour) const {
  Bond bond;
  bond.reference = plane(body().position(neighbour)) - plane(body().position(point));
  bond.length = bond.reference.norm();
  bond.far_volume = volume_[neighbour];
  bond.correction = correction(neighbour);
  bond.end = static_cast<End>(neighbour);
  return bond;
}

BondMembrane::Bond BondMembrane::bond_to_inclusion(const InterfaceBond& at) const {
  Bond bond;
  const Eigen::Vector2d x = plane(body().position(at.point));
  bond.reference = plane(at.end) - x;
  bond.length = (plane(body().position(at.neighbour)) - x).norm();
  bond.far_volume = at.volume;
  bond.correction = correction(at.point);
  bond.end = end_of(static_cast<std::size_t>(&at - body().interface.data()));
  return bond;
}

template <class Visit>
void BondMembrane::for_each_bond(std::size_t point, const Visit& visit) const {
  body().for_each_neighbour(point, [&](std::size_t neighbour) { visit(bond_between(point, neighbour)); });
  for (const InterfaceBond& at : body().interface_of(point)) visit(bond_to_inclusion(at));
}

Eigen::Vector2d BondMembrane::correction(std::size_t point) const {
  return {correction_[0][point], correction_[1][point]};
}

double BondMembrane::bond_correction(std::size_t point, const Bond& bond) const {
  const Eigen::Vector2d mean = 0.5 * (correction(point) + bond.correction);
  return 1 / bond.reference.normalized().cwiseQuotient(mean).norm();
}

/// Factors S of the body points, then of the ghosts: energy of the local law over that of the bonds, in
/// homogeneous states along x and y (eq. (40), (63), (81) of the source, with the misprints of (61), (62)
/// corrected). A planar law is corrected along x only.
void BondMembrane::find_corrections() {
  const Loading loading = settings_.loading;
  const double stretch =
      loading == Loading::uniaxial_compression ? kCorrectionCompression : kCorrectionStretch;
  const double other = lateral_stretch(loading, stretch), exact = neo_hookean_energy(loading, stretch);
  const double c1 = std::get<NeoHookean>(material_.law).c10;
  std::array<std::vector<double>, 2> found = correction_;
  for (std::size_t axis = 0; axis < (loading == Loading::planar ? 1U : 2U); ++axis) {
    const Eigen::Vector2d f = axis == 0 ? Eigen::Vector2d(stretch, other) : Eigen::Vector2d(other, stretch);
    for (const std::size_t i : body().points) {
      double sum = 0;
      for_each_bond(i, [&](const Bond& bond) {
        const Eigen::Vector2d y = f.cwiseProduct(bond.reference);
        const double s2 = y.squaredNorm() / bond.reference.squaredNorm();
        sum += bond.far_volume * body().horizon / bond.length *
               (squared_cosine(bond.reference, y) * law_.potential(s2) + law_.e);
      });
      if (sum > 0) found[axis][i] = c1 * exact / (c0_ * sum);
    }
    for (const GhostPoint& ghost : body().ghosts) found[axis][ghost.point] = found[axis][ghost.master];
  }
  correction_ = std::move(found);
}

Eigen::Vector2d BondMembrane::deformed(std::size_t point, const Bond& bond, std::span<const double> u) const {
  return bond.reference + displacement(bond.end, u) - Eigen::Vector2d(u[point], u[body().size() + point]);
}

double BondMembrane::pull(std::size_t point, const Bond& bond, const Eigen::Vector2d& y) const {
  const double s2 = y.squaredNorm() / bond.reference.squaredNorm();
  return bond_correction(point, bond) * bond.far_volume * 4 * c0_ * body().horizon /
         std::pow(bond.length, 3) * squared_cosine(bond.reference, y) * law_.response(s2);
}

double BondMembrane::energy_density(std::size_t point, std::span<const double> u) const {
  double sum = 0;
  for_each_bond(point, [&](const Bond& bond) {
    const Eigen::Vector2d y = deformed(point, bond, u);
    const double s2 = y.squaredNorm() / bond.reference.squaredNorm();
    sum += bond_correction(point, bond) * bond.far_volume * c0_ * body().horizon / bond.length *
           (squared_cosine(bond.reference, y) * law_.potential(s2) + law_.e);
  });
  return sum;
}

double BondMembrane::family_energy(std::size_t point, std::span<const double> u) const {
  return body().volume[point] > 0 ? body().volume[point] * energy_density(point, u) : 0;
}

void BondMembrane::refit(std::span<const std::size_t> points) {
  open_blocks(points, lattice_.blocks);
}

/// Of a family of infinitely many bonds, to which the surface correction scales those of the lattice.
double BondMembrane::equal_stretch_energy(double stretch, std::size_t /*material*/,
                                          std::size_t /*other*/) const {
  const double c1 = std::get<NeoHookean>(material_.law).c10;
  return 2 * c1 * (law_.potential((1 + stretch) * (1 + stretch)) + law_.e);
}

double BondMembrane::share_left(const WholeFamily& family, const std::vector<bool>& exists,
                                std::size_t /*material*/) const {
  double left = 0, whole = 0;
  for (std::size_t k = 0; k < exists.size(); ++k) {
    const double part = family.volume[k] / family.xi[k].norm();
    whole += part;
    if (exists[k]) left += part;
  }
  return left / whole;
}

double BondMembrane::strain_energy(std::span<const double> u) {
  place_inclusions(u);
  return ordered_sum_of(body().points.size(), [&](std::size_t n) {
    const std::size_t i = body().points[n];
    return body().volume[i] * energy_density(i, u);
  });
}

/// Row sums of |tangent|: along the bond c (|(sR)'| + terms of the turning cosine), across it c |R|.
void BondMembrane::stiffness_bound(std::span<const double> u, std::span<double> bound) {
  place_inclusions(u);
  std::fill(bound.begin(), bound.end(), 0.0);
  for (const std::size_t i : body().points)
    for_each_bond(i, [&](const Bond& bond) {
      const Eigen::Vector2d y = deformed(i, bond, u);
      const double s = std::sqrt(y.squaredNorm() / bond.reference.squaredNorm());
      const double cosine2 = squared_cosine(bond.reference, y), response = std::abs(law_.response(s * s));
      const double turning = 2 * std::sqrt(cosine2 * std::max(0.0, 1 - cosine2)) * response;
      const double block = body().volume[i] * bond.far_volume * bond_correction(i, bond) * 4 * c0_ *
                           body().horizon / std::pow(bond.length, 3) *
                           (cosine2 * (std::abs(law_.stiffness(s)) + response) + turning);
      add_row(static_cast<End>(i), 2 * block, bound);
      if (is_surface(bond.end)) add_row(bond.end, 2 * block, bound);
    });
}

std::optional<Breakdown> BondMembrane::inspect(std::span<const double> u) {
  place_inclusions(u);
  for (const std::size_t i : body().points) {
    Eigen::Matrix2d shape = Eigen::Matrix2d::Zero(), moved = shape;
    for_each_bond(i, [&](const Bond& bond) {
      const double weight = 1 / bond.reference.squaredNorm();
      shape += weight * bond.reference * bond.reference.transpose();
      moved += weight * deformed(i, bond, u) * bond.reference.transpose();
    });
    // The family's gradient is moved * shape^-1, and a shape tensor has a determinant >= 0.
    if (shape.determinant() > 1e-4 * shape.squaredNorm() && !(moved.determinant() > 0))
      return Breakdown{
          body().position(i),
          "the sheet has folded over itself: the deformation gradient of a point has a determinant <= 0"};
  }
  return std::nullopt;
}

Eigen::Matrix2d BondMembrane::nominal_stress(std::size_t point, std::span<const double> u) const {
  Eigen::Matrix2d stress = Eigen::Matrix2d::Zero();
  for_each_bond(point, [&](const Bond& bond) {
    const Eigen::Vector2d y = deformed(point, bond, u);
    stress += 0.5 * pull(point, bond, y) * y * bond.reference.transpose();
  });
  return stress;
}

std::vector<ModelField> BondMembrane::fields(std::span<const double> u) {
  place_inclusions(u);
  ModelField energy{"strain_energy_density", 1, {}, "J/m^3"}, stress{"nominal_stress", 9, {}, "Pa"},
      factor{"surface_correction", 3, {}, {}};
  for (const std::size_t i : body().points) {
    energy.values.push_back(energy_density(i, u));
    const Eigen::Matrix2d p = nominal_stress(i, u);
    stress.values.insert(stress.values.end(), {p(0, 0), p(0, 1), 0, p(1, 0), p(1, 1), 0, 0, 0, 0});
    factor.values.insert(factor.values.end(), {correction_[0][i], correction_[1][i], 0});
  }
  const std::size_t shown = positions().size();
  for (ModelField* field : {&energy, &stress, &factor})  // rigid points have none of these
    field->values.resize(shown * static_cast<std::size_t>(field->components), 0.0);
  return {damage(), std::move(energy), std::move(stress), std::move(factor)};
}

std::vector<std::string> BondMembrane::describe() const {
  const double c1 = std::get<NeoHookean>(material_.law).c10;
  std::vector<std::string> lines = {
      fmt::format("material {}: C1 = {:.6g} Pa; bond constant c0 = C1 / (pi h horizon^2) = {:.6g} N/m^5",
                  material_.name, c1, c0_),
      fmt::format("bond at rest: force {:.4g}, energy {:.4g} (in units of the law; 0 in a sound one)",
                  law_.force_at_rest(), law_.energy_at_rest()),
      "the force is not the gradient of the energy where bonds turn; the energy balance is no check of a "
      "run"};
  for (std::string& line : describe_limits()) lines.push_back(std::move(line));
  if (settings_.surface_correction) {
    std::array<double, 2> least{1e300, 1e300}, most{0, 0};
    for (const std::size_t i : body().points)
      for (std::size_t axis = 0; axis < 2; ++axis) {
        least[axis] = std::min(least[axis], correction_[axis][i]);
        most[axis] = std::max(most[axis], correction_[axis][i]);
      }
    lines.push_back(fmt::format("surface correction: {:.4g} to {:.4g} along x, {:.4g} to {:.4g} along y",
                                least[0], most[0], least[1], most[1]));
  }
  return lines;
}

std::size_t BondMembrane::bytes() const {
  return body().bytes() + 4 * body().size() * sizeof(double) + lattice_.blocks.size();
}

}  // namespace riven
