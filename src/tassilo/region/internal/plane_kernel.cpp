#include "tassilo/region/internal/plane_kernel.h"

#include "tassilo/region/internal/plane_loops.h"

namespace tassilo {

TASSILO_PLANE_KERNEL(plain_plane_kernel, )

const PlaneKernel& plane_kernel(Kernel kernel) {
  switch (kernel) {
#if defined(__x86_64__)
    case Kernel::avx512:
      return avx512_plane_kernel;
    case Kernel::avx2:
      return avx2_plane_kernel;
#endif
    default:  // on aarch64 the plain one is made of NEON already
      return plain_plane_kernel;
  }
}

}  // namespace tassilo
