#include "peridynamics/pmb.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/lanes.hpp"
#include "base/parallel.hpp"

namespace riven {

namespace {

constexpr std::size_t kPiece = 256;  // points that a thread takes at a time

/// Energy density over the squared strain of the continuum, stretched equally in all directions.
double dilatation_modulus(const PmbSettings& settings, int dimension) {
  const double e = settings.youngs_modulus;
  if (dimension == 1) return e / 2;
  if (dimension == 3) return 3 * e;  // 9 K / 2 with Poisson's ratio 1/4
  return settings.plane == Plane::stress ? e / (1 - 1.0 / 3) : e / ((1 + 0.25) * (1 - 0.5));
}

}  // namespace

Pmb::Pmb(Body body, std::vector<PmbSettings> settings)
    : BreakingModel(std::move(body), densities(settings)),
      settings_(std::move(settings)),
      kernels_(pmb_kernels(Pmb::body().dimension)) {
  if (!Pmb::body().defects.inclusions.empty())
    throw InputError("the model \"pmb\" has no rigid inclusions; expected holes and cracks only");
  weight_ = Pmb::body().volume;
  for (const GhostPoint& ghost : Pmb::body().ghosts)
    weight_[ghost.point] = 0.5 * Pmb::body().volume[ghost.master];
  const double moment = family_moment();
  for (const PmbSettings& one : settings_)
    micromodulus_.push_back(4 * dilatation_modulus(one, Pmb::body().dimension) / moment);
  if (settings_.size() > 1) half_compliance_ = half_compliances();
  if (const LatticeBonds* on = Pmb::body().on_lattice()) {
    make_lattice_kernel(*on);
  } else {
    make_list_kernel(std::get<ListedBonds>(Pmb::body().bonds));
  }
}

double Pmb::poissons_ratio() const {
  return body().dimension == 2 && settings_.front().plane == Plane::stress ? 1.0 / 3 : 0.25;
}

double Pmb::equal_stretch_energy(double stretch, std::size_t a, std::size_t b) const {
  const double first = dilatation_modulus(settings_[a], body().dimension);
  const double second = dilatation_modulus(settings_[b], body().dimension);
  return 2 / (1 / first + 1 / second) * stretch * stretch;
}

double Pmb::share_left(const WholeFamily& family, const std::vector<bool>& exists,
                       std::size_t /*material*/) const {
  double left = 0, whole = 0;
  for (std::size_t k = 0; k < exists.size(); ++k) {
    const double part = family.xi[k].norm() * family.volume[k];
    whole += part;
    if (exists[k]) left += part;
  }
  return left / whole;
}

std::vector<double> Pmb::half_compliances() const {
  std::vector<double> values(body().size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = 0.5 / micromodulus_[body().material_of(i)];
  return values;
}

double Pmb::micromodulus_between(std::size_t point, std::size_t end) const {
  if (half_compliance_.empty()) return micromodulus_.front();
  return 1 / (half_compliance_[point] + half_compliance_[end]);
}

double Pmb::full_volume(std::size_t point) const {
  return body().kind[point] == PointKind::ghost ? 2 * weight_[point] : weight_[point];
}

/// Sum of length times volume over a whole family (m^4): that of the stencil, or the median of the complete
/// families of a list, which is the same for points of a lattice whatever its defects. Where a body is too
/// thin for a complete family, that of its largest.
double Pmb::family_moment() const {
  if (const LatticeBonds* on = body().on_lattice()) {
    const double cell = std::pow(body().spacing, body().dimension) * body().thickness;
    double moment = 0;
    for (const double length : on->stencil.length) moment += length * cell;
    return moment;
  }
  std::vector<double> moments;  // of the complete families
  double largest = 0;
  for (const std::size_t i : body().points) {
    double moment = 0;
    const Point x = body().position(i);
    body().for_each_neighbour(i, [&](std::size_t j) {
      const Point y = body().position(j);
      moment += std::hypot(y[0] - x[0], y[1] - x[1], y[2] - x[2]) * full_volume(j);
    });
    largest = std::max(largest, moment);
    if (body().complete[i]) moments.push_back(moment);
  }
  if (moments.empty()) return largest;
  const auto middle = moments.begin() + static_cast<std::ptrdiff_t>(moments.size() / 2);
  std::nth_element(moments.begin(), middle, moments.end());
  return *middle;
}

void Pmb::make_lattice_kernel(const LatticeBonds& on) {
  const Stencil& stencil = on.stencil;
  for (std::size_t k = 0; k < stencil.size(); ++k)
    lattice_.stencil.push_back({stencil.shift[k], stencil.bond[k], stencil.length[k], 1 / stencil.length[k],
                                stencil.length[k] * stencil.length[k]});
  lattice_.masks = body().masks().data();
  for (std::size_t block = 0; block < body().size() / kLanes; ++block)
    lattice_.blocks.push_back(on.bonds.kind(block));
  lattice_.weight = weight_.data();
  lattice_.stiffness = micromodulus_.front();
  if (!half_compliance_.empty()) lattice_.half_compliance = half_compliance_.data();
  const double first = weight_[body().points.front()];
  if (body().ghosts.empty() && std::all_of(body().points.begin(), body().points.end(),
                                           [&](std::size_t i) { return weight_[i] == first; }))
    lattice_.uniform_weight = first;
}

void Pmb::refit(std::span<const std::size_t> points) {
  open_blocks(points, lattice_.blocks);
}

void Pmb::limits_set() {
  lattice_.least_limit2 = list_.least_limit2 = least_limit2().data();
  lattice_.beyond = list_.beyond = beyond().data();
}

void Pmb::make_list_kernel(const ListedBonds& list) {
  const std::size_t size = body().size();
  list_.points.resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    list_.points[i].x = list.position[i];
    list_.points[i].weight = weight_[i];
    if (!half_compliance_.empty()) list_.points[i].half_compliance = half_compliance_[i];
  }
  list_.inverse_length.assign(list.begin.back() + kLanes, 0.0);
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t b = list.begin[i]; b < list.begin[i + 1]; ++b) {
      double length2 = 0;
      for (std::size_t d = 0; d < static_cast<std::size_t>(body().dimension); ++d) {
        const double xi = list.position[list.neighbour[b]][d] - list.position[i][d];
        length2 += xi * xi;
      }
      list_.inverse_length[b] = 1 / std::sqrt(length2);
    }
  list_.begin = list.begin.data();
  list_.neighbour = list.neighbour.data();
  list_.masks = body().masks().data();
  list_.stiffness = micromodulus_.front();
  list_.mixed = !half_compliance_.empty();
}

/// Shows the kernels a state and where their result goes.
void Pmb::look_at(std::span<const double> u, std::span<double> out) {
  const std::size_t size = body().size();
  const auto dimension = static_cast<std::size_t>(body().dimension);
  for (std::size_t d = 0; d < dimension; ++d) {
    lattice_.u[d] = u.data() + d * size;
    lattice_.out[d] = list_.out[d] = out.empty() ? nullptr : out.data() + d * size;
  }
  if (list_.points.empty()) return;
  parallel_pieces(list_.points.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t d = 0; d < dimension; ++d) list_.points[i].u[d] = u[d * size + i];
  });
}

void Pmb::pull(std::size_t begin, std::size_t end) {
  if (body().on_lattice() != nullptr) {
    kernels_.lattice_force(lattice_, begin, end);
  } else {
    kernels_.listed_force(list_, begin, end);
  }
}

std::optional<Breakdown> Pmb::internal_force(std::span<const double> u, std::span<double> force) {
  look_at(u, force);
  parallel_pieces(
      body().size(), [&](std::size_t begin, std::size_t end) { pull(begin, end); }, kPiece);
  return std::nullopt;
}

/// The forces have marked where bonds are too long; where some break, they are found again.
Passage Pmb::advance(std::span<const double> u, std::span<double> force) {
  if (!breaks()) return {};
  const std::vector<LongBond> bonds = long_bonds(u);
  if (bonds.empty()) return {};
  const std::vector<std::size_t> points = lose(bonds, u);
  look_at(u, force);
  const std::size_t group = body().on_lattice() != nullptr ? kLanes : 1;
  for (std::size_t n = 0; n < points.size(); ++n)
    if (n == 0 || points[n] / group != points[n - 1] / group)
      pull(points[n] / group * group, (points[n] / group + 1) * group);
  return passage(bonds);
}

double Pmb::strain_energy(std::span<const double> u) {
  look_at(u, {});
  return ordered_sum<double>(
      body().size(),
      [&](std::size_t begin, std::size_t end) {
        return body().on_lattice() != nullptr ? kernels_.lattice_energy(lattice_, begin, end)
                                              : kernels_.listed_energy(list_, begin, end);
      },
      kPiece);
}

void Pmb::stiffness_bound(std::span<const double> u, std::span<double> bound) {
  look_at(u, bound);
  parallel_pieces(
      body().size(),
      [&](std::size_t begin, std::size_t end) {
        if (body().on_lattice() != nullptr) {
          kernels_.lattice_bound(lattice_, begin, end);
        } else {
          kernels_.listed_bound(list_, begin, end);
        }
      },
      kPiece);
}

std::optional<Breakdown> Pmb::inspect(std::span<const double> /*u*/) {
  return std::nullopt;
}

template <class Visit>
void Pmb::for_each_pull(std::size_t point, std::span<const double> u, const Visit& visit) const {
  const auto pull_of = [&](std::size_t j, const Point& xi) {
    Pull pull{.neighbour = j, .reference = {xi[0], xi[1], xi[2]}, .deformed = {}};
    Eigen::Vector3d eta = Eigen::Vector3d::Zero();
    for (int d = 0; d < body().dimension; ++d) {
      const std::size_t plane = static_cast<std::size_t>(d) * body().size();
      eta[d] = u[plane + j] - u[plane + point];
    }
    pull.deformed = pull.reference + eta;
    const double length = pull.reference.norm(), r = pull.deformed.norm();
    const double stretch = eta.dot(pull.reference + pull.deformed) / (length * (r + length));
    pull.micromodulus = micromodulus_between(point, j);
    pull.energy = 0.5 * pull.micromodulus * stretch * stretch * length;
    pull.per_length = pull.micromodulus * stretch / r;
    visit(pull);
  };
  if (const LatticeBonds* on = body().on_lattice()) {
    for (std::size_t k = 0; k < on->stencil.size(); ++k)
      if (on->bonds.exists(k, point))
        pull_of(BondPlanes::neighbour(on->stencil, k, point), on->stencil.bond[k]);
    return;
  }
  const Point x = body().position(point);
  body().for_each_neighbour(point, [&](std::size_t j) {
    const Point y = body().position(j);
    pull_of(j, {y[0] - x[0], y[1] - x[1], y[2] - x[2]});
  });
}

/// A bond's ends share its energy.
double Pmb::family_energy(std::size_t point, std::span<const double> u) const {
  double energy = 0;
  for_each_pull(point, u, [&](const Pull& pull) {
    energy += 0.5 * weight_[point] * weight_[pull.neighbour] * pull.energy;
  });
  return energy;
}

void Pmb::plain_force(std::span<const double> u, std::span<double> force) const {
  for (std::size_t i = 0; i < body().size(); ++i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for_each_pull(i, u, [&](const Pull& pull) {
      sum += weight_[i] * weight_[pull.neighbour] * pull.per_length * pull.deformed;
    });
    for (int d = 0; d < body().dimension; ++d)
      force[static_cast<std::size_t>(d) * body().size() + i] = sum[d];
  }
}

/// A bond's energy has the second derivative c / L along it and its force over its length across it.
void Pmb::tangent(std::span<const double> u, std::size_t first, std::size_t last, TangentBlocks& to) const {
  const int dimension = body().dimension;
  for (std::size_t i = first; i < last; ++i)
    for_each_pull(i, u, [&](const Pull& pull) {
      if (pull.neighbour < i) return;
      const Eigen::Vector3d e = pull.deformed.normalized();
      const Eigen::Matrix3d stiffness =
          weight_[i] * weight_[pull.neighbour] *
          (pull.per_length * Eigen::Matrix3d::Identity() +
           (pull.micromodulus / pull.reference.norm() - pull.per_length) * e * e.transpose());
      const std::array ends{static_cast<End>(pull.neighbour)};
      add_family_block(i, ends, {}, stiffness.topLeftCorner(dimension, dimension), to);
    });
}

std::vector<ModelField> Pmb::fields(std::span<const double> u) {
  const std::vector<std::size_t>& points = body().points;
  ModelField energy{"strain_energy_density", 1, std::vector<double>(points.size()), "J/m^3"};
  ModelField stress{"nominal_stress", 9, std::vector<double>(9 * points.size()), "Pa"};
  parallel_for(static_cast<std::ptrdiff_t>(points.size()), [&](std::ptrdiff_t number) {
    const auto n = static_cast<std::size_t>(number);
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> p(stress.values.data() + 9 * n);
    p.setZero();
    for_each_pull(points[n], u, [&](const Pull& pull) {
      const double half = 0.5 * full_volume(pull.neighbour);
      energy.values[n] += half * pull.energy;
      p += half * pull.per_length * pull.deformed * pull.reference.transpose();
    });
  });
  return {damage(), std::move(energy), std::move(stress)};
}

std::vector<std::string> Pmb::describe() const {
  std::vector<std::string> lines;
  for (const double micromodulus : micromodulus_)
    lines.push_back(
        fmt::format("material: micromodulus {:.6g} N/m^6, from the sum over a family", micromodulus));
  if (body().dimension > 1)
    lines.push_back(fmt::format("material: Poisson's ratio {:.4g}, that of the model{}", poissons_ratio(),
                                body().dimension == 3                      ? ""
                                : settings_.front().plane == Plane::stress ? " in plane stress"
                                                                           : " in plane strain"));
  for (std::string& line : describe_limits()) lines.push_back(std::move(line));
  return lines;
}

std::size_t Pmb::bytes() const {
  return body().bytes() + weight_.size() * sizeof(double) + lattice_.blocks.size() +
         list_.points.size() * sizeof(PmbPoint) + list_.inverse_length.size() * sizeof(double);
}

}  // namespace riven
