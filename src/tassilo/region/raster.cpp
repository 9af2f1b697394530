#include "tassilo/region/raster.h"

#include <algorithm>
#include <array>
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

}  // namespace tassilo
