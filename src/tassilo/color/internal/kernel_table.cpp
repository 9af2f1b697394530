#include "tassilo/color/internal/kernel_table.h"

#include <algorithm>
#include <cstddef>

namespace tassilo {
namespace {

/// A step costs four vector instructions for 64 cells, a memory access for each of them at least 64 cycles. Own,
/// measured.
constexpr std::size_t kMostSteps = 40;
constexpr int kWindowRows = 128;

std::vector<KernelTable::Window> windows_of(const KernelTable& table) {
  std::vector<KernelTable::Window> windows;
  std::size_t steps = 0;
  for (int v = 0; v < 256; ++v) {
    const auto* row = table.chroma.data() + 256 * static_cast<std::ptrdiff_t>(v);
    std::uint8_t before = 0;
    std::size_t k = 0;
    for (int u = 0; u < 256; ++u) {
      if (row[u] == before) continue;
      if (windows.empty() || v >= windows.back().first_v + kWindowRows) windows.push_back({v, {}});
      KernelTable::Window& window = windows.back();
      if (k == window.steps.size()) {
        if (++steps > kMostSteps) return {};
        window.steps.emplace_back();
        window.steps.back().from.fill(255);  // rows without this step: hardly ever reached, and nothing changes there
      }
      const auto i = static_cast<std::size_t>(v - window.first_v);
      window.steps[k].from[i] = static_cast<std::uint8_t>(u);
      window.steps[k].change[i] = row[u] ^ before;
      before = row[u];
      ++k;
    }
  }
  return windows;
}

KernelTable::HalfBytes half_bytes_of(const KernelTable& table, const ColorTable& colors) {
  KernelTable::HalfBytes halves;
  for (std::size_t rank = 0; rank < colors.priority.size(); ++rank) {
    BrightnessInterval y = colors.brightness[static_cast<std::size_t>(class_index(colors.priority[rank]))];
    y = {std::max(y.low, 0), std::min(y.high, 255)};
    if (y.low > y.high) continue;
    const auto bit = static_cast<std::uint8_t>(1u << rank);
    for (int half = 0; half < 16; ++half) {
      const auto h = static_cast<std::size_t>(half);
      if (half >= (y.low & 15)) halves.from[h] |= bit;
      if (half <= (y.high & 15)) halves.to[h] |= bit;
      if (half < y.low >> 4 || half > y.high >> 4) continue;
      const bool is_first = half == y.low >> 4, is_last = half == y.high >> 4;
      auto& of = is_first && is_last ? halves.both : is_first ? halves.first : is_last ? halves.last : halves.whole;
      of[h] |= bit;
    }
  }
  for (std::size_t bits = 0; bits < 16; ++bits) {
    halves.label_of_low[bits] = table.winner[bits];
    halves.label_of_high[bits] = table.winner[bits << 4];
  }
  return halves;
}

}  // namespace

KernelTable::KernelTable(const ColorTable& table) {
  std::array<std::uint8_t, 256> ranked{};  // a set of classes as claims
  for (std::size_t rank = 0; rank < table.priority.size(); ++rank) {
    const ColorClass color = table.priority[rank];
    const auto bit = static_cast<std::uint8_t>(1u << rank);
    label_of_rank[rank] = static_cast<std::uint8_t>(color);
    for (std::size_t bits = 0; bits < 256; ++bits)
      if ((bits & class_bit(color)) != 0) ranked[bits] |= bit;
    for (int y = 0; y < 256; ++y)
      if (table.brightness[static_cast<std::size_t>(class_index(color))].contains(y))
        bright[static_cast<std::size_t>(y)] |= bit;
  }
  for (std::size_t cell = 0; cell < chroma.size(); ++cell) chroma[cell] = ranked[table.chroma[cell]];
  for (std::size_t claims = 1; claims < 256; ++claims) {
    std::size_t rank = 0;
    while ((claims >> rank & 1) == 0) ++rank;
    winner[claims] = label_of_rank[rank];
  }
  half_bytes = half_bytes_of(*this, table);
  windows = windows_of(*this);
  has_windows = !windows.empty();
}

}  // namespace tassilo
