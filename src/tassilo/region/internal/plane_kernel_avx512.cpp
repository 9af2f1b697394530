#if defined(__x86_64__)

#include <immintrin.h>

#include "tassilo/base/kernel_targets.h"
#include "tassilo/region/internal/plane_kernel.h"
#include "tassilo/region/internal/plane_loops.h"

namespace tassilo {
namespace {

TASSILO_PLANE_JOINS(TASSILO_AVX512)

template <int kTruth>
TASSILO_AVX512 inline __m512i three_rows(const std::uint64_t* b, std::ptrdiff_t row) {
  return _mm512_ternarylogic_epi64(_mm512_loadu_si512(b), _mm512_loadu_si512(b + row), _mm512_loadu_si512(b + 2 * row),
                                   kTruth);
}
/// join_nine with each word's rows joined once; `kTruth` says how three bits are joined, as `Take` does.
template <class Take, int kTruth>
TASSILO_AVX512 inline void nine(std::uint64_t* to, const std::uint64_t* b, std::size_t words, std::size_t row_words,
                                int sign) {
  const auto end = static_cast<std::ptrdiff_t>(words & ~std::size_t{7});
  const auto row = -sign * static_cast<std::ptrdiff_t>(row_words);
  const auto one_word = [&](std::ptrdiff_t i) TASSILO_AVX512 {
    return _mm512_set1_epi64(static_cast<long long>(Take::join(b[i], Take::join(b[i + row], b[i + 2 * row]))));
  };
  if (sign > 0) {
    __m512i before = one_word(-1);
    for (std::ptrdiff_t i = 0; i < end; i += 8) {
      const __m512i here = three_rows<kTruth>(b + i, row), below = _mm512_alignr_epi64(here, before, 7);
      _mm512_storeu_si512(to + i, _mm512_ternarylogic_epi64(here, _mm512_shldi_epi64(here, below, 1),
                                                            _mm512_shldi_epi64(here, below, 2), kTruth));
      before = here;
    }
  } else {
    __m512i after = one_word(end);
    for (std::ptrdiff_t i = end - 8; i >= 0; i -= 8) {
      const __m512i here = three_rows<kTruth>(b + i, row), above = _mm512_alignr_epi64(after, here, 1);
      _mm512_storeu_si512(to + i, _mm512_ternarylogic_epi64(here, _mm512_shrdi_epi64(here, above, 1),
                                                            _mm512_shrdi_epi64(here, above, 2), kTruth));
      after = here;
    }
  }
  join_nine<Take>(to + end, b + end, words - static_cast<std::size_t>(end), row_words, sign);
}
TASSILO_AVX512 void nine_or(std::uint64_t* to, const std::uint64_t* b, std::size_t words, std::size_t row, int sign) {
  nine<TakeOr, 0xfe>(to, b, words, row, sign);
}
TASSILO_AVX512 void nine_and(std::uint64_t* to, const std::uint64_t* b, std::size_t words, std::size_t row, int sign) {
  nine<TakeAnd, 0x80>(to, b, words, row, sign);
}

/// Number of the lowest bit of each word; 64 where there is none.
TASSILO_AVX512 inline __m512i lowest_bits(__m512i words) {
  const __m512i below = _mm512_andnot_si512(words, _mm512_add_epi64(words, _mm512_set1_epi64(-1)));
  return _mm512_sad_epu8(_mm512_popcnt_epi8(below), _mm512_setzero_si512());
}
TASSILO_AVX512 inline __m512i without_lowest(__m512i words) {
  return _mm512_and_si512(words, _mm512_add_epi64(words, _mm512_set1_epi64(-1)));
}

/// Writes the numbers of all bits of 8 words, of which the k-th begins at bit 64 * number[k]; returns where the next
/// ones go. More is written than counts, up to 16 entries.
TASSILO_AVX512 inline std::uint32_t* write_bits_of_8(const std::uint64_t* of, const std::uint32_t* number,
                                                     std::uint32_t* to) {
  // Up to four a word at once: in each lane of 64 bits the first and the second, the third and the fourth.
  __m512i words = _mm512_loadu_si512(of);
  __m512i pairs[2];
  for (__m512i& pair : pairs) {
    pair = lowest_bits(words);
    words = without_lowest(words);
    pair = _mm512_or_si512(pair, _mm512_slli_epi64(lowest_bits(words), 32));
    words = without_lowest(words);
  }
  if (_mm512_test_epi64_mask(words, words) != 0) [[unlikely]] {
    for (int k = 0; k < 8; ++k) to = write_bits(of[k], 64 * number[k], to);
    return to;
  }
  const __m512i firsts =
      _mm512_castsi256_si512(_mm256_slli_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(number)), 6));
  for (int half = 0; half < 2; ++half) {
    const __m512i lanes = _mm512_add_epi64(_mm512_setr_epi64(0, 8, 1, 9, 2, 10, 3, 11), _mm512_set1_epi64(4 * half));
    const __m512i bits = _mm512_permutex2var_epi64(pairs[0], lanes, pairs[1]);
    const __m512i first =
        _mm512_permutexvar_epi32(_mm512_add_epi32(_mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3),
                                                  _mm512_set1_epi32(4 * half)),
                                 firsts);
    const __mmask16 there = _mm512_cmplt_epu32_mask(bits, _mm512_set1_epi32(64));
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(there, _mm512_add_epi32(first, bits)));
    to += __builtin_popcount(there);
  }
  return to;
}

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
    _mm512_storeu_si512(changed + count, _mm512_setzero_si512());
    for (std::size_t k = 0; k < count; k += 8) end = write_bits_of_8(changed + k, number + k, end);
  }
  return static_cast<std::size_t>(end - at);
}

TASSILO_AVX512 void fill(std::uint64_t* words, std::size_t count) {
  std::size_t i = 0;
  unsigned inside = 0;  // 255 or 0: all words as the bit before this block
  for (; i + 8 <= count; i += 8) {
    __m512i block = _mm512_loadu_si512(words + i);
    block = _mm512_xor_si512(block, _mm512_slli_epi64(block, 1));
    block = _mm512_xor_si512(block, _mm512_slli_epi64(block, 2));
    block = _mm512_xor_si512(block, _mm512_slli_epi64(block, 4));
    block = _mm512_xor_si512(block, _mm512_slli_epi64(block, 8));
    block = _mm512_xor_si512(block, _mm512_slli_epi64(block, 16));
    block = _mm512_xor_si512(block, _mm512_slli_epi64(block, 32));
    // The same over the words: which ones follow an odd number of changes.
    unsigned odd = _mm512_movepi64_mask(block);
    odd ^= odd << 1;
    odd ^= odd << 2;
    odd ^= odd << 4;
    const unsigned turned = (odd << 1 ^ inside) & 0xff;
    inside = ((odd >> 7 ^ inside) & 1) != 0 ? 0xff : 0;
    _mm512_storeu_si512(words + i, _mm512_xor_si512(block, _mm512_movm_epi64(static_cast<__mmask8>(turned))));
  }
  if (i == count) return;
  if (inside != 0) words[i] ^= 1;
  fill_between(words + i, count - i);
}

/// From columns and rows of 16 ends of runs, as two vectors of 16 bit in one, to row, begin, end of 8 runs.
struct alignas(64) RunOrder {
  std::uint16_t at[32]{};
  constexpr RunOrder() {
    for (unsigned k = 0; k < 8; ++k) {
      at[3 * k] = static_cast<std::uint16_t>(16 + 2 * k);
      at[3 * k + 1] = static_cast<std::uint16_t>(2 * k);
      at[3 * k + 2] = static_cast<std::uint16_t>(2 * k + 1);
    }
  }
};
constexpr RunOrder kRunOrder;

TASSILO_AVX512 void runs(PixelRun* to, const std::uint32_t* at, std::size_t count, const RowsOfBits& rows) {
  static_assert(sizeof(PixelRun) == 6);
  std::size_t k = 0;
  const std::size_t last_row = count == 0 ? 0 : at[count - 1] / static_cast<std::uint32_t>(rows.row_bits);
  const bool fits = rows.left >= INT16_MIN && rows.left + rows.row_bits <= INT16_MAX && rows.top >= INT16_MIN &&
                    rows.top + static_cast<int>(last_row) <= INT16_MAX;
  if (fits) {
    const __m512 half = _mm512_set1_ps(0.5f), rows_per_bit = _mm512_set1_ps(1 / static_cast<float>(rows.row_bits));
    const __m512i row_bits = _mm512_set1_epi32(rows.row_bits);
    const __m512i left = _mm512_set1_epi32(rows.left), top = _mm512_set1_epi32(rows.top);
    const __m512i order = _mm512_load_si512(kRunOrder.at);
    for (; k + 16 <= count; k += 16) {
      const __m512i number = _mm512_loadu_si512(at + k);
      const __m512 middle = _mm512_add_ps(_mm512_cvtepi32_ps(number), half);
      const __m512i row = _mm512_cvttps_epi32(_mm512_mul_ps(middle, rows_per_bit));
      const __m512i column = _mm512_add_epi32(left, _mm512_sub_epi32(number, _mm512_mullo_epi32(row, row_bits)));
      const __m256i columns = _mm512_cvtepi32_epi16(column);
      const __m256i of_rows = _mm512_cvtepi32_epi16(_mm512_add_epi32(top, row));
      const __m512i both = _mm512_inserti64x4(_mm512_castsi256_si512(columns), of_rows, 1);
      // 48 of 64 bytes count, the next ones write over the others.
      _mm512_storeu_si512(to + k / 2, _mm512_permutexvar_epi16(order, both));
    }
  }
  runs_between(to + k / 2, at + k, count - k, rows);
}

}  // namespace

constinit const PlaneKernel avx512_plane_kernel{Kernel::avx512, join_or, join_and, triple_or, triple_and, nine_or,
                                                nine_and,       move,    changes,  fill,      runs};

}  // namespace tassilo

#endif
