#include "tassilo/surface/surface.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/region/algebra.h"

namespace tassilo {
namespace {

void paint(Surface& surface, const Region& region, SurfaceKind kind) {
  for (const PixelRun& run : region.runs()) {
    const auto row = surface.kinds.begin() + std::ptrdiff_t{run.row} * surface.width;
    std::fill(row + run.begin, row + run.end, kind);
  }
}

// Eight pixels at once. Of the kinds only floor has bit 1, and of floor only lines have bit 0.
static_assert(static_cast<int>(SurfaceKind::carpet) == 2 && static_cast<int>(SurfaceKind::line) == 3 &&
              static_cast<int>(SurfaceKind::object) == 1 && static_cast<int>(SurfaceKind::wall) == 4);
constexpr std::size_t kWord = 8;
constexpr std::uint64_t kBit0 = 0x0101010101010101, kBit1 = kBit0 << 1;

/// How long a line lying on the floor at a pixel may show along row or column.
class LineSize {
 public:
  LineSize(const SurfaceInput& input, const GroundMap* ground, const SurfaceOptions& options)
      : input_(input),
        ground_(ground),
        rims_(2.0 * options.blur_px),
        widest_(options.slant * options.line_width),
        widest_px_(std::max(3.0, input.width / 40.0)) {}

  /// May `pixels` along the row (or the column) around (c, r) be a line, `wider` times as wide as one alone?
  bool holds(int c, int r, bool along_row, double pixels, double wider) const {
    if (ground_ == nullptr) return pixels <= wider * (widest_px_ + rims_);
    int dc = along_row ? 1 : 0, dr = along_row ? 0 : 1;
    if (c + dc >= input_.width) dc = -dc;
    if (r + dr >= input_.height) dr = -dr;
    const auto here = ground_->at(c, r), beside = ground_->at(c + dc, r + dr);
    if (!here || !beside) return false;  // above the horizon lies no line
    const double blurred = pixels - wider * rims_;
    if (blurred <= 0) return true;
    const FloorPoint pixel = *beside - *here;
    return blurred * blurred * dot(pixel, pixel) <= wider * wider * widest_ * widest_;
  }

 private:
  const SurfaceInput& input_;
  const GroundMap* ground_;
  double rims_;       ///< Of both sides. [px]
  double widest_;     ///< [m]
  double widest_px_;  ///< Without calibration.
};

/// A stretch of pixels along a row or a column with carpet before and after it.
struct Gap {
  int column, row;  ///< First pixel.
  int length;
  bool along_row;
};

class Judge {
 public:
  Judge(Surface& surface, const LineSize& size) : surface_(surface), size_(size) {}

  /// Narrow enough for a line? Then it is floor.
  bool accept(const Gap& gap) {
    if (!is_narrow(gap, 1)) return false;
    mark(gap);
    return true;
  }

  /// Where lines meet, white is wider than a line, but lines bound it: pieces of the gap between lines.
  void accept_between_lines(const Gap& gap) {
    int from = 0;
    for (int k = 0; k <= gap.length; ++k) {
      if (k < gap.length && kind(gap, k) != SurfaceKind::line) continue;
      const Gap piece{gap.along_row ? gap.column + from : gap.column, gap.along_row ? gap.row : gap.row + from,
                      k - from, gap.along_row};
      if (piece.length > 0 && is_narrow(piece, 2)) mark(piece);
      from = k + 1;
    }
  }

  /// Is there anything in the gap that is certainly no floor?
  bool has_object(const Gap& gap) const {
    for (int k = 0; k < gap.length; ++k)
      if (kind(gap, k) == SurfaceKind::object) return true;
    return false;
  }

 private:
  /// Pixel k of the gap.
  SurfaceKind& kind(const Gap& gap, int k) const {
    const int column = gap.along_row ? gap.column + k : gap.column, row = gap.along_row ? gap.row : gap.row + k;
    return surface_.kinds[static_cast<std::size_t>(row * surface_.width + column)];
  }

  bool is_narrow(const Gap& gap, double wider) const {
    const int middle = gap.length / 2;
    return gap.along_row ? size_.holds(gap.column + middle, gap.row, true, gap.length, wider)
                         : size_.holds(gap.column, gap.row + middle, false, gap.length, wider);
  }

  void mark(const Gap& gap) {
    bool has_white = false;
    for (int k = 0; k < gap.length; ++k) {
      const SurfaceKind now = kind(gap, k);
      has_white = has_white || now == SurfaceKind::wall || now == SurfaceKind::line;
    }
    for (int k = 0; k < gap.length; ++k) kind(gap, k) = has_white ? SurfaceKind::line : SurfaceKind::carpet;
  }

  Surface& surface_;
  const LineSize& size_;
};

/// Gaps between carpet runs of one row.
void gaps_along_rows(const Region& carpet, RecycledVector<Gap>& gaps) {
  const auto runs = carpet.runs();
  for (std::size_t i = 1; i < runs.size(); ++i)
    if (runs[i].row == runs[i - 1].row)
      gaps.push_back({runs[i - 1].end, runs[i].row, runs[i].begin - runs[i - 1].end, true});
}

/// Gaps below carpet pixels down to the next carpet pixel, or to the lower border: there the carpet goes on.
void gaps_along_columns(const Surface& surface, const Region& carpet, RecycledVector<Gap>& gaps) {
  const Region below =
      clipped(difference(translated(carpet, {.columns = 0, .rows = 1}), carpet), {0, 0, surface.width, surface.height});
  for (const PixelRun& run : below.runs())
    for (int c = run.begin; c < run.end; ++c) {
      int end = run.row;
      while (end < surface.height && surface.at(c, end) != SurfaceKind::carpet &&
             surface.at(c, end) != SurfaceKind::object)
        ++end;
      if (end < surface.height && surface.at(c, end) == SurfaceKind::object) continue;
      gaps.push_back({c, run.row, end - run.row, false});
    }
}

}  // namespace

void SurfaceOptions::check() const {
  if (!(line_width > 0)) throw Error("surface.line_width", "is " + std::to_string(line_width) + ", must be > 0");
  if (!(slant >= 1)) throw Error("surface.slant", "is " + std::to_string(slant) + ", must be >= 1");
  if (blur_px < 0) throw Error("surface.blur_px", "is " + std::to_string(blur_px) + ", must be >= 0");
}

void Surface::update_tiles() {
  static_assert(kTile == kWord);
  const auto columns = static_cast<std::size_t>(width), across = static_cast<std::size_t>(tiles_across());
  tiles.clear();
  tiles.reserve(across * static_cast<std::size_t>(tiles_down()));
  /// Bits that all, some pixels of a column of a tile have; bit 0 of `line` where some are lines.
  RecycledVector<std::uint64_t> all(across), some(across), line(across);
  for (int top = 0; top < height; top += kTile) {
    std::ranges::fill(all, ~std::uint64_t{0});
    std::ranges::fill(some, 0);
    std::ranges::fill(line, 0);
    for (int r = top; r < std::min(top + kTile, height); ++r) {
      const SurfaceKind* const from = row(r).data();
      for (std::size_t k = 0; k < columns / kWord; ++k) {
        std::uint64_t word;
        std::memcpy(&word, from + k * kWord, kWord);
        all[k] &= word;
        some[k] |= word;
        line[k] |= word & (word >> 1);
      }
      // What is beside the image neither keeps a tile from being all floor nor adds anything.
      for (std::size_t c = columns / kWord * kWord; c < columns; ++c) {
        const auto kind = static_cast<std::uint64_t>(from[c]);
        all.back() &= kind * kBit0;
        some.back() |= kind;
        line.back() |= kind & (kind >> 1);
      }
    }
    for (std::size_t k = 0; k < across; ++k)
      tiles.push_back(static_cast<std::uint8_t>(((all[k] & kBit1) == kBit1 ? all_floor : 0) |
                                                ((some[k] & kBit1) != 0 ? some_floor : 0) |
                                                ((line[k] & kBit0) != 0 ? some_line : 0)));
  }
}

Surface find_surface(const SurfaceInput& input, const GroundMap* ground, const SurfaceOptions& options,
                     Surface recycled) {
  expects(input.carpet != nullptr && input.white != nullptr, "surface: carpet and white are given");
  Surface surface = std::move(recycled);
  surface.width = input.width;
  surface.height = input.height;
  surface.kinds.assign(static_cast<std::size_t>(input.width) * static_cast<std::size_t>(input.height),
                       SurfaceKind::unknown);
  paint(surface, *input.carpet, SurfaceKind::carpet);
  paint(surface, *input.white, SurfaceKind::wall);
  for (const Region* region : input.colored) paint(surface, *region, SurfaceKind::object);

  RecycledVector<Gap> gaps, wide;
  gaps_along_columns(surface, *input.carpet, gaps);  // before any gap along a row becomes carpet
  gaps_along_rows(*input.carpet, gaps);
  const LineSize size(input, ground, options);
  Judge judge(surface, size);
  for (const Gap& gap : gaps)
    if (!judge.has_object(gap) && !judge.accept(gap)) wide.push_back(gap);
  for (const Gap& gap : wide) judge.accept_between_lines(gap);
  surface.update_tiles();
  return surface;
}

}  // namespace tassilo
