#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "load/distributed_force.hpp"
#include "load/impactor.hpp"

namespace riven {

/// The flat end of a punch, in two dimensions: a segment with the punch to the left of the way along it.
struct RigidFlat {
  Point from{}, to{};  // ends at the start (m)
  double fade = 0;     // beyond its ends the punch lets go of places over this length (m)
};

using IndenterShape = std::variant<RigidSphere, RigidPlane, RigidFlat>;
/// The centre, the point of the plane, or the middle of the flat, at the start (m).
Point start_of(const IndenterShape& shape);

struct IndenterSettings {
  std::string name;
  IndenterShape shape;
  std::function<Point(double parameter)> way;  // what it has moved by (m)
  double stiffness = 0;                        // epsilon (N/m^3): pressure per depth
  bool sticking = false;                       // or frictionless
  double spacing = 0;                          // of the body's nodes (m)
  /// The tangent of what is deeper is that of this depth (m), but for the stiffness along the normal: what a
  /// round face takes from the stiffness across grows with the depth, and deep nodes are in states that are
  /// only tried, from which it would lead astray.
  double deepest = std::numeric_limits<double>::infinity();
};

/// A rigid body that pushes a part of a mesh's surface out of itself. It moves as prescribed and does not
/// turn.
///
/// A node with the area A has the energy A epsilon w (g^2 + |s|^2) / 2 where its depth g is above 0. Nodes,
/// not points inside of sides: then there are as many conditions as nodes, while points inside would ask
/// straight sides to follow a round indenter, and lock where the penalty is large. s is what a node that
/// sticks has moved along the indenter since it touched, 0 where there is no friction; w is 1, but for what
/// is beyond the ends of a flat. A node sticks from the state on in which `advance` first finds it in touch,
/// until `advance` finds it outside: in between forces are those of an energy, and `advance` changes none.
class Indenter final : public ExternalForce {
 public:
  /// `surface`: nodes with their areas (m^2); `points`: nodes of the body, entry `axis` of a node is axis *
  /// points + node.
  Indenter(IndenterSettings settings, std::vector<LoadShare> surface, std::size_t points, int dimension);

  void add(std::span<const double> u, std::span<const double> v, double parameter,
           std::span<double> force) override;
  void tangent(std::span<const double> u, double parameter, TangentBlocks& to) const override;
  /// The work of what moves the indenter, by the trapezoidal rule while nodes are in touch.
  [[nodiscard]] double work(std::span<const double> u_before, double before, std::span<const double> u,
                            double parameter) const override;
  /// The energy of the contact, and what nodes that stuck held when they came off.
  [[nodiscard]] double held(std::span<const double> u, double parameter) const override;
  /// Nodes less than ten spacings away count, since they may come into contact before it is asked again, four
  /// times: an explicit step is half as long, and a contact that begins is seen twice as often.
  void stiffness_bound(std::span<const double> u, double parameter, std::span<double> bound) const override;
  void advance(std::span<const double> u, double parameter) override;
  void save(Snapshot& to) const override { each_member(*this, to.saving()); }
  void restore(const Snapshot& from) override { each_member(*this, from.restoring()); }

  [[nodiscard]] bool has_memory() const override { return settings_.sticking; }

  [[nodiscard]] const IndenterSettings& settings() const { return settings_; }
  [[nodiscard]] const std::vector<LoadShare>& surface() const { return surface_; }
  /// Force of the body on the indenter (N).
  [[nodiscard]] Point force_on(std::span<const double> u, double parameter) const;
  /// Depth of a node of the surface (m), below 0 outside, or where a flat has let go of it.
  [[nodiscard]] double depth(std::size_t share, std::span<const double> u, double parameter) const;

 private:
  template <class Self, class Each>
  static void each_member(Self& self, const Each& each) {
    const std::string name = "indenter." + self.settings_.name;
    each(name + ".sticks", self.sticks_);
    each(name + ".first", self.first_);
    each(name + ".stored", self.stored_);
    each(name + ".lost", self.lost_);
  }
  /// Energy (J) of a node, its derivative (N) and the derivative of that (N/m).
  struct Push {
    double energy = 0;
    Eigen::Vector3d slope = Eigen::Vector3d::Zero();
    Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
  };
  [[nodiscard]] Eigen::Vector3d place(std::size_t share, std::span<const double> u, const Point& moved) const;
  [[nodiscard]] Eigen::Vector3d first_place(std::size_t share) const;
  [[nodiscard]] Push push(std::size_t share, const Eigen::Vector3d& at) const;

  IndenterSettings settings_;
  std::vector<LoadShare> surface_;
  std::size_t points_, dimension_;
  // By shares:
  std::vector<std::uint8_t> sticks_;
  std::vector<double> first_;   // three per share: where on the indenter it first touched (m)
  std::vector<double> stored_;  // energy in the state of the last `advance` (J)
  double lost_ = 0;             // of nodes that came off (J)
};

}  // namespace riven
