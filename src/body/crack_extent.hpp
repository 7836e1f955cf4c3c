#pragma once

#include <span>
#include <vector>

#include "body/body.hpp"

namespace riven {

/// How far cracks have grown since a state of the body at which its points had lost the shares `before` of
/// their bonds (docs/theory/cracks.md).

/// Share of the bonds that each of the body's points has lost, in their order.
std::vector<double> damages(const Body& body);

/// Share of its family that a point loses to a long flat crack `distance` horizons away, 0 to 1: that of a
/// disc (2D) or ball (3D) beyond a line or plane.
double share_beyond(int dimension, double distance);

/// Damage of a long flat crack along an axis, summed over a line across it (m): 1 times this would be a layer
/// of points without bonds. Bonds count whether they are broken or not.
double crack_depth(const Body& body);

/// Area (m^2) of the cracks beside the points `among`, numbers in the body's list: the damage since `before`
/// summed over their volume, divided by the depth of a flat crack.
double crack_area(const Body& body, double depth, std::span<const std::size_t> among,
                  std::span<const double> before, std::span<const double> now);

}  // namespace riven
