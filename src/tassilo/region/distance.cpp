#include "tassilo/region/distance.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <span>

#include "tassilo/base/contract.h"
#include "tassilo/region/algebra.h"

namespace tassilo {
namespace {

constexpr int kMostExtent = 32768;

/// Eight columns of short distances, as wide as the registers every machine has.
using Lanes = std::int16_t __attribute__((vector_size(16)));

// The two metrics that are not squared: how far a row's pixel is that lies `steps` columns away (g in the paper, there
// along columns), and the last row at which a row's pixel i is not farther than that of a later row u.
struct Chessboard {
  static std::int16_t near(int steps) { return static_cast<std::int16_t>(steps); }
  static Lanes farther(Lanes steps, Lanes rows) { return steps > rows ? steps : rows; }
  static int distance(int rows, int steps) { return std::max(std::abs(rows), steps); }
  static int last_of_first(int i, int gi, int u, int gu) {
    const int middle = (i + u) >> 1;
    return gi <= gu ? std::max(i + gu, middle) : std::min(u - gi, middle);
  }
};
struct CityBlock {
  static std::int16_t near(int steps) { return static_cast<std::int16_t>(steps); }
  static Lanes farther(Lanes steps, Lanes rows) { return steps + rows; }
  static constexpr int kFar = 1 << 20;  // beyond any row
  static int distance(int rows, int steps) { return std::abs(rows) + steps; }
  static int last_of_first(int i, int gi, int u, int gu) {
    if (gu >= gi + u - i) return kFar;
    if (gi > gu + u - i) return -kFar;
    return (gu - gi + u + i) >> 1;
  }
};

/// Columns that are worked on together: as many as a cache line holds, since rows are read and written across.
constexpr std::size_t kStrip = 16;
using StripRow = std::array<std::int32_t, kStrip>;

/// The rows that hold a pixel to reach, rising, and how far along its row each is from a strip's columns.
struct Strip {
  std::span<const int> rows;
  std::span<const StripRow> steps;
  PixelBox window;
};

/// The lower envelope of all rows' distances in one column of the strip.
template <class Metric>
class Envelope {
 public:
  static std::int16_t near(int steps) { return Metric::near(steps); }
  static Lanes farther(Lanes steps, Lanes rows) { return Metric::farther(steps, rows); }

  explicit Envelope(std::size_t rows) : pieces_(rows) {}

  void fill(const Strip& strip, std::size_t column, std::span<StripRow> to) {
    const PixelBox& window = strip.window;
    std::size_t count = 0;
    for (std::size_t k = 0; k < strip.rows.size(); ++k) {
      const int row = strip.rows[k], steps = strip.steps[k][column];
      while (count > 0 && pieces_[count - 1].distance_at(pieces_[count - 1].first) >
                              Metric::distance(pieces_[count - 1].first - row, steps))
        --count;
      const int first = count == 0
                            ? window.y0
                            : 1 + Metric::last_of_first(pieces_[count - 1].row, pieces_[count - 1].steps, row, steps);
      if (first < window.y1) pieces_[count++] = {row, steps, first};
    }
    for (int row = window.y1 - 1; row >= window.y0; --row) {
      while (pieces_[count - 1].first > row) --count;
      to[static_cast<std::size_t>(row - window.y0)][column] = pieces_[count - 1].distance_at(row);
    }
  }

 private:
  struct Piece {
    int row, steps;  ///< Which pixel is nearest ...
    int first;       ///< ... from this row on.
    int distance_at(int at) const { return Metric::distance(at - row, steps); }
  };
  RecycledBuffer<Piece> pieces_;
};

/// The same for squares. With F = row^2 + steps^2 the distance of row r from a row's pixel is r^2 + F - 2 r row: the
/// pixel that is nearest is a corner of the lower convex hull of the points (row, F), which takes no division to find,
/// and the corners serve the rows in their order.
class SquaredEnvelope {
 public:
  static std::int16_t near(int steps) { return static_cast<std::int16_t>(steps * steps); }
  static Lanes farther(Lanes squares, Lanes squared_rows) { return squares + squared_rows; }

  explicit SquaredEnvelope(std::size_t rows) : corners_(rows) {}

  void fill(const Strip& strip, std::size_t column, std::span<StripRow> to) {
    const int y0 = strip.window.y0;
    Corner* const first = corners_.data();
    Corner* end = first;
    for (std::size_t k = 0; k < strip.rows.size(); ++k) {
      const std::int64_t row = strip.rows[k] - y0, steps = strip.steps[k][column];
      const Corner corner{row, row * row + steps * steps, steps};
      while (end - first >= 2 && !turns_left(end[-2], end[-1], corner)) --end;
      *end++ = corner;
    }
    const Corner* nearest = first;
    for (std::size_t r = 0; r < to.size(); ++r) {
      const auto row = static_cast<std::int64_t>(r);
      while (nearest + 1 < end && nearest[1].height - nearest->height <= 2 * row * (nearest[1].row - nearest->row))
        ++nearest;
      to[r][column] =
          static_cast<std::int32_t>((row - nearest->row) * (row - nearest->row) + nearest->steps * nearest->steps);
    }
  }

 private:
  struct Corner {
    std::int64_t row, height, steps;  ///< Rows from the window's first; F; columns away.
  };
  static bool turns_left(const Corner& a, const Corner& b, const Corner& c) {
    return (b.height - a.height) * (c.row - b.row) < (c.height - b.height) * (b.row - a.row);
  }
  RecycledBuffer<Corner> corners_;
};

/// Distances of a strip's columns where none is longer than `kReach`: rows up and down are tried one after the other
/// until no farther one can be nearer, eight columns at once. Where regions are ragged that is over soon, and nothing
/// has to be predicted as on an envelope, which is better for what is smooth and large.
template <class Columns>
class Nearby {
 public:
  explicit Nearby(const PixelBox& window)
      : y0_(window.y0 - kReach), steps_(static_cast<std::size_t>(window.height() + 2 * kReach)) {}

  /// False where a pixel has nothing within reach; `to` is then worth nothing.
  bool fill(const Strip& strip, std::span<StripRow> to) {
    copy_steps(strip);
    for (std::size_t r = 0; r < to.size(); ++r) {
      const Row* const here = steps_.data() + r + kReach;
      Lanes left = here->left, right = here->right;
      for (int rows = 0; any(left > Columns::near(rows), right > Columns::near(rows));) {
        if (++rows > kReach) return false;
        const Lanes step = Lanes{} + Columns::near(rows);
        for (const Row* const other : {here - rows, here + rows}) {
          const Lanes other_left = Columns::farther(other->left, step);
          const Lanes other_right = Columns::farther(other->right, step);
          left = other_left < left ? other_left : left;
          right = other_right < right ? other_right : right;
        }
      }
      for (std::size_t i = 0; i < kStrip / 2; ++i) {
        to[r][i] = left[i];
        to[r][i + kStrip / 2] = right[i];
      }
    }
    return true;
  }

 private:
  static constexpr int kReach = 32;  ///< Then an envelope takes as long.
  struct Row {
    Lanes left, right;
  };

  /// Every row of the window and what is in reach of it; out of reach is what it says, not how far.
  void copy_steps(const Strip& strip) {
    const Lanes none = Lanes{} + Columns::near(kReach + 1);
    std::fill_n(steps_.data(), steps_.size(), Row{none, none});
    for (std::size_t k = 0; k < strip.rows.size(); ++k) {
      const int row = strip.rows[k] - y0_;
      if (row < 0 || row >= static_cast<int>(steps_.size())) continue;
      std::array<std::int16_t, kStrip> near;
      for (std::size_t i = 0; i < kStrip; ++i) near[i] = Columns::near(std::min(strip.steps[k][i], kReach + 1));
      std::memcpy(&steps_[static_cast<std::size_t>(row)], near.data(), sizeof near);
    }
  }

  static bool any(Lanes left, Lanes right) {
    std::int64_t bits[2];
    const Lanes both = left | right;
    std::memcpy(bits, &both, sizeof bits);
    return (bits[0] | bits[1]) != 0;
  }

  int y0_;                     ///< Row of the first of ...
  RecycledBuffer<Row> steps_;  ///< ... how near the nearest pixel of each row is, out of reach where there is none.
};

/// How far along a row of runs, at least one, the nearest pixel is from each column of the window.
void fill_row(std::span<const PixelRun> runs, const PixelBox& window, std::int32_t* to) {
  int done = window.x0;  // the first column that waits for its distance
  int left = window.x0 - kMostExtent;
  for (const PixelRun& run : runs) {
    const int begin = std::clamp<int>(run.begin, done, window.x1), end = std::clamp<int>(run.end, begin, window.x1);
    for (int c = done; c < begin; ++c) to[c - window.x0] = std::min(c - left, run.begin - c);
    std::fill(to + (begin - window.x0), to + (end - window.x0), 0);
    done = end;
    left = run.end - 1;
  }
  for (int c = done; c < window.x1; ++c) to[c - window.x0] = c - left;
}

/// Which rows hold a run.
RecycledVector<int> rows_of(const Region& region) {
  RecycledVector<int> rows;
  for (const PixelRun& run : region.runs())
    if (rows.empty() || rows.back() != run.row) rows.push_back(run.row);
  return rows;
}

template <class Columns>
void fill_image(const Region& region, DistanceImage& image) {
  const auto runs = region.runs();
  const RecycledVector<int> rows = rows_of(region);
  const auto width = static_cast<std::size_t>(image.window.width());
  // One row after the other into strips, as rows lie in the runs; strip after strip down the columns.
  const std::size_t strips = (width + kStrip - 1) / kStrip;
  RecycledBuffer<StripRow> steps(strips * rows.size());
  RecycledBuffer<std::int32_t> along(strips * kStrip);
  std::fill(along.data() + width, along.data() + along.size(), 0);
  for (std::size_t i = 0, k = 0; i < runs.size(); ++k) {
    const std::size_t end = row_end(runs, i);
    fill_row(runs.subspan(i, end - i), image.window, along.data());
    for (std::size_t s = 0; s < strips; ++s)
      std::copy_n(along.data() + s * kStrip, kStrip, steps[s * rows.size() + k].data());
    i = end;
  }
  Nearby<Columns> nearby(image.window);
  Columns columns(rows.size());
  RecycledBuffer<StripRow> to(static_cast<std::size_t>(image.window.height()));
  for (std::size_t s = 0; s < strips; ++s) {
    const Strip strip{rows, {steps.data() + s * rows.size(), rows.size()}, image.window};
    const std::size_t first = s * kStrip, used = std::min(kStrip, width - first);
    const std::span<StripRow> strip_to(to.data(), to.size());
    if (!nearby.fill(strip, strip_to))
      for (std::size_t column = 0; column < used; ++column) columns.fill(strip, column, strip_to);
    for (std::size_t r = 0; r < to.size(); ++r)
      std::copy_n(to[r].data(), used, image.values.data() + r * width + first);
  }
}

DistanceImage distance_image(const Region& region, const PixelBox& window, DistanceMetric metric) {
  DistanceImage image{window, {}};
  if (window.empty() || region.empty()) {
    image.values.assign(static_cast<std::size_t>(window.area()), DistanceImage::kNone);
    return image;
  }
  const PixelBox all = hull(window, bounding_box(region));
  expects(all.width() <= kMostExtent && all.height() <= kMostExtent,
          "window and region extend over 32768 pixels at most");
  image.values.resize(static_cast<std::size_t>(window.area()));
  switch (metric) {
    case DistanceMetric::euclidean_squared:
      fill_image<SquaredEnvelope>(region, image);
      break;
    case DistanceMetric::chessboard:
      fill_image<Envelope<Chessboard>>(region, image);
      break;
    case DistanceMetric::city_block:
      fill_image<Envelope<CityBlock>>(region, image);
      break;
  }
  return image;
}

}  // namespace

DistanceImage distance_to(const Region& region, const PixelBox& window, DistanceMetric metric) {
  return distance_image(region, window, metric);
}

DistanceImage distance_inside(const Region& region, const PixelBox& window, DistanceMetric metric) {
  DistanceImage image{window, {}};
  image.values.assign(static_cast<std::size_t>(window.area()), 0);
  const PixelBox box = bounding_box(region), seen = intersection(box, window);
  if (seen.empty()) return image;
  // A ring of background around the region is enough: whatever lies beyond is farther away than the ring.
  const PixelBox ring{box.x0 - 1, box.y0 - 1, box.x1 + 1, box.y1 + 1};
  const DistanceImage inside = distance_image(complement(region, ring), seen, metric);
  const auto width = static_cast<std::ptrdiff_t>(seen.width());
  for (int row = seen.y0; row < seen.y1; ++row) {
    const auto from = inside.values.begin() + (row - seen.y0) * width;
    const auto to = static_cast<std::ptrdiff_t>(row - window.y0) * window.width() + seen.x0 - window.x0;
    std::copy(from, from + width, image.values.begin() + to);
  }
  return image;
}

}  // namespace tassilo
