#include "tassilo/region/internal/plane_kernel.h"

#include <array>

#include "tassilo/region/internal/plane_loops.h"

namespace tassilo {

namespace {

TASSILO_PLANE_JOINS()
TASSILO_PLANE_NINES()

std::size_t changes(std::uint32_t* at, const std::uint64_t* b, std::size_t words) { return find_changes(at, b, words); }
void fill(std::uint64_t* words, std::size_t count) { fill_between(words, count); }
void runs(PixelRun* to, const std::uint32_t* at, std::size_t count, const RowsOfBits& rows) {
  runs_between(to, at, count, rows);
}

}  // namespace

constinit const PlaneKernel plain_plane_kernel{Kernel::plain, join_or, join_and, triple_or, triple_and, nine_or,
                                               nine_and,      move,    changes,  fill,      runs};

std::span<const PlaneKernel> plane_kernels() {
#if defined(__x86_64__)
  static const std::array kernels{plain_plane_kernel, avx2_plane_kernel, avx512_plane_kernel};
#else
  static const std::array kernels{plain_plane_kernel};
#endif
  return kernels;
}

}  // namespace tassilo
