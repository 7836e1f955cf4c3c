#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace riven {

/// Functions of the slab time s in [0, 1], by which a slab's displacements are sums of vectors.
class TemporalBasis {
 public:
  virtual ~TemporalBasis() = default;
  [[nodiscard]] virtual std::size_t size() const = 0;
  [[nodiscard]] virtual double value(std::size_t function, double s) const = 0;
  /// Derivatives by s.
  [[nodiscard]] virtual double first(std::size_t function, double s) const = 0;
  [[nodiscard]] virtual double second(std::size_t function, double s) const = 0;
};

/// Polynomials of the second degree that are 1 at one of three nodes and 0 at the others; space-time theory
/// (1) for nodes 0, 1/2, 1.
class QuadraticLagrange final : public TemporalBasis {
 public:
  explicit QuadraticLagrange(double middle) : nodes_{0, middle, 1} {}
  [[nodiscard]] std::size_t size() const override { return 3; }
  [[nodiscard]] double value(std::size_t function, double s) const override;
  [[nodiscard]] double first(std::size_t function, double s) const override;
  [[nodiscard]] double second(std::size_t function, double s) const override;
  [[nodiscard]] double node(std::size_t function) const { return nodes_[function]; }

 private:
  /// The other two nodes, and the product of the node's distances from them.
  struct Others {
    double p, q, scale;
  };
  [[nodiscard]] Others others(std::size_t function) const;
  double nodes_[3];
};

/// Points and weights of a quadrature over [0, 1]; the weights' sum is 1.
struct TemporalRule {
  std::vector<double> point, weight;
};
/// Exact for polynomials up to degree 2 `points` - 1; ascending points, symmetric about 1/2.
TemporalRule gauss_rule(std::size_t points);

/// The matrices of the linear slab (theory (3)) for h = 1: rows are test functions, columns trial functions.
struct TemporalMatrices {
  Eigen::MatrixXd inertia;    // A = int N' N'' + N' N' at 0+
  Eigen::MatrixXd stiffness;  // B = int N' N + N N at 0+
};
TemporalMatrices temporal_matrices(const TemporalBasis& basis, const TemporalRule& rule);

}  // namespace riven
