#include "peridynamics/pmb_kernels.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "base/instruction_set.hpp"
#include "base/lanes.hpp"

#define RIVEN_KERNELS "peridynamics/pmb_kernels.inl"
#include "base/for_each_instruction_set.inl"

namespace riven {

PmbKernels pmb_kernels(int dimension) {
  switch (instruction_set()) {
#if defined(__x86_64__)
    case InstructionSet::avx512:
      return avx512::pmb_kernels(dimension);
    case InstructionSet::avx2:
      return avx2::pmb_kernels(dimension);
#endif
    default:
      return portable::pmb_kernels(dimension);
  }
}

}  // namespace riven
