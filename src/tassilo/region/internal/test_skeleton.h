#pragma once

// For tests only.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tassilo/region/algebra.h"
#include "tassilo/region/internal/test_regions.h"

namespace tassilo {

/// The eight neighbors of a pixel, clockwise from the one above: Guo and Hall's p2 .. p9.
using NeighborFlags = std::array<bool, 8>;
inline NeighborFlags neighbor_flags(const Region& region, int column, int row) {
  constexpr std::array<std::array<int, 2>, 8> kSteps{
      {{0, -1}, {1, -1}, {1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}}};
  NeighborFlags flags{};
  for (std::size_t i = 0; i < 8; ++i) flags[i] = contains(region, column + kSteps[i][0], row + kSteps[i][1]);
  return flags;
}

/// Background-to-foreground changes on the way around, the paper's C(p); 1 for a simple pixel: one that may go or come
/// without changing parts and holes.
inline int changes_around(const NeighborFlags& p) {
  int changes = 0;
  for (std::size_t i = 0; i < 8; i += 2) changes += !p[i] && (p[i + 1] || p[(i + 2) % 8]);
  return changes;
}

/// Is the pixel one of a full 2 x 2 square?
inline bool in_full_square(const NeighborFlags& p) {
  for (std::size_t i = 0; i < 8; i += 2)
    if (p[i] && p[i + 1] && p[(i + 2) % 8]) return true;
  return false;
}

/// Does a pixel with these neighbors go in a step? The paper's algorithm A1, word by word.
inline bool guo_hall_deletes(const NeighborFlags& p, bool upper_right) {
  int pairs = 0, other_pairs = 0;
  for (std::size_t i = 0; i < 8; i += 2) {
    pairs += p[(i + 7) % 8] || p[i];
    other_pairs += p[i] || p[i + 1];
  }
  const int n = std::min(pairs, other_pairs);
  const bool other_side = upper_right ? (p[0] || p[1] || !p[3]) && p[2] : (p[4] || p[5] || !p[7]) && p[6];
  return changes_around(p) == 1 && n >= 2 && n <= 3 && !other_side;
}

/// Guo and Hall's algorithm A1, pixel by pixel, beginning with one of its two sub-iterations; tells how many it took.
inline Region guo_hall(Region now, int& step) {
  for (int unchanged = 0; unchanged < 2; ++step) {
    const Region next = region_by_pixel(bounding_box(now), [&](int c, int r) {
      return contains(now, c, r) && !guo_hall_deletes(neighbor_flags(now, c, r), step % 2 == 0);
    });
    unchanged = next == now ? unchanged + 1 : 0;
    now = next;
  }
  return now;
}

/// What `skeleton` is, pixel by pixel. O(steps * area of the box).
inline Region plain_skeleton(const Region& region) {
  Region now = region;
  int step = 0;
  while (true) {
    now = guo_hall(now, step);
    const auto in_square = [](const NeighborFlags& p) { return in_full_square(p) && changes_around(p) == 1; };
    std::vector<PixelRun> found;
    for (const PixelRun& run : now.runs())
      for (std::int16_t c = run.begin; c < run.end; ++c)
        if (in_square(neighbor_flags(now, c, run.row))) found.push_back({run.row, c, static_cast<std::int16_t>(c + 1)});
    const Region before = now;
    for (const PixelRun& pixel : found)
      if (in_square(neighbor_flags(now, pixel.begin, pixel.row))) now = difference(now, Region::from_sorted({pixel}));
    if (now == before) return now;
  }
}

}  // namespace tassilo
