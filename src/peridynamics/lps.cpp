#include "peridynamics/lps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/lanes.hpp"
#include "base/parallel.hpp"

namespace riven {

namespace {

constexpr std::size_t kPiece = 256;  // points that a thread takes at a time

// A factor 1 + a h of the influence below this takes a bond out: at a horizon of one spacing, where there are
// no bonds but those along the axes. From 1.5 spacings on it is 0.3 or more.
constexpr double kLeastFactor = 0.05;

void check(const Body& body, const LpsSettings& settings) {
  if (body.dimension == 1)
    throw InputError("the model \"lps\" has two or three dimensions; expected kind = \"pmb\" in one");
  if (!body.defects.inclusions.empty())
    throw InputError("the model \"lps\" has no rigid inclusions; expected holes and cracks only");
  if (!(settings.poissons_ratio > -1 && settings.poissons_ratio < 0.5))
    throw InputError(fmt::format("Poisson's ratio: found {:g}; expected a number above -1 and below 0.5",
                                 settings.poissons_ratio));
}

/// kappa and beta (Pa): `Lps` has the formulas.
struct Constants {
  double kappa = 0, beta = 0;
};

Constants constants(const LpsSettings& settings, int dimension) {
  const double e = settings.youngs_modulus, nu = settings.poissons_ratio, shear = e / (2 * (1 + nu));
  double bulk = e / (3 * (1 - 2 * nu));  // mean stress over dilatation, in the plane those of the plane
  if (dimension == 2) bulk = settings.plane == Plane::stress ? e / (2 * (1 - nu)) : shear / (1 - 2 * nu);
  const double beta = shear * (dimension + 2);
  return {bulk - beta / dimension, beta};
}

/// The harmonic of fourth order with the symmetry of a square (then it is cos(4 t) / 4) or a cube.
double lattice_harmonic(const Eigen::Vector3d& direction, int dimension) {
  return direction.array().square().square().sum() - 3.0 / (dimension + 2);
}

double factor(double anisotropy, const Eigen::Vector3d& xi, int dimension) {
  return 1 + anisotropy * lattice_harmonic(xi.normalized(), dimension);
}

/// The factor a with which the harmonic vanishes in a family's fourth moment: sum(omega0 (1 + a h) h L^2 V)
/// = 0.
struct Anisotropy {
  double first = 0, second = 0;
  void add(double weight, double harmonic) {
    first += weight * harmonic;
    second += weight * harmonic * harmonic;
  }
  [[nodiscard]] double factor() const { return second > 0 ? -first / second : 0; }
};

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

Lps::Lps(Body body, std::vector<LpsSettings> settings)
    : BreakingModel(std::move(body), densities(settings)), settings_(std::move(settings)) {
  for (const LpsSettings& one : settings_) check(Lps::body(), one);
  kernels_ = lps_kernels(Lps::body().dimension);
  volume_ = Lps::body().volume;
  for (const GhostPoint& ghost : Lps::body().ghosts) volume_[ghost.point] = volume_[ghost.master];
  tension_.assign(Lps::body().size(), 0.0);
  find_anisotropy();
  if (const LatticeBonds* on = Lps::body().on_lattice()) {
    make_stencil(*on);
    find_moments();
    find_constants();
    sort_blocks(*on);
  } else {
    make_list(std::get<ListedBonds>(Lps::body().bonds));
    find_moments();
    find_constants();
    for (std::size_t i = 0; i < list_.points.size(); ++i) list_.points[i].straight = straight_[i];
  }
}

void Lps::find_constants() {
  kappa_.resize(body().size());
  straight_.resize(body().size());
  for (std::size_t i = 0; i < body().size(); ++i) {
    const auto [kappa, beta] = constants(settings_[body().material_of(i)], body().dimension);
    kappa_[i] = kappa;
    straight_[i] = inverse_moment_[i] * beta;
  }
  lattice_.inverse_moment = list_.inverse_moment = inverse_moment_.data();
  lattice_.kappa = list_.kappa = kappa_.data();
  lattice_.straight = straight_.data();
}

double Lps::equal_stretch_energy(double stretch, std::size_t material, std::size_t /*other*/) const {
  const auto [kappa, beta] = constants(settings_[material], body().dimension);
  const double theta = body().dimension * stretch;
  return 0.5 * (kappa + beta / body().dimension) * theta * theta;
}

/// Of the dilatation, and of the sum of squared extensions, the same share is left; the energy has the square
/// of the first.
double Lps::share_left(const WholeFamily& family, const std::vector<bool>& exists,
                       std::size_t material) const {
  double left = 0, whole = 0;
  for (std::size_t k = 0; k < exists.size(); ++k) {
    const double part = omega(family.xi[k]) * family.xi[k].squaredNorm() * family.volume[k];
    whole += part;
    if (exists[k]) left += part;
  }
  const double share = left / whole;
  const auto [kappa, beta] = constants(settings_[material], body().dimension);
  const double of_bonds = beta / body().dimension;
  return (kappa * share * share + of_bonds * share) / (kappa + of_bonds);
}

void Lps::refit(std::span<const std::size_t> points) {
  open_blocks(points, lattice_.blocks);
}

double Lps::omega(const Eigen::Vector3d& xi) const {
  return influence(settings_.front().influence, xi.norm(), body().horizon) *
         factor(anisotropy_, xi, body().dimension);
}

/// One factor for the whole body, so that both ends of a bond agree: that of the stencil, or the median of
/// the complete families of a list, which is the stencil's for points of a lattice and next to nothing for
/// scattered ones.
void Lps::find_anisotropy() {
  const auto add = [&](Anisotropy& to, const Eigen::Vector3d& xi, double volume) {
    const double length = xi.norm();
    to.add(influence(settings_.front().influence, length, body().horizon) * length * length * volume,
           lattice_harmonic(xi / length, body().dimension));
  };
  if (const LatticeBonds* on = body().on_lattice()) {
    Anisotropy family;
    for (const Point& xi : on->stencil.bond) add(family, Eigen::Vector3d(xi.data()), 1);
    anisotropy_ = family.factor();
    return;
  }
  std::vector<double> complete, all;
  for (const std::size_t i : body().points) {
    Anisotropy family;
    const Eigen::Vector3d x(body().position(i).data());
    body().for_each_neighbour(
        i, [&](std::size_t j) { add(family, Eigen::Vector3d(body().position(j).data()) - x, volume_[j]); });
    all.push_back(family.factor());
    if (body().complete[i]) complete.push_back(family.factor());
  }
  anisotropy_ = median(complete.empty() ? all : complete);
}

void Lps::make_stencil(const LatticeBonds& on) {
  for (std::size_t k = 0; k < on.stencil.size(); ++k) {
    const double length = on.stencil.length[k], weight = omega(Eigen::Vector3d(on.stencil.bond[k].data()));
    lattice_.stencil.push_back({on.stencil.shift[k], on.stencil.bond[k], length, weight, weight * length});
  }
  lattice_.masks = on.bonds.bytes().data();
  lattice_.volume = volume_.data();
  lattice_.tension = tension_.data();
}

void Lps::make_list(const ListedBonds& list) {
  list_.points.resize(body().size());
  for (auto* of_bonds : {&list_.weight, &list_.length}) of_bonds->assign(list.begin.back() + kLanes, 0.0);
  for (std::size_t i = 0; i < body().size(); ++i) {
    list_.points[i].x = list.position[i];
    const Eigen::Vector3d x(list.position[i].data());
    for (std::size_t b = list.begin[i]; b < list.begin[i + 1]; ++b) {
      const std::size_t j = list.neighbour[b];
      const Eigen::Vector3d xi = Eigen::Vector3d(list.position[j].data()) - x;
      list_.length[b] = xi.norm();
      list_.weight[b] = omega(xi) * volume_[j];
    }
  }
  list_.begin = list.begin.data();
  list_.neighbour = list.neighbour.data();
  list_.masks = list.masks.data();
  list_.volume = volume_.data();
  list_.tension = tension_.data();
}

void Lps::find_moments() {
  inverse_moment_.assign(body().size(), 0.0);
  double least = 1;  // factor of a bond
  for (const std::size_t i : body().points) {
    double moment = 0;
    for_each_bond(i, [&](const Bond& bond) {
      moment += bond.weight * bond.length * bond.length;
      least = std::min(least, factor(anisotropy_, bond.xi, body().dimension));
    });
    if (moment > 0) inverse_moment_[i] = body().dimension / moment;
  }
  if (least < kLeastFactor)
    throw InputError(
        fmt::format("a horizon of {:.3g} spacings has bonds in too few directions for the model \"lps\"; "
                    "expected one of 1.5 spacings or more (3 is usual)",
                    body().horizon / body().spacing));
}

void Lps::sort_blocks(const LatticeBonds& on) {
  for (std::size_t block = 0; block < body().size() / kLanes; ++block)
    lattice_.blocks.push_back(on.bonds.kind(block));
  const double first = volume_[body().points.front()];
  if (std::all_of(body().points.begin(), body().points.end(),
                  [&](std::size_t i) { return volume_[i] == first; }))
    lattice_.uniform_volume = first;
}

/// Shows the kernels a state and where their result goes.
void Lps::look_at(std::span<const double> u, std::span<double> out) {
  const std::size_t size = body().size();
  const auto dimension = static_cast<std::size_t>(body().dimension);
  for (std::size_t d = 0; d < dimension; ++d) {
    lattice_.u[d] = u.data() + d * size;
    lattice_.out[d] = list_.out[d] = out.empty() ? nullptr : out.data() + d * size;
  }
  parallel_pieces(list_.points.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t d = 0; d < dimension; ++d) list_.points[i].u[d] = u[d * size + i];
  });
}

/// Two sweeps over the points: the second one reads the tensions that the first one made.
template <class Bonds>
void Lps::sweep(Bonds& bonds, void (*first)(Bonds&, std::size_t, std::size_t),
                void (*second)(const Bonds&, std::size_t, std::size_t)) {
  parallel_pieces(
      body().size(), [&](std::size_t begin, std::size_t end) { first(bonds, begin, end); }, kPiece);
  parallel_pieces(list_.points.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) list_.points[i].tension = tension_[i];
  });
  parallel_pieces(
      body().size(), [&](std::size_t begin, std::size_t end) { second(bonds, begin, end); }, kPiece);
}

std::optional<Breakdown> Lps::internal_force(std::span<const double> u, std::span<double> force) {
  look_at(u, force);
  if (body().on_lattice() != nullptr) {
    sweep(lattice_, kernels_.lattice.respond, kernels_.lattice.pull);
  } else {
    sweep(list_, kernels_.list.respond, kernels_.list.pull);
  }
  return std::nullopt;
}

void Lps::stiffness_bound(std::span<const double> u, std::span<double> bound) {
  std::vector<double> grip(body().size()), own_grip(body().size());
  lattice_.grip = list_.grip = grip.data();
  lattice_.own_grip = list_.own_grip = own_grip.data();
  look_at(u, bound);
  if (body().on_lattice() != nullptr) {
    sweep(lattice_, kernels_.lattice.grip, kernels_.lattice.bound);
  } else {
    sweep(list_, kernels_.list.grip, kernels_.list.bound);
  }
}

double Lps::strain_energy(std::span<const double> u) {
  look_at(u, {});
  return ordered_sum<double>(
      body().size(),
      [&](std::size_t begin, std::size_t end) {
        return body().on_lattice() != nullptr ? kernels_.lattice.energy(lattice_, begin, end)
                                              : kernels_.list.energy(list_, begin, end);
      },
      kPiece);
}

std::optional<Breakdown> Lps::inspect(std::span<const double> /*u*/) {
  return std::nullopt;
}

std::vector<std::string> Lps::describe() const {
  const int dimension = body().dimension;
  std::vector<std::string> lines;
  for (const LpsSettings& one : settings_) {
    const auto [kappa, beta] = constants(one, dimension);
    lines.push_back(fmt::format("material: bulk modulus {:.6g} Pa{}, shear modulus {:.6g} Pa",
                                kappa + beta / dimension,
                                dimension == 3               ? ""
                                : one.plane == Plane::stress ? " in plane stress"
                                                             : " in plane strain",
                                beta / (dimension + 2)));
  }
  lines.push_back(fmt::format(
      "influence: {}, corrected for the lattice's directions by {:+.3g} of its harmonic",
      settings_.front().influence == Influence::inverse ? "inverse length" : "constant", anisotropy_));
  for (std::string& line : describe_limits()) lines.push_back(std::move(line));
  return lines;
}

std::size_t Lps::bytes() const {
  return body().bytes() + 5 * volume_.size() * sizeof(double) + lattice_.blocks.size() +
         list_.points.size() * sizeof(LpsPoint) +
         (list_.weight.size() + list_.length.size()) * sizeof(double);
}

}  // namespace riven
