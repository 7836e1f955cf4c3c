#include "peridynamics/lps_kernels.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "base/instruction_set.hpp"
#include "base/lanes.hpp"

#define RIVEN_KERNELS "peridynamics/lps_kernels.inl"
#include "base/for_each_instruction_set.inl"

namespace riven {

LpsKernels lps_kernels(int dimension) {
  switch (instruction_set()) {
#if defined(__x86_64__)
    case InstructionSet::avx512:
      return avx512::lps_kernels(dimension);
    case InstructionSet::avx2:
      return avx2::lps_kernels(dimension);
#endif
    default:
      return portable::lps_kernels(dimension);
  }
}

}  // namespace riven
