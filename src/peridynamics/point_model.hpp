#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "body/body.hpp"
#include "model/model.hpp"

namespace riven {

/// A model whose state is the displacement of a body's points and of the rigid inclusions in it.
///
/// A state holds u_x of all stored points, then u_y (and u_z), then for each inclusion its translation (2)
/// and its rotation angle times its radius of gyration (m). Entries of ghost points are inputs, set by the
/// loads.
class PointModel : public Model {
 public:
  [[nodiscard]] std::size_t dofs() const override;
  void mass(std::span<double> mass) const override;
  [[nodiscard]] double spacing() const override { return body_.spacing; }
  void move(std::span<double> u, const std::array<std::array<double, 3>, 3>& gradient,
            const Point& shift) const override;
  [[nodiscard]] std::vector<Point> positions() const override;
  [[nodiscard]] std::vector<Point> displacements(std::span<const double> u) const override;
  [[nodiscard]] Point place(std::size_t entry) const override;
  [[nodiscard]] std::size_t points() const override { return body_.points.size(); }
  [[nodiscard]] std::size_t bonds() const override { return directed_bonds_; }

  [[nodiscard]] const Body& body() const { return body_; }
  /// First of the three entries of an inclusion in a state.
  [[nodiscard]] std::size_t inclusion_dof(std::size_t inclusion) const;
  /// Memory that body and model hold, without state vectors (bytes).
  [[nodiscard]] virtual std::size_t bytes() const = 0;

 protected:
  /// For models whose bonds break.
  [[nodiscard]] Body& own_body() { return body_; }
  /// `density` of each of the body's materials (kg/m^3), the first one of the inclusions too. Throws
  /// InputError unless the inclusions are discs or boxes of a two-dimensional body.
  PointModel(Body body, std::vector<double> density);
  /// The densities in the settings of a body's materials.
  template <class Settings>
  static std::vector<double> densities(const std::vector<Settings>& of) {
    std::vector<double> values;
    for (const Settings& one : of) values.push_back(one.density);
    return values;
  }
  // Kernels hold on to places in a model's vectors: those move with it, but a copy would look at the
  // original.
  PointModel(PointModel&&) = default;

  /// What a bond ends on: a stored point, or behind those the surface point of an interface bond.
  using End = std::uint32_t;
  [[nodiscard]] End end_of(std::size_t interface_bond) const {
    return static_cast<End>(body_.size() + interface_bond);
  }
  [[nodiscard]] bool is_surface(End end) const { return end >= body_.size(); }

  /// Share of a point's bonds that cracks have cut, the field "damage"; 0 for rigid points.
  [[nodiscard]] ModelField damage() const;

  /// Places the surface points of all inclusions where a state has them; `displacement` then uses them.
  void place_inclusions(std::span<const double> u);
  [[nodiscard]] Eigen::Vector2d displacement(End end, std::span<const double> u) const {
    if (is_surface(end)) return surface_[end - body_.size()];
    return {u[end], u[body_.size() + end]};
  }
  /// Adds a force (N) on a surface point to the force on its inclusion.
  void push_inclusion(End surface, const Eigen::Vector2d& pull, std::span<double> force) const;
  /// Appends the tangent block of a family, from the first and second derivatives of its energy by the
  /// components of its deformed bonds, bond after bond (N, N/m). `ends`: of the bonds. The first derivatives
  /// count only where bonds end on inclusions.
  void add_family_block(std::size_t point, std::span<const End> ends, const Eigen::VectorXd& gradient,
                        const Eigen::MatrixXd& hessian, TangentBlocks& to) const;
  /// Adds a row bound (N/m) of a bond's end to that of the entries that move it.
  void add_row(End end, double row, std::span<double> bound) const;

 private:
  struct Inclusion {
    Eigen::Vector2d center;
    double gyration = 0;             // radius of gyration (m)
    double mass = 0;                 // kg
    Eigen::Rotation2Dd rotation{0};  // of the state placed last
  };

  /// Replaces the surface points among a block's ends by the entries of their inclusions.
  void move_to_inclusions(std::span<const End> ends, const Eigen::VectorXd& gradient,
                          std::vector<std::size_t>& dofs, Eigen::MatrixXd& block) const;
  /// From the inclusion's centre to a surface point (m).
  [[nodiscard]] Eigen::Vector2d arm(const InterfaceBond& bond) const;

  Body body_;
  std::vector<double> density_;
  std::size_t directed_bonds_ = 0;
  std::vector<Inclusion> inclusions_;
  std::vector<Eigen::Vector2d> surface_;  // displacements of the surface points (m)
};

}  // namespace riven
