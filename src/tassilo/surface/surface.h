#pragma once

#include <cstdint>
#include <span>

#include "tassilo/base/recycled.h"
#include "tassilo/camera/ground_map.h"
#include "tassilo/region/region.h"

namespace tassilo {

/// What a pixel shows, as far as its color and its neighborhood tell. Bit 1 tells what is floor: see `next_line`.
enum class SurfaceKind : std::uint8_t {
  unknown,  ///< Neither of the following.
  object,   ///< A color that is no floor: ball, goal, robot.
  carpet,   ///< Field color, and single odd pixels inside it.
  line,     ///< White (or its blurred rim) as narrow as a field line lying there, carpet on both sides.
  wall,     ///< White that is no line.
};

/// One kind for every pixel, row-major.
struct Surface {
  int width = 0, height = 0;
  RecycledVector<SurfaceKind> kinds;

  SurfaceKind at(int column, int row) const { return kinds[static_cast<std::size_t>(row * width + column)]; }
  std::span<const SurfaceKind> row(int r) const {
    return std::span(kinds).subspan(static_cast<std::size_t>(r * width), static_cast<std::size_t>(width));
  }
  bool is_floor(int column, int row) const {
    const SurfaceKind kind = at(column, row);
    return kind == SurfaceKind::carpet || kind == SurfaceKind::line;
  }
};

/// First pixel of a row at or behind `from` that shows a line; row.size() when there is none. A word of pixels at a
/// time.
std::size_t next_line(std::span<const SurfaceKind> row, std::size_t from);
/// First pixel at or behind `from` that is no floor while the one below it is; above.size() when there is none.
/// Likewise.
std::size_t next_floor_end(std::span<const SurfaceKind> above, std::span<const SurfaceKind> below, std::size_t from);

/// Tiles of kFloorTile x kFloorTile pixels that are floor throughout (1) or not (0), row by row, as many as begin
/// inside the image: what passes over floor may pass over a tile at once.
constexpr int kFloorTile = 8;
RecycledVector<std::uint8_t> floor_tiles(const Surface& surface);

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
/// ground    pixel -> floor of this image, for the size of a line; null without calibration: then a fortieth of the
/// image width counts recycled  a former result whose memory is used again cost      one write a pixel and O(runs +
/// pixels of lines); safe from any thread. source: own
Surface find_surface(const SurfaceInput& input, const GroundMap* ground, const SurfaceOptions& options = {},
                     Surface recycled = {});

}  // namespace tassilo
