#include "peridynamics/membrane_kernels.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "base/instruction_set.hpp"
#include "base/lanes.hpp"
#include "peridynamics/family_energy.hpp"

#define RIVEN_KERNELS "peridynamics/membrane_kernels.inl"
#include "base/for_each_instruction_set.inl"

namespace riven {

MembraneKernels membrane_kernels() {
  switch (instruction_set()) {
#if defined(__x86_64__)
    case InstructionSet::avx512:
      return avx512::membrane_kernels();
    case InstructionSet::avx2:
      return avx2::membrane_kernels();
#endif
    default:
      return portable::membrane_kernels();
  }
}

}  // namespace riven
