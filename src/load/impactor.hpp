#pragma once

#include <optional>
#include <span>
#include <string>
#include <variant>

#include "body/body.hpp"

namespace riven {

struct RigidSphere {  // a disc in two dimensions
  Point center{};     // at the start (m)
  double radius = 0;  // m
};

/// A half-space; the normal points out of it, to where bodies are.
struct RigidPlane {
  Point point{};   // on the plane, at the start (m)
  Point normal{};  // of length 1
};

/// A rigid body that does not turn and pushes points out of itself.
///
/// A point whose cell reaches into it by a depth, half a spacing nearer than the point itself, has the energy
/// kappa depth^2 / 2 V: a force along the normal that is the gradient of an energy and acts back on the
/// impactor.
struct Impactor {
  std::string name;
  std::variant<RigidSphere, RigidPlane> shape;
  std::optional<double> mass;  // kg; without, others say where it is
  double stiffness = 0;        // kappa (N/m^4): force density per depth

  [[nodiscard]] Point start() const;  // the centre, or the point of the plane (m)
};

/// How deep (m) a point's cell is in an impactor that has moved by `moved`, below 0 outside, and the way out;
/// of spheres, infinitely far from a spacing on.
struct Depth {
  double value = 0;
  Point out{};
};
Depth depth_of(const Impactor& impactor, const Point& moved, const Point& place, double half_spacing);

/// Adds the forces (N) on the body's points to a state's, and returns the force on the impactor.
Point push(const Impactor& impactor, const Point& moved, const Body& body, std::span<const double> u,
           std::span<double> force);
/// The force on the impactor alone (N).
Point force_on(const Impactor& impactor, const Point& moved, const Body& body, std::span<const double> u);
/// Energy of its contact (J).
double contact_energy(const Impactor& impactor, const Point& moved, const Body& body,
                      std::span<const double> u);
/// Adds a bound of the stiffness (N/m) to the rows of the points, as SelfContact does, and returns that of
/// the impactor's own: points less than a spacing away count there, since it may reach them before the
/// bound is asked for again, and a light impactor feels each.
double add_bound(const Impactor& impactor, const Point& moved, const Body& body, std::span<const double> u,
                 std::span<double> bound);

}  // namespace riven
