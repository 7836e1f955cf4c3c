#include "body/listed_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "body/bond_rules.hpp"
#include "geometry/cubes.hpp"

namespace riven {

namespace {

// A family that holds less than this share of the body's median is cut by a free edge: one that lacks what
// lies beyond 0.7 horizons does. Irregular points alone make families differ by a few percent.
constexpr double kCompleteShare = 0.9;

class ListedBodyMaker {
 public:
  explicit ListedBodyMaker(const ListedBodyInput& in) : in_(in) {}

  Body make() {
    set_constants();
    sort_points();
    make_ghosts();
    make_bonds();
    body_.bonds = std::move(list_);
    return std::move(body_);
  }

 private:
  void set_constants() {
    double volume = 0;
    for (const double v : in_.volume) volume += v;
    body_.dimension = in_.dimension;
    body_.spacing =
        std::pow(volume / static_cast<double>(in_.volume.size()) / in_.thickness, 1.0 / in_.dimension);
    body_.horizon = in_.horizon;
    body_.thickness = in_.thickness;
    body_.faces = in_.faces;
    body_.defects = in_.defects;
    body_.rigid_points.resize(in_.defects.inclusions.size());
    list_.position = in_.position;
    body_.volume = in_.volume;
  }

  void sort_points() {
    const BondRules rules(body_);
    for (std::size_t i = 0; i < list_.position.size(); ++i) {
      const Point& x = list_.position[i];
      const auto inside = [&](const Shape& hole) { return signed_distance(hole, x) < 0; };
      PointKind kind = PointKind::body;
      if (const auto inclusion = rules.rigid_inclusion(x)) {
        kind = PointKind::rigid;
        body_.rigid_points[*inclusion].push_back(i);
      } else if (std::any_of(in_.defects.holes.begin(), in_.defects.holes.end(), inside)) {
        kind = PointKind::outside;
      }
      body_.kind.push_back(kind);
      if (kind == PointKind::body) body_.points.push_back(i);
      if (kind != PointKind::body) body_.volume[i] = 0;
    }
    if (body_.points.empty()) throw InputError("nothing is left of the body: holes and inclusions cover it");
  }

  /// Images of the points near mirrored faces, at each face and at each corner of such faces.
  void make_ghosts() {
    for (const std::size_t i : body_.points) {
      std::vector<Faces> images = {Faces()};
      for (std::size_t face = 0; face < 2 * static_cast<std::size_t>(in_.dimension); ++face) {
        if (!in_.mirrored.test(face)) continue;
        if (std::abs(list_.position[i][face / 2] - in_.faces[face]) > in_.horizon) continue;
        for (std::size_t n = images.size(); n-- > 0;) {
          if (images[n].test(face ^ 1U)) continue;
          images.push_back(images[n]);
          images.back().set(face);
        }
      }
      for (std::size_t n = 1; n < images.size(); ++n) {
        body_.ghosts.push_back({list_.position.size(), i, images[n]});
        list_.position.push_back(reflected(body_, images[n], list_.position[i]));
        body_.kind.push_back(PointKind::ghost);
        body_.volume.push_back(0);
      }
    }
  }

  void make_bonds() {
    const std::size_t size = body_.size();
    std::vector<Faces> mirrored(size);
    std::vector<double> volume = in_.volume;  // of every stored point, ghosts and rigid ones too
    for (const GhostPoint& ghost : body_.ghosts) {
      mirrored[ghost.point] = ghost.faces;
      volume.push_back(in_.volume[ghost.master]);
    }
    const double reach = horizon_limit(in_.horizon);
    const Cubes cubes(list_.position, in_.dimension, reach);
    const BondRules rules(body_);
    std::vector<std::vector<std::uint32_t>> neighbours(size);
    std::vector<double> family(size, 0.0);  // volume of what a point's bonds reach (m^3)
    body_.whole_family.assign(size, 0);
    for (const std::size_t i : body_.points) {
      const bool near_defect = rules.near_defect(list_.position[i]);
      for (const std::size_t j : cubes.within(list_.position[i], reach)) {
        if (j == i || body_.kind[j] == PointKind::outside) continue;
        BondRules::Bond bond;
        if (near_defect)
          bond = rules.between(list_.position[i], list_.position[j], body_.kind[j], mirrored[j]);
        using enum BondRules::Verdict;
        if (bond.verdict == none) continue;
        ++body_.whole_family[i];
        if (bond.verdict == cracked) continue;
        family[i] += volume[j];
        if (bond.verdict == interface) {
          body_.interface.push_back({i, j, bond.inclusion, bond.end, volume[j]});
          continue;
        }
        neighbours[i].push_back(static_cast<std::uint32_t>(j));
        if (body_.kind[j] == PointKind::ghost) neighbours[j].push_back(static_cast<std::uint32_t>(i));
      }
    }
    find_complete(family);
    list_.begin.assign(1, 0);
    for (const auto& of_point : neighbours) {
      list_.neighbour.insert(list_.neighbour.end(), of_point.begin(), of_point.end());
      list_.begin.push_back(list_.neighbour.size());
    }
    list_.close();
  }

  void find_complete(const std::vector<double>& family) {
    std::vector<double> sorted;
    for (const std::size_t i : body_.points) sorted.push_back(family[i]);
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    body_.complete.assign(body_.size(), false);
    for (const std::size_t i : body_.points) body_.complete[i] = family[i] >= kCompleteShare * *middle;
  }

  const ListedBodyInput& in_;
  Body body_;
  ListedBonds list_;
};

}  // namespace

Body make_listed_body(const ListedBodyInput& input) {
  return ListedBodyMaker(input).make();
}

Body listed(const Body& lattice_body) {
  Body body = lattice_body;
  std::vector<std::size_t> stored;  // of the lattice body, in the new order
  for (std::size_t i = 0; i < body.size(); ++i)
    if (body.kind[i] == PointKind::body || body.kind[i] == PointKind::rigid) stored.push_back(i);
  for (const GhostPoint& ghost : body.ghosts) stored.push_back(ghost.point);
  std::vector<std::size_t> number(body.size());
  for (std::size_t n = 0; n < stored.size(); ++n) number[stored[n]] = n;

  ListedBonds list;
  list.begin.push_back(0);
  body.kind.clear();
  body.volume.clear();
  body.whole_family.clear();
  body.complete.clear();
  for (const std::size_t i : stored) {
    list.position.push_back(lattice_body.position(i));
    body.kind.push_back(lattice_body.kind[i]);
    body.volume.push_back(lattice_body.volume[i]);
    body.whole_family.push_back(lattice_body.whole_family[i]);
    body.complete.push_back(lattice_body.complete[i]);
    const std::size_t first = list.neighbour.size();
    lattice_body.for_each_neighbour(
        i, [&](std::size_t j) { list.neighbour.push_back(static_cast<std::uint32_t>(number[j])); });
    std::sort(list.neighbour.begin() + static_cast<std::ptrdiff_t>(first), list.neighbour.end());
    list.begin.push_back(list.neighbour.size());
  }
  list.close();
  for (std::size_t& i : body.points) i = number[i];
  for (auto& points : body.rigid_points)
    for (std::size_t& i : points) i = number[i];
  for (GhostPoint& ghost : body.ghosts) {
    ghost.point = number[ghost.point];
    ghost.master = number[ghost.master];
  }
  for (InterfaceBond& bond : body.interface) {
    bond.point = number[bond.point];
    bond.neighbour = number[bond.neighbour];
  }
  body.bonds = std::move(list);
  return body;
}

}  // namespace riven
