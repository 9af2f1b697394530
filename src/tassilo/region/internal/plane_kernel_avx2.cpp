#if defined(__x86_64__)

#include "tassilo/region/internal/plane_kernel.h"
#include "tassilo/region/internal/plane_loops.h"

namespace tassilo {

TASSILO_PLANE_KERNEL(avx2_plane_kernel, __attribute__((target("avx2"))))

}  // namespace tassilo

#endif
