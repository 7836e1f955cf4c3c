#include "load/distributed_force.hpp"

#include <algorithm>
#include <cmath>

namespace riven {

template <class Visit>
void DistributedForce::for_each(double parameter, const Visit& visit) const {
  for (std::size_t axis = 0; axis < density_.size(); ++axis)
    if (density_[axis])
      for (const LoadShare& share : shares_)
        visit(axis, axis * points_ + share.point,
              share.extent * (*density_[axis])(share.position, parameter));
}

void DistributedForce::add(std::span<const double> /*u*/, std::span<const double> /*v*/, double parameter,
                           std::span<double> force) {
  for_each(parameter, [&](std::size_t, std::size_t entry, double value) { force[entry] += value; });
}

double DistributedForce::work(std::span<const double> u_before, double before, std::span<const double> u,
                              double parameter) const {
  double work = 0;
  for (const double end : {before, parameter})
    for_each(end, [&](std::size_t, std::size_t entry, double value) {
      work += 0.5 * value * (u[entry] - u_before[entry]);
    });
  return work;
}

Point DistributedForce::total(double parameter) const {
  Point sum{};
  for_each(parameter, [&](std::size_t axis, std::size_t, double value) { sum[axis] += value; });
  return sum;
}

std::vector<LoadShare> edge_shares(const Body& body, std::size_t face, double layer) {
  std::vector<LoadShare> shares;
  double volume = 0;
  for (const std::size_t point : body.points) {
    Point x = body.position(point);
    if (std::abs(x[face / 2] - body.faces[face]) > layer * (1 - 1e-9)) continue;
    x[face / 2] = body.faces[face];
    shares.push_back({point, x, body.volume[point]});
    volume += body.volume[point];
  }
  const bool cut = !body.defects.holes.empty() || !body.defects.inclusions.empty();
  const double area = cut ? std::min(body.face_area(face), volume / layer) : body.face_area(face);
  for (LoadShare& share : shares) share.extent *= area / volume;
  return shares;
}

}  // namespace riven
