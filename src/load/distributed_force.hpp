#pragma once

#include <array>
#include <optional>

#include "body/body.hpp"
#include "load/constraints.hpp"
#include "load/external_force.hpp"

namespace riven {

/// A body point's share of what a force is distributed over.
struct LoadShare {
  std::size_t point = 0;
  Point position{};   // where the force's density is taken (m)
  double extent = 0;  // area (m^2) for a traction, volume (m^3) for a body force
};

/// A dead load: a traction (N/m^2) or a body force (N/m^3) on points, that follows neither the body's
/// rotation nor its change of area.
class DistributedForce final : public ExternalForce {
 public:
  using Density = std::array<std::optional<LoadFunction>, 3>;  // nothing: no force along the axis

  /// `points`: of the body, stored ones; entry `axis` of a point is axis * points + point.
  DistributedForce(Density density, std::vector<LoadShare> shares, std::size_t points)
      : density_(std::move(density)), shares_(std::move(shares)), points_(points) {}

  void add(std::span<const double> u, std::span<const double> v, double parameter,
           std::span<double> force) override;
  /// By the trapezoidal rule.
  [[nodiscard]] double work(std::span<const double> u_before, double before, std::span<const double> u,
                            double parameter) const override;
  /// Sum of all forces (N).
  [[nodiscard]] Point total(double parameter) const;

 private:
  /// Calls visit(axis, entry, force) for every component of every share.
  template <class Visit>
  void for_each(double parameter, const Visit& visit) const;

  Density density_;
  std::vector<LoadShare> shares_;
  std::size_t points_;
};

/// Shares of an edge's area, in proportion to their volumes, of the body points nearer to it than `layer`
/// (m). The area is that of the whole edge; where defects may have cut it, the volume in the layer over its
/// thickness if that is less. Empty if there are no such points.
std::vector<LoadShare> edge_shares(const Body& body, std::size_t face, double layer);

}  // namespace riven
