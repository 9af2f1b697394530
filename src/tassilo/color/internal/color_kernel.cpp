#include "tassilo/color/internal/color_kernel.h"

#include <cstddef>

namespace tassilo {
namespace {

void claims_of(const KernelTable& table, const YuvRow& row, int pairs, std::uint8_t* claims) {
  const std::uint8_t* chroma = table.chroma.data();
  for (int k = 0; k < pairs; ++k) claims[k] = chroma[row.v[k * row.chroma_step] * 256 + row.u[k * row.chroma_step]];
}

void labels_of(const KernelTable& table, const std::uint8_t* claims, const YuvRow& row, int width,
               std::uint8_t* labels) {
  for (int c = 0; c < width; ++c) labels[c] = table.label(claims[c / 2], row.y[c * row.y_step]);
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

void dilate_rows(const ThreeRows& rows, int width, std::uint8_t* labels) {
  const auto column = [&](int c) -> std::uint8_t { return rows.above[c] | rows.here[c] | rows.below[c]; };
  std::uint8_t before = 0, here = width > 0 ? column(0) : std::uint8_t{0};
  for (int c = 0; c < width; ++c) {
    const std::uint8_t after = c + 1 < width ? column(c + 1) : std::uint8_t{0};
    labels[c] = before | here | after;
    before = here;
    here = after;
  }
}

}  // namespace

constinit const ColorKernel plain_color_kernel{claims_of, labels_of, runs_of, erode_rows, dilate_rows};

const ColorKernel& color_kernel(Kernel kernel) {
  switch (kernel) {
#if defined(__x86_64__)
    case Kernel::avx512:
      return avx512_color_kernel;
    case Kernel::avx2:
      return avx2_color_kernel;
#elif defined(__aarch64__)
    case Kernel::neon:
      return neon_color_kernel;
#endif
    default:
      return plain_color_kernel;
  }
}

}  // namespace tassilo
