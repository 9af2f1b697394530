// Numbers that describe a region equal their definitions on its pixels, and what one operator says fits what the others
// say.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "bytes.h"
#include "regions.h"
#include "tassilo/base/contract.h"
#include "tassilo/geometry/point.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/enclosing.h"
#include "tassilo/region/feature_table.h"
#include "tassilo/region/features.h"
#include "tassilo/region/feret.h"
#include "tassilo/region/gray.h"
#include "tassilo/region/inscribed.h"
#include "tassilo/region/raster.h"
#include "tassilo/region/region.h"
#include "tassilo/region/residue.h"
#include "tassilo/region/roundness.h"
#include "tassilo/region/select.h"

using namespace tassilo;

namespace {

constexpr double kPi = std::numbers::pi;

bool near(double a, double b, double spare = 1e-6) { return std::abs(a - b) <= spare * std::max(1., std::abs(a)); }

std::vector<PixelPoint> centers_of(const Region& region) {
  std::vector<PixelPoint> centers;
  for (const PixelRun& run : region.runs())
    for (int c = run.begin; c < run.end; ++c) centers.push_back({double(c), double(run.row)});
  return centers;
}

/// Central second moments of weighted points.
struct PlainMoments {
  double weight = 0;
  PixelPoint center;
  SecondMoments second;
};
template <class Weight>
PlainMoments plain_moments(const std::vector<PixelPoint>& points, Weight weight) {
  PlainMoments m;
  for (const PixelPoint p : points) {
    m.weight += weight(p);
    m.center = m.center + weight(p) * p;
  }
  if (m.weight == 0) return {};
  m.center = (1 / m.weight) * m.center;
  for (const PixelPoint p : points) {
    const PixelPoint d = p - m.center;
    m.second.rr += weight(p) * d.y * d.y / m.weight;
    m.second.rc += weight(p) * d.y * d.x / m.weight;
    m.second.cc += weight(p) * d.x * d.x / m.weight;
  }
  return m;
}
bool near(const PlainMoments& a, PixelPoint center, const SecondMoments& second) {
  return distance(a.center, center) < 1e-6 && near(a.second.rr, second.rr) && near(a.second.rc, second.rc) &&
         near(a.second.cc, second.cc);
}
void check_axes(const EquivalentEllipse& ellipse) {
  expects(ellipse.ra >= ellipse.rb && ellipse.rb >= 0 && std::isfinite(ellipse.ra), "half axes by size");
  expects(ellipse.phi > -kPi / 2 - 1e-12 && ellipse.phi <= kPi / 2, "a direction without a sense");
}

void check_shape(const Region& region, const std::vector<PixelPoint>& points) {
  const ShapeFeatures shape = shape_features(region);
  expects(shape.area == std::ssize(points) && shape.box == bounding_box(region), "area and box");
  expects(near(plain_moments(points, [](PixelPoint) { return 1.; }), shape.center, shape.moments), "moments");
  check_axes(shape.ellipse);
  double farthest = 0;
  for (const PixelPoint p : points) farthest = std::max(farthest, distance(p, shape.center));
  const double circle = kPi * farthest * farthest;
  expects(near(shape.circularity, farthest > 0 ? std::min(1., double(shape.area) / circle) : 1), "circularity");
  const double way = orientation(region) - shape.ellipse.phi;
  expects(near(std::abs(std::sin(way)), 0) && std::abs(orientation(region)) <= kPi, "one of the axis's two ways");

  std::vector<double> distances;
  for (const PixelPoint p : centers_of(inner_boundary(region))) distances.push_back(distance(p, shape.center));
  double mean = 0, variance = 0;
  for (const double d : distances) mean += d / double(distances.size());
  for (const double d : distances) variance += (d - mean) * (d - mean) / double(distances.size());
  const Roundness round = roundness(region);
  expects(near(round.distance, mean) && near(round.deviation, std::sqrt(variance), 1e-4), "distances of the boundary");
  expects(round.roundness >= 0 && round.roundness <= 1, "roundness is a share");
}

void check_extent(const Region& region, double angle) {
  const auto hull = convex_hull(region);
  double longest = 0, low = 1e9, high = -1e9;
  for (const PixelPoint a : hull) {
    for (const PixelPoint b : hull) longest = std::max(longest, distance(a, b));
    const double along = a.x * std::cos(angle) - a.y * std::sin(angle);
    low = std::min(low, along);
    high = std::max(high, along);
  }
  const Diameter across = diameter(region);
  const FeretDiameters feret = feret_diameters(region);
  expects(near(across.length, longest) && near(distance(across.first, across.second), longest), "diameter");
  expects(near(feret.max.length, longest), "the largest extent is the diameter");
  const double extent = feret_diameter(region, angle);
  expects(near(extent, high - low), "extent along a direction");
  expects(extent <= feret.max.length + 1e-9 && extent >= feret.min.length - 1e-9, "extents lie between");
  for (const CaliperWidth& width : {feret.min, feret.max}) {
    expects(near(feret_diameter(region, width.angle), width.length), "extents along their own directions");
    expects(width.angle > -kPi / 2 && width.angle <= kPi / 2, "a direction without a sense");
  }
  const Circle around = smallest_circle(region);
  expects(around.radius >= longest / 2 - 1e-9 && around.radius <= longest / std::numbers::sqrt3 + 1e-9,
          "Jung's theorem");
  const RotatedRectangle box = smallest_rectangle(region);
  expects(box.half_length >= box.half_width && box.half_width >= 0, "sides by size");
  expects(near(2 * box.half_width, feret_diameter(region, box.phi + kPi / 2)), "as wide as the region");
  expects(near(2 * box.half_length, feret_diameter(region, box.phi)), "as long as the region");
  const double length = contour_length(region);
  expects(length >= 0 && compactness(region) >= 1 && convexity(region) <= 1 && convexity(region) > 0,
          "in their ranges");
  expects(rectangularity(region) >= 0 && rectangularity(region) <= 1, "rectangularity is a share");
}

/// Every feature alone, several together in any order, and moved to another place.
void check_table(const Region& region, Bytes& bytes) {
  std::vector<Feature> features;
  for (const FeatureInfo& info : all_features()) {
    expects(feature_named(info.name) == info.feature && to_string(info.feature) == info.name, "names are read");
    features.push_back(info.feature);
  }
  for (int swaps = 8; swaps > 0; --swaps)
    std::swap(features[static_cast<std::size_t>(bytes.next()) % features.size()],
              features[static_cast<std::size_t>(bytes.next()) % features.size()]);
  const auto together = feature_values(region, features);
  FeatureMeter meter(region);
  std::vector<FeatureRange> ranges;
  for (std::size_t i = 0; i < features.size(); ++i) {
    expects(std::isfinite(together[i]), "features are finite");
    expects(together[i] == feature_value(region, features[i]) && together[i] == meter(features[i]), "each as all");
    expects(!(together[i] == 0 && std::signbit(together[i])), "zero has no sign");
    ranges.push_back({features[i], together[i], together[i]});
  }
  expects(fits(region, ranges), "in ranges of its own features");
  const FeatureRange larger{.feature = Feature::area, .min = double(area(region)) + 1};
  expects(!fits(region, {&larger, 1}), "not in others");
}

void check_gray(const Region& region, Bytes& bytes) {
  constexpr int kWidth = 24, kHeight = 9, kStride = 27;
  std::array<std::uint8_t, std::size_t{kStride} * kHeight> image{};
  const int levels = 1 + bytes.below(255);
  for (std::uint8_t& byte : image) byte = static_cast<std::uint8_t>(bytes.below(levels));
  const ByteView view{image.data(), kWidth, kHeight, kStride};
  const auto points = centers_of(clipped(region, {0, 0, kWidth, kHeight}));
  const auto value_at = [&](PixelPoint p) { return double(image[std::size_t(p.y) * kStride + std::size_t(p.x)]); };
  std::vector<int> values;
  for (const PixelPoint p : points) values.push_back(static_cast<int>(value_at(p)));
  std::ranges::sort(values);
  const GrayHistogram histogram = gray_histogram(region, view);
  const GrayFeatures gray = gray_features(region, view);
  const GrayMoments moments = gray_moments(region, view);
  expects(gray.count == std::ssize(values), "pixels within the image");
  for (int v = 0; v < 256; ++v)
    expects(histogram.count[static_cast<std::size_t>(v)] == std::ranges::count(values, v), "histogram");
  const PlainMoments plain = plain_moments(points, value_at);
  expects(near(plain.weight, moments.volume) && near(plain, moments.center, moments.moments), "weighted moments");
  check_axes(moments.ellipse);
  if (values.empty()) return;
  double mean = 0, variance = 0;
  for (const int v : values) mean += v / double(values.size());
  for (const int v : values) variance += (v - mean) * (v - mean) / double(values.size());
  expects(near(gray.mean, mean) && near(gray.deviation, std::sqrt(variance), 1e-5), "mean and deviation");
  expects(gray.min == values.front() && gray.max == values.back(), "extremes");
  expects(gray.median == values[(values.size() - 1) / 2] && gray_quantile(histogram, .5) == gray.median, "median");
  expects(gray.entropy >= 0 && gray.entropy <= 8 + 1e-9, "entropy of bytes");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  const Region region = next_region(bytes, 16, 40);
  check_table(region, bytes);
  check_gray(region, bytes);
  if (region.empty()) return 0;
  const auto points = centers_of(region);
  check_shape(region, points);
  check_extent(region, bytes.next() / 40. - kPi);
  return 0;
}
