// The loops over points and bonds of the membrane, in the lanes of one instruction set
// (for_each_instruction_set.inl): first the averages over each family, then the forces. On a lattice the
// lanes are eight points of a row at the same bond of the stencil, in a list eight bonds of a point.

RIVEN_INLINE const double* at(const double* plane, std::size_t point, std::ptrdiff_t shift = 0) {
  return plane + static_cast<std::ptrdiff_t>(point) + shift;
}

template <std::size_t N>
RIVEN_INLINE void load_all(const std::array<std::vector<double>, N>& planes, std::size_t point,
                           std::ptrdiff_t shift, Lanes (&to)[N]) {
  RIVEN_UNROLL
  for (std::size_t n = 0; n < N; ++n) to[n] = load(at(planes[n].data(), point, shift));
}

/// Family averages as they grow bond by bond.
struct FamilySums {
  Lanes s2, s4, gradient[4];

  RIVEN_INLINE FamilySums() : s2(broadcast(0)), s4(s2), gradient{s2, s2, s2, s2} {}
  /// `w`: weight over |xi|^2, 0 where there is no bond.
  template <class Component>
  RIVEN_INLINE void add(Lanes w, Component x, Component y, Lanes yx, Lanes yy, Component inverse2) {
    const Lanes r2 = yx * yx + yy * yy, ws2 = w * r2, wx = w * x, wy = w * y;
    s2 += ws2;
    s4 += ws2 * (r2 * inverse2);
    gradient[0] += wx * yx;
    gradient[1] += wy * yx;
    gradient[2] += wx * yy;
    gradient[3] += wy * yy;
  }
};

// ---- on a lattice ----

/// Weight over |xi|^2 of a bond of the stencil in the families of eight points; theory, eq. (10).
RIVEN_INLINE Lanes weight_of(const Lanes (&coefficient)[kMoments], const Moments& bond) {
  Lanes weight = coefficient[0] * bond[0];
  RIVEN_UNROLL
  for (std::size_t m = 1; m < kMoments; ++m) weight += coefficient[m] * bond[m];
  return weight;
}

/// Deformed bonds of eight points along one axis, x the undeformed (m).
RIVEN_INLINE Lanes deformed(const double* u, double x, std::size_t point, std::ptrdiff_t shift) {
  return x + (load(at(u, point, shift)) - load(at(u, point)));
}

template <bool kIntact>
RIVEN_INLINE void average_block(const MembraneLattice& on, MembranePlanes& planes, std::size_t block) {
  const std::size_t i = block * kLanes, count = on.stencil.size();
  const std::uint8_t* masks = on.masks + block * count;
  Lanes coefficient[kMoments];
  load_all(on.coefficient, i, 0, coefficient);
  FamilySums sums;
  for (std::size_t k = 0; k < count; ++k) {
    if (!kIntact && masks[k] == 0) continue;
    const MembraneBondOffset& bond = on.stencil[k];
    const Lanes w = kIntact ? broadcast(bond.whole_weight)
                            : select(expand(masks[k]), weight_of(coefficient, bond.weight));
    sums.add(w, bond.x, bond.y, deformed(on.u[0], bond.x, i, bond.shift),
             deformed(on.u[1], bond.y, i, bond.shift), bond.inverse2);
  }
  store(planes.mean_s2.data() + i, sums.s2);
  store(planes.mean_s4.data() + i, sums.s4);
  RIVEN_UNROLL
  for (std::size_t c = 0; c < 4; ++c) store(planes.mean_gradient[c].data() + i, sums.gradient[c]);
}

inline void average(const MembraneLattice& on, MembranePlanes& planes, std::size_t begin, std::size_t end) {
  for (std::size_t block = begin / kLanes; block < end / kLanes; ++block) {
    if (on.blocks[block] == BlockKind::intact) average_block<true>(on, planes, block);
    if (on.blocks[block] == BlockKind::partial) average_block<false>(on, planes, block);
  }
}

/// Forces on eight points (theory, eq. (1)). The part with the own n needs of the bonds one vector, which
/// vanishes in a whole family.
template <bool kIntact>
RIVEN_INLINE void gather_block(const MembraneLattice& on, std::size_t block) {
  const std::size_t i = block * kLanes, count = on.stencil.size();
  const std::uint8_t* masks = on.masks + block * count;
  Lanes coefficient[kMoments], n[4];
  load_all(on.coefficient, i, 0, coefficient);
  const Lanes a = load(on.a.data() + i), b = load(on.b.data() + i);
  Lanes fx = broadcast(0), fy = fx, own_x = fx, own_y = fx;
  for (std::size_t k = 0; k < count; ++k) {
    if (!kIntact && masks[k] == 0) continue;
    const MembraneBondOffset& bond = on.stencil[k];
    const Lanes yx = deformed(on.u[0], bond.x, i, bond.shift), yy = deformed(on.u[1], bond.y, i, bond.shift);
    const Lanes s2 = (yx * yx + yy * yy) * bond.inverse2;
    const Lanes a_far = load(at(on.a.data(), i, bond.shift)), b_far = load(at(on.b.data(), i, bond.shift));
    Lanes far = broadcast(bond.whole_weight), pull;
    if (kIntact) {
      pull = far * ((a + a_far) + (b + b_far) * s2);
    } else {
      const Mask exists = expand(masks[k]);
      const Lanes own = select(exists, weight_of(coefficient, bond.weight));
      Lanes coefficient_far[kMoments];
      load_all(on.coefficient, i, bond.shift, coefficient_far);
      far = select(exists, weight_of(coefficient_far, bond.weight));
      pull = own * (a + b * s2) + far * (a_far + b_far * s2);
      own_x += own * bond.x;
      own_y += own * bond.y;
    }
    load_all(on.n, i, bond.shift, n);
    const Lanes wx = far * bond.x, wy = far * bond.y;
    fx += pull * yx + n[0] * wx + n[1] * wy;
    fy += pull * yy + n[2] * wx + n[3] * wy;
  }
  if (!kIntact) {
    load_all(on.n, i, 0, n);
    fx += n[0] * own_x + n[1] * own_y;
    fy += n[2] * own_x + n[3] * own_y;
  }
  store(on.force[0] + i, fx);
  store(on.force[1] + i, fy);
}

inline void gather(const MembraneLattice& on, std::size_t begin, std::size_t end) {
  for (std::size_t block = begin / kLanes; block < end / kLanes; ++block) {
    if (on.blocks[block] == BlockKind::intact) {
      gather_block<true>(on, block);
    } else if (on.blocks[block] == BlockKind::partial) {
      gather_block<false>(on, block);
    } else {
      for (double* force : on.force) store(force + block * kLanes, broadcast(0));
    }
  }
}

// ---- listed bonds ----

/// Where the other ends of eight bonds of a point lie: points as MembranePoint has them, four doubles at a
/// time.
struct FarEnds {
  const double* at[kLanes];

  RIVEN_INLINE FarEnds(const MembraneList& list, std::size_t first) {
    RIVEN_UNROLL
    for (std::size_t l = 0; l < kLanes; ++l) at[l] = list.points[list.neighbour[first + l]].x.data();
  }
};

/// Eight bonds of a point: x, y undeformed, yx, yy deformed (m).
struct BondsOfPoint {
  Lanes x, y, yx, yy, inverse2;
  Lanes inverse3;  // 1/length^3, 0 where there is no bond
  Lanes c, s;      // cosine and sine of twice a bond's angle

  RIVEN_INLINE BondsOfPoint(const MembranePoint& own, const FarEnds& ends, Mask exists) {
    Lanes far[4];
    load_fours(ends.at, 0, far);
    x = far[0] - own.x[0];
    y = far[1] - own.x[1];
    yx = x + (far[2] - own.u[0]);
    yy = y + (far[3] - own.u[1]);
    // An entry that is no bond may be the point itself, at length 0.
    const Lanes inverse = select(exists, inverse_root(x * x + y * y));
    inverse2 = inverse * inverse;
    inverse3 = inverse * inverse2;
    c = (x * x - y * y) * inverse2;
    s = (x + x) * y * inverse2;
  }
};

/// Calls visit(eight bonds, their other ends) for the bonds of a point.
template <class Visit>
RIVEN_INLINE void for_each_eight(const MembraneList& list, std::size_t point, const Visit& visit) {
  const std::uint8_t* masks = list.masks + list.begin[point] / 8 + point;
  for (std::size_t n = list.begin[point]; n < list.begin[point + 1]; n += kLanes, ++masks) {
    if (*masks == 0) continue;
    const FarEnds ends(list, n);
    visit(BondsOfPoint(list.points[point], ends, expand(*masks)), ends);
  }
}

/// Weights over |xi|^2 in the point's own family.
RIVEN_INLINE Lanes own_weight(const Moments& k, const BondsOfPoint& at) {
  return at.inverse3 * (k[0] + k[1] * at.c + at.s * (k[2] + k[3] * at.s + k[4] * at.c));
}

inline void average(const MembraneList& list, MembranePlanes& planes, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    if (!list.has_coefficients(i)) continue;
    FamilySums sums;
    for_each_eight(list, i, [&](const BondsOfPoint& bonds, const FarEnds&) RIVEN_INLINED {
      sums.add(own_weight(list.points[i].coefficient, bonds), bonds.x, bonds.y, bonds.yx, bonds.yy,
               bonds.inverse2);
    });
    planes.mean_s2[i] = sum(sums.s2);
    planes.mean_s4[i] = sum(sums.s4);
    RIVEN_UNROLL
    for (std::size_t c = 0; c < 4; ++c) planes.mean_gradient[c][i] = sum(sums.gradient[c]);
  }
}

inline void gather(const MembraneList& list, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    const MembranePoint& point = list.points[i];
    Lanes fx = broadcast(0), fy = fx, own_x = fx, own_y = fx;
    for_each_eight(list, i, [&](const BondsOfPoint& bonds, const FarEnds& ends) RIVEN_INLINED {
      const Lanes own = own_weight(point.coefficient, bonds);
      own_x += own * bonds.x;
      own_y += own * bonds.y;
      const Lanes s2 = (bonds.yx * bonds.yx + bonds.yy * bonds.yy) * bonds.inverse2;
      Lanes pull = own * (point.law.a + point.law.b * s2), far[4];
      load_fours(ends.at, 4, far);
      Lanes weight = far[0] + far[1] * bonds.c + bonds.s * (far[2] + far[3] * bonds.s);
      load_fours(ends.at, 8, far);
      weight = bonds.inverse3 * (weight + bonds.s * bonds.c * far[0]);
      pull += weight * (far[1] + far[2] * s2);
      const Lanes wx = weight * bonds.x, wy = weight * bonds.y;
      fx += pull * bonds.yx + far[3] * wx;
      fy += pull * bonds.yy;
      load_fours(ends.at, 12, far);
      fx += far[0] * wy;
      fy += far[1] * wx + far[2] * wy;
    });
    const auto& n = point.law.n;
    list.force[0][i] = sum(fx + n[0] * own_x + n[1] * own_y);
    list.force[1][i] = sum(fy + n[2] * own_x + n[3] * own_y);
  }
}

// ---- of points ----

/// Energies and force laws of points from their averages; theory, eq. (9), and rule 5 of 5a. Entries without
/// coefficients get those of a state of rest.
template <class Law, class Bonds>
__attribute__((flatten)) std::size_t respond_by(const Law& law, Bonds& on, MembranePlanes& planes,
                                                std::size_t begin, std::size_t end) {
  std::size_t fallen = 0;
#pragma omp simd reduction(+ : fallen)
  for (std::size_t i = begin; i < end; ++i) {
    const bool own = on.has_coefficients(i);
    const double a = own ? planes.mean_s2[i] : 1, b = own ? planes.mean_s4[i] : 1;
    fallen += collapsed(a, b) ? 1U : 0U;
    const FamilyEnergy e = family_energy(law, a, b), k = stiffened_modulus(planes.kappa[i], a, b);
    const double g0 = planes.mean_gradient[0][i], g1 = planes.mean_gradient[1][i],
                 g2 = planes.mean_gradient[2][i], g3 = planes.mean_gradient[3][i];
    const double z2 = a - 2 * (g0 * g0 + g1 * g1 + g2 * g2 + g3 * g3);  // mean of |Y - F xi|^2 / |xi|^2
    const double v = planes.volume[i], n = -4 * v * k.w;
    planes.energy_density[i] = e.w + k.w * z2;
    on.set_law(
        i, {2 * v * (e.wa + k.w + k.wa * z2), 4 * v * (e.wb + k.wb * z2), {n * g0, n * g1, n * g2, n * g3}});
  }
  return fallen;
}

template <class Bonds>
std::size_t respond(const InvariantLaw& law, Bonds& on, MembranePlanes& planes, std::size_t begin,
                    std::size_t end) {
  average(on, planes, begin, end);
  return std::visit([&](const auto& w) { return respond_by(w, on, planes, begin, end); }, law);
}

inline MembraneKernels membrane_kernels() {
  return {{respond<MembraneLattice>, gather}, {respond<MembraneList>, gather}};
}
