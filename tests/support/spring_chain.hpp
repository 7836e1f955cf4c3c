#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "model/model.hpp"

namespace riven::testing {

/// Energy, force and stiffness of a spring by its elongation.
struct Spring {
  std::function<double(double)> energy, force, stiffness;
};

inline Spring linear_spring(double k) {
  return {[k](double e) { return 0.5 * k * e * e; }, [k](double e) { return k * e; },
          [k](double) { return k; }};
}

/// Of length 1 at rest: W = c (l^2 + 2/l - 3).
inline Spring neo_hookean_spring(double c) {
  return {[c](double e) { return c * ((1 + e) * (1 + e) + 2 / (1 + e) - 3); },
          [c](double e) { return 2 * c * (1 + e - std::pow(1 + e, -2)); },
          [c](double e) { return 2 * c * (1 + 2 * std::pow(1 + e, -3)); }};
}

/// Masses in a row along x, one entry each, a spring between neighbours and maybe one from the first to the
/// ground. Springs that are crushed to nothing are refused.
class SpringChain : public Model {
 public:
  SpringChain(std::vector<double> masses, Spring spring, bool grounded)
      : masses_(std::move(masses)), spring_(std::move(spring)), grounded_(grounded) {}

  [[nodiscard]] std::size_t dofs() const override { return masses_.size(); }
  std::optional<Breakdown> internal_force(std::span<const double> u, std::span<double> force) override {
    ++evaluations;
    std::fill(force.begin(), force.end(), 0.0);
    for (std::size_t i = grounded_ ? 0 : 1; i < u.size(); ++i) {
      const double e = elongation(u, i);
      if (!(e > -1)) return Breakdown{{}, "a spring is crushed"};
      const double f = spring_.force(e);
      force[i] -= f;
      if (i > 0) force[i - 1] += f;
    }
    return std::nullopt;
  }
  [[nodiscard]] double strain_energy(std::span<const double> u) override {
    double sum = 0;
    for (std::size_t i = grounded_ ? 0 : 1; i < u.size(); ++i) sum += spring_.energy(elongation(u, i));
    return sum;
  }
  [[nodiscard]] bool conservative() const override { return true; }
  void mass(std::span<double> mass) const override {
    std::copy(masses_.begin(), masses_.end(), mass.begin());
  }
  void stiffness_bound(std::span<const double>, std::span<double> bound) override {
    std::fill(bound.begin(), bound.end(), 4 * spring_.stiffness(0));
  }
  [[nodiscard]] std::size_t tangent_parts() const override { return masses_.size(); }
  void tangent(std::span<const double> u, std::size_t first, std::size_t last,
               TangentBlocks& to) const override {
    for (std::size_t i = first; i < last; ++i) {
      if (i == 0 && !grounded_) continue;
      const double k = spring_.stiffness(elongation(u, i));
      if (i > 0) to.dofs.push_back(i - 1);
      to.dofs.push_back(i);
      to.begin.push_back(to.dofs.size());
      if (i > 0)
        to.values.insert(to.values.end(), {k, -k, -k, k});
      else
        to.values.push_back(k);
    }
  }
  [[nodiscard]] double spacing() const override { return 1; }
  [[nodiscard]] std::optional<Breakdown> inspect(std::span<const double>) override { return std::nullopt; }
  void move(std::span<double>, const std::array<std::array<double, 3>, 3>&, const Point&) const override {}
  [[nodiscard]] std::vector<Point> positions() const override {
    std::vector<Point> points;
    for (std::size_t i = 0; i < masses_.size(); ++i) points.push_back(place(i));
    return points;
  }
  [[nodiscard]] std::vector<Point> displacements(std::span<const double> u) const override {
    std::vector<Point> points;
    for (const double x : u) points.push_back({x, 0, 0});
    return points;
  }
  [[nodiscard]] std::vector<ModelField> fields(std::span<const double>) override { return {}; }
  [[nodiscard]] Point place(std::size_t entry) const override {
    return {1.0 + static_cast<double>(entry), 0, 0};
  }
  [[nodiscard]] std::vector<std::string> describe() const override { return {}; }
  [[nodiscard]] std::size_t points() const override { return masses_.size(); }
  [[nodiscard]] std::size_t bonds() const override { return masses_.size(); }

  long evaluations = 0;

 private:
  [[nodiscard]] double elongation(std::span<const double> u, std::size_t i) const {
    return u[i] - (i > 0 ? u[i - 1] : 0);
  }
  std::vector<double> masses_;
  Spring spring_;
  bool grounded_;
};

}  // namespace riven::testing
