#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace riven {

/// Eight neighbouring points of a lattice row, in the compiler's portable vector type: one AVX-512 register,
/// two of AVX, four of SSE2. Kernels are written in it once.
inline constexpr std::size_t kLanes = 8;
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));
using LaneMask = std::int64_t __attribute__((vector_size(kLanes * sizeof(double))));

inline Lanes load(const double* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

inline void store(double* to, Lanes lanes) {
  std::memcpy(to, &lanes, sizeof lanes);
}

inline Lanes broadcast(double value) {
  return Lanes{} + value;
}

inline double square_root(double value) {
  return std::sqrt(value);
}
inline Lanes square_root(Lanes value) {
  for (std::size_t l = 0; l < kLanes; ++l) value[l] = std::sqrt(value[l]);
  return value;
}

inline Lanes select(LaneMask mask, Lanes value) {
  return mask ? value : Lanes{};
}

/// Lane l is true where bit l is set.
inline LaneMask expand(std::uint8_t bits) {
  constexpr LaneMask one_bit = {1, 2, 4, 8, 16, 32, 64, 128};
  return (one_bit & static_cast<std::int64_t>(bits)) != 0;
}

}  // namespace riven
