// Bonds between points in the lanes of one instruction set, for kernels that include this file.

/// Eight bonds: deformed bond vectors Y and displacement differences eta (m).
template <int D>
struct Bonds {
  Lanes y[D];
  Lanes eta[D];
};

template <int D>
RIVEN_INLINE Lanes dot(const Lanes (&a)[D], const Lanes (&b)[D]) {
  Lanes sum = a[0] * b[0];
  RIVEN_UNROLL
  for (int d = 1; d < D; ++d) sum = sum + a[d] * b[d];
  return sum;
}

RIVEN_INLINE Lanes load_at(const double* field, std::size_t point, std::ptrdiff_t shift) {
  return load(field + static_cast<std::ptrdiff_t>(point) + shift);
}

/// Bond k of the stencil of eight points of a lattice.
template <int D, class Lattice, class Offset>
RIVEN_INLINE Bonds<D> bonds_at(const Lattice& on, const Offset& bond, std::size_t point,
                               const Lanes (&u)[D]) {
  Bonds<D> bonds;
  RIVEN_UNROLL
  for (int d = 0; d < D; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    bonds.eta[d] = load_at(on.u[axis], point, bond.shift) - u[d];
    bonds.y[d] = bond.xi[axis] + bonds.eta[d];
  }
  return bonds;
}

template <int D, class Lattice>
RIVEN_INLINE void load_displacements(const Lattice& on, std::size_t point, Lanes (&u)[D]) {
  RIVEN_UNROLL
  for (int d = 0; d < D; ++d) u[d] = load(on.u[static_cast<std::size_t>(d)] + point);
}

/// r^2 - L^2 = eta (xi + Y): without cancellation for small strains.
template <int D>
RIVEN_INLINE Lanes squared_growth(const Bonds<D>& at) {
  Lanes sums[D];
  RIVEN_UNROLL
  for (int d = 0; d < D; ++d) sums[d] = (at.y[d] - at.eta[d]) + at.y[d];
  return dot(at.eta, sums);
}
