#if defined(__x86_64__)

#include "tassilo/region/internal/plane_kernel.h"
#include "tassilo/region/internal/plane_loops.h"

#if defined(__clang__)
#define TASSILO_AVX512 __attribute__((target("avx512f,avx512bw,avx512vl")))
#else
#define TASSILO_AVX512 __attribute__((target("avx512f,avx512bw,avx512vl,prefer-vector-width=512")))
#endif

namespace tassilo {

TASSILO_PLANE_KERNEL(avx512_plane_kernel, TASSILO_AVX512)

}  // namespace tassilo

#endif
