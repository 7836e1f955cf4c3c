#include "peridynamics/stretch_kernels.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "base/instruction_set.hpp"
#include "base/lanes.hpp"

#define RIVEN_KERNELS "peridynamics/stretch_kernels.inl"
#include "base/for_each_instruction_set.inl"

namespace riven {

FindLongBonds find_long_bonds(int dimension) {
  switch (instruction_set()) {
#if defined(__x86_64__)
    case InstructionSet::avx512:
      return avx512::find_long_bonds(dimension);
    case InstructionSet::avx2:
      return avx2::find_long_bonds(dimension);
#endif
    default:
      return portable::find_long_bonds(dimension);
  }
}

}  // namespace riven
