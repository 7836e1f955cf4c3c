#pragma once

#include <vector>

#include "load/constraints.hpp"
#include "load/external_force.hpp"

namespace riven {

/// A side that a pressure acts on: its nodes, corners first, counterclockwise seen from outside.
struct PressedSide {
  std::vector<std::uint32_t> node;
};

/// A pressure (Pa) on the deformed sides of a body, across them and into it: the force -p J F^-T n dA on each
/// undeformed area dA. Within a side the pressure is interpolated between its nodes. In two dimensions a
/// side is as thick as it was.
class FollowerPressure final : public ExternalForce {
 public:
  /// `place`: undeformed positions of all nodes (m); entry `axis` of a node is axis * nodes + node.
  FollowerPressure(LoadFunction pressure, std::vector<PressedSide> sides, std::vector<Point> place,
                   int dimension, double thickness);

  void add(std::span<const double> u, std::span<const double> v, double parameter,
           std::span<double> force) override;
  /// The symmetric part of a block per side. Of a constant pressure the rest cancels where sides meet, and
  /// is left on rims that are free to move.
  void tangent(std::span<const double> u, double parameter, TangentBlocks& to) const override;
  /// Of a pressure that changes in proportion on a straight way: exact, the pressure times the volume swept.
  [[nodiscard]] double work(std::span<const double> u_before, double before, std::span<const double> u,
                            double parameter) const override;
  /// Sum of all forces in a state (N).
  [[nodiscard]] Point total(std::span<const double> u, double parameter) const;

 private:
  /// Calls visit(point, pressure, r, s) for the quadrature points of a side; r and s: along its deformed
  /// coordinates (m), in two dimensions s is the thickness. Their cross product is the normal times area.
  template <class Visit>
  void for_each_point(const PressedSide& side, std::span<const double> u, const std::vector<double>& pressure,
                      const Visit& visit) const;
  /// Calls visit(entry, force) with the forces of all sides; a pressure for each node of each side.
  template <class Visit>
  void for_each_force(std::span<const double> u, const std::vector<double>& pressure,
                      const Visit& visit) const;
  /// Of all nodes of all sides.
  [[nodiscard]] std::vector<double> pressures(double parameter) const;

  LoadFunction pressure_;
  std::vector<PressedSide> sides_;
  std::vector<Point> place_;
  int dimension_;
  double thickness_;
};

}  // namespace riven
