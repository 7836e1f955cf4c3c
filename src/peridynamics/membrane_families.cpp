// The families of the membrane: weights of their bonds, anew where bonds have broken.

#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "base/lanes.hpp"
#include "peridynamics/membrane.hpp"

namespace riven {

namespace {

// Where the family is cut, short waves are held by fewer bonds and a full stabilisation would stiffen edges
// (5a, 5).
constexpr double kCutFamilyStabilisation = 0.1;

// Determinant of a family's shape tensor (trace 1) below which all its bonds lie on one line: two of a
// lattice's bonds that do not have one of 0.02 and more.
constexpr double kFlatFamily = 1e-4;

// Share of a family's base weights: with less left it has no energy of its own any more (theory, section 5,
// broken bonds).
constexpr double kLostFamily = 0.1;

Eigen::Vector2d plane(const Point& p) {
  return {p[0], p[1]};
}

/// sum w n n^T of bonds in these directions.
Eigen::Matrix2d shape_tensor(const std::vector<PlaneBond>& bonds, const FamilyWeights& weights) {
  Eigen::Matrix2d shape = Eigen::Matrix2d::Zero();
  for (std::size_t j = 0; j < bonds.size(); ++j) {
    const Eigen::Vector2d n = Eigen::Vector2d(bonds[j].x, bonds[j].y).normalized();
    shape += weights.weight[j] * n * n.transpose();
  }
  return shape;
}

}  // namespace

/// Shows the kernels the body's bonds.
void Membrane::look_at_bonds() {
  const std::size_t n = body().size();
  if (const auto* list = std::get_if<ListedBonds>(&body().bonds)) {
    list_.begin = list->begin.data();
    list_.neighbour = list->neighbour.data();
    list_.masks = list->masks.data();
    list_.points.resize(n);
    for (std::size_t i = 0; i < n; ++i) list_.points[i].x = {list->position[i][0], list->position[i][1]};
    return;
  }
  const LatticeBonds& on = *body().on_lattice();
  lattice_.masks = on.bonds.masks(0);
  for (std::size_t block = 0; block < n / kLanes; ++block) lattice_.blocks.push_back(on.bonds.kind(block));
  for (std::size_t k = 0; k < on.stencil.size(); ++k) {
    const PlaneBond bond{on.stencil.bond[k][0], on.stencil.bond[k][1]};
    const double length = on.stencil.length[k];
    Moments weight = WeightFormula::terms(angular_functions(bond));
    for (double& w : weight) w /= length * length * length;
    lattice_.stencil.push_back({on.stencil.shift[k], bond.x, bond.y, 1 / (length * length), weight});
  }
  for (auto* plane : {&lattice_.a, &lattice_.b}) plane->assign(n, 0.0);
  for (auto& plane : lattice_.coefficient) plane.assign(n, 0.0);
  for (auto& plane : lattice_.n) plane.assign(n, 0.0);
}

void Membrane::limits_set() {
  const double limit = *std::min_element(limits().stretch.begin(), limits().stretch.end());
  most_energy_density_ = equal_stretch_energy(limit, 0, 0);
  std::vector<std::size_t> cut;
  for (const std::size_t i : body().points)
    if (body().damage(i) > 0) cut.push_back(i);
  refit(cut);
}

double Membrane::equal_stretch_energy(double stretch, std::size_t /*material*/, std::size_t /*other*/) const {
  const double s2 = (1 + stretch) * (1 + stretch);
  return energy_by_averages(s2, s2 * s2).w;
}

/// As `fit` has it.
double Membrane::share_left(const WholeFamily& family, const std::vector<bool>& exists,
                            std::size_t /*material*/) const {
  double left = 0, whole = 0;
  for (std::size_t k = 0; k < exists.size(); ++k) {
    const double weight = total_weight(std::array{PlaneBond{family.xi[k].x(), family.xi[k].y()}});
    whole += weight;
    if (exists[k]) left += weight;
  }
  return left < kLostFamily * whole ? 0 : left / whole;
}

Moments Membrane::coefficients(std::size_t point) const {
  if (body().on_lattice() == nullptr) return list_.points[point].coefficient;
  Moments c{};
  for (std::size_t m = 0; m < kMoments; ++m) c[m] = lattice_.coefficient[m][point];
  return c;
}

void Membrane::set_coefficients(std::size_t point, const Moments& coefficients) {
  if (body().on_lattice() == nullptr) {
    list_.points[point].coefficient = coefficients;
    return;
  }
  for (std::size_t m = 0; m < kMoments; ++m) lattice_.coefficient[m][point] = coefficients[m];
}

/// A block stays intact only where its points and all their neighbours have the weights of a whole family.
void Membrane::find_intact_blocks(const Moments& whole) {
  for (MembraneBondOffset& bond : lattice_.stencil) {
    bond.whole_weight = 0;
    for (std::size_t m = 0; m < kMoments; ++m) bond.whole_weight += whole[m] * bond.weight[m];
  }
  const auto is_whole = [&](std::size_t i) { return coefficients(i) == whole; };
  for (std::size_t i = 0; i < body().size(); ++i) {
    BlockKind& kind = lattice_.blocks[i / kLanes];
    if (kind != BlockKind::intact) continue;
    bool sound = is_whole(i);
    body().for_each_neighbour(i, [&](std::size_t j) { sound = sound && is_whole(j); });
    if (!sound) kind = BlockKind::partial;
  }
}

/// Bonds of a point without weights: those to other points, then those that end on inclusions.
std::vector<MembraneBond> Membrane::bonds_of(std::size_t point) const {
  std::vector<MembraneBond> bonds;
  const Eigen::Vector2d x = plane(body().position(point));
  body().for_each_neighbour(point, [&](std::size_t j) {
    bonds.push_back({plane(body().position(j)) - x, 0, static_cast<End>(j), -1});
  });
  for (const InterfaceBond& bond : body().interface_of(point))
    bonds.push_back({plane(bond.end) - x, 0,
                     end_of(static_cast<std::size_t>(&bond - body().interface.data())),
                     static_cast<int>(bond.inclusion)});
  return bonds;
}

/// Directions of a family at its whole lengths: a bond to an inclusion keeps the weight that it had
/// before it was shortened (theory 5a, rule 4). The order is that of `bonds_of`.
std::vector<PlaneBond> Membrane::unshortened_bonds_of(std::size_t point) const {
  std::vector<PlaneBond> bonds;
  const Point x = body().position(point);
  const auto add = [&](std::size_t j) {
    const Point y = body().position(j);
    bonds.push_back({y[0] - x[0], y[1] - x[1]});
  };
  body().for_each_neighbour(point, add);
  for (const InterfaceBond& bond : body().interface_of(point)) add(bond.neighbour);
  return bonds;
}

double Membrane::stabilisation_modulus(std::size_t point) const {
  return stabilisation_ * 0.5 * material_.small_strain().shear *
         (body().complete[point] ? 1.0 : kCutFamilyStabilisation);
}

void Membrane::make_families() {
  for (const std::size_t i : body().points) {
    planes_.kappa[i] = stabilisation_modulus(i);
    fit(i);
  }
  if (body().on_lattice() != nullptr) find_intact_blocks(WeightFormula::coefficients(whole_.coefficients));
}

/// Weights of a body point's family as it is, and the share of the energy that it has left. Most points of a
/// lattice have the whole stencil, which is solved for once.
void Membrane::fit(std::size_t point) {
  const std::vector<PlaneBond> bonds = unshortened_bonds_of(point);
  const double weight = total_weight(bonds);
  if (base_weight_[point] == 0) {
    base_weight_[point] = weight;
    base_trace_[point] = shape_tensor(bonds, base_weights(bonds)).inverse().trace();
  }
  const double share = weight > 0 ? weight / base_weight_[point] : 0;
  const bool at_interface = !body().interface_of(point).empty();
  const LatticeBonds* on = body().on_lattice();
  const bool is_whole = on != nullptr && !at_interface && bonds.size() == on->stencil.size();
  if (is_whole && whole_.weight.empty()) whole_ = moment_corrected_weights(bonds);
  const bool ragged = times_crushed(point) > 0 || (breaks() && is_at_crack(point));
  const FamilyWeights weights = ragged     ? base_weights(bonds)
                                : is_whole ? whole_
                                           : moment_corrected_weights(bonds);
  energy_volume_[point] = share * body().volume[point];
  smallest_weight_[point] = weights.smallest_ratio;
  const bool lost = share < kLostFamily || times_crushed(point) > 1;
  const bool by_formula = weights.kind == FamilyWeights::Kind::smooth && !at_interface && !lost;
  set_coefficients(point, by_formula ? WeightFormula::coefficients(weights.coefficients) : Moments{});
  if (by_formula) return;
  add_listed_family(point, weights, shape_tensor(bonds, weights),
                    lost ? std::vector<MembraneBond>{} : bonds_of(point));
}

/// Listed families that have kept their bonds stay as they are.
void Membrane::refit(std::span<const std::size_t> points) {
  const std::vector<ListedFamily> families = std::exchange(listed_, {});
  const ListedFamilyBonds bonds = std::exchange(listed_bonds_, {});
  auto next = families.begin();
  const auto keep_those_before = [&](std::size_t point) {
    for (; next != families.end() && next->point < point; ++next) keep_listed_family(*next, bonds);
    if (next != families.end() && next->point == point) ++next;
  };
  const std::vector<std::size_t> changed = with_neighbours(points);
  for (const std::size_t i : changed) {
    if (body().kind[i] != PointKind::body) continue;
    keep_those_before(i);
    fit(i);
  }
  keep_those_before(body().size());
  sort_incoming();
  open_blocks(with_neighbours(changed), lattice_.blocks);  // intact ones take all weights they see for whole
}

/// Ascending.
std::vector<std::size_t> Membrane::with_neighbours(std::span<const std::size_t> points) const {
  std::vector<std::size_t> all(points.begin(), points.end());
  for (const std::size_t i : points) body().for_each_neighbour(i, [&](std::size_t j) { all.push_back(j); });
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Whether bonds of a point or of a neighbour are gone.
bool Membrane::is_at_crack(std::size_t point) const {
  const auto is_cut = [&](std::size_t i) {
    return body().kind[i] == PointKind::body && body().damage(i) > 0;
  };
  bool at = is_cut(point);
  body().for_each_neighbour(point, [&](std::size_t j) { at = at || is_cut(j); });
  return at;
}

/// `shape`: sum w n n^T.
void Membrane::add_listed_family(std::size_t point, const FamilyWeights& weights,
                                 const Eigen::Matrix2d& shape, std::vector<MembraneBond> bonds) {
  ListedFamily family;
  family.point = point;
  family.by_least_squares = weights.kind == FamilyWeights::Kind::listed;
  family.by_gradient = weights.kind == FamilyWeights::Kind::gradient;
  for (std::size_t j = 0; j < bonds.size(); ++j) bonds[j].weight = weights.weight[j];
  if (bonds.empty()) family.by_gradient = false;
  if (family.by_gradient && shape.determinant() < kFlatFamily) {
    family.by_gradient = false;  // no weights, no gradient: the point hangs on its neighbours' forces alone
    bonds.clear();
  }
  if (family.by_gradient) family.inverse_shape = shape.inverse();
  // Few bonds near a line make F stiff across it: a damaged family is never stiffer than it was.
  if (family.by_gradient && !is_sound(point))
    energy_volume_[point] = std::min(
        energy_volume_[point], body().volume[point] * base_trace_[point] / family.inverse_shape.trace());
  ListedFamilyBonds& list = listed_bonds_;
  family.begin = list.end.size();
  for (const MembraneBond& bond : bonds) {
    list.x.push_back(bond.reference.x());
    list.y.push_back(bond.reference.y());
    list.weight.push_back(bond.weight);
    list.end.push_back(bond.end);
  }
  family.end = list.end.size();
  listed_.push_back(family);
}

void Membrane::keep_listed_family(ListedFamily family, const ListedFamilyBonds& bonds) {
  ListedFamilyBonds& list = listed_bonds_;
  const std::size_t begin = list.end.size();
  const auto copy = [&](auto& to, const auto& from) {
    const auto first = from.begin();
    to.insert(to.end(), first + static_cast<std::ptrdiff_t>(family.begin),
              first + static_cast<std::ptrdiff_t>(family.end));
  };
  copy(list.x, bonds.x);
  copy(list.y, bonds.y);
  copy(list.weight, bonds.weight);
  copy(list.end, bonds.end);
  family.end += begin - family.begin;
  family.begin = begin;
  listed_.push_back(family);
}

/// Sorts the bonds of the listed families by their far ends.
void Membrane::sort_incoming() {
  ListedFamilyBonds& list = listed_bonds_;
  list.force_x.assign(list.end.size(), 0.0);
  list.force_y.assign(list.end.size(), 0.0);
  std::vector<std::size_t> count(body().size(), 0);
  for (std::uint32_t b = 0; b < list.end.size(); ++b) {
    if (is_surface(list.end[b])) {
      list.surface.push_back(b);
    } else {
      ++count[list.end[b]];
    }
  }
  list.incoming_begin.push_back(0);
  std::vector<std::size_t> next(body().size(), 0);
  for (std::size_t i = 0; i < body().size(); ++i) {
    if (count[i] == 0) continue;
    next[i] = list.incoming_begin.back();
    list.target.push_back(static_cast<std::uint32_t>(i));
    list.incoming_begin.push_back(next[i] + count[i]);
  }
  list.incoming.resize(list.incoming_begin.back());
  for (std::uint32_t b = 0; b < list.end.size(); ++b)
    if (!is_surface(list.end[b])) list.incoming[next[list.end[b]]++] = b;
}

}  // namespace riven
