// AVX2: one memory access a chroma cell, all else 32 pixels an instruction. Only functions marked with TASSILO_AVX2 may
// hold such instructions: nothing that other sources share is compiled for this machine.

#if defined(__x86_64__)

#include <immintrin.h>

#include <array>

#include "tassilo/base/kernel_targets.h"
#include "tassilo/color/internal/color_kernel.h"
#define TASSILO_ROW_TARGET TASSILO_AVX2
#include "tassilo/color/internal/row_loops.h"

namespace tassilo {
namespace {

/// Of row_loops.h.
struct Bytes {
  using Vector = __m256i;
  static constexpr int kSize = 32, kBitsPerByte = 1;

  TASSILO_AVX2 static Vector zero() { return _mm256_setzero_si256(); }
  TASSILO_AVX2 static Vector load(const std::uint8_t* from) {
    return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
  }
  TASSILO_AVX2 static void store(std::uint8_t* to, Vector v) { _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), v); }
  TASSILO_AVX2 static Vector left_of(Vector before, Vector here) {
    return _mm256_alignr_epi8(here, _mm256_permute2x128_si256(before, here, 0x21), 15);
  }
  TASSILO_AVX2 static Vector right_of(Vector here, Vector after) {
    return _mm256_alignr_epi8(_mm256_permute2x128_si256(here, after, 0x21), here, 1);
  }
  TASSILO_AVX2 static Vector same(Vector a, Vector b, Vector c) {
    return _mm256_and_si256(b, _mm256_and_si256(_mm256_cmpeq_epi8(a, b), _mm256_cmpeq_epi8(c, b)));
  }
  TASSILO_AVX2 static Vector any(Vector a, Vector b, Vector c) { return _mm256_or_si256(b, _mm256_or_si256(a, c)); }
  TASSILO_AVX2 static std::uint32_t changes(Vector a, Vector b) {
    return ~static_cast<std::uint32_t>(_mm256_movemask_epi8(_mm256_cmpeq_epi8(a, b)));
  }
};

TASSILO_AVX2 inline __m256i twice(const std::array<std::uint8_t, 16>& table) {
  return _mm256_broadcastsi128_si256(_mm_loadu_si128(reinterpret_cast<const __m128i*>(table.data())));
}

/// Sixteen table look-ups by 16-bit numbers: each cell is a memory access, for AVX2 has no table of 64 bytes and its
/// gather is no faster.
TASSILO_AVX2 inline __m128i look_up_16(const std::uint8_t* table, __m128i first_eight, __m128i last_eight) {
  alignas(16) std::array<std::uint16_t, 16> at;
  _mm_store_si128(reinterpret_cast<__m128i*>(at.data()), first_eight);
  _mm_store_si128(reinterpret_cast<__m128i*>(at.data() + 8), last_eight);
  // Two chains of insertions do not wait for each other.
  __m128i even = _mm_setzero_si128(), odd = even;
#define TASSILO_INSERT(k)                        \
  even = _mm_insert_epi8(even, table[at[k]], k); \
  odd = _mm_insert_epi8(odd, table[at[(k) + 1]], (k) + 1);
  TASSILO_INSERT(0)
  TASSILO_INSERT(2)
  TASSILO_INSERT(4)
  TASSILO_INSERT(6)
  TASSILO_INSERT(8)
  TASSILO_INSERT(10)
  TASSILO_INSERT(12)
  TASSILO_INSERT(14)
#undef TASSILO_INSERT
  return _mm_or_si128(even, odd);
}

TASSILO_AVX2 void claims_of(const KernelTable& table, const YuvRow& row, int pairs, std::uint8_t* claims) {
  const std::uint8_t* chroma = table.chroma.data();
  const auto load16 = [](const std::uint8_t* from)
                          TASSILO_AVX2 { return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from)); };
  int k = 0;
  if (row.chroma_step == 1) {
    for (; k + 16 <= pairs; k += 16) {
      const __m128i u = load16(row.u + k), v = load16(row.v + k);
      const __m128i found = look_up_16(chroma, _mm_unpacklo_epi8(u, v), _mm_unpackhi_epi8(u, v));
      _mm_storeu_si128(reinterpret_cast<__m128i*>(claims + k), found);
    }
  } else if (row.chroma_step == 2 && row.u + 1 == row.v) {
    for (; k + 16 <= pairs; k += 16) {
      const __m128i found = look_up_16(chroma, load16(row.u + 2 * k), load16(row.u + 2 * k + 16));
      _mm_storeu_si128(reinterpret_cast<__m128i*>(claims + k), found);
    }
  }
  const YuvRow rest{row.y, row.u + k * row.chroma_step, row.v + k * row.chroma_step, row.y_step, row.chroma_step};
  plain_color_kernel.claims(table, rest, pairs - k, claims + k);
}

TASSILO_AVX2 int labels_of(const KernelTable& table, const std::uint8_t* claims, const YuvRow& of_row, int width,
                           std::uint8_t* labels, const RowRuns* runs) {
  const YuvRow row = of_row;  // not to be looked up again after every store of bytes, which might change it
  const KernelTable::HalfBytes& halves = table.half_bytes;
  const __m256i whole = twice(halves.whole), first = twice(halves.first), last = twice(halves.last),
                both = twice(halves.both), from = twice(halves.from), to = twice(halves.to);
  const __m256i label_low = twice(halves.label_of_low), label_high = twice(halves.label_of_high);
  const __m256i half_mask = _mm256_set1_epi8(15), zero = Bytes::zero();
  int c = 0;
  for (; c + 32 <= width; c += 32) {
    __m256i y;
    if (row.y_step == 1) {
      y = Bytes::load(row.y + c);
    } else {
      // Even bytes from where Y comes first, odd ones where it comes second; no byte behind the row is read.
      const bool y_first = row.y < row.u;
      const std::uint8_t* block = row.y + 2 * c - (y_first ? 0 : 1);
      const __m256i low_bytes = _mm256_set1_epi16(255);
      __m256i a = Bytes::load(block), b = Bytes::load(block + 32);
      a = y_first ? _mm256_and_si256(a, low_bytes) : _mm256_srli_epi16(a, 8);
      b = y_first ? _mm256_and_si256(b, low_bytes) : _mm256_srli_epi16(b, 8);
      y = _mm256_permute4x64_epi64(_mm256_packus_epi16(a, b), 0xd8);
    }
    const __m128i pairs = _mm_loadu_si128(reinterpret_cast<const __m128i*>(claims + c / 2));
    const __m256i cells = _mm256_set_m128i(_mm_unpackhi_epi8(pairs, pairs), _mm_unpacklo_epi8(pairs, pairs));
    const __m256i low = _mm256_and_si256(y, half_mask);
    const __m256i high = _mm256_and_si256(_mm256_srli_epi16(y, 4), half_mask);
    const __m256i begun = _mm256_shuffle_epi8(from, low), not_over = _mm256_shuffle_epi8(to, low);
    const __m256i in_first = _mm256_and_si256(_mm256_shuffle_epi8(first, high), begun);
    const __m256i in_last = _mm256_and_si256(_mm256_shuffle_epi8(last, high), not_over);
    const __m256i in_both = _mm256_and_si256(_mm256_shuffle_epi8(both, high), _mm256_and_si256(begun, not_over));
    const __m256i bright =
        _mm256_or_si256(_mm256_or_si256(_mm256_shuffle_epi8(whole, high), in_first), _mm256_or_si256(in_last, in_both));
    const __m256i left = _mm256_and_si256(cells, bright);
    const __m256i lower = _mm256_and_si256(left, half_mask);
    const __m256i upper = _mm256_and_si256(_mm256_srli_epi16(left, 4), half_mask);
    const __m256i label = _mm256_blendv_epi8(_mm256_shuffle_epi8(label_low, lower),
                                             _mm256_shuffle_epi8(label_high, upper), _mm256_cmpeq_epi8(lower, zero));
    Bytes::store(labels + c, label);
  }
  const YuvRow rest{row.y + c * row.y_step, row.u, row.v, row.y_step, row.chroma_step};
  plain_color_kernel.labels(table, claims + c / 2, rest, width - c, labels + c, nullptr);
  return runs == nullptr ? 0 : runs_of<Bytes>(labels, width, *runs);
}

}  // namespace

constinit const ColorKernel avx2_color_kernel{Kernel::avx2, claims_of, labels_of, erode_rows<Bytes>,
                                              dilate_rows<Bytes>};

}  // namespace tassilo

#endif
