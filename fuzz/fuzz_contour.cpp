// Contours of any region and frame: their points are finite and where they may be, none is missing or there twice, and
// all kernels find the same.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>
#include <utility>

#include "bytes.h"
#include "regions.h"
#include "tassilo/base/contract.h"
#include "tassilo/contour/boundary_contours.h"
#include "tassilo/contour/contour.h"
#include "tassilo/contour/skeleton_contours.h"
#include "tassilo/contour/sub_pixel_edges.h"
#include "tassilo/image/frame.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/components.h"
#include "tassilo/region/features.h"
#include "tassilo/region/residue.h"
#include "tassilo/region/skeleton.h"

using namespace tassilo;

namespace {

std::pair<int, int> pixel_at(PixelPoint p) { return {static_cast<int>(p.y), static_cast<int>(p.x)}; }

void check_boundaries(const Region& region) {
  const auto borders = boundary_contours(region);
  Pixels seen;
  std::int64_t inner = 0;
  double outer_length = 0;
  for (const BoundaryContour& border : borders) {
    const auto& points = border.contour.points;
    expects(border.contour.closed && !points.empty(), "borders are closed");
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double step = distance(points[i], points[(i + 1) % points.size()]);
      expects(points.size() == 1 || step == 1 || step == std::numbers::sqrt2, "from pixel to neighbor");
      seen.insert(pixel_at(points[i]));
    }
    inner += border.hole;
    if (!border.hole) outer_length += length(border.contour);
  }
  expects(seen == pixels_of(inner_boundary(region)), "borders have all pixels of the boundary");
  expects(inner == hole_count(region), "a border a hole");
  expects(std::ssize(borders) - inner == label_runs(region).count, "a border a part");
  expects(std::abs(outer_length - contour_length(region)) < 1e-6, "as long as the region's contour");
}

/// Of any region: of a thick one nearly all is junction.
void check_stretches(const Region& region, int min_points) {
  const SkeletonContours result = skeleton_contours(region);
  Pixels left = pixels_of(region), in_junctions;
  for (const Junction& junction : result.junctions) {
    expects(!junction.pixels.empty(), "junctions have pixels");
    for (const PixelPoint point : junction.pixels) {
      expects(left.erase(pixel_at(point)) == 1, "a pixel is in one junction");
      in_junctions.insert(pixel_at(point));
    }
  }
  const auto is_of = [&](int junction, PixelPoint point) {
    const auto& pixels = result.junctions.at(static_cast<std::size_t>(junction)).pixels;
    return std::ranges::count(pixels, point) == 1;
  };
  std::int64_t longer = 0;
  for (const SkeletonContour& stretch : result.contours) {
    const auto& points = stretch.contour.points;
    expects(!points.empty(), "contours have points");
    longer += std::ssize(points) >= min_points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      expects(i == 0 || distance(points[i - 1], points[i]) < 1.5, "from pixel to neighbor");
      const bool may = (i == 0 && stretch.from >= 0) || (i + 1 == points.size() && stretch.to >= 0);
      expects(in_junctions.contains(pixel_at(points[i])) == may, "junctions are at ends only");
      expects(may || left.erase(pixel_at(points[i])) == 1, "a pixel is in one contour");
    }
    expects(stretch.from < 0 || is_of(stretch.from, points.front()), "a contour begins at its junction");
    expects(stretch.to < 0 || is_of(stretch.to, points.back()), "a contour ends at its junction");
    expects(!stretch.contour.closed || (stretch.from < 0 && stretch.to < 0), "closed ones meet no junction");
  }
  expects(left.empty(), "every pixel is in a contour or a junction");
  expects(std::ssize(skeleton_contours(region, {.min_points = min_points}).contours) == longer, "short ones left out");
}

FrameBuffer next_frame(Bytes& bytes) {
  constexpr PixelFormat kFormats[] = {PixelFormat::yuyv422, PixelFormat::uyvy422, PixelFormat::yuv422p,
                                      PixelFormat::yuv420p, PixelFormat::nv12};
  const int width = bytes.below(150), height = bytes.below(12);
  FrameBuffer buffer = make_frame_buffer(kFormats[bytes.below(5)], width, height, ColorRange::full);
  // A ramp, black and white, or anything.
  const int ramp = bytes.below(64), contrast = 1 + bytes.below(255);
  for (int r = 0; r < height; ++r)
    for (int c = 0; c < width; ++c) {
      const YuvRow row = buffer.frame.view.row(r);
      const int value = std::min(ramp * c, 255) + (bytes.next() * contrast & 255);
      buffer.planes[0][row.y + c * row.y_step - buffer.planes[0]] = static_cast<std::uint8_t>(std::min(value, 255));
    }
  return buffer;
}

void check_edges(const FrameView& frame, const Region& region, Bytes& bytes) {
  EdgeOptions options;
  options.filter_size_px = 3 + 2 * bytes.below(3);
  options.low = (1 + bytes.next()) / 8.;
  options.high = options.low + bytes.next() / 8.;
  options.min_points = 1 + bytes.below(5);
  const auto edges = sub_pixel_edges(frame, region, options);
  std::set<std::pair<double, double>> seen;
  for (const Contour& edge : edges) {
    expects(std::ssize(edge.points) >= options.min_points, "short edges are left out");
    for (std::size_t i = 0; i < edge.points.size(); ++i) {
      const PixelPoint p = edge.points[i];
      expects(std::isfinite(p.x) && std::isfinite(p.y), "points are finite");
      expects(p.x >= .5 && p.y >= .5 && p.x <= frame.width() - 1.5 && p.y <= frame.height() - 1.5, "in the frame");
      const int c = static_cast<int>(std::floor(p.x)), r = static_cast<int>(std::floor(p.y));
      expects(contains(region, c, r) || contains(region, c + 1, r) || contains(region, c, r + 1), "in the region");
      expects(i == 0 || distance(edge.points[i - 1], p) < 4.3, "linked to one nearby");
    }
  }
  with_every_kernel([&] {
    const auto same = sub_pixel_edges(frame, region, options);
    expects(std::ranges::equal(
                same, edges,
                [](const Contour& a, const Contour& b) { return a.closed == b.closed && a.points == b.points; }),
            "kernels find the same edges");
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  const Region region = next_region(bytes, 24, 40);
  check_boundaries(region);
  const int min_points = 1 + bytes.below(6);
  check_stretches(region, min_points);
  check_stretches(skeleton(region), min_points);
  const int left = bytes.below(120);
  const bool everywhere = bytes.below(2) == 0;
  const FrameBuffer buffer = next_frame(bytes);
  const FrameView& frame = buffer.frame.view;
  check_edges(frame,
              everywhere ? Region::from_box({0, 0, frame.width(), frame.height()}) : translated(region, {left, 4}),
              bytes);
  return 0;
}
