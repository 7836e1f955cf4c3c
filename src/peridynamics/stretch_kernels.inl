// The search for bonds beyond their limit, in the lanes of one instruction set
// (for_each_instruction_set.inl): eight points of a row at the same bond of the stencil.

#include "peridynamics/bond_lanes.inl"

template <int D>
void find_long_bonds_of(StretchLattice& on, std::size_t begin, std::size_t end) {
  const std::size_t count = on.stencil.size();
  for (std::size_t block = begin; block < end; ++block) {
    const std::uint8_t* masks = on.masks + block * count;
    const double limit2 = on.least_limit2[block];
    on.beyond[block] = 0;
    if (__builtin_isinf(limit2)) continue;
    const std::size_t point = block * kLanes;
    Lanes u[D];
    load_displacements(on, point, u);
    Mask beyond;
    for (std::size_t k = 0; k < count; ++k) {
      if (masks[k] == 0) continue;
      const StretchBond& bond = on.stencil[k];
      const Bonds<D> at = bonds_at(on, bond, point, u);
      beyond = beyond | (greater(dot(at.y, at.y), bond.length2 * limit2) & expand(masks[k]));
    }
    on.beyond[block] = bits_of(beyond) != 0 ? 1 : 0;
  }
}

inline FindLongBonds find_long_bonds(int dimension) {
  if (dimension == 1) return find_long_bonds_of<1>;
  return dimension == 2 ? find_long_bonds_of<2> : find_long_bonds_of<3>;
}
