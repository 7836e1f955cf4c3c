// The loop over bonds of the bond-based membrane on a lattice, in the lanes of one instruction set
// (for_each_instruction_set.inl): every point sums the pair forces on itself.

/// R of squared stretches, as BondLaw::response; `inverse` is 1 over the stretch.
RIVEN_INLINE Lanes response(const BondLaw& law, Lanes s2, Lanes inverse) {
  const Lanes q = inverse * inverse;
  return law.p2 + 2 * law.p4 * s2 -
         q * (0.5 * law.m1 * inverse + q * (law.m2 + q * (2 * law.m4 + 3 * law.m6 * q)));
}

RIVEN_INLINE Lanes at(const double* plane, std::size_t point, std::ptrdiff_t shift = 0) {
  return load(plane + static_cast<std::ptrdiff_t>(point) + shift);
}

template <bool kIntact>
RIVEN_INLINE void pull_block(const BondMembraneLattice& on, std::size_t block) {
  const std::size_t i = block * kLanes, count = on.stencil.size();
  const std::uint8_t* masks = on.masks + block * count;
  const BondLaw law = on.law;
  const auto [gx, gy] = on.correction;
  Lanes fx = broadcast(0), fy = fx;
  for (std::size_t k = 0; k < count; ++k) {
    if (!kIntact && masks[k] == 0) continue;
    const BondMembraneOffset& bond = on.stencil[k];
    const Lanes x = bond.x + (at(on.u[0], i, bond.shift) - at(on.u[0], i));
    const Lanes y = bond.y + (at(on.u[1], i, bond.shift) - at(on.u[1], i));
    const Lanes s2 = (x * x + y * y) * bond.inverse2, inverse = inverse_root(s2);
    const Lanes cosine = (bond.x * x + bond.y * y) * bond.inverse2 * inverse;
    // Twice the mean factors of both ends; an ellipse through them, eq. (43) of the source.
    const Lanes mx = at(gx, i) + at(gx, i, bond.shift), my = at(gy, i) + at(gy, i, bond.shift);
    const Lanes mx2 = mx * mx, my2 = my * my;
    const Lanes corrected = 0.5 * mx * my * inverse_root(bond.nx2 * my2 + bond.ny2 * mx2);
    Lanes pull = bond.stiffness * corrected * at(on.volume, i, bond.shift) * (cosine * cosine) *
                 response(law, s2, inverse);
    if (!kIntact) pull = select(expand(masks[k]), pull);
    fx += pull * x;
    fy += pull * y;
  }
  const Lanes own = at(on.share, i) * at(on.volume, i);
  store(on.force[0] + i, own * fx);
  store(on.force[1] + i, own * fy);
}

inline void pull(const BondMembraneLattice& on, std::size_t begin, std::size_t end) {
  for (std::size_t block = begin / kLanes; block < end / kLanes; ++block) {
    if (on.blocks[block] == BlockKind::intact) {
      pull_block<true>(on, block);
    } else if (on.blocks[block] == BlockKind::partial) {
      pull_block<false>(on, block);
    } else {
      for (double* force : on.force) store(force + block * kLanes, broadcast(0));
    }
  }
}

inline BondMembraneKernel bond_membrane_kernel() {
  return pull;
}
