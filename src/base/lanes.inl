// Eight neighbouring points of a lattice row, or eight bonds of a point, in registers of one instruction set.
// Included by for_each_instruction_set.inl inside a namespace of that set; RIVEN_REGISTER: doubles of a
// register.

inline constexpr std::size_t kRegister = RIVEN_REGISTER;
inline constexpr std::size_t kRegisters = kLanes / kRegister;

using Register = double __attribute__((vector_size(kRegister * sizeof(double))));
using UnalignedRegister __attribute__((aligned(8), may_alias)) = Register;
using RegisterMask = std::int64_t __attribute__((vector_size(kRegister * sizeof(double))));

struct Lanes {
  Register part[kRegisters];
};

RIVEN_INLINE Lanes broadcast(double value) {
  Lanes lanes;
  RIVEN_UNROLL
  for (Register& part : lanes.part) part = Register{} + value;
  return lanes;
}

RIVEN_INLINE Lanes load(const double* from) {
  Lanes lanes;
  RIVEN_UNROLL
  for (std::size_t p = 0; p < kRegisters; ++p)
    lanes.part[p] = *reinterpret_cast<const UnalignedRegister*>(from + p * kRegister);
  return lanes;
}

/// A row of a square to be transposed: one register, or of eight lanes two halves from places four apart.
RIVEN_INLINE Register load_row(const double* const* from, std::size_t offset) {
#if RIVEN_REGISTER == 8
  return reinterpret_cast<Register>(_mm512_insertf64x4(
      _mm512_castpd256_pd512(_mm256_loadu_pd(from[0] + offset)), _mm256_loadu_pd(from[4] + offset), 1));
#else
  return *reinterpret_cast<const UnalignedRegister*>(from[0] + offset);
#endif
}

RIVEN_INLINE void store(double* to, Lanes lanes) {
  RIVEN_UNROLL
  for (std::size_t p = 0; p < kRegisters; ++p)
    *reinterpret_cast<UnalignedRegister*>(to + p * kRegister) = lanes.part[p];
}

/// Swaps what lies off the diagonal in the blocks of `h` lanes of two registers.
template <std::size_t h, std::size_t... lane>
RIVEN_INLINE void exchange(Register& a, Register& b, std::index_sequence<lane...>) {
  const Register upper = __builtin_shufflevector(a, b, ((lane & h) != 0 ? kRegister + lane - h : lane)...);
  b = __builtin_shufflevector(a, b, ((lane & h) != 0 ? kRegister + lane : lane + h)...);
  a = upper;
}

/// Four doubles from each of eight places: lane l of to[n] is from[l][offset + n].
RIVEN_INLINE void load_fours(const double* const (&from)[kLanes], std::size_t offset, Lanes (&to)[4]) {
  constexpr std::size_t side = kRegister < 4 ? kRegister : 4;
  constexpr auto lanes = std::make_index_sequence<kRegister>();
  RIVEN_UNROLL
  for (std::size_t p = 0; p < kRegisters; ++p) {
    RIVEN_UNROLL
    for (std::size_t n = 0; n < 4; n += side) {
      Register row[side];
      RIVEN_UNROLL
      for (std::size_t m = 0; m < side; ++m) row[m] = load_row(from + p * kRegister + m, offset + n);
      if constexpr (side == 4) {
        exchange<2>(row[0], row[2], lanes);
        exchange<2>(row[1], row[3], lanes);
        exchange<1>(row[2], row[3], lanes);
      }
      exchange<1>(row[0], row[1], lanes);
      RIVEN_UNROLL
      for (std::size_t m = 0; m < side; ++m) to[n + m].part[p] = row[m];
    }
  }
}

#define RIVEN_LANES_OPERATOR(op)                                                     \
  RIVEN_INLINE Lanes operator op(Lanes a, Lanes b) {                                 \
    RIVEN_UNROLL                                                                     \
    for (std::size_t p = 0; p < kRegisters; ++p) a.part[p] = a.part[p] op b.part[p]; \
    return a;                                                                        \
  }                                                                                  \
  RIVEN_INLINE Lanes operator op(Lanes a, double b) {                                \
    RIVEN_UNROLL                                                                     \
    for (Register & part : a.part) part = part op b;                                 \
    return a;                                                                        \
  }                                                                                  \
  RIVEN_INLINE Lanes operator op(double a, Lanes b) {                                \
    RIVEN_UNROLL                                                                     \
    for (Register & part : b.part) part = a op part;                                 \
    return b;                                                                        \
  }
RIVEN_LANES_OPERATOR(+)
RIVEN_LANES_OPERATOR(-)
RIVEN_LANES_OPERATOR(*)
RIVEN_LANES_OPERATOR(/)
#undef RIVEN_LANES_OPERATOR

RIVEN_INLINE Lanes& operator+=(Lanes& a, Lanes b) {
  a = a + b;
  return a;
}

RIVEN_INLINE Lanes maximum(Lanes a, Lanes b) {
  RIVEN_UNROLL
  for (std::size_t p = 0; p < kRegisters; ++p) a.part[p] = a.part[p] > b.part[p] ? a.part[p] : b.part[p];
  return a;
}

RIVEN_INLINE Lanes magnitude(Lanes a) {
  return maximum(a, 0.0 - a);
}

/// Sum of the lanes, always in the same order.
RIVEN_INLINE double sum(Lanes lanes) {
  Register parts = lanes.part[0];
  RIVEN_UNROLL
  for (std::size_t p = 1; p < kRegisters; ++p) parts += lanes.part[p];
  double total = parts[0];
  RIVEN_UNROLL
  for (std::size_t l = 1; l < kRegister; ++l) total += parts[l];
  return total;
}

#if RIVEN_REGISTER == 8

struct Mask {
  __mmask8 bits = 0;
};

RIVEN_INLINE Mask expand(std::uint8_t bits) {
  return {bits};
}
RIVEN_INLINE std::uint8_t bits_of(Mask mask) {
  return mask.bits;
}
RIVEN_INLINE Mask operator&(Mask a, Mask b) {
  return {static_cast<__mmask8>(a.bits & b.bits)};
}
RIVEN_INLINE Mask operator|(Mask a, Mask b) {
  return {static_cast<__mmask8>(a.bits | b.bits)};
}
RIVEN_INLINE Mask greater(Lanes a, double b) {
  return {_mm512_cmp_pd_mask(reinterpret_cast<__m512d>(a.part[0]), _mm512_set1_pd(b), _CMP_GT_OQ)};
}
RIVEN_INLINE Lanes select(Mask mask, Lanes a) {
  return {{reinterpret_cast<Register>(_mm512_maskz_mov_pd(mask.bits, reinterpret_cast<__m512d>(a.part[0])))}};
}

/// 1 / sqrt(a) to the last bit or two: 14 bits by the processor, the rest by one step of fourth order.
RIVEN_INLINE Lanes inverse_root(Lanes a) {
  const Lanes y = {{reinterpret_cast<Register>(_mm512_rsqrt14_pd(reinterpret_cast<__m512d>(a.part[0])))}};
  const Lanes e = 1.0 - (a * y) * y;
  return y + (e * y) * (((5.0 / 16) * e + 3.0 / 8) * e + 0.5);
}

/// sqrt(a) to the last bit or two, for a above 0.
RIVEN_INLINE Lanes root(Lanes a) {
  return a * inverse_root(a);
}

#else

struct Mask {
  RegisterMask part[kRegisters] = {};
};

/// Masks of a register for every pattern of its bits.
struct RegisterMasks {
  RegisterMask of[1U << kRegister] = {};
  constexpr RegisterMasks() {
    for (std::size_t bits = 0; bits < (1U << kRegister); ++bits)
      for (std::size_t l = 0; l < kRegister; ++l) of[bits][l] = ((bits >> l) & 1U) != 0 ? -1 : 0;
  }
};
inline const RegisterMasks kRegisterMasks;

RIVEN_INLINE Mask expand(std::uint8_t bits) {
  Mask mask;
  RIVEN_UNROLL
  for (std::size_t p = 0; p < kRegisters; ++p)
    mask.part[p] =
        kRegisterMasks.of[(static_cast<std::size_t>(bits) >> (p * kRegister)) & ((1U << kRegister) - 1)];
  return mask;
}
RIVEN_INLINE std::uint8_t bits_of(Mask mask) {
  unsigned bits = 0;
  for (std::size_t l = 0; l < kLanes; ++l)
    bits |= mask.part[l / kRegister][l % kRegister] != 0 ? 1U << l : 0U;
  return static_cast<std::uint8_t>(bits);
}
RIVEN_INLINE Mask operator&(Mask a, Mask b) {
  RIVEN_UNROLL
  for (std::size_t p = 0; p < kRegisters; ++p) a.part[p] &= b.part[p];
  return a;
}
RIVEN_INLINE Mask operator|(Mask a, Mask b) {
  RIVEN_UNROLL
  for (std::size_t p = 0; p < kRegisters; ++p) a.part[p] |= b.part[p];
  return a;
}
RIVEN_INLINE Mask greater(Lanes a, double b) {
  Mask mask;
  RIVEN_UNROLL
  for (std::size_t p = 0; p < kRegisters; ++p) mask.part[p] = a.part[p] > b;
  return mask;
}
RIVEN_INLINE Lanes select(Mask mask, Lanes a) {
  RIVEN_UNROLL
  for (std::size_t p = 0; p < kRegisters; ++p)
    a.part[p] = reinterpret_cast<Register>(reinterpret_cast<RegisterMask>(a.part[p]) & mask.part[p]);
  return a;
}

RIVEN_INLINE Lanes root(Lanes a) {
  RIVEN_UNROLL
  for (Register& part : a.part) {
#if RIVEN_REGISTER == 4
    part = reinterpret_cast<Register>(_mm256_sqrt_pd(reinterpret_cast<__m256d>(part)));
#else
    for (std::size_t l = 0; l < kRegister; ++l) part[l] = __builtin_sqrt(part[l]);
#endif
  }
  return a;
}

/// 1 / sqrt(a). Root and division beat an estimate with refinement on registers of four.
RIVEN_INLINE Lanes inverse_root(Lanes a) {
  return 1.0 / root(a);
}

#endif
