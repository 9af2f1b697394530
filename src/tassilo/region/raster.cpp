#include "tassilo/region/raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "tassilo/base/contract.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/internal/coordinate.h"
#include "tassilo/region/internal/polygon_scan.h"

namespace tassilo {
namespace {

void paint(const Region& region, const PixelBox& window, std::uint8_t value, std::vector<std::uint8_t>& bytes) {
  const Region visible = clipped(region, window);
  for (const PixelRun& run : visible.runs()) {
    const auto first = static_cast<std::ptrdiff_t>(run.row - window.y0) * window.width() + run.begin - window.x0;
    std::fill_n(bytes.begin() + first, run.length(), value);
  }
}

/// The columns that a row of pixel centres shares with all points at most `radius` from a segment.
struct StrokeRow {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

  void add(double from, double to) {
    if (from > to) return;
    low = std::min(low, from);
    high = std::max(high, to);
  }
  void add_disc(PixelPoint middle, double radius, double y) {
    const double square = radius * radius - (y - middle.y) * (y - middle.y);
    if (square < 0) return;
    add(middle.x - std::sqrt(square), middle.x + std::sqrt(square));
  }
  /// The rectangle between the two end discs.
  void add_band(PixelPoint a, PixelPoint b, double radius, double y) {
    const PixelPoint along = b - a;
    const double length = norm(along);
    if (length == 0) return;
    double from = -std::numeric_limits<double>::infinity(), to = std::numeric_limits<double>::infinity();
    // low <= slope * (x - a.x) + offset <= high
    const auto narrow = [&](double slope, double offset, double least, double most) {
      if (slope == 0) {
        if (offset < least || offset > most) to = -std::numeric_limits<double>::infinity();
        return;
      }
      const double p = a.x + (least - offset) / slope, q = a.x + (most - offset) / slope;
      from = std::max(from, std::min(p, q));
      to = std::min(to, std::max(p, q));
    };
    narrow(along.x / length, along.y / length * (y - a.y), 0, length);
    narrow(-along.y / length, along.x / length * (y - a.y), -radius, radius);
    add(from, to);
  }
};

}  // namespace

Region region_of_bytes(ByteView image, const std::bitset<256>& values) {
  std::array<bool, 256> inside{};
  for (std::size_t value = 0; value < inside.size(); ++value) inside[value] = values[value];
  RunVector runs;
  for (int r = 0; r < image.height; ++r) {
    const auto bytes = image.row(r);
    for (auto begin = bytes.begin(); begin != bytes.end();) {
      begin = std::find_if(begin, bytes.end(), [&](std::uint8_t byte) { return inside[byte]; });
      if (begin == bytes.end()) break;
      const auto end = std::find_if(begin, bytes.end(), [&](std::uint8_t byte) { return !inside[byte]; });
      runs.push_back({to_coordinate(r), to_coordinate(static_cast<int>(begin - bytes.begin())),
                      to_coordinate(static_cast<int>(end - bytes.begin()))});
      begin = end;
    }
  }
  return Region::from_sorted(std::move(runs));
}

std::vector<Region> regions_of_labels(ByteView labels, int count) {
  expects(count >= 0 && count <= 256, "labels are bytes");
  std::vector<RunVector> runs(static_cast<std::size_t>(count));
  for (int r = 0; r < labels.height; ++r) {
    const auto bytes = labels.row(r);
    for (auto begin = bytes.begin(); begin != bytes.end();) {
      const std::uint8_t label = *begin;
      const auto end = std::find_if(begin, bytes.end(), [&](std::uint8_t byte) { return byte != label; });
      if (label < count)
        runs[label].push_back({to_coordinate(r), to_coordinate(static_cast<int>(begin - bytes.begin())),
                               to_coordinate(static_cast<int>(end - bytes.begin()))});
      begin = end;
    }
  }
  std::vector<Region> regions;
  regions.reserve(runs.size());
  for (RunVector& of_label : runs) regions.push_back(Region::from_sorted(std::move(of_label)));
  return regions;
}

std::vector<std::uint8_t> to_mask(const Region& region, const PixelBox& window, std::uint8_t inside) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(window.area()), 0);
  paint(region, window, inside, bytes);
  return bytes;
}

std::vector<std::uint8_t> to_labels(std::span<const Region> regions, const PixelBox& window) {
  expects(regions.size() <= 256, "labels are bytes");
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(window.area()), 0);
  for (std::size_t k = 0; k < regions.size(); ++k) paint(regions[k], window, static_cast<std::uint8_t>(k), bytes);
  return bytes;
}

Region region_from_polygon(std::span<const PixelPoint> vertices, const PixelBox& window) {
  PolygonScan scan(window);
  scan.add(vertices);
  return std::move(scan).region();
}

Region region_from_stroke(std::span<const PixelPoint> way, double radius, const PixelBox& window) {
  expects(radius >= 0, "region_from_stroke: radius >= 0");
  RunVector runs;
  for (std::size_t i = 0; i < way.size(); ++i) {
    const PixelPoint a = way[i], b = way[std::min(i + 1, way.size() - 1)];
    if (i > 0 && i + 1 == way.size()) break;  // the last point ends the segment before
    const double top = std::max(std::ceil(std::min(a.y, b.y) - radius), double(window.y0));
    const double bottom = std::min(std::floor(std::max(a.y, b.y) + radius), double(window.y1 - 1));
    for (double y = top; y <= bottom; ++y) {
      StrokeRow row;
      row.add_disc(a, radius, y);
      row.add_disc(b, radius, y);
      row.add_band(a, b, radius, y);
      const double first = std::max(std::ceil(row.low), double(window.x0));
      const double last = std::min(std::floor(row.high), double(window.x1 - 1));
      if (first <= last)
        runs.push_back({to_coordinate(static_cast<int>(y)), to_coordinate(static_cast<int>(first)),
                        to_coordinate(static_cast<int>(last) + 1)});
    }
  }
  return Region::from_runs(std::move(runs));
}

}  // namespace tassilo
