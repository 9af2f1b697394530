#if defined(__x86_64__)

#include "tassilo/base/kernel_targets.h"
#include "tassilo/region/internal/plane_kernel.h"
#include "tassilo/region/internal/plane_loops.h"

namespace tassilo {
namespace {

TASSILO_PLANE_JOINS(TASSILO_AVX2)
TASSILO_PLANE_NINES(TASSILO_AVX2)

TASSILO_AVX2 std::size_t changes(std::uint32_t* at, const std::uint64_t* b, std::size_t words) {
  return find_changes(at, b, words);
}
TASSILO_AVX2 void fill(std::uint64_t* words, std::size_t count) { fill_between(words, count); }
TASSILO_AVX2 void runs(PixelRun* to, const std::uint32_t* at, std::size_t count, const RowsOfBits& rows) {
  runs_between(to, at, count, rows);
}

}  // namespace

constinit const PlaneKernel avx2_plane_kernel{Kernel::avx2, join_or, join_and, triple_or, triple_and, nine_or,
                                              nine_and,     move,    changes,  fill,      runs};

}  // namespace tassilo

#endif
