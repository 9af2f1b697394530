#include "tassilo/region/distance.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <span>

#include "tassilo/base/contract.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/internal/row_sweep.h"

namespace tassilo {
namespace {

constexpr int kMostExtent = 32768;

// Each metric says how far a row's pixel is that lies `steps` columns away (g in the paper, there along columns), and
// from which row on a later row's pixel is the nearer one.
struct EuclideanSquared {
  static std::int64_t distance(std::int64_t rows, std::int64_t steps) { return rows * rows + steps * steps; }
  static std::int64_t last_of_first(std::int64_t i, std::int64_t gi, std::int64_t u, std::int64_t gu) {
    const std::int64_t above = u * u - i * i + gu * gu - gi * gi, below = 2 * (u - i);
    return above >= 0 ? above / below : -((-above + below - 1) / below);
  }
};
struct Chessboard {
  static std::int64_t distance(std::int64_t rows, std::int64_t steps) { return std::max(std::abs(rows), steps); }
  static std::int64_t last_of_first(std::int64_t i, std::int64_t gi, std::int64_t u, std::int64_t gu) {
    const std::int64_t middle = (i + u) >> 1;
    return gi <= gu ? std::max(i + gu, middle) : std::min(u - gi, middle);
  }
};
struct CityBlock {
  static constexpr std::int64_t kFar = 1 << 20;  // beyond any row
  static std::int64_t distance(std::int64_t rows, std::int64_t steps) { return std::abs(rows) + steps; }
  static std::int64_t last_of_first(std::int64_t i, std::int64_t gi, std::int64_t u, std::int64_t gu) {
    if (gu >= gi + u - i) return kFar;
    if (gi > gu + u - i) return -kFar;
    return (gu - gi + u + i) >> 1;
  }
};

/// Rows that hold a pixel to reach, and how many columns it is away from each column of the window.
struct RowDistances {
  RecycledVector<int> rows;                ///< Rising.
  RecycledVector<std::int32_t> distances;  ///< [row][column of the window]
};

/// Appends the distances along a row of runs, at least one, to `out`.
void append_row(std::span<const PixelRun> runs, const PixelBox& window, RecycledVector<std::int32_t>& out) {
  std::size_t next = 0;  // the first run that ends beyond the column
  for (int c = window.x0; c < window.x1; ++c) {
    while (next < runs.size() && runs[next].end <= c) ++next;
    int nearest = kMostExtent;
    if (next < runs.size()) nearest = std::max(0, runs[next].begin - c);
    if (next > 0) nearest = std::min(nearest, c - runs[next - 1].end + 1);
    out.push_back(nearest);
  }
}

RowDistances row_distances(const Region& region, const PixelBox& window) {
  const auto runs = region.runs();
  RowDistances result;
  for (std::size_t i = 0; i < runs.size();) {
    const std::size_t end = row_end(runs, i);
    result.rows.push_back(runs[i].row);
    append_row(runs.subspan(i, end - i), window, result.distances);
    i = end;
  }
  return result;
}

/// The lower envelope of all rows' distances, column by column.
template <class Metric>
void fill_columns(const RowDistances& along, DistanceImage& image) {
  const auto width = static_cast<std::size_t>(image.window.width());
  struct Piece {
    std::size_t row;     ///< Index of the row that is nearest ...
    std::int64_t first;  ///< ... from this row of the plane on.
  };
  RecycledVector<Piece> pieces(along.rows.size());
  for (std::size_t c = 0; c < width; ++c) {
    const auto steps = [&](std::size_t k) -> std::int64_t { return along.distances[k * width + c]; };
    std::size_t count = 0;
    for (std::size_t k = 0; k < along.rows.size(); ++k) {
      const auto is_nearer_at = [&](std::size_t other, std::int64_t row) {
        return Metric::distance(row - along.rows[other], steps(other)) >
               Metric::distance(row - along.rows[k], steps(k));
      };
      while (count > 0 && is_nearer_at(pieces[count - 1].row, pieces[count - 1].first)) --count;
      if (count == 0) {
        pieces[count++] = {k, image.window.y0};
        continue;
      }
      const std::size_t last = pieces[count - 1].row;
      const std::int64_t first = 1 + Metric::last_of_first(along.rows[last], steps(last), along.rows[k], steps(k));
      if (first < image.window.y1) pieces[count++] = {k, first};
    }
    for (int row = image.window.y1 - 1; row >= image.window.y0; --row) {
      while (pieces[count - 1].first > row) --count;
      const std::size_t k = pieces[count - 1].row;
      image.values[static_cast<std::size_t>(row - image.window.y0) * width + c] =
          static_cast<std::int32_t>(Metric::distance(row - along.rows[k], steps(k)));
    }
  }
}

DistanceImage distance_image(const Region& region, const PixelBox& window, DistanceMetric metric) {
  DistanceImage image{window, {}};
  image.values.assign(static_cast<std::size_t>(window.area()), DistanceImage::kNone);
  if (window.empty() || region.empty()) return image;
  const PixelBox all = hull(window, bounding_box(region));
  expects(all.width() <= kMostExtent && all.height() <= kMostExtent,
          "window and region extend over 32768 pixels at most");
  const RowDistances along = row_distances(region, window);
  switch (metric) {
    case DistanceMetric::euclidean_squared:
      fill_columns<EuclideanSquared>(along, image);
      break;
    case DistanceMetric::chessboard:
      fill_columns<Chessboard>(along, image);
      break;
    case DistanceMetric::city_block:
      fill_columns<CityBlock>(along, image);
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
