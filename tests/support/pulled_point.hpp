#pragma once

#include <optional>
#include <string>
#include <vector>

#include "load/constraints.hpp"
#include "model/model.hpp"

namespace riven::testing {

/// What models of one point have in common that a load pulls by something: the load moves u[0], and u[1] is
/// free.
class PulledPoint : public Model {
 public:
  [[nodiscard]] std::size_t dofs() const override { return 2; }
  [[nodiscard]] bool conservative() const override { return true; }
  void mass(std::span<double> mass) const override { mass[0] = mass[1] = 1; }
  [[nodiscard]] double spacing() const override { return 1; }
  [[nodiscard]] std::optional<Breakdown> inspect(std::span<const double>) override { return std::nullopt; }
  void move(std::span<double>, const std::array<std::array<double, 3>, 3>&, const Point&) const override {}
  [[nodiscard]] std::vector<Point> positions() const override { return {Point{}}; }
  [[nodiscard]] std::vector<Point> displacements(std::span<const double> u) const override {
    return {Point{u[1], 0, 0}};
  }
  [[nodiscard]] std::vector<ModelField> fields(std::span<const double>) override { return {}; }
  [[nodiscard]] Point place(std::size_t) const override { return {}; }
  [[nodiscard]] std::vector<std::string> describe() const override { return {}; }
  [[nodiscard]] std::size_t points() const override { return 1; }
  [[nodiscard]] std::size_t bonds() const override { return 1; }
};

/// The load u[0] = p - 1.
inline Constraints pull_point() {
  Constraints constraints(2, 1);
  constraints.add({.slave = 0, .terms = {{[](const Point&, double p) { return p - 1; }, {}, 0, 1, 0}}});
  return constraints;
}

}  // namespace riven::testing
