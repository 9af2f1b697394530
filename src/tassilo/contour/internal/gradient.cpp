#include "tassilo/contour/internal/gradient.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <type_traits>

#include "tassilo/base/kernel_targets.h"

namespace tassilo {
namespace {

/// Room left and right of a block, so that rows of columns stay whole vectors.
constexpr int kMargin = 4;
constexpr int kColumns = kBlock + 2 * kMargin;
static_assert(kMargin >= kMaxReach);

/// A block and its margins after the pass down the columns.
struct ColumnSums {
  std::array<std::int16_t, kColumns> smooth, slope;
};

/// (1 1)^(2 reach) by distance from the centre, and the derivative's part to the right of it.
template <int kReach>
constexpr std::array<int, kReach + 1> kSmooth{};
template <>
constexpr std::array<int, 2> kSmooth<1>{2, 1};
template <>
constexpr std::array<int, 3> kSmooth<2>{6, 4, 1};
template <>
constexpr std::array<int, 4> kSmooth<3>{20, 15, 6, 1};
template <int kReach>
constexpr std::array<int, kReach + 1> kSlope{};
template <>
constexpr std::array<int, 2> kSlope<1>{0, 1};
template <>
constexpr std::array<int, 3> kSlope<2>{0, 2, 1};
template <>
constexpr std::array<int, 4> kSlope<3>{0, 5, 4, 1};

/// Column sums of the kColumns columns from `first`; bytes are kStep apart.
template <int kReach, int kStep>
[[gnu::always_inline]] inline void sum_columns(const std::array<const std::uint8_t*, 2 * kMaxReach + 1>& rows,
                                               std::ptrdiff_t first, ColumnSums& __restrict to) {
  std::array<const std::uint8_t*, 2 * kReach + 1> from;
  for (std::size_t k = 0; k < from.size(); ++k) from[k] = rows[k] + first * kStep;
  for (int c = 0; c < kColumns; ++c) {
    int smooth = kSmooth<kReach>[0] * from[kReach][c * kStep], slope = 0;
    for (std::size_t k = 1; k <= kReach; ++k) {
      const int below = from[kReach + k][c * kStep], above = from[kReach - k][c * kStep];
      smooth += kSmooth<kReach>[k] * (below + above);
      slope += kSlope<kReach>[k] * (below - above);
    }
    to.smooth[static_cast<std::size_t>(c)] = static_cast<std::int16_t>(smooth);
    to.slope[static_cast<std::size_t>(c)] = static_cast<std::int16_t>(slope);
  }
}

template <int kReach>
[[gnu::always_inline]] inline void sum_columns(const BrightnessRows& rows, int column, ColumnSums& to) {
  const int first = column - kMargin;
  if (first >= 0 && first + kColumns <= rows.width) {
    if (rows.step == 1) return sum_columns<kReach, 1>(rows.row, first, to);
    return sum_columns<kReach, 2>(rows.row, first, to);
  }
  // At the border: bytes that are missing are the border's.
  std::array<std::array<std::uint8_t, kColumns>, 2 * kReach + 1> bytes;
  BrightnessRows padded;
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    for (int c = 0; c < kColumns; ++c)
      bytes[k][static_cast<std::size_t>(c)] = rows.row[k][std::clamp(first + c, 0, rows.width - 1) * rows.step];
    padded.row[k] = bytes[k].data();
  }
  sum_columns<kReach, 1>(padded.row, 0, to);
}

template <int kReach>
[[gnu::always_inline]] inline void gradients_of_block(const ColumnSums& sums, int column, const GradientRow& to) {
  // Only the largest filter's sums leave 16 bit, and lose three of their bits.
  using Sum = std::conditional_t<(kReach < 3), std::int16_t, std::int32_t>;
  constexpr int kShift = kReach < 3 ? 0 : 3;
  const std::int16_t *smooth = sums.smooth.data() + kMargin, *slope = sums.slope.data() + kMargin;
  std::int16_t* __restrict x = to.x + column, * __restrict y = to.y + column;
  std::int32_t* __restrict squared = to.squared + column;
  for (int c = 0; c < kBlock; ++c) {
    Sum gx = 0, gy = static_cast<Sum>(kSmooth<kReach>[0] * slope[c]);
    for (int k = 1; k <= kReach; ++k) {
      const auto tap = static_cast<std::size_t>(k);
      gx = static_cast<Sum>(gx + kSlope<kReach>[tap] * (smooth[c + k] - smooth[c - k]));
      gy = static_cast<Sum>(gy + kSmooth<kReach>[tap] * (slope[c + k] + slope[c - k]));
    }
    x[c] = static_cast<std::int16_t>(gx >> kShift);
    y[c] = static_cast<std::int16_t>(gy >> kShift);
  }
  for (int c = 0; c < kBlock; ++c) squared[c] = x[c] * x[c] + y[c] * y[c];
}

template <int kReach>
[[gnu::always_inline]] inline void gradients_of_row(const BrightnessRows& rows, std::span<const int> columns,
                                                    const GradientRow& to) {
  // Two passes over a few blocks each: what is written in narrow pieces is long in memory when it is read in wide ones.
  constexpr std::size_t kGroup = 8;
  std::array<ColumnSums, kGroup> sums;
  for (std::size_t first = 0; first < columns.size(); first += kGroup) {
    const auto group = columns.subspan(first, std::min(kGroup, columns.size() - first));
    for (std::size_t i = 0; i < group.size(); ++i) sum_columns<kReach>(rows, group[i], sums[i]);
    for (std::size_t i = 0; i < group.size(); ++i) gradients_of_block<kReach>(sums[i], group[i], to);
  }
}

[[gnu::always_inline]] inline void gradients(const BrightnessRows& rows, int reach, std::span<const int> columns,
                                             const GradientRow& to) {
  if (reach == 1) return gradients_of_row<1>(rows, columns, to);
  if (reach == 2) return gradients_of_row<2>(rows, columns, to);
  gradients_of_row<3>(rows, columns, to);
}

/// Bit k of the result is the lowest bit of flags[k].
[[gnu::always_inline]] inline std::uint32_t packed(const std::array<std::uint8_t, kBlock>& flags) {
  static_assert(std::endian::native == std::endian::little);
  std::uint32_t bits = 0;
  for (std::size_t k = 0; k < kBlock; k += 8) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, flags.data() + k, 8);
    bits |= static_cast<std::uint32_t>(eight * 0x0102040810204080u >> 56) << k;
  }
  return bits;
}

[[gnu::always_inline]] inline void peaks(const std::array<GradientRow, 3>& rows, std::int32_t least,
                                         std::span<const int> columns, std::span<std::uint32_t> peaks) {
  std::array<std::uint8_t, kBlock> flags;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::int16_t *x = rows[1].x + columns[i], *y = rows[1].y + columns[i];
    const std::int32_t *above = rows[0].squared + columns[i], *here = rows[1].squared + columns[i],
                       *below = rows[2].squared + columns[i];
    for (int c = 0; c < kBlock; ++c) {
      const bool steeper_down = std::abs(y[c]) > std::abs(x[c]);
      const std::int32_t before = steeper_down ? above[c] : here[c - 1], after = steeper_down ? below[c] : here[c + 1];
      flags[static_cast<std::size_t>(c)] = (here[c] >= least) & (here[c] > before) & (here[c] >= after);
    }
    peaks[i] = packed(flags);
  }
}

void gradients_plain(const BrightnessRows& rows, int reach, std::span<const int> columns, const GradientRow& to) {
  gradients(rows, reach, columns, to);
}
void peaks_plain(const std::array<GradientRow, 3>& rows, std::int32_t least, std::span<const int> columns,
                 std::span<std::uint32_t> to) {
  peaks(rows, least, columns, to);
}
#if defined(__x86_64__)

// The same words, compiled for wider registers.
TASSILO_AVX2 void gradients_avx2(const BrightnessRows& rows, int reach, std::span<const int> columns,
                                 const GradientRow& to) {
  gradients(rows, reach, columns, to);
}
TASSILO_AVX2 void peaks_avx2(const std::array<GradientRow, 3>& rows, std::int32_t least, std::span<const int> columns,
                             std::span<std::uint32_t> to) {
  peaks(rows, least, columns, to);
}

TASSILO_AVX512 void gradients_avx512(const BrightnessRows& rows, int reach, std::span<const int> columns,
                                     const GradientRow& to) {
  gradients(rows, reach, columns, to);
}
TASSILO_AVX512 void peaks_avx512(const std::array<GradientRow, 3>& rows, std::int32_t least,
                                 std::span<const int> columns, std::span<std::uint32_t> to) {
  peaks(rows, least, columns, to);
}

constexpr std::array<GradientKernel, 3> kKernels{{{Kernel::plain, gradients_plain, peaks_plain},
                                                  {Kernel::avx2, gradients_avx2, peaks_avx2},
                                                  {Kernel::avx512, gradients_avx512, peaks_avx512}}};

#else

constexpr std::array<GradientKernel, 1> kKernels{{{Kernel::plain, gradients_plain, peaks_plain}}};

#endif

}  // namespace

std::span<const GradientKernel> gradient_kernels() { return kKernels; }

}  // namespace tassilo
