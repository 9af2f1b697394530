#include "tassilo/region/feature_table.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "tassilo/base/contract.h"
#include "tassilo/region/fill.h"
#include "tassilo/region/inscribed.h"

namespace tassilo {
namespace {

template <class T, class Measure>
const T& once(std::optional<T>& known, Measure measure) {
  if (!known) known = measure();
  return *known;
}

struct Row {
  FeatureInfo info;
  double (*measure)(FeatureMeter&);
};

template <double (*of)(const Region&)>
double plain(FeatureMeter& m) {
  return of(m.region());
}

constexpr std::array kTable{
    Row{{Feature::area, "area", "px^2", "number of pixels"},
        [](FeatureMeter& m) { return static_cast<double>(m.shape().area); }},
    Row{{Feature::row, "row", "px", "row of the centre of gravity"},
        [](FeatureMeter& m) { return m.shape().center.y; }},
    Row{{Feature::column, "column", "px", "column of the centre of gravity"},
        [](FeatureMeter& m) { return m.shape().center.x; }},
    Row{{Feature::row1, "row1", "px", "first row"}, [](FeatureMeter& m) { return double(m.shape().box.y0); }},
    Row{{Feature::column1, "column1", "px", "first column"}, [](FeatureMeter& m) { return double(m.shape().box.x0); }},
    Row{{Feature::row2, "row2", "px", "last row, inclusive"},
        [](FeatureMeter& m) { return m.region().empty() ? 0. : m.shape().box.y1 - 1.; }},
    Row{{Feature::column2, "column2", "px", "last column, inclusive"},
        [](FeatureMeter& m) { return m.region().empty() ? 0. : m.shape().box.x1 - 1.; }},
    Row{{Feature::width, "width", "px", "width of the smallest axis-parallel box"},
        [](FeatureMeter& m) { return double(m.shape().box.width()); }},
    Row{{Feature::height, "height", "px", "height of the smallest axis-parallel box"},
        [](FeatureMeter& m) { return double(m.shape().box.height()); }},
    Row{{Feature::ra, "ra", "px", "longer half axis of the ellipse with the same moments"},
        [](FeatureMeter& m) { return m.shape().ellipse.ra; }},
    Row{{Feature::rb, "rb", "px", "shorter half axis of that ellipse"},
        [](FeatureMeter& m) { return m.shape().ellipse.rb; }},
    Row{{Feature::phi, "phi", "rad", "direction of the longer half axis, (-pi/2, pi/2]"},
        [](FeatureMeter& m) { return m.shape().ellipse.phi; }},
    Row{{Feature::orientation, "orientation", "rad", "the same towards the pixel farthest from the centre, (-pi, pi]"},
        plain<orientation>},
    Row{{Feature::anisometry, "anisometry", "", "ra / rb"}, [](FeatureMeter& m) { return m.shape().anisometry; }},
    Row{{Feature::bulkiness, "bulkiness", "", "pi ra rb / area"}, [](FeatureMeter& m) { return m.shape().bulkiness; }},
    Row{{Feature::structure_factor, "struct_factor", "", "anisometry * bulkiness - 1"},
        [](FeatureMeter& m) { return m.shape().structure_factor; }},
    Row{{Feature::circularity, "circularity", "", "area over that of the circle around the centre, at most 1"},
        [](FeatureMeter& m) { return m.shape().circularity; }},
    Row{{Feature::compactness, "compactness", "", "contour length^2 / (4 pi area), at least 1"}, plain<compactness>},
    Row{{Feature::convexity, "convexity", "", "area over that of the convex hull"}, plain<convexity>},
    Row{{Feature::rectangularity, "rectangularity", "", "agreement with the rectangle of the same moments"},
        plain<rectangularity>},
    Row{{Feature::roundness, "roundness", "", "1 - dist_deviation / dist_mean"},
        [](FeatureMeter& m) { return m.round().roundness; }},
    Row{{Feature::dist_mean, "dist_mean", "px", "mean distance of the boundary from the centre"},
        [](FeatureMeter& m) { return m.round().distance; }},
    Row{{Feature::dist_deviation, "dist_deviation", "px", "deviation of that distance"},
        [](FeatureMeter& m) { return m.round().deviation; }},
    Row{{Feature::num_sides, "num_sides", "", "number of sides if it is a regular polygon"},
        [](FeatureMeter& m) { return m.round().sides; }},
    Row{{Feature::contour_length, "contlength", "px", "length of the outer contours"}, plain<contour_length>},
    Row{{Feature::connect_num, "connect_num", "", "number of 8-connected components"},
        [](FeatureMeter& m) { return double(label_runs(m.region()).count); }},
    Row{{Feature::holes_num, "holes_num", "", "number of holes"},
        [](FeatureMeter& m) { return static_cast<double>(hole_count(m.region())); }},
    Row{{Feature::area_holes, "area_holes", "px^2", "number of pixels in holes"},
        [](FeatureMeter& m) { return static_cast<double>(area(holes(m.region()))); }},
    Row{{Feature::euler_number, "euler_number", "", "components less holes"},
        [](FeatureMeter& m) { return static_cast<double>(euler_number(m.region())); }},
    Row{{Feature::max_diameter, "max_diameter", "px", "largest distance of two pixels"},
        [](FeatureMeter& m) { return m.feret().max.length; }},
    Row{{Feature::min_feret, "min_feret", "px", "least width between two parallel lines"},
        [](FeatureMeter& m) { return m.feret().min.length; }},
    Row{{Feature::outer_radius, "outer_radius", "px", "radius of the smallest circle around"},
        [](FeatureMeter& m) { return smallest_circle(m.region()).radius; }},
    Row{{Feature::inner_radius, "inner_radius", "px", "radius of the largest circle inside"},
        [](FeatureMeter& m) { return inner_circle(m.region()).radius; }},
    Row{{Feature::inner_width, "inner_width", "px", "width of the largest axis-parallel box inside"},
        [](FeatureMeter& m) { return double(m.inner_box().width()); }},
    Row{{Feature::inner_height, "inner_height", "px", "height of that box"},
        [](FeatureMeter& m) { return double(m.inner_box().height()); }},
    Row{{Feature::rect2_len1, "rect2_len1", "px", "half length of the smallest rectangle at any angle"},
        [](FeatureMeter& m) { return m.rectangle().half_length; }},
    Row{{Feature::rect2_len2, "rect2_len2", "px", "half width of that rectangle"},
        [](FeatureMeter& m) { return m.rectangle().half_width; }},
    Row{{Feature::rect2_phi, "rect2_phi", "rad", "direction of its length, (-pi/2, pi/2]"},
        [](FeatureMeter& m) { return m.rectangle().phi; }},
    Row{{Feature::moments_m20, "moments_m20", "px^4", "sum of squared row distances from the centre"},
        [](FeatureMeter& m) { return m.shape().moments.rr * static_cast<double>(m.shape().area); }},
    Row{{Feature::moments_m11, "moments_m11", "px^4", "sum of products of row and column distances"},
        [](FeatureMeter& m) { return m.shape().moments.rc * static_cast<double>(m.shape().area); }},
    Row{{Feature::moments_m02, "moments_m02", "px^4", "sum of squared column distances from the centre"},
        [](FeatureMeter& m) { return m.shape().moments.cc * static_cast<double>(m.shape().area); }},
};

constexpr bool in_order() {
  for (std::size_t k = 0; k < kTable.size(); ++k)
    if (static_cast<std::size_t>(kTable[k].info.feature) != k) return false;
  return true;
}
static_assert(in_order() && kTable.size() == static_cast<std::size_t>(Feature::moments_m02) + 1, "one row a feature");

constexpr auto kInfos = [] {
  std::array<FeatureInfo, kTable.size()> infos{};
  std::ranges::transform(kTable, infos.begin(), &Row::info);
  return infos;
}();

const Row& row_of(Feature feature) {
  const auto index = static_cast<std::size_t>(feature);
  expects(index < kTable.size(), "a known feature");
  return kTable[index];
}

}  // namespace

std::span<const FeatureInfo> all_features() { return kInfos; }

std::optional<Feature> feature_named(std::string_view name) {
  const auto row = std::ranges::find(kInfos, name, &FeatureInfo::name);
  if (row == kInfos.end()) return std::nullopt;
  return row->feature;
}

std::string_view to_string(Feature feature) { return row_of(feature).info.name; }

const ShapeFeatures& FeatureMeter::shape() {
  return once(shape_, [&] { return shape_features(region_); });
}
const RotatedRectangle& FeatureMeter::rectangle() {
  return once(rectangle_, [&] { return smallest_rectangle(region_); });
}
const FeretDiameters& FeatureMeter::feret() {
  return once(feret_, [&] { return feret_diameters(region_); });
}
const PixelBox& FeatureMeter::inner_box() {
  return once(inner_box_, [&] { return inner_rectangle(region_); });
}

const Roundness& FeatureMeter::round() {
  return once(round_, [&] { return roundness(region_); });
}

double FeatureMeter::operator()(Feature feature) { return row_of(feature).measure(*this); }

double feature_value(const Region& region, Feature feature) { return FeatureMeter(region)(feature); }

RecycledVector<double> feature_values(const Region& region, std::span<const Feature> features) {
  FeatureMeter meter(region);
  RecycledVector<double> values;
  values.reserve(features.size());
  for (const Feature feature : features) values.push_back(meter(feature));
  return values;
}

}  // namespace tassilo
