#include "tassilo/surface/surface.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"

namespace tassilo {
namespace {

/// Colors before the neighborhood was asked.
enum Paint : std::uint8_t { unknown, carpet, white, colored };

void paint(std::vector<std::uint8_t>& map, int width, const Region& region, Paint value) {
  for (const PixelRun& run : region.runs()) {
    const auto row = map.begin() + std::ptrdiff_t{run.row} * width;
    std::fill(row + run.begin, row + run.end, static_cast<std::uint8_t>(value));
  }
}

/// How long a line lying on the floor at a pixel may show along row or column.
class LineSize {
 public:
  LineSize(const SurfaceInput& input, const GroundMap* ground, const SurfaceOptions& options)
      : input_(input), ground_(ground), options_(options) {}

  double along_row(int c, int r) const { return longest(c, r, 1, 0); }
  double along_column(int c, int r) const { return longest(c, r, 0, 1); }

 private:
  double longest(int c, int r, int dc, int dr) const {
    const double rims = 2.0 * options_.blur_px;
    if (ground_ == nullptr) return std::max(3.0, input_.width / 40.0) + rims;
    if (c + dc >= input_.width) dc = -dc;
    if (r + dr >= input_.height) dr = -dr;
    const auto here = ground_->at(c, r), beside = ground_->at(c + dc, r + dr);
    if (!here || !beside) return 0;  // above the horizon lies no line
    return options_.slant * options_.line_width / std::max(1e-6, distance(*here, *beside)) + rims;
  }

  const SurfaceInput& input_;
  const GroundMap* ground_;
  const SurfaceOptions& options_;
};

}  // namespace

void SurfaceOptions::check() const {
  if (!(line_width > 0)) throw Error("line_width", "is " + std::to_string(line_width) + ", must be > 0");
  if (!(slant >= 1)) throw Error("slant", "is " + std::to_string(slant) + ", must be >= 1");
  if (blur_px < 0) throw Error("blur_px", "is " + std::to_string(blur_px) + ", must be >= 0");
}

Surface find_surface(const SurfaceInput& input, const GroundMap* ground, const SurfaceOptions& options,
                     Surface recycled) {
  expects(input.carpet != nullptr && input.white != nullptr, "surface: carpet and white are given");
  const int width = input.width, height = input.height;
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  thread_local std::vector<std::uint8_t> map;
  map.assign(pixels, unknown);
  paint(map, width, *input.carpet, carpet);
  paint(map, width, *input.white, white);
  for (const Region* region : input.colored) paint(map, width, *region, colored);

  Surface surface = std::move(recycled);
  surface.width = width;
  surface.height = height;
  surface.kinds.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i)
    surface.kinds[i] = map[i] == carpet  ? SurfaceKind::carpet
                       : map[i] == white ? SurfaceKind::wall
                                         : SurfaceKind::other;

  const LineSize size(input, ground, options);
  const auto kind_at = [&](int c, int r) -> SurfaceKind& {
    return surface.kinds[static_cast<std::size_t>(r * width + c)];
  };
  const auto mark = [&](int c, int r, bool line) {
    SurfaceKind& kind = kind_at(c, r);
    if (line || kind == SurfaceKind::other) kind = line ? SurfaceKind::line : SurfaceKind::carpet;
  };
  /// Stretches of white or unknown along one row or column, between what `bounds` it.
  struct Stretch {
    int begin = -1;  ///< -1 until the bound before it was seen
    bool has_white = false;
  };
  thread_local std::vector<Stretch> open;
  const auto scan = [&](double wider, auto bounds) {
    for (int r = 0; r < height; ++r) {
      Stretch stretch;
      for (int c = 0; c < width; ++c) {
        const std::uint8_t p = map[static_cast<std::size_t>(r * width + c)];
        if (bounds(p, c, r)) {
          if (stretch.begin >= 0 && c > stretch.begin &&
              c - stretch.begin <= wider * size.along_row((stretch.begin + c) / 2, r))
            for (int i = stretch.begin; i < c; ++i) mark(i, r, stretch.has_white);
          stretch = {c + 1, false};
        } else if (p == colored) {
          stretch = {};
        } else if (p == white) {
          stretch.has_white = true;
        }
      }
    }
    // All columns at once, row by row; below the image the carpet goes on.
    open.assign(static_cast<std::size_t>(width), Stretch{});
    for (int r = 0; r <= height; ++r)
      for (int c = 0; c < width; ++c) {
        const std::uint8_t p =
            r < height ? map[static_cast<std::size_t>(r * width + c)] : static_cast<std::uint8_t>(carpet);
        Stretch& stretch = open[static_cast<std::size_t>(c)];
        if (r == height || bounds(p, c, r)) {
          if (stretch.begin >= 0 && r > stretch.begin &&
              r - stretch.begin <= wider * size.along_column(c, (stretch.begin + r) / 2))
            for (int i = stretch.begin; i < r; ++i) mark(c, i, stretch.has_white);
          stretch = {r + 1, false};
        } else if (p == colored) {
          stretch = {};
        } else if (p == white) {
          stretch.has_white = true;
        }
      }
  };
  scan(1, [](std::uint8_t p, int, int) { return p == carpet; });
  // Where lines meet, white is wider than a line, but lines bound it.
  scan(2, [&](std::uint8_t p, int c, int r) { return p == carpet || kind_at(c, r) == SurfaceKind::line; });
  return surface;
}

}  // namespace tassilo
