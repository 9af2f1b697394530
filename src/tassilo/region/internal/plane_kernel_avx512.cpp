#if defined(__x86_64__)

#include <immintrin.h>

#include "tassilo/base/kernel_targets.h"
#include "tassilo/region/internal/plane_kernel.h"
#include "tassilo/region/internal/plane_loops.h"

namespace tassilo {
namespace {

TASSILO_PLANE_JOINS(TASSILO_AVX512)

/// Most words hold no change: those that do are moved together first, so that no branch asks for each.
TASSILO_AVX512 std::size_t changes(std::uint32_t* at, const std::uint64_t* b, std::size_t words) {
  constexpr std::size_t kBlock = 512;  // [words]
  alignas(64) std::uint64_t changed[kBlock + 8];
  alignas(64) std::uint32_t number[kBlock + 16];
  std::uint32_t* end = at;
  const __m256i eight = _mm256_set1_epi32(8);
  for (std::size_t block = 0; block < words; block += kBlock) {
    const std::size_t behind = words - block < kBlock ? words : block + kBlock;
    std::size_t count = 0;
    __m256i index =
        _mm256_add_epi32(_mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7), _mm256_set1_epi32(static_cast<int>(block)));
    for (std::size_t i = block; i < behind; i += 8) {
      const std::size_t rest = behind - i;
      const __mmask8 inside = rest >= 8 ? 0xff : static_cast<__mmask8>((1u << rest) - 1);
      const __m512i here = _mm512_maskz_loadu_epi64(inside, b + i), below = _mm512_maskz_loadu_epi64(inside, b + i - 1);
      const __m512i moved = _mm512_or_si512(_mm512_slli_epi64(here, 1), _mm512_srli_epi64(below, 63));
      const __m512i change = _mm512_xor_si512(here, moved);
      const __mmask8 some = _mm512_mask_test_epi64_mask(inside, change, change);
      _mm512_storeu_si512(changed + count, _mm512_maskz_compress_epi64(some, change));
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(number + count), _mm256_maskz_compress_epi32(some, index));
      count += static_cast<std::size_t>(__builtin_popcount(some));
      index = _mm256_add_epi32(index, eight);
    }
    for (std::size_t k = 0; k < count; ++k) {
      // Two are written whether there are or not, more are rare; the next word's write over what is too much.
      std::uint64_t word = changed[k];
      const std::uint32_t first = 64 * number[k];
      const int bits = __builtin_popcountll(word);
      end[0] = first + static_cast<std::uint32_t>(_tzcnt_u64(word));
      word &= word - 1;
      end[1] = first + static_cast<std::uint32_t>(_tzcnt_u64(word));
      if (bits > 2) [[unlikely]]
        write_bits(word & (word - 1), first, end + 2);
      end += bits;
    }
  }
  return static_cast<std::size_t>(end - at);
}

}  // namespace

constinit const PlaneKernel avx512_plane_kernel{join_or, join_and, triple_or, triple_and, move, changes};

}  // namespace tassilo

#endif
