// AVX-512 with VBMI: 64 cells or pixels an instruction. Only functions marked with TASSILO_AVX512 may hold such
// instructions: nothing that other sources share is compiled for this machine.

#if defined(__x86_64__)

#include <immintrin.h>

#include <array>
#include <cstddef>
#include <cstring>

#include "tassilo/base/kernel_targets.h"
#include "tassilo/color/internal/color_kernel.h"

namespace tassilo {
namespace {

TASSILO_AVX512 inline __m512i load(const std::uint8_t* from) { return _mm512_loadu_si512(from); }

/// The numbers first, first + step / divisor, ... as a table in memory, not one made at run time.
template <class Number>
struct alignas(64) Numbers {
  std::array<Number, 64 / sizeof(Number)> values{};
  constexpr Numbers(int first, int step, int divisor = 1) {
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = static_cast<Number>(first + static_cast<int>(i) * step / divisor);
  }
};
constexpr Numbers<std::uint8_t> kBytes(0, 1), kEven(0, 2), kOdd(1, 2), kHalf(0, 1, 2), kLeft(63, 1), kRight(1, 1);

template <class Number>
TASSILO_AVX512 inline __m512i load(const Numbers<Number>& numbers) {
  return _mm512_load_si512(numbers.values.data());
}

/// U and V of the 64 cells from k on.
struct Cells {
  __m512i u, v;
};
TASSILO_AVX512 inline Cells cells_at(const YuvRow& row, int k) {
  // NV12 has U V U V .., packed formats (Y) U (Y) V ..: first the chroma bytes, then U apart from V.
  const __m512i even = load(kEven), odd = load(kOdd);
  const bool u_first = row.u < row.v;
  const std::uint8_t* first = (u_first ? row.u : row.v) + k * row.chroma_step;
  __m512i a, b;
  if (row.chroma_step == 2) {
    a = load(first);
    b = load(first + 64);
  } else {
    // Begins at the pixel before a leading Y, so that no byte behind the row is read.
    const bool y_first = row.y < row.u;
    const std::uint8_t* block = y_first ? first - 1 : first;
    const __m512i chroma = y_first ? odd : even;
    a = _mm512_permutex2var_epi8(load(block), chroma, load(block + 64));
    b = _mm512_permutex2var_epi8(load(block + 128), chroma, load(block + 192));
  }
  return {_mm512_permutex2var_epi8(a, u_first ? even : odd, b), _mm512_permutex2var_epi8(a, u_first ? odd : even, b)};
}

/// Claims of N times 64 cells: a step's tables are loaded once for all. The steps of a row come by rising U: when no
/// cell has reached one, none reaches the next.
template <std::size_t N>
TASSILO_AVX512 inline void claims_of_cells(const KernelTable& table, const Cells (&cells)[N], std::uint8_t* claims) {
  __m512i found[N];
  for (std::size_t i = 0; i < N; ++i) found[i] = _mm512_setzero_si512();
  for (const KernelTable::Window& window : table.windows) {
    __m512i row[N];
    __mmask64 inside[N];
    __mmask64 any = 0;
    for (std::size_t i = 0; i < N; ++i) {
      row[i] = _mm512_sub_epi8(cells[i].v, _mm512_set1_epi8(static_cast<char>(window.first_v)));
      inside[i] = _mm512_cmplt_epu8_mask(row[i], _mm512_set1_epi8(static_cast<char>(128)));
      any |= inside[i];
    }
    if (any == 0) continue;
    for (const KernelTable::Step& step : window.steps) {
      const __m512i from_low = load(step.from.data()), from_high = load(step.from.data() + 64);
      __mmask64 reached[N];
      any = 0;
      for (std::size_t i = 0; i < N; ++i) {
        const __m512i from = _mm512_permutex2var_epi8(from_low, row[i], from_high);
        reached[i] = _mm512_mask_cmpge_epu8_mask(inside[i], cells[i].u, from);
        any |= reached[i];
      }
      if (any == 0) break;
      const __m512i change_low = load(step.change.data()), change_high = load(step.change.data() + 64);
      for (std::size_t i = 0; i < N; ++i) {
        const __m512i change = _mm512_maskz_permutex2var_epi8(reached[i], change_low, row[i], change_high);
        found[i] = _mm512_xor_si512(found[i], change);
      }
    }
  }
  for (std::size_t i = 0; i < N; ++i) _mm512_storeu_si512(claims + 64 * i, found[i]);
}

TASSILO_AVX512 void claims_of_planes(const KernelTable& table, const std::uint8_t* u, const std::uint8_t* v, int pairs,
                                     std::uint8_t* claims) {
  int k = 0;
  for (; k + 128 <= pairs; k += 128)
    claims_of_cells<2>(table, {{load(u + k), load(v + k)}, {load(u + k + 64), load(v + k + 64)}}, claims + k);
  for (; k + 64 <= pairs; k += 64) claims_of_cells<1>(table, {{load(u + k), load(v + k)}}, claims + k);
  if (k == pairs) return;
  const auto n = static_cast<unsigned>(pairs - k);
  const __mmask64 rest = _bzhi_u64(~0ull, n);
  alignas(64) std::array<std::uint8_t, 64> block;
  claims_of_cells<1>(table, {{_mm512_maskz_loadu_epi8(rest, u + k), _mm512_maskz_loadu_epi8(rest, v + k)}},
                     block.data());
  std::memcpy(claims + k, block.data(), n);
}

TASSILO_AVX512 void claims_of(const KernelTable& table, const YuvRow& row, int pairs, std::uint8_t* claims) {
  if (!table.has_windows) {
    plain_color_kernel.claims(table, row, pairs, claims);
    return;
  }
  if (row.chroma_step == 1) {
    claims_of_planes(table, row.u, row.v, pairs, claims);
    return;
  }
  int k = 0;
  for (; k + 128 <= pairs; k += 128) claims_of_cells<2>(table, {cells_at(row, k), cells_at(row, k + 64)}, claims + k);
  for (; k + 64 <= pairs; k += 64) claims_of_cells<1>(table, {cells_at(row, k)}, claims + k);
  if (k == pairs) return;
  const YuvRow rest{row.y, row.u + k * row.chroma_step, row.v + k * row.chroma_step, row.y_step, row.chroma_step};
  plain_color_kernel.claims(table, rest, pairs - k, claims + k);
}

/// The 256 bytes of a table.
struct Table256 {
  __m512i a, b, c, d;
};
TASSILO_AVX512 inline __m512i look_up(const Table256& table, __m512i at) {
  const __m512i low = _mm512_permutex2var_epi8(table.a, at, table.b);
  const __m512i high = _mm512_permutex2var_epi8(table.c, at, table.d);
  return _mm512_mask_blend_epi8(_mm512_movepi8_mask(at), low, high);
}

/// The lowest bit of the claims that brightness leaves, as a label.
TASSILO_AVX512 inline __m512i labels_of_pixels(const Table256& bright, __m512i label_of_rank, __m512i claims,
                                               __m512i y) {
  const __m512i left = _mm512_and_si512(claims, look_up(bright, y));
  const __m512i below = _mm512_andnot_si512(left, _mm512_sub_epi8(left, _mm512_set1_epi8(1)));
  return _mm512_permutexvar_epi8(_mm512_popcnt_epi8(below), label_of_rank);
}

/// Neighbors to the left and to the right of 64 pixels.
TASSILO_AVX512 inline __m512i left_of(__m512i before, __m512i here) {
  // Byte 63 of the block before, then bytes 0 .. 62.
  return _mm512_permutex2var_epi8(before, load(kLeft), here);
}
TASSILO_AVX512 inline __m512i right_of(__m512i here, __m512i after) {
  return _mm512_permutex2var_epi8(here, load(kRight), after);
}
/// Columns of the set bits to `to`, which has room for 64.
TASSILO_AVX512 inline void store_columns(__mmask64 bits, int c, std::uint16_t* to) {
  const __m512i columns = _mm512_maskz_compress_epi8(bits, load(kBytes));
  const __m512i first = _mm512_set1_epi16(static_cast<short>(c));
  const int count = __builtin_popcountll(bits);
  // Mostly a few: short stores seldom meet the end of a cache line.
  if (count <= 8) {
    const __m128i words =
        _mm_add_epi16(_mm_cvtepu8_epi16(_mm512_castsi512_si128(columns)), _mm512_castsi512_si128(first));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to), words);
    return;
  }
  _mm512_storeu_si512(to, _mm512_add_epi16(_mm512_cvtepu8_epi16(_mm512_castsi512_si256(columns)), first));
  if (count > 32)
    _mm512_storeu_si512(to + 32, _mm512_add_epi16(_mm512_cvtepu8_epi16(_mm512_extracti64x4_epi64(columns, 1)), first));
}

/// Writes the runs of a row, 64 pixels after 64. Like rows below, `runs` is a copy: a store of bytes might change
/// what is only referred to, so it would be looked up again after each.
struct RunWriter {
  RowRuns runs;
  int begins = 0, ends = 0;

  /// The pixels from c on; those behind the row are no_color. `before` is the block before them.
  TASSILO_AVX512 void add(int c, __m512i before, __m512i here) {
    const __m512i left = left_of(before, here);
    const __mmask64 changed = _mm512_cmpneq_epi8_mask(here, left);
    if (changed == 0) return;
    const __mmask64 begin = _mm512_mask_test_epi8_mask(changed, here, here);
    const __mmask64 end = _mm512_mask_test_epi8_mask(changed, left, left);
    const __m512i label = _mm512_maskz_compress_epi8(begin, here);
    store_columns(begin, c, runs.begin + begins);
    store_columns(end, c, runs.end + ends);
    const int count = __builtin_popcountll(begin);
    if (count <= 8)
      _mm_storel_epi64(reinterpret_cast<__m128i*>(runs.label + begins), _mm512_castsi512_si128(label));
    else
      _mm512_storeu_si512(runs.label + begins, label);
    begins += count;
    ends += __builtin_popcountll(end);
  }
  /// Returns how many there are.
  int finish(int width) const {
    if (ends < begins) runs.end[ends] = static_cast<std::uint16_t>(width);  // up to the border, which ends a block
    return begins;
  }
};

template <class Use>
TASSILO_AVX512 inline void for_labels(const KernelTable& table, const std::uint8_t* claims, const YuvRow& row,
                                      int width, std::uint8_t* labels, Use use) {
  // One by one: the caller has just written them one by one, so that reading all at once would wait for the stores. And
  // not through the reference, which would be looked up again after every store of bytes.
  const std::uint8_t *const y_of_row = row.y, *const u_of_row = row.u;
  const int y_step = row.y_step;
  const std::uint8_t* of_y = table.bright.data();
  const Table256 bright{load(of_y), load(of_y + 64), load(of_y + 128), load(of_y + 192)};
  const __m512i label_of_rank =
      _mm512_broadcast_i32x4(_mm_loadu_si128(reinterpret_cast<const __m128i*>(table.label_of_rank.data())));
  const __m512i half = load(kHalf), even = load(kEven), odd = load(kOdd);
  __m512i before = _mm512_setzero_si512();
  int c = 0;
  for (; c + 64 <= width; c += 64) {
    const __m512i pairs = _mm512_castsi256_si512(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(claims + c / 2)));
    __m512i y;
    if (y_step == 1) {
      y = load(y_of_row + c);
    } else if (y_of_row < u_of_row) {
      y = _mm512_permutex2var_epi8(load(y_of_row + 2 * c), even, load(y_of_row + 2 * c + 64));
    } else {
      // U Y V Y: begins one byte before Y, so that no byte behind the row is read.
      y = _mm512_permutex2var_epi8(load(y_of_row + 2 * c - 1), odd, load(y_of_row + 2 * c + 63));
    }
    const __m512i here = labels_of_pixels(bright, label_of_rank, _mm512_permutexvar_epi8(half, pairs), y);
    _mm512_storeu_si512(labels + c, here);
    use(c, before, here);
    before = here;
  }
  if (c < width) {
    alignas(64) std::array<std::uint8_t, 64> rest{};
    for (int k = c; k < width; ++k)
      rest[static_cast<std::size_t>(k - c)] = table.label(claims[k / 2], y_of_row[k * y_step]);
    std::memcpy(labels + c, rest.data(), static_cast<std::size_t>(width - c));
    use(c, before, load(rest.data()));
  }
}

TASSILO_AVX512 int labels_of(const KernelTable& table, const std::uint8_t* claims, const YuvRow& row, int width,
                             std::uint8_t* labels, const RowRuns* runs) {
  if (runs == nullptr) {
    for_labels(table, claims, row, width, labels, [](int, __m512i, __m512i) TASSILO_AVX512 {});
    return 0;
  }
  RunWriter writer{*runs};
  for_labels(table, claims, row, width, labels,
             [&](int c, __m512i before, __m512i here) TASSILO_AVX512 { writer.add(c, before, here); });
  return writer.finish(width);
}

TASSILO_AVX512 inline __m512i same(__m512i a, __m512i b, __m512i c) {
  return _mm512_maskz_mov_epi8(_mm512_mask_cmpeq_epu8_mask(_mm512_cmpeq_epu8_mask(a, b), c, b), b);
}
constexpr int kOr3 = 0xfe;

/// Three rows of 64 pixels as one: what all three share, or what any has.
struct Erode {
  TASSILO_AVX512 static __m512i join(__m512i a, __m512i b, __m512i c) { return same(a, b, c); }
};
struct Dilate {
  TASSILO_AVX512 static __m512i join(__m512i a, __m512i b, __m512i c) {
    return _mm512_ternarylogic_epi64(a, b, c, kOr3);
  }
};

/// A vector of the first `width - c` pixels of three rows, no_color behind them.
template <class Operation>
TASSILO_AVX512 inline __m512i column(ThreeRows rows, int width, int c) {
  if (c + 64 <= width) return Operation::join(load(rows.above + c), load(rows.here + c), load(rows.below + c));
  if (c >= width) return _mm512_setzero_si512();
  const __mmask64 inside = _bzhi_u64(~0ull, static_cast<unsigned>(width - c));
  return Operation::join(_mm512_maskz_loadu_epi8(inside, rows.above + c),
                         _mm512_maskz_loadu_epi8(inside, rows.here + c),
                         _mm512_maskz_loadu_epi8(inside, rows.below + c));
}

template <class Operation, class Use>
TASSILO_AVX512 inline void over_nine(ThreeRows rows, int width, std::uint8_t* labels, Use use) {
  __m512i before = _mm512_setzero_si512(), here = column<Operation>(rows, width, 0), out_before = before;
  for (int c = 0; c < width; c += 64) {
    const __m512i after = column<Operation>(rows, width, c + 64);
    __m512i out = Operation::join(left_of(before, here), here, right_of(here, after));
    // Stores with a mask of bytes are slow on some machines: only at the end of a row.
    if (c + 64 <= width) {
      _mm512_storeu_si512(labels + c, out);
    } else {
      const __mmask64 inside = _bzhi_u64(~0ull, static_cast<unsigned>(width - c));
      out = _mm512_maskz_mov_epi8(inside, out);
      _mm512_mask_storeu_epi8(labels + c, inside, out);
    }
    use(c, out_before, out);
    before = here;
    here = after;
    out_before = out;
  }
}

TASSILO_AVX512 void erode_rows(const ThreeRows& rows, int width, std::uint8_t* labels) {
  over_nine<Erode>(rows, width, labels, [](int, __m512i, __m512i) TASSILO_AVX512 {});
}

TASSILO_AVX512 int dilate_rows(const ThreeRows& rows, int width, std::uint8_t* labels, const RowRuns& runs) {
  RunWriter writer{runs};
  over_nine<Dilate>(rows, width, labels,
                    [&](int c, __m512i before, __m512i here) TASSILO_AVX512 { writer.add(c, before, here); });
  return writer.finish(width);
}

}  // namespace

constinit const ColorKernel avx512_color_kernel{Kernel::avx512, claims_of, labels_of, erode_rows, dilate_rows};

}  // namespace tassilo

#endif
