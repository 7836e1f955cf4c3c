#pragma once

#include <array>
#include <cstddef>

#include "geometry/shape.hpp"

namespace riven {

/// Numbers of a cell along x, y, z, counted from the first cell of the body; ghost cells are below 0 or
/// above.
using Cell = std::array<int, 3>;

/// A uniform lattice in 1, 2 or 3 dimensions: one point at the centre of each cell, with room for layers of
/// ghost points around them, x running fastest. Rows are padded to whole vectors and the ends of the storage
/// by the reach of a bond, so that a kernel may load whole vectors at any neighbour of any row; beyond the
/// ghost layers what it finds there are other points.
class Lattice {
 public:
  Lattice() = default;
  /// `first`: position of cell (0, 0, 0) in metres; `cells`: number along each axis, 1 beyond the dimension;
  /// `reach`: of a bond, in cells; `layers` of ghost cells on both sides of each axis.
  Lattice(int dimension, std::array<int, 3> cells, double spacing, const Point& first, int reach,
          std::array<int, 3> layers);

  [[nodiscard]] int dimension() const { return dimension_; }
  [[nodiscard]] const std::array<int, 3>& cells() const { return cells_; }
  [[nodiscard]] double spacing() const { return spacing_; }
  /// Layers of ghost cells on both sides of an axis.
  [[nodiscard]] int layers(std::size_t axis) const { return layers_[axis]; }

  /// Entries of a field's storage, padding included; a multiple of kLanes.
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] std::size_t row_length() const { return row_; }
  /// First entry of row r, r in [0, rows()); a multiple of kLanes.
  [[nodiscard]] std::size_t row_begin(std::size_t r) const { return slack_ + r * row_; }

  [[nodiscard]] std::size_t index(const Cell& cell) const;
  [[nodiscard]] Cell cell(std::size_t index) const;
  [[nodiscard]] Point position(const Cell& cell) const;
  [[nodiscard]] Point position(std::size_t index) const { return position(cell(index)); }
  /// Whether the cell belongs to the body's box (no ghost).
  [[nodiscard]] bool inside(const Cell& cell) const;
  /// Whether the cell lies in the box grown by the ghost layers.
  [[nodiscard]] bool stored(const Cell& cell) const;
  /// Difference of storage index between a cell and the one at `offset`.
  [[nodiscard]] std::ptrdiff_t shift(const Cell& offset) const;

  /// Calls visit(cell, index) for every cell of the box grown by the ghost layers, in storage order.
  template <class Visit>
  void for_each_cell(const Visit& visit) const {
    for (int k = -layers(2); k < cells_[2] + layers(2); ++k)
      for (int j = -layers(1); j < cells_[1] + layers(1); ++j)
        for (int i = -layers(0); i < cells_[0] + layers(0); ++i) visit(Cell{i, j, k}, index({i, j, k}));
  }

 private:
  int dimension_ = 0;
  std::array<int, 3> cells_{1, 1, 1};
  std::array<int, 3> layers_{};
  double spacing_ = 0;
  Point first_{};
  std::size_t left_ = 0;  // padding before cell 0 of a row
  std::size_t row_ = 0;   // entries of a row
  std::size_t rows_ = 0;
  std::size_t slack_ = 0;  // padding before the first and after the last row
  std::size_t size_ = 0;
};

}  // namespace riven
