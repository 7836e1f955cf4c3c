// The loops over bonds of the PMB model, in the lanes of one instruction set (for_each_instruction_set.inl).
// On a lattice the lanes are eight points of a row at the same bond of the stencil, in a list eight bonds of
// a point.

#include "peridynamics/bond_lanes.inl"

RIVEN_INLINE Lanes weights_at(const PmbLattice& on, const PmbBond& bond, std::size_t point) {
  return load_at(on.weight, point, bond.shift);
}

/// Micromodulus of eight bonds.
RIVEN_INLINE Lanes stiffness_at(const PmbLattice& on, const PmbBond& bond, std::size_t point) {
  if (on.half_compliance == nullptr) return broadcast(on.stiffness);
  return broadcast(1) / (load(on.half_compliance + point) + load_at(on.half_compliance, point, bond.shift));
}

/// What a bond's pull is multiplied by, beside what all bonds share.
enum class Factor { none, weight, weight_and_stiffness };

/// Forces on eight points: f = c (1/L - 1/r) Y V per bond, with r = |Y|. The same as c s Y / r with the
/// stretch s = (r - L) / L, in one root.
template <int D, Factor kFactor, bool kIntact>
RIVEN_INLINE void pull_block(PmbLattice& on, std::size_t block) {
  const std::size_t point = block * kLanes, count = on.stencil.size();
  const std::uint8_t* masks = on.masks + block * count;
  const double limit2 = on.least_limit2 == nullptr ? __builtin_inf() : on.least_limit2[block];
  Lanes u[D], force[D];
  load_displacements(on, point, u);
  RIVEN_UNROLL
  for (Lanes& component : force) component = broadcast(0);
  Mask beyond;
  for (std::size_t k = 0; k < count; ++k) {
    if (!kIntact && masks[k] == 0) continue;
    const PmbBond& bond = on.stencil[k];
    const Bonds<D> at = bonds_at(on, bond, point, u);
    const Lanes r2 = dot(at.y, at.y);
    Lanes pull = bond.inverse_length - inverse_root(r2);
    Mask is_long = greater(r2, bond.length2 * limit2);
    if (!kIntact) {
      const Mask exists = expand(masks[k]);
      pull = select(exists, pull);
      is_long = is_long & exists;
    }
    if (kFactor != Factor::none) pull = pull * weights_at(on, bond, point);
    if (kFactor == Factor::weight_and_stiffness) pull = pull * stiffness_at(on, bond, point);
    beyond = beyond | is_long;
    RIVEN_UNROLL
    for (int d = 0; d < D; ++d) force[d] += pull * at.y[d];
  }
  Lanes scale = broadcast(on.stiffness * on.uniform_weight * on.uniform_weight);
  if (kFactor == Factor::weight) scale = on.stiffness * load(on.weight + point);
  if (kFactor == Factor::weight_and_stiffness) scale = load(on.weight + point);
  RIVEN_UNROLL
  for (int d = 0; d < D; ++d) store(on.out[static_cast<std::size_t>(d)] + point, scale * force[d]);
  if (on.beyond != nullptr) on.beyond[block] = bits_of(beyond) != 0 ? 1 : 0;
}

template <int D, Factor kFactor>
void pull_blocks(PmbLattice& on, std::size_t begin, std::size_t end) {
  for (std::size_t block = begin / kLanes; block < end / kLanes; ++block) {
    if (on.blocks[block] == BlockKind::intact) pull_block<D, kFactor, true>(on, block);
    if (on.blocks[block] == BlockKind::partial) pull_block<D, kFactor, false>(on, block);
  }
}

template <int D>
void lattice_force(PmbLattice& on, std::size_t begin, std::size_t end) {
  if (on.half_compliance != nullptr) return pull_blocks<D, Factor::weight_and_stiffness>(on, begin, end);
  return on.uniform_weight > 0 ? pull_blocks<D, Factor::none>(on, begin, end)
                               : pull_blocks<D, Factor::weight>(on, begin, end);
}

/// s^2 L of eight bonds.
template <int D>
RIVEN_INLINE Lanes squared_stretch_times_length(const Bonds<D>& at, Lanes inverse_length) {
  const Lanes r2 = dot(at.y, at.y), r = r2 * inverse_root(r2);
  const Lanes stretch = squared_growth(at) * inverse_length * inverse_length / (r * inverse_length + 1.0);
  return stretch * stretch / inverse_length;
}

template <int D>
double lattice_energy(const PmbLattice& on, std::size_t begin, std::size_t end) {
  Lanes energy = broadcast(0);
  for (std::size_t point = begin; point < end; point += kLanes) {
    const std::uint8_t* masks = on.masks + point / kLanes * on.stencil.size();
    Lanes u[D], of_point = broadcast(0);
    load_displacements(on, point, u);
    for (std::size_t k = 0; k < on.stencil.size(); ++k) {
      if (masks[k] == 0) continue;
      const PmbBond& bond = on.stencil[k];
      const Lanes w =
          squared_stretch_times_length(bonds_at(on, bond, point, u), broadcast(bond.inverse_length));
      of_point += select(expand(masks[k]), w * weights_at(on, bond, point) * stiffness_at(on, bond, point));
    }
    energy += of_point * load(on.weight + point);
  }
  return 0.25 * sum(energy);
}

/// Own blocks of the tangent: a bond's is K = c (1/L e e^T + (1/L - 1/r) (I - e e^T)), and a point's is the
/// sum of |K| over its bonds. The energy of a bond is at most that of its ends with the other one held,
/// twice: (x_i - x_j) K (x_i - x_j) <= 2 x_i |K| x_i + 2 x_j |K| x_j. So no eigenvalue is above twice the
/// largest own block, whatever the far ends do.
template <int D>
struct OwnBlock {
  Lanes entry[D][D];  // upper half

  RIVEN_INLINE OwnBlock() {
    RIVEN_UNROLL
    for (auto& row : entry) RIVEN_UNROLL
    for (Lanes& value : row) value = broadcast(0);
  }
  RIVEN_INLINE void add(const Lanes (&y)[D], Lanes inverse_length, Mask exists, Lanes weight) {
    const Lanes inverse_r = inverse_root(dot(y, y));
    const Lanes along = select(exists, weight * inverse_length);
    const Lanes across = select(exists, weight * magnitude(inverse_length - inverse_r));
    const Lanes excess = select(exists, (along - across) * inverse_r * inverse_r);
    RIVEN_UNROLL
    for (int a = 0; a < D; ++a) {
      RIVEN_UNROLL
      for (int b = a; b < D; ++b) entry[a][b] += select(exists, excess * y[a] * y[b]);
      entry[a][a] += across;
    }
  }
};

/// Twice the largest sum of |entries| in a row of the own block.
template <int D>
RIVEN_INLINE double row_bound(const double (&own)[D][D]) {
  double largest = 0;
  RIVEN_UNROLL
  for (int a = 0; a < D; ++a) {
    double row = 0;
    RIVEN_UNROLL
    for (int b = 0; b < D; ++b) row += __builtin_fabs(a < b ? own[a][b] : own[b][a]);
    largest = row > largest ? row : largest;
  }
  return 2 * largest;
}

template <int D>
void lattice_bound(const PmbLattice& on, std::size_t begin, std::size_t end) {
  for (std::size_t point = begin; point < end; point += kLanes) {
    const std::uint8_t* masks = on.masks + point / kLanes * on.stencil.size();
    Lanes u[D];
    load_displacements(on, point, u);
    OwnBlock<D> block;
    for (std::size_t k = 0; k < on.stencil.size(); ++k) {
      if (masks[k] == 0) continue;
      const PmbBond& bond = on.stencil[k];
      block.add(bonds_at(on, bond, point, u).y, broadcast(bond.inverse_length), expand(masks[k]),
                weights_at(on, bond, point) * stiffness_at(on, bond, point));
    }
    double own[D][D][kLanes];
    RIVEN_UNROLL
    for (int a = 0; a < D; ++a) RIVEN_UNROLL
    for (int b = a; b < D; ++b) store(own[a][b], block.entry[a][b]);
    for (std::size_t l = 0; l < kLanes; ++l) {
      double of_point[D][D];
      RIVEN_UNROLL
      for (int a = 0; a < D; ++a) RIVEN_UNROLL
      for (int b = a; b < D; ++b) of_point[a][b] = own[a][b][l];
      RIVEN_UNROLL
      for (int d = 0; d < D; ++d)
        on.out[static_cast<std::size_t>(d)][point + l] = on.weight[point + l] * row_bound(of_point);
    }
  }
}

// ---- listed bonds ----

/// Eight bonds of a point, from bond n on.
template <int D>
struct ListedBonds8 {
  Bonds<D> bonds;
  Lanes weight, inverse_length;
  Lanes stiffness;  // micromodulus
};

template <int D>
RIVEN_INLINE ListedBonds8<D> gather(const PmbList& list, const PmbPoint& own, std::size_t n) {
  alignas(64) double x[D][kLanes], u[D][kLanes], weight[kLanes], half_compliance[kLanes];
  for (std::size_t l = 0; l < kLanes; ++l) {
    const PmbPoint& far = list.points[list.neighbour[n + l]];
    RIVEN_UNROLL
    for (int d = 0; d < D; ++d) {
      x[d][l] = far.x[static_cast<std::size_t>(d)];
      u[d][l] = far.u[static_cast<std::size_t>(d)];
    }
    weight[l] = far.weight;
    half_compliance[l] = far.half_compliance;
  }
  ListedBonds8<D> at;
  RIVEN_UNROLL
  for (int d = 0; d < D; ++d) {
    at.bonds.eta[d] = load(u[d]) - own.u[static_cast<std::size_t>(d)];
    at.bonds.y[d] = (load(x[d]) - own.x[static_cast<std::size_t>(d)]) + at.bonds.eta[d];
  }
  at.weight = load(weight);
  at.inverse_length = load(list.inverse_length.data() + n);
  at.stiffness =
      list.mixed ? broadcast(1) / (own.half_compliance + load(half_compliance)) : broadcast(list.stiffness);
  return at;
}

/// Calls visit(eight bonds, which of them exist) for the bonds of a point.
template <int D, class Visit>
RIVEN_INLINE void for_each_eight(const PmbList& list, std::size_t point, const Visit& visit) {
  const PmbPoint& own = list.points[point];
  const std::uint8_t* masks = list.masks + list.begin[point] / 8 + point;
  for (std::size_t n = list.begin[point]; n < list.begin[point + 1]; n += kLanes, ++masks)
    if (*masks != 0) visit(gather<D>(list, own, n), expand(*masks));
}

template <int D>
void listed_force(PmbList& list, std::size_t begin, std::size_t end) {
  for (std::size_t point = begin; point < end; ++point) {
    const double limit2 = list.least_limit2 == nullptr ? __builtin_inf() : list.least_limit2[point];
    Lanes force[D];
    RIVEN_UNROLL
    for (Lanes& component : force) component = broadcast(0);
    Mask beyond;
    for_each_eight<D>(list, point, [&](const ListedBonds8<D>& at, Mask exists) RIVEN_INLINED {
      const Lanes r2 = dot(at.bonds.y, at.bonds.y);
      beyond = beyond | (greater(r2 * at.inverse_length * at.inverse_length, limit2) & exists);
      const Lanes pull = select(exists, (at.inverse_length - inverse_root(r2)) * at.weight * at.stiffness);
      RIVEN_UNROLL
      for (int d = 0; d < D; ++d) force[d] += select(exists, pull * at.bonds.y[d]);
    });
    RIVEN_UNROLL
    for (int d = 0; d < D; ++d)
      list.out[static_cast<std::size_t>(d)][point] = list.points[point].weight * sum(force[d]);
    if (list.beyond != nullptr) list.beyond[point] = bits_of(beyond) != 0 ? 1 : 0;
  }
}

template <int D>
double listed_energy(const PmbList& list, std::size_t begin, std::size_t end) {
  double energy = 0;
  for (std::size_t point = begin; point < end; ++point) {
    Lanes of_point = broadcast(0);
    for_each_eight<D>(list, point, [&](const ListedBonds8<D>& at, Mask exists) RIVEN_INLINED {
      const Lanes w = squared_stretch_times_length(at.bonds, at.inverse_length) * at.weight;
      of_point += select(exists, w * at.stiffness);
    });
    energy += list.points[point].weight * sum(of_point);
  }
  return 0.25 * energy;
}

template <int D>
void listed_bound(const PmbList& list, std::size_t begin, std::size_t end) {
  for (std::size_t point = begin; point < end; ++point) {
    OwnBlock<D> block;
    for_each_eight<D>(list, point, [&](const ListedBonds8<D>& at, Mask exists) RIVEN_INLINED {
      block.add(at.bonds.y, at.inverse_length, exists, at.weight * at.stiffness);
    });
    double own[D][D];
    RIVEN_UNROLL
    for (int a = 0; a < D; ++a) RIVEN_UNROLL
    for (int b = a; b < D; ++b) own[a][b] = sum(block.entry[a][b]);
    RIVEN_UNROLL
    for (int d = 0; d < D; ++d)
      list.out[static_cast<std::size_t>(d)][point] = list.points[point].weight * row_bound(own);
  }
}

template <int D>
PmbKernels kernels_of() {
  return {lattice_force<D>, listed_force<D>,  lattice_energy<D>,
          listed_energy<D>, lattice_bound<D>, listed_bound<D>};
}

inline PmbKernels pmb_kernels(int dimension) {
  return dimension == 1 ? kernels_of<1>() : dimension == 2 ? kernels_of<2>() : kernels_of<3>();
}
