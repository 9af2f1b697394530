#include "tassilo/color/internal/color_kernel.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace tassilo {
namespace {

template <int kStep>
void claims_with_step(const std::uint8_t* __restrict chroma, const std::uint8_t* __restrict u,
                      const std::uint8_t* __restrict v, int pairs, std::uint8_t* __restrict claims) {
  int k = 0;
  // Four at a time: one store instead of four.
  for (; k + 4 <= pairs; k += 4) {
    const auto at = [&](int i) -> std::uint32_t { return chroma[v[(k + i) * kStep] << 8 | u[(k + i) * kStep]]; };
    const std::uint32_t four = at(0) | at(1) << 8 | at(2) << 16 | at(3) << 24;
    std::memcpy(claims + k, &four, sizeof four);
  }
  for (; k < pairs; ++k) claims[k] = chroma[v[k * kStep] << 8 | u[k * kStep]];
}

void claims_of(const KernelTable& table, const YuvRow& row, int pairs, std::uint8_t* claims) {
  static_assert(std::endian::native == std::endian::little);
  const auto with_step = row.chroma_step == 1   ? claims_with_step<1>
                         : row.chroma_step == 2 ? claims_with_step<2>
                                                : claims_with_step<4>;
  with_step(table.chroma.data(), row.u, row.v, pairs, claims);
}

int runs_of(const std::uint8_t* labels, int width, const RowRuns& runs) {
  int count = 0;
  for (int c = 0; c < width;) {
    int end = c + 1;
    while (end < width && labels[end] == labels[c]) ++end;
    runs.begin[count] = static_cast<std::uint16_t>(c);
    runs.end[count] = static_cast<std::uint16_t>(end);
    runs.label[count] = labels[c];
    count += labels[c] != 0;
    c = end;
  }
  return count;
}

int labels_of(const KernelTable& table, const std::uint8_t* claims, const YuvRow& row, int width, std::uint8_t* labels,
              const RowRuns* runs) {
  for (int c = 0; c < width; ++c) labels[c] = table.label(claims[c / 2], row.y[c * row.y_step]);
  return runs == nullptr ? 0 : runs_of(labels, width, *runs);
}

std::uint8_t same(std::uint8_t a, std::uint8_t b, std::uint8_t c) { return a == b && c == b ? b : std::uint8_t{0}; }

void erode_rows(const ThreeRows& rows, int width, std::uint8_t* labels) {
  const auto column = [&](int c) { return same(rows.above[c], rows.here[c], rows.below[c]); };
  std::uint8_t before = 0, here = width > 0 ? column(0) : std::uint8_t{0};
  for (int c = 0; c < width; ++c) {
    const std::uint8_t after = c + 1 < width ? column(c + 1) : std::uint8_t{0};
    labels[c] = same(before, here, after);
    before = here;
    here = after;
  }
}

int dilate_rows(const ThreeRows& rows, int width, std::uint8_t* labels, const RowRuns& runs) {
  const auto column = [&](int c) -> std::uint8_t { return rows.above[c] | rows.here[c] | rows.below[c]; };
  std::uint8_t before = 0, here = width > 0 ? column(0) : std::uint8_t{0};
  for (int c = 0; c < width; ++c) {
    const std::uint8_t after = c + 1 < width ? column(c + 1) : std::uint8_t{0};
    labels[c] = before | here | after;
    before = here;
    here = after;
  }
  return runs_of(labels, width, runs);
}

}  // namespace

constinit const ColorKernel plain_color_kernel{Kernel::plain, claims_of, labels_of, erode_rows, dilate_rows};

std::span<const ColorKernel> color_kernels() {
#if defined(__x86_64__)
  static const std::array kernels{plain_color_kernel, avx2_color_kernel, avx512_color_kernel};
#elif defined(__aarch64__)
  static const std::array kernels{plain_color_kernel, neon_color_kernel};
#else
  static const std::array kernels{plain_color_kernel};
#endif
  return kernels;
}

}  // namespace tassilo
