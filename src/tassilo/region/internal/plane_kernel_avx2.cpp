#if defined(__x86_64__)

#include "tassilo/base/kernel_targets.h"
#include "tassilo/region/internal/plane_kernel.h"
#include "tassilo/region/internal/plane_loops.h"

namespace tassilo {
namespace {

TASSILO_PLANE_JOINS(TASSILO_AVX2)

TASSILO_AVX2 std::size_t changes(std::uint32_t* at, const std::uint64_t* b, std::size_t words) {
  return find_changes(at, b, words);
}

}  // namespace

constinit const PlaneKernel avx2_plane_kernel{join_or, join_and, triple_or, triple_and, move, changes};

}  // namespace tassilo

#endif
