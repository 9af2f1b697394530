#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tassilo/color/color_table.h"

namespace tassilo {

/// A color table as the kernels want it. Bit k of a claim stands for the class that is k-th in priority, so that the
/// lowest bit wins.
struct KernelTable {
  explicit KernelTable(const ColorTable& table);

  std::array<std::uint8_t, 256 * 256> chroma{};  ///< Claims of a cell: chroma[V * 256 + U].
  std::array<std::uint8_t, 256> bright{};        ///< Claims that Y allows.
  /// Label of the k-th class in priority; [8] is no_color. As long as a vector's table.
  std::array<std::uint8_t, 16> label_of_rank{};

  /// The chroma table once more, for machines that look 64 or 128 bytes up at once: for 128 rows V from `first_v` on,
  /// where along U the claims change. All steps up to a cell's U, xor-ed, are its claims; a row lies in one window at
  /// most.
  struct Step {
    alignas(64) std::array<std::uint8_t, 128> from{};  ///< First U behind the change, by V - first_v.
    alignas(
        64) std::array<std::uint8_t, 128> change{};  ///< Claims that come or go there; 0 where there is no such step.
  };
  struct Window {
    int first_v = 0;
    std::vector<Step> steps;
  };
  std::vector<Window> windows;
  /// So few steps that looking all of them up beats one memory access a chroma cell; else `windows` is empty.
  bool has_windows = false;

  /// Brightness and winners once more, for machines that look 16 bytes up at once. The Y of class k are one interval,
  /// which covers whole high halves of a byte in the middle and cuts the first and the last one.
  struct HalfBytes {
    /// By the high half: claims for which it is all inside, cut at its first, at its last, at both ends.
    std::array<std::uint8_t, 16> whole{}, first{}, last{}, both{};
    std::array<std::uint8_t, 16> from{}, to{};  ///< By the low half: claims whose interval has begun, is not over.
    std::array<std::uint8_t, 16> label_of_low{}, label_of_high{};  ///< Winner of the lower, of the upper four claims.
  };
  HalfBytes half_bytes;

  std::uint8_t label(std::uint8_t claims, std::uint8_t y) const { return winner[claims & bright[y]]; }
  std::array<std::uint8_t, 256> winner{};  ///< Label of a set of claims.
};

}  // namespace tassilo
