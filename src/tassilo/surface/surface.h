#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "tassilo/base/recycled.h"
#include "tassilo/camera/ground_map.h"
#include "tassilo/region/region.h"

namespace tassilo {

/// What a pixel shows, as far as its color and its neighborhood tell. Of the values only those of floor have bit 1, so
/// that eight pixels can be asked at once.
enum class SurfaceKind : std::uint8_t {
  unknown,  ///< Neither of the following.
  object,   ///< A color that is no floor: ball, goal, robot.
  carpet,   ///< Field color, and single odd pixels inside it.
  line,     ///< White (or its blurred rim) as narrow as a field line lying there, carpet on both sides.
  wall,     ///< White that is no line.
};

/// One kind for every pixel, row-major, and what each tile of 8 x 8 pixels holds, so that whole tiles can be passed
/// over.
struct Surface {
  /// Bits of a tile.
  enum Tile : std::uint8_t { all_floor = 1, some_floor = 2, some_line = 4 };
  static constexpr int kTile = 8;  ///< [px]

  int width = 0, height = 0;
  RecycledVector<SurfaceKind> kinds;
  RecycledVector<std::uint8_t> tiles;  ///< As many as begin inside the image, row-major; see `update_tiles`.

  SurfaceKind at(int column, int row) const { return kinds[static_cast<std::size_t>(row * width + column)]; }
  std::span<const SurfaceKind> row(int r) const {
    return std::span(kinds).subspan(static_cast<std::size_t>(r * width), static_cast<std::size_t>(width));
  }
  bool is_floor(int column, int row) const {
    const SurfaceKind kind = at(column, row);
    return kind == SurfaceKind::carpet || kind == SurfaceKind::line;
  }
  int tiles_across() const { return (width + kTile - 1) / kTile; }
  int tiles_down() const { return (height + kTile - 1) / kTile; }
  std::span<const std::uint8_t> tile_row(int t) const {
    return std::span(tiles).subspan(static_cast<std::size_t>(t * tiles_across()),
                                    static_cast<std::size_t>(tiles_across()));
  }
  /// Makes the tiles fit the kinds; `find_surface` has done so. O(pixels / 8).
  void update_tiles();
};

/// Calls visit(row, begin, end) for each stretch of line pixels along a row, in the order of pixels.
/// cost     O(tiles + pixels of tiles with lines)
template <class Visit>
void for_each_line_run(const Surface& surface, Visit visit) {
  RecycledVector<int> starts;  // columns where tiles with lines begin
  for (int t = 0; t < surface.tiles_down(); ++t) {
    const auto tiles = surface.tile_row(t);
    starts.clear();
    for (std::size_t k = 0; k < tiles.size(); ++k)
      if ((tiles[k] & Surface::some_line) != 0) starts.push_back(static_cast<int>(k) * Surface::kTile);
    if (starts.empty()) continue;
    for (int r = t * Surface::kTile; r < std::min((t + 1) * Surface::kTile, surface.height); ++r) {
      const auto row = surface.row(r);
      const auto is_line = [&](int c) { return row[static_cast<std::size_t>(c)] == SurfaceKind::line; };
      int c = 0;
      for (const int start : starts) {
        const int end = std::min(start + Surface::kTile, surface.width);
        for (c = std::max(c, start); c < end;) {
          if (!is_line(c++)) continue;
          const int begin = c - 1;
          while (c < surface.width && is_line(c)) ++c;
          visit(r, begin, c);
        }
      }
    }
  }
}

/// Calls visit(column, row) for each pixel that is no floor while the one below it is, in the order of pixels.
/// cost     O(tiles + pixels of tiles at the rim of the floor)
template <class Visit>
void for_each_floor_end(const Surface& surface, Visit visit) {
  RecycledVector<int> starts;  // columns where tiles begin in which floor may end
  for (int t = 0; t < surface.tiles_down(); ++t) {
    const auto tiles = surface.tile_row(t), below = surface.tile_row(std::min(t + 1, surface.tiles_down() - 1));
    starts.clear();
    for (std::size_t k = 0; k < tiles.size(); ++k)
      if ((tiles[k] & Surface::all_floor) == 0 && ((tiles[k] | below[k]) & Surface::some_floor) != 0)
        starts.push_back(static_cast<int>(k) * Surface::kTile);
    if (starts.empty()) continue;
    for (int r = t * Surface::kTile; r < std::min((t + 1) * Surface::kTile, surface.height - 1); ++r)
      for (const int start : starts)
        for (int c = start; c < std::min(start + Surface::kTile, surface.width); ++c)
          if (!surface.is_floor(c, r) && surface.is_floor(c, r + 1)) visit(c, r);
  }
}

struct SurfaceOptions {
  double line_width = 0.05;  ///< Of the field's lines. [m], > 0
  /// A line crossed at 45 degrees is sqrt(2) wider along row and column than across. [1], >= 1
  double slant = 1.5;
  int blur_px = 2;     ///< Rim between line and carpet that is neither color. [px], >= 0
  void check() const;  ///< Throws Error naming the first field out of range.
};

/// What the surface is judged from: the regions that are certainly one or the other color.
struct SurfaceInput {
  int width = 0, height = 0;       ///< [px]
  const Region* carpet = nullptr;  ///< Green. All regions lie within the image.
  const Region* white = nullptr;
  std::span<const Region* const> colored;  ///< Any other class: its pixels are no floor, however narrow.
};

/// Tells carpet, lines and walls apart by the neighborhood of the white regions (DESIGN 6.7): a stretch of white along
/// a row or a column belongs to a line when it is no longer than a line lying there would show and carpet bounds it at
/// both ends.
///
/// ground    pixel -> floor of this image, for the size of a line;
///           null without calibration: then a fortieth of the image width counts
/// recycled  a former result whose memory is used again
/// cost      one write a pixel and O(runs + pixels of lines); safe from any thread
/// source    own
Surface find_surface(const SurfaceInput& input, const GroundMap* ground, const SurfaceOptions& options = {},
                     Surface recycled = {});

}  // namespace tassilo
