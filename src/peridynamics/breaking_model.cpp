#include "peridynamics/breaking_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/lanes.hpp"
#include "base/parallel.hpp"

namespace riven {

namespace {

constexpr std::size_t kPiece = 256;  // points that a thread takes at a time
constexpr double kNever = std::numeric_limits<double>::infinity();

void check(const FailureLimits& limits, const Body& body) {
  std::size_t materials = 1;
  for (const std::size_t i : body.points) materials = std::max(materials, body.material_of(i) + 1);
  const std::size_t given = limits.materials();
  if (given < materials || given * given != limits.stretch.size())
    throw InputError(
        fmt::format("limits of stretch: {} are given; expected one for each pair of the body's {} "
                    "materials",
                    limits.stretch.size(), materials));
  for (const double limit : limits.stretch)
    if (!(limit > 0))
      throw InputError(fmt::format("limit of stretch: found {:g}; expected one above 0", limit));
  for (const double limit : limits.damage)
    if (!(limit > 0))
      throw InputError(fmt::format("limit of damage: found {:g}; expected one above 0", limit));
}

}  // namespace

void BreakingModel::set_limits(FailureLimits limits) {
  limits_ = std::move(limits);
  if (!breaks()) return;
  check(limits_, body());
  find_least_limits();
  beyond_.assign(least_limit2_.size(), body().on_lattice() != nullptr ? 0 : 1);
  if (const LatticeBonds* on = body().on_lattice()) {
    for (std::size_t k = 0; k < on->stencil.size(); ++k)
      lattice_.stencil.push_back(
          {on->stencil.shift[k], on->stencil.bond[k], on->stencil.length[k] * on->stencil.length[k]});
    lattice_.masks = body().masks().data();
    lattice_.least_limit2 = least_limit2_.data();
    lattice_.beyond = beyond_.data();
    find_long_bonds_ = find_long_bonds(body().dimension);
  }
  limits_set();
}

double BreakingModel::limit2(std::size_t point, std::size_t end) const {
  if (body().is_unbreakable(point) || body().is_unbreakable(end)) return kNever;
  const double ratio = 1 + limits_.between(body().material_of(point), body().material_of(end));
  return ratio * ratio;
}

namespace {

/// Mean over bonds of how far they reach across a plane (m), each counted by its part of the energy. Per area
/// of a plane, as many bonds cross it as their reach over the volume of a point.
struct Reach {
  double parts = 0, across = 0;
  void add(double part, double distance) {
    parts += part;
    across += part * distance;
  }
  [[nodiscard]] double mean() const { return parts > 0 ? across / parts : 0; }
};

/// Mean of |cos| over all directions.
double mean_cosine(int dimension) {
  return dimension == 1 ? 1 : dimension == 2 ? 2 / std::numbers::pi : 0.5;
}

}  // namespace

double BreakingModel::reach() const {
  if (const LatticeBonds* on = body().on_lattice()) {
    Reach family;
    for (const Point& xi : on->stencil.bond)
      family.add(part_of_energy(Eigen::Vector3d(xi.data())), std::abs(xi[0]));
    return family.mean();
  }
  std::vector<double> complete, all;
  for (const std::size_t i : body().points) {
    Reach family;
    const Eigen::Vector3d x(body().position(i).data());
    body().for_each_neighbour(i, [&](std::size_t j) {
      const Eigen::Vector3d xi = Eigen::Vector3d(body().position(j).data()) - x;
      const double volume = body().volume[j] > 0 ? body().volume[j] : body().volume[i];  // ghosts have none
      family.add(part_of_energy(xi) * volume, mean_cosine(body().dimension) * xi.norm());
    });
    all.push_back(family.mean());
    if (body().complete[i]) complete.push_back(family.mean());
  }
  std::vector<double>& values = complete.empty() ? all : complete;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double BreakingModel::critical_stretch(double energy_release_rate, std::size_t a, std::size_t b) const {
  constexpr double kStart = 1e-8, kMost = 1e3;
  const double density = energy_release_rate / reach();
  const auto is_enough = [&](double stretch) { return !(equal_stretch_energy(stretch, a, b) < density); };
  double high = kStart;
  while (high < kMost && !is_enough(high)) high *= 2;
  if (!is_enough(high))
    throw InputError(
        fmt::format("critical energy release rate: found {:g} J/m^2, which no stretch below {:g} "
                    "reaches; expected a smaller one",
                    energy_release_rate, kMost));
  double low = high == kStart ? 0 : 0.5 * high;
  for (double middle = 0.5 * (low + high); low < middle && middle < high; middle = 0.5 * (low + high))
    (is_enough(middle) ? high : low) = middle;
  return high;
}

std::size_t BreakingModel::group() const {
  return body().on_lattice() != nullptr ? kLanes : 1;
}

void BreakingModel::find_least_limits() {
  least_limit2_.assign(body().size() / group(), kNever);
  parallel_for(static_cast<std::ptrdiff_t>(least_limit2_.size()), [&](std::ptrdiff_t number) {
    const auto n = static_cast<std::size_t>(number);
    for (std::size_t i = n * group(); i < (n + 1) * group(); ++i)
      body().for_each_neighbour(
          i, [&](std::size_t j) { least_limit2_[n] = std::min(least_limit2_[n], limit2(i, j)); });
  });
}

void BreakingModel::look_for_long_bonds(std::span<const double> u) {
  if (body().on_lattice() == nullptr) return;
  for (std::size_t d = 0; d < static_cast<std::size_t>(body().dimension); ++d)
    lattice_.u[d] = u.data() + d * body().size();
  parallel_pieces(
      beyond_.size(), [&](std::size_t begin, std::size_t end) { find_long_bonds_(lattice_, begin, end); },
      kPiece / kLanes);
}

/// |Y|^2 / L^2: the same bits from both ends of the bond.
double BreakingModel::squared_ratio(std::size_t point, std::size_t end, std::span<const double> u) const {
  const Point x = body().position(point), x_end = body().position(end);
  double length2 = 0, r2 = 0;
  for (std::size_t d = 0; d < static_cast<std::size_t>(body().dimension); ++d) {
    const std::size_t plane = d * body().size();
    const double xi = x_end[d] - x[d], y = xi + (u[plane + end] - u[plane + point]);
    length2 += xi * xi;
    r2 += y * y;
  }
  return r2 / length2;
}

std::vector<BreakingModel::LongBond> BreakingModel::long_bonds(std::span<const double> u) const {
  std::vector<std::vector<LongBond>> found((body().size() + kPiece - 1) / kPiece);
  parallel_pieces(
      body().size(),
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          if (beyond_[i / group()] == 0) continue;
          body().for_each_bond(i, [&](std::size_t bond, std::size_t j) {
            const double ratio2 = squared_ratio(i, j, u), limit2 = this->limit2(i, j);
            if (!(ratio2 > limit2)) return;
            const double part = (std::sqrt(ratio2) - 1) / (std::sqrt(limit2) - 1);
            found[begin / kPiece].push_back({i, bond, j, part * part - 1});
          });
        }
      },
      kPiece);
  std::vector<LongBond> bonds;
  for (const auto& of_piece : found) bonds.insert(bonds.end(), of_piece.begin(), of_piece.end());
  return bonds;
}

Passage BreakingModel::passage(const std::vector<LongBond>& bonds) {
  Passage passage{.broken = bonds.size()};
  for (const LongBond& bond : bonds) passage.excess += bond.excess / static_cast<double>(bonds.size());
  return passage;
}

/// Points of which too many bonds break lose them all.
void BreakingModel::add_points_to_lose(std::vector<LongBond>& bonds) const {
  if (limits_.damage.empty()) return;
  const std::size_t long_ones = bonds.size();
  for (std::size_t first = 0; first < long_ones;) {
    const std::size_t i = bonds[first].point;
    std::size_t last = first;
    while (last < long_ones && bonds[last].point == i) ++last;
    const double left = static_cast<double>(body().family_size(i) - (last - first));
    const double whole = body().whole_family[i];
    if (whole > 0 && 1 - left / whole >= limits_.damage[body().material_of(i)])
      body().for_each_bond(i, [&](std::size_t bond, std::size_t j) {
        if (limit2(i, j) < kNever) bonds.push_back({i, bond, j, 0});
      });
    first = last;
  }
}

std::vector<std::size_t> BreakingModel::lose(std::vector<LongBond> bonds, std::span<const double> u) {
  add_points_to_lose(bonds);
  std::vector<std::size_t> points;
  for (const LongBond& bond : bonds) points.insert(points.end(), {bond.point, bond.end});
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  const auto energy = [&] {
    return ordered_sum<double>(
        points.size(),
        [&](std::size_t begin, std::size_t end) {
          double sum = 0;
          for (std::size_t n = begin; n < end; ++n) sum += family_energy(points[n], u);
          return sum;
        },
        kLanes);
  };
  const double before = energy();
  for (const LongBond& bond : bonds) own_body().cut(bond.point, bond.bond);
  for (const std::size_t i : points) refit(i);
  dissipated_ += before - energy();
  return points;
}

Passage BreakingModel::advance(std::span<const double> u, std::span<double> force) {
  if (!breaks()) return {};
  look_for_long_bonds(u);
  std::vector<LongBond> bonds = long_bonds(u);
  Passage passage = BreakingModel::passage(bonds);
  if (bonds.empty()) return passage;
  lose(std::move(bonds), u);
  passage.breakdown = internal_force(u, force);
  return passage;
}

double BreakingModel::overload(std::span<const double> u) const {
  struct Largest {
    double value = 0;
    void operator+=(const Largest& other) { value = std::max(value, other.value); }
  };
  return ordered_sum<Largest>(
             body().size(),
             [&](std::size_t begin, std::size_t end) {
               Largest most;
               for (std::size_t i = begin; i < end; ++i)
                 body().for_each_neighbour(i, [&](std::size_t j) {
                   const double limit = std::sqrt(limit2(i, j)) - 1;
                   most += {(std::sqrt(squared_ratio(i, j, u)) - 1) / limit};
                 });
               return most;
             },
             kPiece)
      .value;
}

std::vector<std::string> BreakingModel::describe_limits() const {
  if (!breaks()) return {"failure: none, bonds never break"};
  std::vector<std::string> lines;
  for (std::size_t a = 0; a < limits_.materials(); ++a)
    for (std::size_t b = a; b < limits_.materials(); ++b) {
      const double limit = limits_.between(a, b);
      const std::string which =
          limits_.materials() == 1 ? "" : fmt::format(" between materials {} and {}", a + 1, b + 1);
      lines.push_back(std::isfinite(limit)
                          ? fmt::format("failure: bonds{} break beyond a stretch of {:.6g}", which, limit)
                          : fmt::format("failure: bonds{} never break", which));
    }
  return lines;
}

void BreakingModel::save(Snapshot& to) const {
  each_member(*this, to.saving());
}

void BreakingModel::restore(const Snapshot& from) {
  each_member(*this, from.restoring());
  for (std::size_t i = 0; i < body().size(); ++i) refit(i);
}

}  // namespace riven
