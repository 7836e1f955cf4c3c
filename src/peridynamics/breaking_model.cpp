#include "peridynamics/breaking_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

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
  for (const auto* of_points : {&limits.damage, &limits.energy_density})
    for (const double limit : *of_points)
      if (!(limit > 0))
        throw InputError(
            fmt::format("limit of damage or energy density: found {:g}; expected one above 0", limit));
}

/// A crushed family may be where its law says nothing: then its energy is not known, and counts as none.
double finite(double energy) {
  return std::isfinite(energy) ? energy : 0;
}

/// Points (ascending) whose bonds are others than these masks said.
std::vector<std::size_t> changed_since(const std::vector<std::uint8_t>& before, const Body& body) {
  std::vector<std::size_t> points;
  const std::vector<std::uint8_t>& now = body.masks();
  if (const LatticeBonds* on = body.on_lattice()) {
    const std::size_t bonds_of_block = on->stencil.size();
    for (std::size_t block = 0; block * bonds_of_block < now.size(); ++block) {
      unsigned lanes = 0;
      for (std::size_t k = block * bonds_of_block; k < (block + 1) * bonds_of_block; ++k)
        lanes |= static_cast<unsigned>(now[k] ^ before[k]);
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        if ((lanes >> lane & 1U) != 0) points.push_back(block * kLanes + lane);
    }
    return points;
  }
  const auto& list = std::get<ListedBonds>(body.bonds);
  for (std::size_t i = 0; i < body.size(); ++i) {
    const auto first = static_cast<std::ptrdiff_t>(list.begin[i] / 8 + i);
    const std::size_t bytes = (list.begin[i + 1] - list.begin[i] + 7) / 8;
    if (!std::equal(now.begin() + first, now.begin() + first + static_cast<std::ptrdiff_t>(bytes),
                    before.begin() + first))
      points.push_back(i);
  }
  return points;
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
  for (auto* marks : {&crushed_, &times_crushed_}) marks->assign(body().size(), 0);
  limits_set();
}

double BreakingModel::limit2(std::size_t point, std::size_t end) const {
  if (body().is_unbreakable(point) || body().is_unbreakable(end)) return kNever;
  const double ratio = 1 + limits_.between(body().material_of(point), body().material_of(end));
  return ratio * ratio;
}

/// That of the stencil, or the one among the complete families of a list that is like most of them.
BreakingModel::WholeFamily BreakingModel::whole_family() const {
  WholeFamily family;
  if (const LatticeBonds* on = body().on_lattice()) {
    for (const Point& xi : on->stencil.bond) family.xi.emplace_back(xi.data());
    family.volume.assign(family.xi.size(), 1);
    return family;
  }
  std::vector<std::pair<double, std::size_t>> sizes;  // volume of a family, its point
  for (const bool complete : {true, false})
    for (std::size_t n = 0; n < body().points.size() && (complete || sizes.empty()); ++n) {
      const std::size_t i = body().points[n];
      double volume = 0;
      body().for_each_neighbour(i, [&](std::size_t j) { volume += body().volume[j]; });
      if (body().complete[i] == complete) sizes.emplace_back(volume, i);
    }
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  const std::size_t i = middle->second;
  const Eigen::Vector3d x(body().position(i).data());
  body().for_each_neighbour(i, [&](std::size_t j) {
    family.xi.push_back(Eigen::Vector3d(body().position(j).data()) - x);
    family.volume.push_back(body().volume[j] > 0 ? body().volume[j] : body().volume[i]);  // ghosts have none
  });
  return family;
}

/// What families lose when the bonds across a plane break, integrated over their distances from it on both
/// sides (m): over rows of a lattice, else over distances and directions.
double BreakingModel::lost_depth(const WholeFamily& family, std::size_t material) const {
  const bool lattice = body().on_lattice() != nullptr;
  const double step = lattice ? body().spacing : body().horizon / 32;
  const int directions = lattice || body().dimension == 1 ? 1 : 24;
  double lost = 0;
  for (int n = 0; n < directions; ++n) {
    // Spread over a half circle, in space over a half sphere by the golden angle.
    const double z = body().dimension == 3 ? (n + 0.5) / directions : 0;
    const double angle = body().dimension == 3 ? 2.399963229728653 * n : std::numbers::pi * n / directions;
    const double r = std::sqrt(1 - z * z);
    const Eigen::Vector3d normal =
        lattice ? Eigen::Vector3d::UnitX() : Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), z);
    for (double depth = 0.5 * step; depth < body().horizon; depth += step) {
      std::vector<bool> exists;
      for (const Eigen::Vector3d& xi : family.xi) exists.push_back(xi.dot(normal) < depth);
      lost += 2 * step * (1 - share_left(family, exists, material)) / directions;
    }
  }
  return lost;
}

double BreakingModel::critical_stretch(double energy_release_rate, std::size_t a, std::size_t b) const {
  constexpr double kStart = 1e-8, kMost = 1e3;
  const WholeFamily family = whole_family();
  const double first = lost_depth(family, a), second = a == b ? first : lost_depth(family, b);
  const auto is_enough = [&](double stretch) {
    return !(
        0.5 * (equal_stretch_energy(stretch, a, b) * first + equal_stretch_energy(stretch, b, a) * second) <
        energy_release_rate);
  };
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

void BreakingModel::open_blocks(std::span<const std::size_t> points, std::vector<BlockKind>& blocks) {
  if (blocks.empty()) return;
  for (const std::size_t i : points) {
    BlockKind& kind = blocks[i / kLanes];
    if (kind == BlockKind::intact) kind = BlockKind::partial;
  }
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
  const std::vector<LongBond> further = bonds_of_loaded_points(u);
  if (further.empty()) return bonds;
  bonds.insert(bonds.end(), further.begin(), further.end());
  const auto at = [](const LongBond& bond) { return std::pair(bond.point, bond.bond); };
  std::stable_sort(bonds.begin(), bonds.end(),
                   [&](const LongBond& a, const LongBond& b) { return at(a) < at(b); });
  bonds.erase(std::unique(bonds.begin(), bonds.end(),
                          [&](const LongBond& a, const LongBond& b) { return at(a) == at(b); }),
              bonds.end());
  return bonds;
}

/// Of a body point; 0 where there is no limit.
double BreakingModel::energy_over_limit(std::size_t point, std::span<const double> u) const {
  if (limits_.energy_density.empty() || body().is_unbreakable(point)) return 0;
  const double limit = limits_.energy_density[body().material_of(point)];
  return limit < kNever ? family_energy(point, u) / (body().volume[point] * limit) : 0;
}

std::vector<BreakingModel::LongBond> BreakingModel::bonds_of_loaded_points(std::span<const double> u) const {
  std::vector<LongBond> bonds;
  if (limits_.energy_density.empty()) return bonds;
  std::vector<double> load(body().points.size());
  parallel_for(static_cast<std::ptrdiff_t>(load.size()), [&](std::ptrdiff_t n) {
    const auto at = static_cast<std::size_t>(n);
    load[at] = energy_over_limit(body().points[at], u);
  });
  for (std::size_t n = 0; n < load.size(); ++n)
    if (load[n] > 1)
      body().for_each_bond(body().points[n], [&](std::size_t bond, std::size_t j) {
        if (!body().is_unbreakable(j)) bonds.push_back({body().points[n], bond, j, load[n] - 1});
      });
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
        if (!body().is_unbreakable(i) && !body().is_unbreakable(j)) bonds.push_back({i, bond, j, 0});
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
  const std::vector<std::size_t> changed = changed_by(points);
  const auto energy = [&] {
    return ordered_sum<double>(
        changed.size(),
        [&](std::size_t begin, std::size_t end) {
          double sum = 0;
          for (std::size_t n = begin; n < end; ++n) sum += finite(family_energy(changed[n], u));
          return sum;
        },
        kLanes);
  };
  const double before = energy();
  for (const LongBond& bond : bonds) own_body().cut(bond.point, bond.bond);
  refit(points);
  dissipated_ += before - energy();
  return points;
}

Passage BreakingModel::advance(std::span<const double> u, std::span<double> force) {
  if (!breaks()) return {};
  look_for_long_bonds(u);
  std::vector<LongBond> bonds = long_bonds(u);
  Passage passage = BreakingModel::passage(bonds);
  if (!bonds.empty()) lose(std::move(bonds), u);
  if (count_crushed(u)) passage.broken = std::max<std::size_t>(passage.broken, 1);
  if (passage.broken > 0) passage.breakdown = internal_force(u, force);
  passage.stiffer = passage.broken > 0 && stiffens();
  return passage;
}

/// Returns whether there were any.
bool BreakingModel::count_crushed(std::span<const double> u) {
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < crushed_.size(); ++i)
    if (std::exchange(crushed_[i], 0) != 0) points.push_back(i);
  for (const std::size_t i : points) {
    dissipated_ += crushed_energy(i, u);
    ++times_crushed_[i];
  }
  if (!points.empty()) refit(points);
  for (const std::size_t i : points) dissipated_ -= finite(family_energy(i, u));
  return !points.empty();
}

double BreakingModel::overload(std::span<const double> u) const {
  if (!breaks()) return 0;
  struct Largest {
    double value = 0;
    void operator+=(const Largest& other) { value = std::max(value, other.value); }
  };
  return ordered_sum<Largest>(
             body().size(),
             [&](std::size_t begin, std::size_t end) {
               Largest most;
               for (std::size_t i = begin; i < end; ++i) {
                 if (body().kind[i] == PointKind::body) most += {std::sqrt(energy_over_limit(i, u))};
                 body().for_each_neighbour(i, [&](std::size_t j) {
                   const double limit = std::sqrt(limit2(i, j)) - 1;
                   most += {(std::sqrt(squared_ratio(i, j, u)) - 1) / limit};
                 });
               }
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
  for (std::size_t m = 0; m < limits_.energy_density.size(); ++m)
    if (limits_.energy_density[m] < kNever)
      lines.push_back(fmt::format("failure: all bonds of a point{} break beyond {:.6g} J/m^3",
                                  limits_.materials() == 1 ? "" : fmt::format(" of material {}", m + 1),
                                  limits_.energy_density[m]));
  return lines;
}

void BreakingModel::save(Snapshot& to) const {
  each_member(*this, to.saving());
}

void BreakingModel::restore(const Snapshot& from) {
  const std::vector<std::uint8_t> masks = bond_masks(), times = times_crushed_;
  each_member(*this, from.restoring());
  std::vector<std::size_t> points = changed_since(masks, body());
  for (std::size_t i = 0; i < times.size(); ++i)
    if (times[i] != times_crushed_[i]) points.push_back(i);
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  refit(points);
}

}  // namespace riven
