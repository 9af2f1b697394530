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

std::uint64_t word_at(std::span<const SurfaceKind> row, std::size_t column) {
  std::uint64_t word;
  std::memcpy(&word, row.data() + column, kWord);
  return word;
}

/// First column at or behind `from` where `holds` is true; whole words where `any_holds` is false are passed over.
template <class AnyInWord, class Holds>
std::size_t next_where(std::size_t width, std::size_t from, AnyInWord any_holds, Holds holds) {
  for (; from + kWord <= width; from += kWord) {
    if (!any_holds(from)) continue;
    while (!holds(from)) ++from;
    return from;
  }
  while (from < width && !holds(from)) ++from;
  return from;
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
    return gap.length <= wider * (gap.along_row ? size_.along_row(gap.column + middle, gap.row)
                                                : size_.along_column(gap.column, gap.row + middle));
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

std::size_t next_line(std::span<const SurfaceKind> row, std::size_t from) {
  return next_where(
      row.size(), from, [&](std::size_t c) { return (word_at(row, c) & (word_at(row, c) >> 1) & kBit0) != 0; },
      [&](std::size_t c) { return row[c] == SurfaceKind::line; });
}

std::size_t next_floor_end(std::span<const SurfaceKind> above, std::span<const SurfaceKind> below, std::size_t from) {
  const auto floor = [](SurfaceKind kind) { return kind == SurfaceKind::carpet || kind == SurfaceKind::line; };
  return next_where(
      above.size(), from, [&](std::size_t c) { return (~word_at(above, c) & word_at(below, c) & kBit1) != 0; },
      [&](std::size_t c) { return !floor(above[c]) && floor(below[c]); });
}

RecycledVector<std::uint8_t> floor_tiles(const Surface& surface) {
  static_assert(kFloorTile == kWord);
  const auto width = static_cast<std::size_t>(surface.width), across = (width + kWord - 1) / kWord;
  RecycledVector<std::uint8_t> tiles;
  tiles.reserve(across * static_cast<std::size_t>((surface.height + kFloorTile - 1) / kFloorTile));
  RecycledVector<std::uint64_t> all(across);  // bits that all pixels of a column of the tile have
  for (int top = 0; top < surface.height; top += kFloorTile) {
    std::ranges::fill(all, ~std::uint64_t{0});
    for (int r = top; r < std::min(top + kFloorTile, surface.height); ++r) {
      const auto row = surface.row(r);
      for (std::size_t k = 0; k < width / kWord; ++k) all[k] &= word_at(row, k * kWord);
      if (width % kWord == 0) continue;
      std::uint64_t rest = ~std::uint64_t{0};
      std::memcpy(&rest, row.data() + width / kWord * kWord, width % kWord);
      all.back() &= rest;
    }
    for (const std::uint64_t bits : all) tiles.push_back((bits & kBit1) == kBit1);
  }
  return tiles;
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

  thread_local RecycledVector<Gap> gaps, wide;
  gaps.clear();
  wide.clear();
  gaps_along_columns(surface, *input.carpet, gaps);  // before any gap along a row becomes carpet
  gaps_along_rows(*input.carpet, gaps);
  const LineSize size(input, ground, options);
  Judge judge(surface, size);
  for (const Gap& gap : gaps)
    if (!judge.has_object(gap) && !judge.accept(gap)) wide.push_back(gap);
  for (const Gap& gap : wide) judge.accept_between_lines(gap);
  return surface;
}

}  // namespace tassilo
