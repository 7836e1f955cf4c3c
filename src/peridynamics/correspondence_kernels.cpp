#include "peridynamics/correspondence_kernels.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "base/instruction_set.hpp"
#include "base/lanes.hpp"

#define RIVEN_KERNELS "peridynamics/correspondence_kernels.inl"
#include "base/for_each_instruction_set.inl"

namespace riven {

CorrespondenceKernels correspondence_kernels(int dimension) {
  switch (instruction_set()) {
#if defined(__x86_64__)
    case InstructionSet::avx512:
      return avx512::correspondence_kernels(dimension);
    case InstructionSet::avx2:
      return avx2::correspondence_kernels(dimension);
#endif
    default:
      return portable::correspondence_kernels(dimension);
  }
}

}  // namespace riven
