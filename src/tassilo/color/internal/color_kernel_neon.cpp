// NEON: 16 cells or pixels an instruction, tables of 64 bytes looked up at once.

#if defined(__aarch64__)

#include <arm_neon.h>

#include "tassilo/color/internal/color_kernel.h"
#define TASSILO_ROW_TARGET
#include "tassilo/color/internal/row_loops.h"

namespace tassilo {
namespace {

/// Of row_loops.h.
struct Bytes {
  using Vector = uint8x16_t;
  static constexpr int kSize = 16, kBitsPerByte = 4;

  static Vector zero() { return vdupq_n_u8(0); }
  static Vector load(const std::uint8_t* from) { return vld1q_u8(from); }
  static void store(std::uint8_t* to, Vector v) { vst1q_u8(to, v); }
  static Vector left_of(Vector before, Vector here) { return vextq_u8(before, here, 15); }
  static Vector right_of(Vector here, Vector after) { return vextq_u8(here, after, 1); }
  static Vector same(Vector a, Vector b, Vector c) { return vandq_u8(b, vandq_u8(vceqq_u8(a, b), vceqq_u8(c, b))); }
  static Vector any(Vector a, Vector b, Vector c) { return vorrq_u8(b, vorrq_u8(a, c)); }
  /// NEON has no mask of one bit a byte: a shift that narrows leaves four of them.
  static std::uint64_t changes(Vector a, Vector b) {
    const uint8x8_t narrow = vshrn_n_u16(vreinterpretq_u16_u8(vmvnq_u8(vceqq_u8(a, b))), 4);
    return vget_lane_u64(vreinterpret_u64_u8(narrow), 0) & 0x1111111111111111u;
  }
};

uint8x16x4_t table64(const std::uint8_t* from) { return vld1q_u8_x4(from); }

/// One of 128 bytes for each row; 0 for rows beyond them.
uint8x16_t look_up(const std::uint8_t* table, uint8x16_t row) {
  return vqtbx4q_u8(vqtbl4q_u8(table64(table), row), table64(table + 64), vsubq_u8(row, vdupq_n_u8(64)));
}

/// Claims of 16 cells. Rows outside a window change nothing: look-ups beyond the table are 0.
uint8x16_t claims_of_cells(const KernelTable& table, uint8x16_t u, uint8x16_t v) {
  uint8x16_t claims = vdupq_n_u8(0);
  for (const KernelTable::Window& window : table.windows) {
    const uint8x16_t row = vsubq_u8(v, vdupq_n_u8(static_cast<std::uint8_t>(window.first_v)));
    for (const KernelTable::Step& step : window.steps) {
      const uint8x16_t reached = vcgeq_u8(u, look_up(step.from.data(), row));
      claims = veorq_u8(claims, vandq_u8(reached, look_up(step.change.data(), row)));
    }
  }
  return claims;
}

void claims_of(const KernelTable& table, const YuvRow& row, int pairs, std::uint8_t* claims) {
  int k = 0;
  // Packed formats are read by whole groups of four bytes, beginning with whatever comes first.
  const bool y_first = row.y < row.u;
  for (; table.has_windows && k + 16 <= pairs; k += 16) {
    uint8x16_t u, v;
    if (row.chroma_step == 1) {
      u = vld1q_u8(row.u + k);
      v = vld1q_u8(row.v + k);
    } else {
      const bool u_first = row.u < row.v;
      const std::uint8_t* first = (u_first ? row.u : row.v) + k * row.chroma_step;
      uint8x16_t a, b;
      if (row.chroma_step == 2) {
        const uint8x16x2_t chroma = vld2q_u8(first);
        a = chroma.val[0];
        b = chroma.val[1];
      } else {
        const uint8x16x4_t group = vld4q_u8(y_first ? first - 1 : first);
        a = group.val[y_first ? 1 : 0];
        b = group.val[y_first ? 3 : 2];
      }
      u = u_first ? a : b;
      v = u_first ? b : a;
    }
    vst1q_u8(claims + k, claims_of_cells(table, u, v));
  }
  const YuvRow rest{row.y, row.u + k * row.chroma_step, row.v + k * row.chroma_step, row.y_step, row.chroma_step};
  plain_color_kernel.claims(table, rest, pairs - k, claims + k);
}

int labels_of(const KernelTable& table, const std::uint8_t* claims, const YuvRow& row, int width, std::uint8_t* labels,
              const RowRuns* runs) {
  const uint8x16x4_t bright[4] = {table64(table.bright.data()), table64(table.bright.data() + 64),
                                  table64(table.bright.data() + 128), table64(table.bright.data() + 192)};
  const uint8x16_t label_of_rank = vld1q_u8(table.label_of_rank.data());
  const auto label = [&](uint8x16_t cells, uint8x16_t y) {
    uint8x16_t allowed = vqtbl4q_u8(bright[0], y);
    allowed = vqtbx4q_u8(allowed, bright[1], vsubq_u8(y, vdupq_n_u8(64)));
    allowed = vqtbx4q_u8(allowed, bright[2], vsubq_u8(y, vdupq_n_u8(128)));
    allowed = vqtbx4q_u8(allowed, bright[3], vsubq_u8(y, vdupq_n_u8(192)));
    // Leading zeros of the reversed bits: the number of the lowest bit, 8 where there is none.
    return vqtbl1q_u8(label_of_rank, vclzq_u8(vrbitq_u8(vandq_u8(cells, allowed))));
  };
  int c = 0;
  for (; c + 32 <= width; c += 32) {
    const uint8x16_t pairs = vld1q_u8(claims + c / 2);
    uint8x16_t y0, y1;
    if (row.y_step == 1) {
      y0 = vld1q_u8(row.y + c);
      y1 = vld1q_u8(row.y + c + 16);
    } else {
      const bool y_first = row.y < row.u;
      const std::uint8_t* block = row.y + 2 * c - (y_first ? 0 : 1);
      y0 = vld2q_u8(block).val[y_first ? 0 : 1];
      y1 = vld2q_u8(block + 32).val[y_first ? 0 : 1];
    }
    vst1q_u8(labels + c, label(vzip1q_u8(pairs, pairs), y0));
    vst1q_u8(labels + c + 16, label(vzip2q_u8(pairs, pairs), y1));
  }
  const YuvRow rest{row.y + c * row.y_step, row.u, row.v, row.y_step, row.chroma_step};
  plain_color_kernel.labels(table, claims + c / 2, rest, width - c, labels + c, nullptr);
  return runs == nullptr ? 0 : runs_of<Bytes>(labels, width, *runs);
}

}  // namespace

constinit const ColorKernel neon_color_kernel{Kernel::neon, claims_of, labels_of, erode_rows<Bytes>,
                                              dilate_rows<Bytes>};

}  // namespace tassilo

#endif
