#pragma once

#include <span>
#include <vector>

#include "linalg/symmetric_matrix.hpp"
#include "load/constraints.hpp"
#include "load/external_force.hpp"
#include "model/model.hpp"

namespace riven {

/// The tangent stiffness of a model under constraints, as a sparse matrix of the entries that are free and
/// have a tangent. With u = T q of the constraints it is T^T K T.
class TangentMatrix {
 public:
  /// Finds the pattern. With `mass` (kg, an entry per entry of the state) free entries that have some are
  /// unknowns too, whether bonds hold them or not.
  TangentMatrix(const Model& model, const Constraints& constraints, std::span<const double> u,
                std::span<const double> mass = {});

  /// Sums the tangent of a state, that of the last force evaluation.
  void assemble(std::span<const double> u);
  /// The same with what external forces add.
  void assemble(std::span<const double> u, const ExternalForces& external, double parameter);

  [[nodiscard]] const SymmetricMatrix& matrix() const { return matrix_; }
  /// Those of an earlier `matrix()`.
  void set_values(std::span<const double> values) { matrix_.value.assign(values.begin(), values.end()); }
  /// To add to the diagonal in place, and take it away again.
  [[nodiscard]] double& diagonal(std::size_t row) { return matrix_.value[matrix_.begin[row + 1] - 1]; }
  /// Entries of the state that the rows stand for.
  [[nodiscard]] std::span<const std::size_t> entries() const { return entries_; }

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
  void number_unknowns(const std::vector<Constraints::Image>& images, std::span<const double> u,
                       std::span<const double> mass);
  [[nodiscard]] std::vector<std::vector<Row>> rows_of(const std::vector<TangentBlocks>& pieces) const;
  void find_pattern(std::span<const double> u);
  void add(const std::vector<TangentBlocks>& pieces);
  void add(const std::vector<Row>& rows, const double* block, std::size_t size, int share);

  const Model& model_;
  std::vector<Unknown> unknowns_;     // of the state's entries
  std::vector<std::size_t> entries_;  // of the unknowns
  SymmetricMatrix matrix_;
};

}  // namespace riven
