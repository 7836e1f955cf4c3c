// Compiles the kernels in the file RIVEN_KERNELS once for each instruction set, in namespaces of their own:
// riven::portable, riven::avx2, riven::avx512. What the kernels need is included before; code in headers
// stays portable, so nothing that other parts of the program share is compiled for a processor that may lack
// it. This file has no guard: a kernels' source file includes it after defining RIVEN_KERNELS.

#define RIVEN_INLINE inline __attribute__((always_inline))
#define RIVEN_UNROLL _Pragma("GCC unroll 8")
#define RIVEN_INLINED __attribute__((always_inline))  // lambdas

#define RIVEN_REGISTER 2
namespace riven::portable {
#include "base/lanes.inl"
#include RIVEN_KERNELS
}  // namespace riven::portable
#undef RIVEN_REGISTER

#if defined(__x86_64__)
#pragma GCC push_options
#pragma GCC target("avx2,fma")
#define RIVEN_REGISTER 4
namespace riven::avx2 {
#include "base/lanes.inl"
#include RIVEN_KERNELS
}  // namespace riven::avx2
#undef RIVEN_REGISTER
#pragma GCC pop_options

#pragma GCC push_options
#pragma GCC target("avx512f,avx512dq,avx2,fma")
#define RIVEN_REGISTER 8
namespace riven::avx512 {
#include "base/lanes.inl"
#include RIVEN_KERNELS
}  // namespace riven::avx512
#undef RIVEN_REGISTER
#pragma GCC pop_options
#endif

#undef RIVEN_KERNELS
#undef RIVEN_INLINE
#undef RIVEN_INLINED
#undef RIVEN_UNROLL
