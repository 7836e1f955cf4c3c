#include "body/body.hpp"

#include <algorithm>

#include "base/lanes.hpp"

namespace riven {

void ListedBonds::close() {
  const std::size_t points = begin.size() - 1;
  neighbour.resize(begin.back() + kLanes, 0);
  masks.assign(begin.back() / 8 + points + 1, 0);
  for (std::size_t i = 0; i < points; ++i)
    for (std::size_t n = 0; n < begin[i + 1] - begin[i]; ++n)
      masks[begin[i] / 8 + i + n / 8] |= static_cast<std::uint8_t>(1U << (n % 8));
}

Point Body::position(std::size_t point) const {
  const LatticeBonds* on = on_lattice();
  return on != nullptr ? on->lattice.position(point) : std::get<ListedBonds>(bonds).position[point];
}

std::span<const InterfaceBond> Body::interface_of(std::size_t point) const {
  const auto [first, last] =
      std::equal_range(interface.begin(), interface.end(), InterfaceBond{.point = point},
                       [](const InterfaceBond& a, const InterfaceBond& b) { return a.point < b.point; });
  return {first, last};
}

std::size_t Body::family_size(std::size_t point) const {
  std::size_t size = interface_of(point).size();
  for_each_neighbour(point, [&](std::size_t) { ++size; });
  return size;
}

void Body::mark(std::vector<std::uint8_t>& values, std::span<const std::size_t> numbers,
                std::uint8_t value) const {
  values.resize(size(), 0);
  for (const std::size_t number : numbers) values[points[number]] = value;
  for (const GhostPoint& ghost : ghosts) values[ghost.point] = values[ghost.master];
}

void Body::cut(std::size_t point, std::size_t bond) {
  if (auto* on = std::get_if<LatticeBonds>(&bonds)) return on->bonds.cut(on->stencil, bond, point);
  auto& list = std::get<ListedBonds>(bonds);
  const std::size_t end = list.neighbour[bond];
  const auto first = list.neighbour.begin() + static_cast<std::ptrdiff_t>(list.begin[end]);
  const auto last = list.neighbour.begin() + static_cast<std::ptrdiff_t>(list.begin[end + 1]);
  list.cut(point, bond);
  list.cut(end, static_cast<std::size_t>(std::lower_bound(first, last, point) - list.neighbour.begin()));
}

double Body::damage(std::size_t point) const {
  const double whole = whole_family[point];  // 0 for a point that holes have cut off from all others
  return whole > 0 ? 1 - static_cast<double>(family_size(point)) / whole : 0;
}

double Body::face_area(std::size_t face) const {
  double area = thickness;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(dimension); ++axis)
    if (axis != face / 2) area *= faces[2 * axis + 1] - faces[2 * axis];
  return area;
}

std::size_t Body::bytes() const {
  std::size_t sum = size() * (sizeof(PointKind) + sizeof(double) + sizeof(std::uint32_t)) + size() / 8 +
                    material.size() + unbreakable.size() + points.size() * sizeof(std::size_t) +
                    interface.size() * sizeof(InterfaceBond);
  if (const LatticeBonds* on = on_lattice()) return sum + size() * on->stencil.size() / 8;
  const auto& list = std::get<ListedBonds>(bonds);
  return sum + size() * (sizeof(Point) + sizeof(std::size_t)) +
         list.neighbour.size() * sizeof(std::uint32_t) + list.masks.size();
}

Point reflected(const Body& body, const Faces& at, const Point& x) {
  Point image = x;
  for (std::size_t face = 0; face < at.size(); ++face)
    if (at.test(face)) image[face / 2] = 2 * body.faces[face] - image[face / 2];
  return image;
}

}  // namespace riven
