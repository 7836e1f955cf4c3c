#include "geometry/lattice.hpp"

#include "base/lanes.hpp"

namespace riven {

namespace {

std::size_t whole_vectors(int n) {
  return (static_cast<std::size_t>(n) + kLanes - 1) / kLanes * kLanes;
}

}  // namespace

Lattice::Lattice(int dimension, std::array<int, 3> cells, double spacing, const Point& first, int reach,
                 std::array<int, 3> layers)
    : dimension_(dimension), cells_(cells), layers_(layers), spacing_(spacing), first_(first) {
  left_ = whole_vectors(layers_[0]);
  row_ = left_ + whole_vectors(cells_[0]) + whole_vectors(layers_[0]);
  rows_ = static_cast<std::size_t>(cells_[1] + 2 * layers_[1]) *
          static_cast<std::size_t>(cells_[2] + 2 * layers_[2]);
  const auto along = [&](int axis) { return axis < dimension_ ? reach : 0; };
  slack_ = whole_vectors(static_cast<int>(shift({along(0), along(1), along(2)})));
  size_ = rows_ * row_ + 2 * slack_;
}

std::size_t Lattice::index(const Cell& cell) const {
  const auto along = [&](std::size_t axis) { return static_cast<std::size_t>(cell[axis] + layers_[axis]); };
  const std::size_t row = along(2) * static_cast<std::size_t>(cells_[1] + 2 * layers_[1]) + along(1);
  return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(row_begin(row) + left_) + cell[0]);
}

Cell Lattice::cell(std::size_t index) const {
  const std::size_t along = (index - slack_) % row_;
  const auto row = static_cast<int>((index - slack_) / row_);
  const int rows_y = cells_[1] + 2 * layers_[1];
  return {static_cast<int>(along) - static_cast<int>(left_), row % rows_y - layers_[1],
          row / rows_y - layers_[2]};
}

Point Lattice::position(const Cell& cell) const {
  Point p{};
  for (int a = 0; a < dimension_; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    p[axis] = first_[axis] + cell[axis] * spacing_;
  }
  return p;
}

bool Lattice::inside(const Cell& cell) const {
  for (std::size_t a = 0; a < 3; ++a)
    if (cell[a] < 0 || cell[a] >= cells_[a]) return false;
  return true;
}

bool Lattice::stored(const Cell& cell) const {
  for (std::size_t a = 0; a < 3; ++a)
    if (cell[a] < -layers_[a] || cell[a] >= cells_[a] + layers_[a]) return false;
  return true;
}

std::ptrdiff_t Lattice::shift(const Cell& offset) const {
  const std::ptrdiff_t rows_y = std::ptrdiff_t{cells_[1]} + std::ptrdiff_t{2} * layers_[1];
  return (offset[2] * rows_y + offset[1]) * static_cast<std::ptrdiff_t>(row_) + offset[0];
}

}  // namespace riven
