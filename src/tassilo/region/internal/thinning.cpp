#include "tassilo/region/internal/thinning.h"

#include <cstddef>

#include "tassilo/base/kernel_targets.h"

namespace tassilo {
namespace {

/// 64 pixels of a row with what is left and right of each.
struct Neighbors {
  TileRow west, here, east;
};

[[gnu::always_inline]] inline Neighbors neighbors(TileRow left, TileRow here, TileRow right) {
  return {here << 1 | left >> 63, here, here >> 1 | right << 63};
}

/// Algorithm A1 for 64 pixels at once. In the words of the paper: C(p) = 1, 2 <= N(p) <= 3, and the step's condition.
template <ThinningStep kStep>
[[gnu::always_inline]] inline TileRow pixels_of_step(const Neighbors& up, const Neighbors& row, const Neighbors& down) {
  const TileRow nw = up.west, n = up.here, ne = up.east, w = row.west, e = row.east;
  const TileRow sw = down.west, s = down.here, se = down.east;
  // Pairs of neighbors, clockwise; even ones and odd ones each cover all eight.
  const TileRow nw_n = nw | n, ne_e = ne | e, se_s = se | s, sw_w = sw | w;
  const TileRow n_ne = n | ne, e_se = e | se, s_sw = s | sw, w_nw = w | nw;
  // How often the way around goes from background to foreground: exactly once.
  const TileRow c1 = ~n & ne_e, c2 = ~e & se_s, c3 = ~s & sw_w, c4 = ~w & nw_n;
  const TileRow one_of_three = c1 ^ c2 ^ c3, more_of_three = (c1 & c2) | (c3 & (c1 | c2));
  const TileRow once = (one_of_three ^ c4) & ~more_of_three;
  if constexpr (kStep == ThinningStep::square)
    return row.here & once & ((n & ((ne & e) | (nw & w))) | (s & ((se & e) | (sw & w))));
  // At least two pairs each way: no end of a line. Not all eight: something of the pixel is bare.
  const TileRow two_even = (nw_n & ne_e) | (se_s & (nw_n | ne_e)) | (sw_w & (nw_n | ne_e | se_s));
  const TileRow two_odd = (n_ne & e_se) | (s_sw & (n_ne | e_se)) | (w_nw & (n_ne | e_se | s_sw));
  const TileRow all = nw_n & ne_e & se_s & sw_w & n_ne & e_se & s_sw & w_nw;
  const TileRow other_side = kStep == ThinningStep::upper_right ? e & (n_ne | ~se) : w & (s_sw | ~nw);
  return row.here & once & two_even & two_odd & ~(all | other_side);
}

template <ThinningStep kStep>
[[gnu::always_inline]] inline void find_step(const ThinningTile* tiles, std::span<const std::int32_t> active,
                                             OwnRows* found) {
  for (std::size_t i = 0; i < active.size(); ++i) {
    const ThinningTile& tile = tiles[active[i]];
    const TileRow *here = tile.rows.data(), *left = tiles[tile.left].rows.data(),
                  *right = tiles[tile.right].rows.data();
    TileRow* __restrict to = found[i].data();
    for (int k = 0; k < kTileHeight; ++k)
      to[k] = pixels_of_step<kStep>(neighbors(left[k], here[k], right[k]),
                                    neighbors(left[k + 1], here[k + 1], right[k + 1]),
                                    neighbors(left[k + 2], here[k + 2], right[k + 2]));
  }
}

[[gnu::always_inline]] inline void find(std::span<const ThinningTile> tiles, std::span<const std::int32_t> active,
                                        ThinningStep step, std::span<OwnRows> found) {
  switch (step) {
    case ThinningStep::upper_right:
      return find_step<ThinningStep::upper_right>(tiles.data(), active, found.data());
    case ThinningStep::lower_left:
      return find_step<ThinningStep::lower_left>(tiles.data(), active, found.data());
    case ThinningStep::square:
      return find_step<ThinningStep::square>(tiles.data(), active, found.data());
  }
}

void find_plain(std::span<const ThinningTile> tiles, std::span<const std::int32_t> active, ThinningStep step,
                std::span<OwnRows> found) {
  find(tiles, active, step, found);
}

#if defined(__x86_64__)

// The same words, compiled for wider registers: the compiler turns the eight rows of a tile into one or two of them.
TASSILO_AVX2 void find_avx2(std::span<const ThinningTile> tiles, std::span<const std::int32_t> active,
                            ThinningStep step, std::span<OwnRows> found) {
  find(tiles, active, step, found);
}

TASSILO_AVX512 void find_avx512(std::span<const ThinningTile> tiles, std::span<const std::int32_t> active,
                                ThinningStep step, std::span<OwnRows> found) {
  find(tiles, active, step, found);
}

constexpr std::array<ThinningKernel, 3> kKernels{
    {{Kernel::plain, find_plain}, {Kernel::avx2, find_avx2}, {Kernel::avx512, find_avx512}}};

#else

constexpr std::array<ThinningKernel, 1> kKernels{{{Kernel::plain, find_plain}}};

#endif

}  // namespace

TileRow find_square(std::span<const ThinningTile> tiles, const ThinningTile& tile, std::size_t k) {
  const ThinningTile &left = tiles[static_cast<std::size_t>(tile.left)],
                     &right = tiles[static_cast<std::size_t>(tile.right)];
  const auto row = [&](std::size_t r) { return neighbors(left.rows[r], tile.rows[r], right.rows[r]); };
  return pixels_of_step<ThinningStep::square>(row(k), row(k + 1), row(k + 2));
}

std::span<const ThinningKernel> thinning_kernels() { return kKernels; }

}  // namespace tassilo
