#include "tassilo/region/raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <utility>

#include "tassilo/base/contract.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/internal/coordinate.h"

namespace tassilo {
namespace {

void paint(const Region& region, const PixelBox& window, std::uint8_t value, std::vector<std::uint8_t>& bytes) {
  const Region visible = clipped(region, window);
  for (const PixelRun& run : visible.runs()) {
    const auto first = static_cast<std::ptrdiff_t>(run.row - window.y0) * window.width() + run.begin - window.x0;
    std::fill_n(bytes.begin() + first, run.length(), value);
  }
}

/// Where an edge passes through a row of pixel centres.
struct Crossing {
  int row = 0;
  double column = 0;

  friend auto operator<=>(const Crossing&, const Crossing&) = default;
};

/// Rows and columns from the smallest whole number >= value, cut to [low, high].
int ceil_within(double value, int low, int high) {
  return static_cast<int>(std::clamp(std::ceil(value), static_cast<double>(low), static_cast<double>(high)));
}

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
  if (vertices.size() < 3 || window.empty()) return {};
  RecycledVector<Crossing> crossings;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    PixelPoint top = vertices[i], bottom = vertices[(i + 1) % vertices.size()];
    expects(std::isfinite(top.x) && std::isfinite(top.y), "polygon vertices are finite");
    // The same arithmetic whichever way the edge is walked: polygons that share it get the same crossings.
    if (bottom.y < top.y) std::swap(top, bottom);
    const int first = ceil_within(top.y, window.y0, window.y1), end = ceil_within(bottom.y, window.y0, window.y1);
    for (int row = first; row < end; ++row) {
      const double share = (row - top.y) / (bottom.y - top.y);
      crossings.push_back({row, top.x + share * (bottom.x - top.x)});
    }
  }
  std::ranges::sort(crossings, [](const Crossing& a, const Crossing& b) { return a < b; });
  // Every row has an even number of crossings, as a closed outline comes back.
  RunVector runs;
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
    runs.push_back({to_coordinate(crossings[i].row),
                    to_coordinate(ceil_within(crossings[i].column, window.x0, window.x1)),
                    to_coordinate(ceil_within(crossings[i + 1].column, window.x0, window.x1))});
  return Region::from_runs(std::move(runs));
}

}  // namespace tassilo
