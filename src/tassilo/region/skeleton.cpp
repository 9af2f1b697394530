#include "tassilo/region/skeleton.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>

#include "tassilo/base/contract.h"
#include "tassilo/base/recycled.h"
#include "tassilo/region/internal/thinning.h"

namespace tassilo {
namespace {

/// Tiles beside each other.
struct TileBand {
  int row = 0;                        ///< Image row of the tiles' first own row. [px]
  std::size_t first = 0, behind = 0;  ///< Its tiles, from left to right.
};

/// A region as tiles, of which only those near pixels exist.
struct TiledRegion {
  RecycledVector<ThinningTile> tiles;  ///< [0] is empty and stands for all that do not exist.
  RecycledVector<int> column;          ///< Image column of bit 0, one a tile. [px]
  RecycledVector<TileBand> bands;      ///< From top to bottom.
};

int floor_to(int value, int step) { return value - ((value % step) + step) % step; }

/// Makes tiles of runs, band by band.
class Tiler {
 public:
  explicit Tiler(const Region& region) : runs_(region.runs()) {
    const PixelBox box = bounding_box(region);
    left_ = floor_to(box.x0, kTileWidth) - kTileWidth;  // so that each strip has one to its left
    const auto strips = static_cast<std::size_t>((box.x1 - left_) / kTileWidth + 2);
    used_.resize(strips / 64 + 1);
    here_.resize(strips);
    above_.resize(strips);
  }

  TiledRegion tiled() && {
    result_.tiles.reserve(runs_.size() / 2 + 1);
    result_.tiles.emplace_back();
    result_.column.push_back(0);
    std::size_t first = 0;
    int row = first_row(runs_.front().row);
    while (true) {
      std::size_t behind = first;
      while (behind < runs_.size() && runs_[behind].row <= row + kTileHeight) ++behind;
      add_band(row, runs_.subspan(first, behind - first));
      // The next band's upper border is this band's last row.
      first = behind;
      while (first > 0 && runs_[first - 1].row >= row + kTileHeight - 1) --first;
      if (first == runs_.size()) break;
      row = std::max(row + kTileHeight, first_row(runs_[first].row));
    }
    return std::move(result_);
  }

 private:
  /// Of the first band that needs a row, be it as its lower border.
  static int first_row(int row) { return floor_to(row - 1, kTileHeight); }
  std::size_t strip_of(int column) const { return static_cast<std::size_t>((column - left_) / kTileWidth); }

  void add_band(int row, std::span<const PixelRun> runs) {
    const bool follows = !result_.bands.empty() && result_.bands.back().row + kTileHeight == row;
    const std::size_t first_above = result_.bands.empty() ? 1 : result_.bands.back().first;
    const std::size_t first = result_.tiles.size();
    if (!follows) forget(above_, first_above, first);
    for (const PixelRun& run : runs)
      for (std::size_t strip = strip_of(run.begin); strip <= strip_of(run.end - 1); ++strip)
        used_[strip / 64] |= std::uint64_t{1} << strip % 64;
    number_tiles(first);
    for (const PixelRun& run : runs) paint(run, run.row - row + 1);
    link(first);
    result_.bands.push_back({row, first, result_.tiles.size()});
    forget(above_, first_above, first);
    std::swap(above_, here_);
  }

  void number_tiles(std::size_t first) {
    std::size_t next = first;
    for (std::size_t word = 0; word < used_.size(); ++word)
      for (; used_[word] != 0; used_[word] &= used_[word] - 1) {
        const std::size_t strip = word * 64 + static_cast<std::size_t>(std::countr_zero(used_[word]));
        here_[strip] = static_cast<std::int32_t>(next++);
        result_.column.push_back(left_ + static_cast<int>(strip) * kTileWidth);
      }
    result_.tiles.resize(next);
  }

  void paint(const PixelRun& run, int tile_row) {
    const std::size_t first = strip_of(run.begin), last = strip_of(run.end - 1);
    const TileRow from = ~TileRow{0} << (run.begin - left_) % kTileWidth;
    const TileRow until = ~TileRow{0} >> (kTileWidth - 1 - (run.end - 1 - left_) % kTileWidth);
    for (std::size_t strip = first; strip <= last; ++strip)
      result_.tiles[static_cast<std::size_t>(here_[strip])].rows[static_cast<std::size_t>(tile_row)] |=
          (strip == first ? from : ~TileRow{0}) & (strip == last ? until : ~TileRow{0});
  }

  void link(std::size_t first) {
    for (std::size_t t = first; t < result_.tiles.size(); ++t) {
      ThinningTile& tile = result_.tiles[t];
      const std::size_t strip = strip_of(result_.column[t]);
      tile.left = here_[strip - 1];
      tile.right = here_[strip + 1];
      tile.above = above_[strip];
      // Tile 0 keeps no neighbors.
      if (tile.above != 0) result_.tiles[static_cast<std::size_t>(tile.above)].below = static_cast<std::int32_t>(t);
    }
  }

  void forget(RecycledVector<std::int32_t>& tile_at, std::size_t first, std::size_t behind) const {
    for (std::size_t t = first; t < behind; ++t) tile_at[strip_of(result_.column[t])] = 0;
  }

  std::span<const PixelRun> runs_;
  int left_ = 0;
  RecycledVector<std::uint64_t> used_;         ///< One bit a strip: has a tile in this band.
  RecycledVector<std::int32_t> here_, above_;  ///< Tile by strip, in this band and the one above; 0 where is none.
  TiledRegion result_;
};

/// Peels a tiled region in place.
class Thinning {
 public:
  Thinning(TiledRegion& tiled, const ThinningKernel& kernel)
      : tiles_(tiled.tiles),
        bands_(tiled.bands),
        kernel_(kernel),
        awake_until_(tiles_.size(), 2),
        active_(tiles_.size()),
        found_(tiles_.size()) {}

  void run() {
    do peel();
    while (open_squares());
  }

 private:
  ThinningTile& tile_at(std::int32_t index) { return tiles_[static_cast<std::size_t>(index)]; }

  /// A tile whose surroundings did not change in the last two steps gives what it gave two steps ago: nothing.
  void wake(std::int32_t tile) { awake_until_[static_cast<std::size_t>(tile)] = step_ + 2; }

  /// Both sub-iterations in turn, until neither changes anything.
  void peel() {
    while (true) {
      std::size_t count = 0;
      for (std::size_t t = 1; t < tiles_.size(); ++t) {
        active_[count] = static_cast<std::int32_t>(t);
        count += awake_until_[t] > step_;
      }
      if (count == 0) return;
      ++step_;
      const std::span<const std::int32_t> active(active_.data(), count);
      kernel_.find(tiles_, active, step_ % 2 == 1 ? ThinningStep::upper_right : ThinningStep::lower_left, found_);
      for (std::size_t i = 0; i < count; ++i) remove(active[i], found_[i]);
    }
  }

  /// Simple pixels of full squares, one after the other from top to bottom; did any go?
  bool open_squares() {
    std::iota(active_.begin(), active_.end(), 0);
    kernel_.find(tiles_, active_, ThinningStep::square, found_);
    bool changed = false;
    for (const TileBand& band : bands_)
      if (std::any_of(found_.begin() + static_cast<std::ptrdiff_t>(band.first),
                      found_.begin() + static_cast<std::ptrdiff_t>(band.behind),
                      [](const OwnRows& rows) { return rows != OwnRows{}; }))
        changed |= open_squares(band);
    return changed;
  }

  bool open_squares(const TileBand& band) {
    bool changed = false;
    for (std::size_t k = 0; k < kTileHeight; ++k)
      for (std::size_t t = band.first; t < band.behind; ++t)
        for (TileRow left = found_[t][k]; left != 0; left &= left - 1) {
          OwnRows gone{};
          gone[k] = left & -left & find_square(tiles_, tiles_[t], k);
          changed |= gone[k] != 0;
          remove(static_cast<std::int32_t>(t), gone);
        }
    return changed;
  }

  /// Deletes pixels of a tile, keeps the neighbors' copies of them equal, and wakes whatever sees them.
  void remove(std::int32_t index, const OwnRows& gone) {
    TileRow any = 0;
    for (const TileRow row : gone) any |= row;
    if (any == 0) return;
    ThinningTile& tile = tile_at(index);
    for (std::size_t k = 0; k < kTileHeight; ++k) tile.rows[k + 1] &= ~gone[k];
    const bool at_left = any & 1, at_right = any >> 63;
    wake(index);
    wake(at_left ? tile.left : 0);
    wake(at_right ? tile.right : 0);
    const auto wake_beyond = [&](std::int32_t other) {
      wake(other);
      wake(at_left ? tile_at(other).left : 0);
      wake(at_right ? tile_at(other).right : 0);
    };
    if (gone.front() != 0) {
      tile_at(tile.above).rows.back() = tile.rows[1];
      wake_beyond(tile.above);
    }
    if (gone.back() != 0) {
      tile_at(tile.below).rows.front() = tile.rows[kTileHeight];
      wake_beyond(tile.below);
    }
  }

  std::span<ThinningTile> tiles_;
  std::span<const TileBand> bands_;
  const ThinningKernel& kernel_;
  int step_ = 0;                     ///< Number of steps taken.
  RecycledVector<int> awake_until_;  ///< Last step in which a tile has to be looked at.
  RecycledVector<std::int32_t> active_;
  RecycledVector<OwnRows> found_;
};

/// Adds the runs of 64 pixels that begin at `column`; joins what goes on from the tile before.
void append_runs(TileRow pixels, int row, int column, RunVector& runs) {
  while (pixels != 0) {
    const int begin = std::countr_zero(pixels), length = std::countr_one(pixels >> begin);
    const auto from = static_cast<std::int16_t>(column + begin),
               to = static_cast<std::int16_t>(column + begin + length);
    if (begin == 0 && !runs.empty() && runs.back().row == row && runs.back().end == from)
      runs.back().end = to;
    else
      runs.push_back({static_cast<std::int16_t>(row), from, to});
    if (begin + length == kTileWidth) return;
    pixels &= ~TileRow{0} << (begin + length);
  }
}

Region region_of(const TiledRegion& tiled, std::size_t expected_runs) {
  RunVector runs;
  runs.reserve(expected_runs);
  for (const TileBand& band : tiled.bands)
    for (std::size_t k = 0; k < kTileHeight; ++k)
      for (std::size_t t = band.first; t < band.behind; ++t)
        append_runs(tiled.tiles[t].rows[k + 1], band.row + static_cast<int>(k), tiled.column[t], runs);
  return Region::from_sorted(std::move(runs));
}

}  // namespace

Region skeleton_by(const ThinningKernel& kernel, const Region& region) {
  expects(is_supported(kernel.kernel), "a kernel this machine can run");
  if (region.empty()) return {};
  TiledRegion tiled = Tiler(region).tiled();
  Thinning(tiled, kernel).run();
  return region_of(tiled, region.runs().size());
}

Region skeleton(const Region& region) { return skeleton_by(version_in_use(thinning_kernels()), region); }

}  // namespace tassilo
