#pragma once

#include <span>
#include <vector>

#include "linalg/cholesky.hpp"
#include "load/constraints.hpp"
#include "model/model.hpp"

namespace riven {

/// The tangent stiffness of a model under constraints, as a sparse linear system of the entries that are free
/// and have a tangent. With u = T q of the constraints it is T^T K T.
class TangentSystem {
 public:
  /// Finds the system's pattern and an ordering for it. Throws FactorFailure.
  TangentSystem(const Model& model, const Constraints& constraints, std::span<const double> u);

  /// Sums the tangent of a state, that of the last force evaluation.
  void assemble(std::span<const double> u);
  /// Factors the tangent plus `shift` times `diagonal`, which has an entry per entry of the state (N/m).
  /// False unless the sum is positive definite.
  [[nodiscard]] bool factor(double shift, std::span<const double> diagonal);
  /// The displacements (m) that the forces (N) on a state's free entries call for; 0 elsewhere.
  void solve(std::span<const double> force, std::span<double> increment);

  [[nodiscard]] std::size_t unknowns() const { return matrix_.rows(); }
  /// Operations and memory (bytes) of a factorisation.
  [[nodiscard]] double flops() const { return cholesky_.flops(); }
  [[nodiscard]] double bytes() const;

 private:
  struct Unknown {
    int number = -1;  // -1: held, or without a tangent
    double sign = 1;
  };
  /// A row of a block that belongs to an unknown.
  struct Row {
    int number = 0;
    std::size_t place = 0;  // in the block
    double sign = 1;
  };
  /// Calls visit(blocks) for all of the tangent's blocks, in order, some hundred parts of it at a time.
  template <class Visit>
  void for_each_batch(std::span<const double> u, const Visit& visit) const;
  void number_unknowns(const std::vector<Constraints::Image>& images, std::span<const double> u);
  [[nodiscard]] std::vector<std::vector<Row>> rows_of(const std::vector<TangentBlocks>& pieces) const;
  void find_pattern(std::span<const double> u);
  void add(const std::vector<Row>& rows, const double* block, std::size_t size, int share);

  const Model& model_;
  std::vector<Unknown> unknowns_;     // of the state's entries
  std::vector<std::size_t> entries_;  // of the unknowns
  SymmetricMatrix matrix_;
  SparseCholesky cholesky_;
};

}  // namespace riven
