#include "peridynamics/bond_membrane_kernels.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "base/instruction_set.hpp"
#include "base/lanes.hpp"

#define RIVEN_KERNELS "peridynamics/bond_membrane_kernels.inl"
#include "base/for_each_instruction_set.inl"

namespace riven {

BondMembraneKernel bond_membrane_kernel() {
  switch (instruction_set()) {
#if defined(__x86_64__)
    case InstructionSet::avx512:
      return avx512::bond_membrane_kernel();
    case InstructionSet::avx2:
      return avx2::bond_membrane_kernel();
#endif
    default:
      return portable::bond_membrane_kernel();
  }
}

}  // namespace riven
