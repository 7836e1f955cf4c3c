#include "geometry/lattice.hpp"

#include "base/lanes.hpp"

namespace riven {

namespace {

std::size_t whole_vectors(int n) {
  return (static_cast<std::size_t>(n) + kLanes - 1) / kLanes * kLanes;
}

}  // namespace

Lattice::Lattice(int dimension, std::array<int, 3> cells, double spacing, const Point& first, int reach)
    : dimension_(dimension), reach_(reach), cells_(cells), spacing_(spacing), first_(first) {
  left_ = whole_vectors(reach_);
  row_ = left_ + whole_vectors(cells_[0]) + whole_vectors(reach_);
  rows_ = static_cast<std::size_t>(cells_[1] + 2 * this->reach(1)) *
          static_cast<std::size_t>(cells_[2] + 2 * this->reach(2));
  slack_ = whole_vectors(reach_);
  size_ = rows_ * row_ + 2 * slack_;
}

std::size_t Lattice::index(const Cell& cell) const {
  const auto along = [&](int axis) {
    const int number = cell[static_cast<std::size_t>(axis)] + reach(axis);
    return static_cast<std::size_t>(number);
  };
  const std::size_t row = along(2) * static_cast<std::size_t>(cells_[1] + 2 * reach(1)) + along(1);
  return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(row_begin(row) + left_) + cell[0]);
}

Cell Lattice::cell(std::size_t index) const {
  const std::size_t along = (index - slack_) % row_;
  const auto row = static_cast<int>((index - slack_) / row_);
  const int rows_y = cells_[1] + 2 * reach(1);
  return {static_cast<int>(along) - static_cast<int>(left_), row % rows_y - reach(1),
          row / rows_y - reach(2)};
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
  for (std::size_t a = 0; a < 3; ++a) {
    const int r = reach(static_cast<int>(a));
    if (cell[a] < -r || cell[a] >= cells_[a] + r) return false;
  }
  return true;
}

std::ptrdiff_t Lattice::shift(const Cell& offset) const {
  const std::ptrdiff_t rows_y = std::ptrdiff_t{cells_[1]} + std::ptrdiff_t{2} * reach(1);
  return (offset[2] * rows_y + offset[1]) * static_cast<std::ptrdiff_t>(row_) + offset[0];
}

}  // namespace riven
