// The loops over bonds of the linear peridynamic solid, in the lanes of one instruction set
// (for_each_instruction_set.inl). On a lattice the lanes are eight points of a row at the same bond of the
// stencil, in a list eight bonds of a point.

#include "peridynamics/bond_lanes.inl"

/// Extension e = |Y| - |xi| of eight bonds.
template <int D>
RIVEN_INLINE Lanes extension(const Bonds<D>& at, Lanes length) {
  return squared_growth(at) / (root(dot(at.y, at.y)) + length);
}

/// q = c (kappa theta - beta) of eight points with the dilatation theta = c S, from the sum S of omega L e V
/// over the family.
RIVEN_INLINE Lanes tension(const LpsLattice& on, std::size_t point, Lanes sum) {
  const Lanes c = load(on.inverse_moment + point);
  return c * (load(on.kappa + point) * (c * sum)) - load(on.straight + point);
}

/// Sums over families for the bound of the stiffness: omega L V, that times the extension, and times the
/// directions of the bonds.
template <int D>
struct GripSums {
  Lanes lengths = broadcast(0), dilatation = lengths, own[D];

  RIVEN_INLINE GripSums() {
    RIVEN_UNROLL
    for (Lanes& component : own) component = broadcast(0);
  }
  RIVEN_INLINE void add(const Lanes (&y)[D], Lanes length, Lanes weight_length, Mask exists) {
    const Lanes r2 = dot(y, y), inverse_r = inverse_root(r2);
    lengths += select(exists, weight_length);
    dilatation += select(exists, weight_length * (r2 * inverse_r - length));
    RIVEN_UNROLL
    for (int d = 0; d < D; ++d) own[d] += select(exists, weight_length * inverse_r * y[d]);
  }
};

/// Length of the sums of directions.
template <int D>
RIVEN_INLINE Lanes norm(const Lanes (&own)[D]) {
  constexpr double kLeast = 1e-280;  // of which the root is no trouble
  return root(maximum(dot(own, own), broadcast(kLeast)));
}

/// The tangent is at most a matrix of own blocks. A bond's part (x_i - x_j) k (x_i - x_j) is at most
/// 2 x_i |k| x_i + 2 x_j |k| x_j. The dilatation's part of a family, kappa V (g x)^2, is by Cauchy's
/// inequality at most kappa V sum|g| sum(|g| (n x)^2), with the directions n of the parts of g.
template <int D>
struct OwnBlock {
  Lanes entry[D][D];  // upper half

  RIVEN_INLINE OwnBlock() {
    RIVEN_UNROLL
    for (auto& row : entry) RIVEN_UNROLL
    for (Lanes& value : row) value = broadcast(0);
  }
  /// `straight`: beta (c + c') of the ends; `both_q`: their tensions; `grip`: of the other end.
  RIVEN_INLINE void add(const Lanes (&y)[D], Lanes length, Lanes straight, Lanes both_q, Lanes grip,
                        Lanes weight, Mask exists) {
    const Lanes inverse_r = inverse_root(dot(y, y));
    const Lanes along = weight * (2.0 * straight + length * grip);
    const Lanes across = weight * (2.0 * magnitude(straight + both_q * length * inverse_r));
    const Lanes excess = (along - across) * inverse_r * inverse_r;
    RIVEN_UNROLL
    for (int a = 0; a < D; ++a) {
      RIVEN_UNROLL
      for (int b = a; b < D; ++b) entry[a][b] += select(exists, excess * y[a] * y[b]);
      entry[a][a] += select(exists, across);
    }
  }
  /// Sum of |entries| in row a.
  RIVEN_INLINE Lanes row(int a) const {
    Lanes sum = broadcast(0);
    RIVEN_UNROLL
    for (int b = 0; b < D; ++b) sum += magnitude(a < b ? entry[a][b] : entry[b][a]);
    return sum;
  }
};

// ---- on a lattice ----

template <int D, bool kUniform, bool kIntact>
RIVEN_INLINE void respond_block(LpsLattice& on, std::size_t block) {
  const std::size_t point = block * kLanes, count = on.stencil.size();
  const std::uint8_t* masks = on.masks + block * count;
  Lanes u[D], sum = broadcast(0);
  load_displacements(on, point, u);
  for (std::size_t k = 0; k < count; ++k) {
    if (!kIntact && masks[k] == 0) continue;
    const LpsBond& bond = on.stencil[k];
    const Bonds<D> at = bonds_at(on, bond, point, u);
    Lanes part = bond.weight_length * (root(dot(at.y, at.y)) - bond.length);
    if (!kIntact) part = select(expand(masks[k]), part);
    if (!kUniform) part = part * load_at(on.volume, point, bond.shift);
    sum += part;
  }
  if (kUniform) sum = on.uniform_volume * sum;
  store(on.tension + point, tension(on, point, sum));
}

/// Forces on eight points: a bond carries omega ((A + A') L + (B + B') (r - L)) Y / r times both volumes,
/// with A = c kappa theta and B = c beta of its ends: omega (beta (c + c') + (q + q') L / r) Y.
template <int D, bool kUniform, bool kIntact>
RIVEN_INLINE void pull_block(const LpsLattice& on, std::size_t block) {
  const std::size_t point = block * kLanes, count = on.stencil.size();
  const std::uint8_t* masks = on.masks + block * count;
  Lanes u[D], force[D];
  load_displacements(on, point, u);
  RIVEN_UNROLL
  for (Lanes& component : force) component = broadcast(0);
  const Lanes q = load(on.tension + point), own = load(on.straight + point);
  for (std::size_t k = 0; k < count; ++k) {
    if (!kIntact && masks[k] == 0) continue;
    const LpsBond& bond = on.stencil[k];
    const Bonds<D> at = bonds_at(on, bond, point, u);
    const Lanes both_q = q + load_at(on.tension, point, bond.shift);
    const Lanes straight = own + load_at(on.straight, point, bond.shift);
    Lanes pull = bond.weight * straight + (bond.weight_length * both_q) * inverse_root(dot(at.y, at.y));
    if (!kIntact) pull = select(expand(masks[k]), pull);
    if (!kUniform) pull = pull * load_at(on.volume, point, bond.shift);
    RIVEN_UNROLL
    for (int d = 0; d < D; ++d) force[d] += pull * at.y[d];
  }
  const Lanes scale = kUniform ? broadcast(on.uniform_volume * on.uniform_volume) : load(on.volume + point);
  RIVEN_UNROLL
  for (int d = 0; d < D; ++d) store(on.out[static_cast<std::size_t>(d)] + point, scale * force[d]);
}

template <int D, bool kUniform>
RIVEN_INLINE void respond_blocks(LpsLattice& on, std::size_t begin, std::size_t end) {
  for (std::size_t block = begin / kLanes; block < end / kLanes; ++block) {
    if (on.blocks[block] == BlockKind::intact) respond_block<D, kUniform, true>(on, block);
    if (on.blocks[block] == BlockKind::partial) respond_block<D, kUniform, false>(on, block);
  }
}

template <int D>
void respond(LpsLattice& on, std::size_t begin, std::size_t end) {
  return on.uniform_volume > 0 ? respond_blocks<D, true>(on, begin, end)
                               : respond_blocks<D, false>(on, begin, end);
}

template <int D, bool kUniform>
RIVEN_INLINE void pull_blocks(const LpsLattice& on, std::size_t begin, std::size_t end) {
  for (std::size_t block = begin / kLanes; block < end / kLanes; ++block) {
    if (on.blocks[block] == BlockKind::intact) pull_block<D, kUniform, true>(on, block);
    if (on.blocks[block] == BlockKind::partial) pull_block<D, kUniform, false>(on, block);
  }
}

template <int D>
void pull(const LpsLattice& on, std::size_t begin, std::size_t end) {
  return on.uniform_volume > 0 ? pull_blocks<D, true>(on, begin, end) : pull_blocks<D, false>(on, begin, end);
}

template <int D>
void grip(LpsLattice& on, std::size_t begin, std::size_t end) {
  for (std::size_t point = begin; point < end; point += kLanes) {
    const std::uint8_t* masks = on.masks + point / kLanes * on.stencil.size();
    Lanes u[D];
    load_displacements(on, point, u);
    GripSums<D> sums;
    for (std::size_t k = 0; k < on.stencil.size(); ++k) {
      if (masks[k] == 0) continue;
      const LpsBond& bond = on.stencil[k];
      sums.add(bonds_at(on, bond, point, u).y, broadcast(bond.length),
               bond.weight_length * load_at(on.volume, point, bond.shift), expand(masks[k]));
    }
    const Lanes c = load(on.inverse_moment + point), own = norm(sums.own);
    const Lanes kappa = maximum(load(on.kappa + point), broadcast(0));
    store(on.tension + point, tension(on, point, sums.dilatation));
    store(on.grip + point, kappa * c * c * (sums.lengths + own));
    store(on.own_grip + point, kappa * c * c * (sums.lengths + own) * own);
  }
}

template <int D>
void bound(const LpsLattice& on, std::size_t begin, std::size_t end) {
  for (std::size_t point = begin; point < end; point += kLanes) {
    const std::uint8_t* masks = on.masks + point / kLanes * on.stencil.size();
    Lanes u[D];
    load_displacements(on, point, u);
    const Lanes q = load(on.tension + point), own = load(on.straight + point);
    OwnBlock<D> block;
    for (std::size_t k = 0; k < on.stencil.size(); ++k) {
      if (masks[k] == 0) continue;
      const LpsBond& bond = on.stencil[k];
      block.add(bonds_at(on, bond, point, u).y, broadcast(bond.length),
                own + load_at(on.straight, point, bond.shift), q + load_at(on.tension, point, bond.shift),
                load_at(on.grip, point, bond.shift), bond.weight * load_at(on.volume, point, bond.shift),
                expand(masks[k]));
    }
    RIVEN_UNROLL
    for (int d = 0; d < D; ++d)
      store(on.out[static_cast<std::size_t>(d)] + point,
            load(on.volume + point) * (block.row(d) + load(on.own_grip + point)));
  }
}

template <int D>
double energy(const LpsLattice& on, std::size_t begin, std::size_t end) {
  Lanes energy = broadcast(0);
  for (std::size_t point = begin; point < end; point += kLanes) {
    const std::uint8_t* masks = on.masks + point / kLanes * on.stencil.size();
    Lanes u[D], first = broadcast(0), second = first;
    load_displacements(on, point, u);
    for (std::size_t k = 0; k < on.stencil.size(); ++k) {
      if (masks[k] == 0) continue;
      const LpsBond& bond = on.stencil[k];
      const Lanes e = extension(bonds_at(on, bond, point, u), broadcast(bond.length));
      const Lanes we = select(expand(masks[k]), bond.weight * e * load_at(on.volume, point, bond.shift));
      first += we * bond.length;
      second += select(expand(masks[k]), we * e);
    }
    const Lanes theta = load(on.inverse_moment + point) * first;
    energy += (load(on.kappa + point) * theta * theta + load(on.straight + point) * second) *
              load(on.volume + point);
  }
  return 0.5 * sum(energy);
}

// ---- listed bonds ----

/// Eight bonds of a point, from bond n on, and what their other ends hold.
template <int D>
struct ListedBonds8 {
  const std::uint32_t* ends;
  Bonds<D> bonds;
  Lanes weight, length, straight, tension;
};

template <int D>
RIVEN_INLINE ListedBonds8<D> gather(const LpsList& list, const LpsPoint& own, std::size_t n) {
  ListedBonds8<D> at;
  at.ends = list.neighbour + n;
  const double* ends[kLanes];
  RIVEN_UNROLL
  for (std::size_t l = 0; l < kLanes; ++l) ends[l] = list.points[at.ends[l]].x.data();
  Lanes place[4], state[4];
  load_fours(ends, 0, place);
  load_fours(ends, 4, state);
  RIVEN_UNROLL
  for (int d = 0; d < D; ++d) {
    at.bonds.eta[d] = state[d] - own.u[static_cast<std::size_t>(d)];
    at.bonds.y[d] = (place[d] - own.x[static_cast<std::size_t>(d)]) + at.bonds.eta[d];
  }
  at.weight = load(list.weight.data() + n);
  at.length = load(list.length.data() + n);
  at.straight = place[3];
  at.tension = state[3];
  return at;
}

/// Calls visit(eight bonds, which of them exist) for the bonds of a point.
template <int D, class Visit>
RIVEN_INLINE void for_each_eight(const LpsList& list, std::size_t point, const Visit& visit) {
  const std::uint8_t* masks = list.masks + list.begin[point] / 8 + point;
  for (std::size_t n = list.begin[point]; n < list.begin[point + 1]; n += kLanes, ++masks)
    if (*masks != 0) visit(gather<D>(list, list.points[point], n), expand(*masks));
}

template <int D>
void respond(LpsList& list, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    Lanes parts = broadcast(0);
    for_each_eight<D>(list, i, [&](const ListedBonds8<D>& at, Mask exists) RIVEN_INLINED {
      const Lanes e = root(dot(at.bonds.y, at.bonds.y)) - at.length;
      parts += select(exists, at.weight * at.length * e);
    });
    const double c = list.inverse_moment[i], theta = c * sum(parts);
    list.tension[i] = c * (list.kappa[i] * theta) - list.points[i].straight;
  }
}

template <int D>
void pull(const LpsList& list, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    const LpsPoint& own = list.points[i];
    Lanes force[D];
    RIVEN_UNROLL
    for (Lanes& component : force) component = broadcast(0);
    for_each_eight<D>(list, i, [&](const ListedBonds8<D>& at, Mask exists) RIVEN_INLINED {
      const Lanes pull =
          at.weight * (own.straight + at.straight +
                       (own.tension + at.tension) * at.length * inverse_root(dot(at.bonds.y, at.bonds.y)));
      RIVEN_UNROLL
      for (int d = 0; d < D; ++d) force[d] += select(exists, pull * at.bonds.y[d]);
    });
    RIVEN_UNROLL
    for (int d = 0; d < D; ++d) list.out[static_cast<std::size_t>(d)][i] = list.volume[i] * sum(force[d]);
  }
}

template <int D>
void grip(LpsList& list, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    GripSums<D> sums;
    for_each_eight<D>(list, i, [&](const ListedBonds8<D>& at, Mask exists) RIVEN_INLINED {
      sums.add(at.bonds.y, at.length, at.weight * at.length, exists);
    });
    double own2 = 0;
    RIVEN_UNROLL
    for (const Lanes& component : sums.own) own2 += sum(component) * sum(component);
    const double c = list.inverse_moment[i], theta = c * sum(sums.dilatation);
    const double kappa = list.kappa[i] > 0 ? list.kappa[i] : 0;
    const double own = __builtin_sqrt(own2), all = sum(sums.lengths) + own;
    list.tension[i] = c * (list.kappa[i] * theta) - list.points[i].straight;
    list.grip[i] = kappa * c * c * all;
    list.own_grip[i] = kappa * c * c * all * own;
  }
}

template <int D>
void bound(const LpsList& list, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    const LpsPoint& own = list.points[i];
    OwnBlock<D> block;
    for_each_eight<D>(list, i, [&](const ListedBonds8<D>& at, Mask exists) RIVEN_INLINED {
      double grip[kLanes];
      for (std::size_t l = 0; l < kLanes; ++l) grip[l] = list.grip[at.ends[l]];
      block.add(at.bonds.y, at.length, own.straight + at.straight, own.tension + at.tension, load(grip),
                at.weight, exists);
    });
    double entry[D][D];
    RIVEN_UNROLL
    for (int a = 0; a < D; ++a) RIVEN_UNROLL
    for (int b = a; b < D; ++b) entry[a][b] = entry[b][a] = sum(block.entry[a][b]);
    RIVEN_UNROLL
    for (int a = 0; a < D; ++a) {
      double row = list.own_grip[i];
      RIVEN_UNROLL
      for (int b = 0; b < D; ++b) row += __builtin_fabs(entry[a][b]);
      list.out[static_cast<std::size_t>(a)][i] = list.volume[i] * row;
    }
  }
}

template <int D>
double energy(const LpsList& list, std::size_t begin, std::size_t end) {
  double energy = 0;
  for (std::size_t i = begin; i < end; ++i) {
    Lanes first = broadcast(0), second = first;
    for_each_eight<D>(list, i, [&](const ListedBonds8<D>& at, Mask exists) RIVEN_INLINED {
      const Lanes e = extension(at.bonds, at.length), we = at.weight * e;
      first += select(exists, we * at.length);
      second += select(exists, we * e);
    });
    const double theta = list.inverse_moment[i] * sum(first);
    energy += list.volume[i] * (list.kappa[i] * theta * theta + list.points[i].straight * sum(second));
  }
  return 0.5 * energy;
}

template <int D>
LpsKernels kernels_of() {
  return {{respond<D>, pull<D>, grip<D>, bound<D>, energy<D>},
          {respond<D>, pull<D>, grip<D>, bound<D>, energy<D>}};
}

inline LpsKernels lps_kernels(int dimension) {
  return dimension == 2 ? kernels_of<2>() : kernels_of<3>();
}
