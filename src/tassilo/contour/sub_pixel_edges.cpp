#include "tassilo/contour/sub_pixel_edges.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/contour/internal/edge_points.h"
#include "tassilo/region/algebra.h"

namespace tassilo {
namespace {

/// What a gradient is at least, squared and in the filter's unit.
std::int32_t least_squared(double gray_levels_per_px, int reach) {
  const double least = gray_levels_per_px * gradient_unit(reach);
  return static_cast<std::int32_t>(std::min(std::ceil(least * least), 2147483647.));
}

/// Binary logarithm of a number, of 1 for 0, to 3e-4: a parabola through logarithms is exact for a Gaussian profile,
/// and where it has its vertex needs no more.
float log2_of(std::int32_t number) {
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(std::max(number, 1)));
  const float exponent = static_cast<float>(static_cast<int>(bits >> 23) - 127);
  const float m = std::bit_cast<float>((bits & 0x7fffffU) | 0x3f800000U);
  // Interpolates at Chebyshev nodes and keeps log2(1) and log2(2).
  return exponent + (m - 1) + (m - 1) * (m - 2) * (-.765066F + (.4059009F - .08161574F * m) * m);
}

/// Walks down a region, keeps the gradients of three rows and takes the maxima of the middle one.
class PointFinder {
 public:
  PointFinder(const GradientKernel& kernel, const FrameView& frame, const Region& region, const EdgeOptions& options)
      : kernel_(kernel),
        frame_(frame),
        runs_(region.runs()),
        reach_(options.filter_size_px / 2),
        least_(least_squared(options.low, reach_)) {
    const auto blocks = static_cast<std::size_t>((frame.width() + kBlock - 1) / kBlock);
    needed_.resize(blocks / 64 + 1);
    columns_.resize(blocks);
    inside_.resize(blocks);
    peaks_.resize(blocks);
    const std::size_t row_size = (blocks + 2) * kBlock;
    slopes_.resize(6 * row_size);
    squares_.resize(3 * row_size);
    for (std::size_t k = 0; k < 3; ++k)
      rows_[k] = {slopes_.data() + 2 * k * row_size + kBlock, slopes_.data() + (2 * k + 1) * row_size + kBlock,
                  squares_.data() + k * row_size + kBlock};
  }

  RecycledVector<EdgePoint> points() && {
    if (runs_.empty()) return {};
    std::array<std::size_t, 4> first{};  // runs of the rows above, here and below begin here, and those after them
    const int top = runs_.front().row, bottom = runs_.back().row;
    for (int row = top - 1; row <= bottom + 1; ++row) {
      while (first[3] < runs_.size() && runs_[first[3]].row <= row + 1) ++first[3];
      add_gradients(row, runs_.subspan(first[0], first[3] - first[0]));
      if (row > top) add_points(row - 1, runs_.subspan(first[0], first[1] - first[0]));
      first = {first[1], first[2], first[3], first[3]};
    }
    return std::move(points_);
  }

 private:
  const GradientRow& gradients(int row) const { return rows_[static_cast<std::size_t>(row % 3)]; }

  /// Of a row, near runs of it and the rows beside it.
  void add_gradients(int row, std::span<const PixelRun> runs) {
    for (const PixelRun& run : runs)
      for (int block = (run.begin - 1) / kBlock; block <= run.end / kBlock; ++block)
        needed_[static_cast<std::size_t>(block / 64)] |= std::uint64_t{1} << block % 64;
    std::size_t count = 0;
    for (std::size_t word = 0; word < needed_.size(); ++word)
      for (; needed_[word] != 0; needed_[word] &= needed_[word] - 1)
        columns_[count++] = (static_cast<int>(word) * 64 + std::countr_zero(needed_[word])) * kBlock;
    BrightnessRows from;
    from.width = frame_.width();
    for (int k = -reach_; k <= reach_; ++k) {
      const YuvRow bytes = frame_.row(std::clamp(row + k, 0, frame_.height() - 1));
      from.row[static_cast<std::size_t>(k + reach_)] = bytes.y;
      from.step = bytes.y_step;
    }
    kernel_.gradients(from, reach_, std::span(columns_).first(count), gradients(row));
  }

  void add_points(int row, std::span<const PixelRun> runs) {
    std::size_t count = 0;
    for (const PixelRun& run : runs)
      for (int column = run.begin / kBlock * kBlock; column < run.end; column += kBlock) {
        if (count == 0 || columns_[count - 1] != column) {
          columns_[count] = column;
          inside_[count++] = 0;
        }
        const int from = std::max(run.begin - column, 0), until = std::min(run.end - column, kBlock);
        inside_[count - 1] |= ~std::uint32_t{0} << from & ~std::uint32_t{0} >> (kBlock - until);
      }
    const std::array<GradientRow, 3> rows{gradients(row + 2), gradients(row), gradients(row + 1)};
    kernel_.peaks(rows, least_, std::span(columns_).first(count), peaks_);
    for (std::size_t i = 0; i < count; ++i)
      for (std::uint32_t peaks = peaks_[i] & inside_[i]; peaks != 0; peaks &= peaks - 1)
        add_point(rows, columns_[i] + std::countr_zero(peaks), row);
  }

  void add_point(const std::array<GradientRow, 3>& rows, int column, int row) {
    const GradientRow& here = rows[1];
    const std::int16_t slope_x = here.x[column], slope_y = here.y[column];
    const bool steeper_down = std::abs(slope_y) > std::abs(slope_x);
    // Addresses are chosen, not ways: which axis it is cannot be foretold.
    const std::int32_t* const around[2][2] = {{here.squared + column - 1, here.squared + column + 1},
                                              {rows[0].squared + column, rows[2].squared + column}};
    const float before = log2_of(*around[steeper_down][0]), after = log2_of(*around[steeper_down][1]);
    // Steep and flat at once, the three logarithms may be equal, or the middle one not the largest, for want of digits:
    // then there is no better place than the pixel itself.
    const float bend = 2 * log2_of(here.squared[column]) - before - after;
    const float offset = bend > 0 ? std::clamp((after - before) / (2 * bend), -.5F, .5F) : 0;
    const float down = static_cast<float>(steeper_down) * offset;
    points_.push_back({static_cast<float>(column) + (offset - down), static_cast<float>(row) + down,
                       static_cast<std::int16_t>(column), static_cast<std::int16_t>(row), slope_x, slope_y,
                       here.squared[column]});
  }

  const GradientKernel& kernel_;
  const FrameView& frame_;
  std::span<const PixelRun> runs_;
  int reach_;
  std::int32_t least_;
  RecycledVector<std::uint64_t> needed_;
  RecycledVector<std::int16_t> slopes_;
  RecycledVector<std::int32_t> squares_;
  std::array<GradientRow, 3> rows_;
  RecycledVector<int> columns_;
  RecycledVector<std::uint32_t> inside_, peaks_;
  RecycledVector<EdgePoint> points_;
};

/// Links each point to one before and one behind it.
class Linker {
 public:
  explicit Linker(const RecycledVector<EdgePoint>& points)
      : points_(points), nearest_(points.size()), next_(points.size()), previous_(points.size()) {
    if (points.empty()) return;
    top_ = points.front().row;
    first_of_row_.resize(static_cast<std::size_t>(points.back().row - top_) + 4);
    std::int32_t i = 0;
    for (std::size_t k = 0; k < first_of_row_.size(); ++k) {
      while (i < count() && point(i).row < top_ + static_cast<int>(k)) ++i;
      first_of_row_[k] = i;
    }
    look_at_neighbors();
    for (i = 0; i < count(); ++i) {
      if (nearest_[index(i)][0].point == kNone || nearest_[index(i)][1].point == kNone) look_farther(i);
      const auto [behind, ahead] = nearest_[index(i)];
      link(i, ahead.point, ahead.distance);
      link(behind.point, i, behind.distance);
    }
  }

  RecycledVector<Contour> contours(const EdgeOptions& options) && {
    const std::int32_t strong = least_squared(options.high, options.filter_size_px / 2);
    RecycledVector<Contour> contours;
    RecycledVector<char> seen(points_.size(), false);
    for (std::int32_t i = 0; i < count(); ++i) {
      if (seen[index(i)]) continue;
      std::int32_t first = i;
      while (previous_[index(first)].point != kNone && previous_[index(first)].point != i)
        first = previous_[index(first)].point;
      const bool closed = previous_[index(first)].point != kNone;
      if (closed) first = i;
      bool is_strong = false;
      int length = 0;
      for (std::int32_t at = first; at != kNone && !seen[index(at)]; at = next_[index(at)].point) {
        seen[index(at)] = true;
        is_strong |= point(at).squared >= strong;
        ++length;
      }
      if (!is_strong || length < options.min_points) continue;
      Contour& contour = contours.emplace_back();
      contour.closed = closed;
      contour.points.reserve(static_cast<std::size_t>(length));
      for (std::int32_t at = first; length > 0; at = next_[index(at)].point, --length)
        contour.points.push_back({point(at).x, point(at).y});
    }
    return contours;
  }

 private:
  static constexpr std::int32_t kNone = -1;
  static constexpr int kFar = 2;  ///< Columns and rows in which neighbors are looked for at most. [px]

  /// Another point, and how far it is.
  struct Link {
    std::int32_t point = kNone;
    float distance = 1e9F;  ///< Squared. [px^2]
  };

  static std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }
  const EdgePoint& point(std::int32_t i) const { return points_[index(i)]; }
  std::int32_t count() const { return static_cast<std::int32_t>(points_.size()); }

  /// Lets `there` be what comes next to `here` along the edge, if it is nearer than what is known. Without branches:
  /// which side it is on, and whether it is the nearest, cannot be foretold.
  void offer(std::int32_t here, std::int32_t there, bool is_ahead, float distance) {
    Link& known = nearest_[index(here)][is_ahead];
    const bool nearer = distance < known.distance;
    known.point = nearer ? there : known.point;
    known.distance = nearer ? distance : known.distance;
  }

  /// A pair of points that are near each other.
  void look_at(std::int32_t i, std::int32_t j, bool both_ways) {
    const EdgePoint &a = point(i), &b = point(j);
    if (a.slope_x * b.slope_x + a.slope_y * b.slope_y <= 0) return;
    const float x = b.x - a.x, y = b.y - a.y, distance = x * x + y * y;
    // Ahead is where the brighter side is to the right.
    offer(i, j, x * a.slope_y > y * a.slope_x, distance);
    if (both_ways) offer(j, i, x * b.slope_y < y * b.slope_x, distance);
  }

  /// All pairs in neighboring pixels, each once.
  void look_at_neighbors() {
    for (std::size_t row = 0; row + 2 < first_of_row_.size(); ++row) {
      std::int32_t below = first_of_row_[row + 1];
      const std::int32_t end = below, below_end = first_of_row_[row + 2];
      for (std::int32_t i = first_of_row_[row]; i < end; ++i) {
        const int column = point(i).column;
        if (i + 1 < end && point(i + 1).column == column + 1) look_at(i, i + 1, true);
        while (below < below_end && point(below).column < column - 1) ++below;
        for (std::int32_t j = below; j < below_end && point(j).column <= column + 1; ++j) look_at(i, j, true);
      }
    }
  }

  /// A gap of a pixel is bridged.
  void look_farther(std::int32_t i) {
    const EdgePoint& here = point(i);
    const int last = static_cast<int>(first_of_row_.size()) - 2;
    for (int row = std::max(here.row - top_ - kFar, 0); row <= std::min(here.row - top_ + kFar, last); ++row) {
      const auto begin = points_.begin() + first_of_row_[static_cast<std::size_t>(row)],
                 end = points_.begin() + first_of_row_[static_cast<std::size_t>(row) + 1];
      auto there = std::partition_point(begin, end, [&](const EdgePoint& p) { return p.column < here.column - kFar; });
      for (; there != end && there->column <= here.column + kFar; ++there) {
        const auto j = static_cast<std::int32_t>(there - points_.begin());
        if (j != i) look_at(i, j, false);
      }
    }
  }

  /// Makes b follow a, unless either has a nearer one on that side already; takes the place of one farther off.
  void link(std::int32_t a, std::int32_t b, float distance) {
    if (a == kNone || b == kNone) return;
    Link &after = next_[index(a)], &before = previous_[index(b)];
    if (after.distance <= distance || before.distance <= distance) return;
    if (after.point != kNone) previous_[index(after.point)] = {};
    if (before.point != kNone) next_[index(before.point)] = {};
    after = {b, distance};
    before = {a, distance};
  }

  const RecycledVector<EdgePoint>& points_;
  RecycledVector<std::array<Link, 2>> nearest_;  ///< Behind and ahead.
  RecycledVector<Link> next_, previous_;
  int top_ = 0;
  RecycledVector<std::int32_t> first_of_row_;
};

}  // namespace

void EdgeOptions::check() const {
  if (filter_size_px != 3 && filter_size_px != 5 && filter_size_px != 7)
    throw Error("sub_pixel_edges.filter_size_px", "is " + std::to_string(filter_size_px) + ", must be 3, 5 or 7");
  if (!(low > 0)) throw Error("sub_pixel_edges.low", "is " + std::to_string(low) + ", must be > 0");
  if (!(high >= low)) throw Error("sub_pixel_edges.high", "is " + std::to_string(high) + ", must be >= low");
  if (min_points < 1) throw Error("sub_pixel_edges.min_points", "is " + std::to_string(min_points) + ", must be >= 1");
}

RecycledVector<EdgePoint> edge_points(const GradientKernel& kernel, const FrameView& frame, const Region& region,
                                      const EdgeOptions& options) {
  expects(is_supported(kernel.kernel), "a kernel this machine can run");
  const Region inner = clipped(region, {1, 1, frame.width() - 1, frame.height() - 1});
  return PointFinder(kernel, frame, inner, options).points();
}

RecycledVector<Contour> linked(const RecycledVector<EdgePoint>& points, const EdgeOptions& options) {
  return Linker(points).contours(options);
}

RecycledVector<Contour> sub_pixel_edges_by(const GradientKernel& kernel, const FrameView& frame, const Region& region,
                                           const EdgeOptions& options) {
  options.check();
  return linked(edge_points(kernel, frame, region, options), options);
}

RecycledVector<Contour> sub_pixel_edges(const FrameView& frame, const Region& region, const EdgeOptions& options) {
  return sub_pixel_edges_by(version_in_use(gradient_kernels()), frame, region, options);
}

}  // namespace tassilo
