// The loops over bonds of the correspondence model, in the lanes of one instruction set
// (for_each_instruction_set.inl). On a lattice the lanes are eight points of a row at the same bond of the
// stencil, in a list eight bonds of a point.

#include "peridynamics/bond_lanes.inl"

/// Place of an entry of a symmetric matrix whose upper half lies row by row.
template <int D>
constexpr int upper(int r, int c) {
  return r <= c ? r * D - r * (r - 1) / 2 + (c - r) : upper<D>(c, r);
}

template <int D>
RIVEN_INLINE void clear(Lanes (&rows)[D][D]) {
  RIVEN_UNROLL
  for (auto& row : rows) RIVEN_UNROLL
  for (Lanes& value : row) value = broadcast(0);
}

/// a K^-1, with eight matrices K^-1 from place n on.
template <int D>
RIVEN_INLINE void times_shape(const std::array<const double*, 6>& shape, std::size_t n,
                              const Lanes (&a)[D][D], Lanes (&product)[D][D]) {
  Lanes k[D * (D + 1) / 2];
  RIVEN_UNROLL
  for (int c = 0; c < D * (D + 1) / 2; ++c) k[c] = load(shape[static_cast<std::size_t>(c)] + n);
  RIVEN_UNROLL
  for (int r = 0; r < D; ++r) RIVEN_UNROLL
  for (int c = 0; c < D; ++c) {
    Lanes sum = a[r][0] * k[upper<D>(0, c)];
    RIVEN_UNROLL
    for (int m = 1; m < D; ++m) sum += a[r][m] * k[upper<D>(m, c)];
    product[r][c] = sum;
  }
}

/// R = P K^-1 - s (F - 1) of eight points whose rows start at n; point: their place in the body.
template <int D, class Bonds>
RIVEN_INLINE void reply_eight(Bonds& on, std::size_t point, const GradientRows& f, const GradientRows& p,
                              std::size_t n) {
  Lanes stress[D][D], r[D][D];
  RIVEN_UNROLL
  for (int a = 0; a < D; ++a) RIVEN_UNROLL
  for (int b = 0; b < D; ++b) stress[a][b] = load(p[static_cast<std::size_t>(D * a + b)] + n);
  times_shape<D>(on.shape, point, stress, r);
  const Lanes spring = load(on.spring + point);
  RIVEN_UNROLL
  for (int a = 0; a < D; ++a) RIVEN_UNROLL
  for (int b = 0; b < D; ++b) {
    const auto c = static_cast<std::size_t>(D * a + b);
    store(on.reply[c] + point, r[a][b] - spring * (load(f[c] + n) - (a == b ? 1.0 : 0.0)));
  }
}

// ---- on a lattice ----

/// F = 1 + sum(omega eta xi V) K^-1 of eight points, into rows from n on, and if asked for sum(omega |z|^2 V)
/// = sum(omega |eta|^2 V) - H : sum(omega eta xi V), since z is what a least-squares fit leaves.
template <int D, bool kUniform, bool kIntact, bool kRest>
RIVEN_INLINE void deform_block(const CorrespondenceLattice& on, std::size_t block, const GradientRows& f,
                               double* rests, std::size_t n) {
  const std::size_t point = block * kLanes, count = on.stencil.size();
  const std::uint8_t* masks = on.masks + block * count;
  Lanes u[D], sums[D][D], h[D][D], rest = broadcast(0);
  load_displacements(on, point, u);
  clear(sums);
  for (std::size_t k = 0; k < count; ++k) {
    if (!kIntact && masks[k] == 0) continue;
    const CorrespondenceBond& bond = on.stencil[k];
    RIVEN_UNROLL
    for (int a = 0; a < D; ++a) {
      const Lanes eta = load_at(on.u[static_cast<std::size_t>(a)], point, bond.shift) - u[a];
      Lanes weighed = bond.weight * eta;
      if (!kIntact) weighed = select(expand(masks[k]), weighed);
      if (!kUniform) weighed = weighed * load_at(on.volume, point, bond.shift);
      if (kRest) rest += weighed * eta;
      RIVEN_UNROLL
      for (int b = 0; b < D; ++b) sums[a][b] += weighed * bond.xi[static_cast<std::size_t>(b)];
    }
  }
  times_shape<D>(on.shape, point, sums, h);
  const double scale = kUniform ? on.uniform_volume : 1;
  RIVEN_UNROLL
  for (int a = 0; a < D; ++a) RIVEN_UNROLL
  for (int b = 0; b < D; ++b) {
    store(f[static_cast<std::size_t>(D * a + b)] + n, (a == b ? 1.0 : 0.0) + scale * h[a][b]);
    if (kRest) rest = rest - scale * h[a][b] * sums[a][b];
  }
  if (kRest) store(rests + n, scale * rest);
}

template <int D, bool kUniform, bool kRest>
RIVEN_INLINE std::size_t deform_blocks(const CorrespondenceLattice& on, std::size_t begin, std::size_t end,
                                       const GradientRows& f, double* rest) {
  std::size_t n = 0;
  for (std::size_t block = begin / kLanes; block < end / kLanes; ++block) {
    if (on.families[block] == 0) continue;
    if (on.blocks[block] == BlockKind::intact) deform_block<D, kUniform, true, kRest>(on, block, f, rest, n);
    if (on.blocks[block] == BlockKind::partial)
      deform_block<D, kUniform, false, kRest>(on, block, f, rest, n);
    n += kLanes;
  }
  return n;
}

template <int D>
std::size_t deform(const CorrespondenceLattice& on, std::size_t begin, std::size_t end,
                   const GradientRows& f) {
  return on.uniform_volume > 0 ? deform_blocks<D, true, false>(on, begin, end, f, nullptr)
                               : deform_blocks<D, false, false>(on, begin, end, f, nullptr);
}

template <int D>
std::size_t measure(const CorrespondenceLattice& on, std::size_t begin, std::size_t end,
                    const GradientRows& f, double* rest) {
  return deform_blocks<D, false, true>(on, begin, end, f, rest);
}

template <int D>
void reply(CorrespondenceLattice& on, std::size_t begin, std::size_t end, const GradientRows& f,
           const GradientRows& p) {
  std::size_t n = 0;
  for (std::size_t block = begin / kLanes; block < end / kLanes; ++block) {
    if (on.families[block] == 0) continue;
    reply_eight<D>(on, block * kLanes, f, p, n);
    n += kLanes;
  }
}

/// Forces on eight points: a bond carries omega ((R + R') xi + (s + s') eta) times both volumes.
template <int D, bool kUniform, bool kIntact>
RIVEN_INLINE void pull_block(const CorrespondenceLattice& on, std::size_t block) {
  const std::size_t point = block * kLanes, count = on.stencil.size();
  const std::uint8_t* masks = on.masks + block * count;
  Lanes u[D], force[D], bonds[D];  // bonds: sum of omega xi V, 0 in whole families
  load_displacements(on, point, u);
  RIVEN_UNROLL
  for (int d = 0; d < D; ++d) force[d] = bonds[d] = broadcast(0);
  const Lanes own_spring = load(on.spring + point);
  for (std::size_t k = 0; k < count; ++k) {
    if (!kIntact && masks[k] == 0) continue;
    const CorrespondenceBond& bond = on.stencil[k];
    Lanes weight = broadcast(bond.weight);
    if (!kIntact) weight = select(expand(masks[k]), weight);
    if (!kUniform) weight = weight * load_at(on.volume, point, bond.shift);
    const Lanes springs = own_spring + load_at(on.spring, point, bond.shift);
    RIVEN_UNROLL
    for (int a = 0; a < D; ++a) {
      Lanes pull = springs * (load_at(on.u[static_cast<std::size_t>(a)], point, bond.shift) - u[a]);
      RIVEN_UNROLL
      for (int b = 0; b < D; ++b)
        pull += load_at(on.reply[static_cast<std::size_t>(D * a + b)], point, bond.shift) *
                bond.xi[static_cast<std::size_t>(b)];
      force[a] += weight * pull;
      if (!kIntact || !kUniform) bonds[a] += weight * bond.xi[static_cast<std::size_t>(a)];
    }
  }
  const Lanes scale = kUniform ? broadcast(on.uniform_volume * on.uniform_volume) : load(on.volume + point);
  RIVEN_UNROLL
  for (int a = 0; a < D; ++a) {
    if (!kIntact || !kUniform) RIVEN_UNROLL
    for (int b = 0; b < D; ++b)
      force[a] += load(on.reply[static_cast<std::size_t>(D * a + b)] + point) * bonds[b];
    store(on.out[static_cast<std::size_t>(a)] + point, scale * force[a]);
  }
}

template <int D, bool kUniform>
RIVEN_INLINE void pull_blocks(const CorrespondenceLattice& on, std::size_t begin, std::size_t end) {
  for (std::size_t block = begin / kLanes; block < end / kLanes; ++block) {
    if (on.blocks[block] == BlockKind::intact) pull_block<D, kUniform, true>(on, block);
    if (on.blocks[block] == BlockKind::partial) pull_block<D, kUniform, false>(on, block);
  }
}

template <int D>
void pull(const CorrespondenceLattice& on, std::size_t begin, std::size_t end) {
  return on.uniform_volume > 0 ? pull_blocks<D, true>(on, begin, end) : pull_blocks<D, false>(on, begin, end);
}

// ---- listed bonds ----

/// Eight bonds of a point, from bond n on.
template <int D>
struct ListedBonds8 {
  const double* ends[kLanes];
  Lanes xi[D], eta[D], spring, last_reply, weight;
};

template <int D>
RIVEN_INLINE ListedBonds8<D> gather(const CorrespondenceList& list, const CorrespondencePoint& own,
                                    std::size_t n) {
  ListedBonds8<D> at;
  RIVEN_UNROLL
  for (std::size_t l = 0; l < kLanes; ++l) at.ends[l] = list.points[list.neighbour[n + l]].x.data();
  Lanes place[4], state[4];
  load_fours(at.ends, 0, place);
  load_fours(at.ends, 4, state);
  RIVEN_UNROLL
  for (int d = 0; d < D; ++d) {
    at.xi[d] = place[d] - own.x[static_cast<std::size_t>(d)];
    at.eta[d] = state[d] - own.u[static_cast<std::size_t>(d)];
  }
  at.spring = place[3];
  at.last_reply = state[3];
  at.weight = load(list.weight.data() + n);
  return at;
}

/// Calls visit(eight bonds, which of them exist) for the bonds of a point.
template <int D, class Visit>
RIVEN_INLINE void for_each_eight(const CorrespondenceList& list, std::size_t point, const Visit& visit) {
  const std::uint8_t* masks = list.masks + list.begin[point] / 8 + point;
  for (std::size_t n = list.begin[point]; n < list.begin[point + 1]; n += kLanes, ++masks)
    if (*masks != 0) visit(gather<D>(list, list.points[point], n), expand(*masks));
}

template <int D, bool kRest>
RIVEN_INLINE std::size_t deform_points(const CorrespondenceList& list, std::size_t begin, std::size_t end,
                                       const GradientRows& f, double* rests) {
  for (std::size_t i = begin; i < end; ++i) {
    Lanes sums[D][D], squares = broadcast(0);
    clear(sums);
    for_each_eight<D>(list, i, [&](const ListedBonds8<D>& at, Mask exists) RIVEN_INLINED {
      RIVEN_UNROLL
      for (int a = 0; a < D; ++a) {
        const Lanes weighed = select(exists, at.weight * at.eta[a]);
        if (kRest) squares += weighed * at.eta[a];
        RIVEN_UNROLL
        for (int b = 0; b < D; ++b) sums[a][b] += weighed * at.xi[b];
      }
    });
    double rest = kRest ? sum(squares) : 0;
    RIVEN_UNROLL
    for (int a = 0; a < D; ++a) {
      double row[D];
      RIVEN_UNROLL
      for (int m = 0; m < D; ++m) row[m] = sum(sums[a][m]);
      RIVEN_UNROLL
      for (int b = 0; b < D; ++b) {
        double h = 0;
        RIVEN_UNROLL
        for (int m = 0; m < D; ++m) h += row[m] * list.shape[static_cast<std::size_t>(upper<D>(m, b))][i];
        f[static_cast<std::size_t>(D * a + b)][i - begin] = h + (a == b ? 1 : 0);
        rest -= h * row[b];
      }
    }
    if (kRest) rests[i - begin] = rest;
  }
  return end - begin;
}

template <int D>
std::size_t deform(const CorrespondenceList& list, std::size_t begin, std::size_t end,
                   const GradientRows& f) {
  return deform_points<D, false>(list, begin, end, f, nullptr);
}

template <int D>
std::size_t measure(const CorrespondenceList& list, std::size_t begin, std::size_t end, const GradientRows& f,
                    double* rest) {
  return deform_points<D, true>(list, begin, end, f, rest);
}

template <int D>
void reply(CorrespondenceList& list, std::size_t begin, std::size_t end, const GradientRows& f,
           const GradientRows& p) {
  for (std::size_t i = begin; i < end; ++i) RIVEN_UNROLL
  for (int a = 0; a < D; ++a) RIVEN_UNROLL
  for (int b = 0; b < D; ++b) {
    const auto c = static_cast<std::size_t>(D * a + b);
    double r = -list.spring[i] * (f[c][i - begin] - (a == b ? 1 : 0));
    RIVEN_UNROLL
    for (int m = 0; m < D; ++m)
      r += p[static_cast<std::size_t>(D * a + m)][i - begin] *
           list.shape[static_cast<std::size_t>(upper<D>(m, b))][i];
    list.reply[c][i] = r;
  }
}

/// The replies of eight bonds' other ends.
template <int D>
RIVEN_INLINE void gather_replies(const ListedBonds8<D>& at, Lanes (&reply)[D * D]) {
  Lanes four[4];
  RIVEN_UNROLL
  for (int begin = 0; begin + 4 <= D * D; begin += 4) {
    load_fours(at.ends, static_cast<std::size_t>(8 + begin), four);
    RIVEN_UNROLL
    for (int c = 0; c < 4; ++c) reply[begin + c] = four[c];
  }
  if constexpr (D == 3) reply[8] = at.last_reply;
}

template <int D>
void pull(const CorrespondenceList& list, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    const CorrespondencePoint& own = list.points[i];
    Lanes force[D];
    RIVEN_UNROLL
    for (Lanes& component : force) component = broadcast(0);
    for_each_eight<D>(list, i, [&](const ListedBonds8<D>& at, Mask exists) RIVEN_INLINED {
      Lanes reply[D * D];
      gather_replies<D>(at, reply);
      const Lanes springs = own.spring + at.spring;
      RIVEN_UNROLL
      for (int a = 0; a < D; ++a) {
        Lanes pull = springs * at.eta[a];
        RIVEN_UNROLL
        for (int b = 0; b < D; ++b)
          pull += (list.reply[static_cast<std::size_t>(D * a + b)][i] + reply[D * a + b]) * at.xi[b];
        force[a] += select(exists, at.weight * pull);
      }
    });
    RIVEN_UNROLL
    for (int d = 0; d < D; ++d) list.out[static_cast<std::size_t>(d)][i] = list.volume[i] * sum(force[d]);
  }
}

template <int D>
CorrespondenceKernels kernels_of() {
  return {{deform<D>, measure<D>, reply<D>, pull<D>}, {deform<D>, measure<D>, reply<D>, pull<D>}};
}

inline CorrespondenceKernels correspondence_kernels(int dimension) {
  return dimension == 2 ? kernels_of<2>() : kernels_of<3>();
}
