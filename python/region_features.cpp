#include "tassilo/region/feature_table.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "bindings.h"
#include "region_checks.h"
#include "tassilo/files/coco_mask.h"
#include "tassilo/files/region_png.h"
#include "tassilo/region/distance.h"
#include "tassilo/region/enclosing.h"
#include "tassilo/region/features.h"
#include "tassilo/region/feret.h"
#include "tassilo/region/gray.h"
#include "tassilo/region/inscribed.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/roundness.h"
#include "tassilo/region/select.h"

// What is measured on regions; how to add something stands at the top of region.cpp.

namespace tassilo::python {

/// A gray image or the brightness of a frame, with gaps or without.
struct GrayArgument {
  py::object owner;
  GrayView view{ByteView{}};
};

}  // namespace tassilo::python

namespace pybind11::detail {

template <>
struct type_caster<tassilo::python::GrayArgument> {
  PYBIND11_TYPE_CASTER(tassilo::python::GrayArgument, const_name("Union[Frame, numpy.ndarray]"));
  bool load(handle source, bool) {
    using namespace tassilo;
    value.owner = reinterpret_borrow<object>(source);
    if (isinstance<Frame>(source)) {
      value.view = GrayView(source.cast<const Frame&>().view);
      return true;
    }
    if (!isinstance<array>(source)) return false;
    const auto image = reinterpret_borrow<array>(source);
    if (image.ndim() != 2 || image.itemsize() != 1 || image.dtype().kind() != 'u')
      python::refuse("image", "is " + python::shown(image) + ", must be (height, width) of uint8");
    if (image.shape(0) > python::kHigh || image.shape(1) > python::kHigh)
      python::refuse("image", "is " + python::shown(image) + ", must be at most 32767 in each direction");
    value.view.data = static_cast<const std::uint8_t*>(image.data());
    value.view.height = static_cast<int>(image.shape(0));
    value.view.width = static_cast<int>(image.shape(1));
    value.view.row_step = image.strides(0);
    value.view.pixel_step = image.strides(1);
    return true;
  }
};

}  // namespace pybind11::detail

namespace tassilo::python {
namespace {

void check_rectangularity(const Region& region) {
  // The rectangle with the same moments may be longer than the region's box, but not by more than its diagonal.
  const PixelBox box = bounding_box(region);
  const int diagonal = static_cast<int>(std::hypot(box.width(), box.height())) + 2;
  check_box("box of the region, grown by its diagonal,", grown(box, diagonal, diagonal));
}

/// For distances between the pixels of `box` and those of a window.
void check_distances(const PixelBox& box, const PixelBox& window) {
  check_window(window);
  const PixelBox all = hull(box, window);
  if (all.width() > 32768 || all.height() > 32768)
    refuse("box of region and window", "is " + text_of(all) + ", must be at most 32768 in each direction");
}

void check_inside(const Region& region, const PixelBox& window) {
  const PixelBox ring = grown(bounding_box(region), 1, 1);
  check_box("box of the region, grown by a pixel,", ring);
  check_distances(ring, window);
}

void check_inner_circle(const Region& region) { check_inside(region, bounding_box(region)); }

/// Its boundary is found by an erosion with the four neighbors.
void check_roundness(const Region& region) { check_element<1>(region, rectangle(3, 3)); }

void check_feature(const Region& region, Feature feature) {
  if (feature == Feature::rectangularity) check_rectangularity(region);
  if (feature == Feature::inner_radius) check_inner_circle(region);
  if (feature >= Feature::roundness && feature <= Feature::num_sides) check_roundness(region);
}

Feature feature_of(const std::string& name) {
  if (const auto feature = feature_named(name)) return *feature;
  std::string names;
  for (const FeatureInfo& info : all_features()) names.append(names.empty() ? "" : ", ").append(info.name);
  refuse("feature", "is '" + name + "', must be one of " + names);
}

using Names = std::optional<std::vector<std::string>>;

std::vector<Feature> features_of(const Names& names) {
  std::vector<Feature> features;
  if (names) {
    for (const std::string& name : *names) {
      const Feature feature = feature_of(name);
      if (std::ranges::find(features, feature) != features.end())
        refuse("names", "hold '" + name + "' twice, must once");
      features.push_back(feature);
    }
  } else {
    for (const FeatureInfo& info : all_features()) features.push_back(info.feature);
  }
  if (features.empty()) refuse("names", "are none, must be at least one");
  return features;
}

std::vector<FeatureRange> ranges_of(const py::dict& named) {
  std::vector<FeatureRange> ranges;
  for (const auto& [name, range] : named) {
    const auto [low, high] = as<std::pair<double, double>>("range", range, "(min, max)");
    if (!(low <= high))
      refuse("range", "is " + py::str(range).cast<std::string>() + ", must be (min, max), min <= max");
    ranges.push_back({feature_of(as<std::string>("feature", name, "a name")), low, high});
  }
  return ranges;
}

py::dict feature_dict(const Region& region, const Names& names) {
  const std::vector<Feature> features = features_of(names);
  for (const Feature feature : features) check_feature(region, feature);
  RecycledVector<double> values;
  {
    py::gil_scoped_release unlocked;
    values = feature_values(region, features);
  }
  py::dict result;
  for (std::size_t k = 0; k < features.size(); ++k) result[py::str(std::string(to_string(features[k])))] = values[k];
  return result;
}

py::array feature_array(const std::vector<Region>& regions, const Names& names) {
  const std::vector<Feature> features = features_of(names);
  for (const Region& region : regions)
    for (const Feature feature : features) check_feature(region, feature);
  std::vector<double> values;
  {
    py::gil_scoped_release unlocked;
    values.reserve(regions.size() * features.size());
    for (const Region& region : regions)
      for (const double value : feature_values(region, features)) values.push_back(value);
  }
  py::list fields;
  for (const Feature feature : features) fields.append(py::make_tuple(std::string(to_string(feature)), "f8"));
  const auto count = static_cast<py::ssize_t>(values.size());
  return array_of(std::move(values), {count}).attr("view")(fields);
}

void bind_table(py::module_& module) {
  module.def(
      "all_features",
      [] {
        py::list list;
        for (const FeatureInfo& info : all_features())
          list.append(py::dict("name"_a = std::string(info.name), "unit"_a = std::string(info.unit),
                               "meaning"_a = std::string(info.meaning)));
        return list;
      },
      "All features that are one number: name, unit, meaning.");
  module.def("features", &feature_dict,
             "Features of a region by their names, all where none are given; 0 for the empty region.", "region"_a,
             "names"_a = py::none());
  module.def("feature_array", &feature_array,
             "`features` of many regions: a structured array with a row for each region and the names as fields.",
             "regions"_a, "names"_a = py::none());
  module.def(
      "select",
      [](const std::vector<Region>& regions, const py::dict& ranges) {
        const std::vector<FeatureRange> checked = ranges_of(ranges);
        for (const Region& region : regions)
          for (const FeatureRange& range : checked) check_feature(region, range.feature);
        py::gil_scoped_release unlocked;
        return select(std::span<const Region>(regions), std::span<const FeatureRange>(checked));
      },
      "The regions whose features lie in closed ranges: select(parts, {'area': (50, 1e9), 'circularity': (.8, 1)}); "
      "put "
      "the cheap features first.",
      "regions"_a, "ranges"_a);
  module.def(
      "sorted_by",
      [](const std::vector<Region>& regions, const std::string& feature, const std::string& order) {
        const auto checked =
            choice<SortOrder>("order", order, {{"rising", SortOrder::rising}, {"falling", SortOrder::falling}});
        const Feature key = feature_of(feature);
        for (const Region& region : regions) check_feature(region, key);
        py::gil_scoped_release unlocked;
        return sorted(regions, key, checked);
      },
      "The regions ordered by a feature, 'rising' or 'falling'; equal ones keep their order. C++ calls it `sorted`.",
      "regions"_a, "feature"_a, "order"_a = "rising");
  module.def(
      "sorted_by_first_point",
      [](const std::vector<Region>& regions, const std::string& order) {
        const auto checked =
            choice<SortOrder>("order", order, {{"rising", SortOrder::rising}, {"falling", SortOrder::falling}});
        return sorted_by_first_point(regions, checked);
      },
      "The regions ordered by their first pixels, top to bottom, then left to right.", "regions"_a,
      "order"_a = "rising");
  module.def(
      "fill_up",
      [](const Region& region, const py::dict& ranges, Connectivity foreground) {
        const std::vector<FeatureRange> checked = ranges_of(ranges);
        const Region box = Region::from_box(bounding_box(region));  // holes lie in it
        for (const FeatureRange& range : checked) check_feature(box, range.feature);
        py::gil_scoped_release unlocked;
        return fill_up(region, checked, foreground);
      },
      "The region with those of its holes filled whose features lie in closed ranges.", "region"_a, "ranges"_a,
      "foreground"_a = Connectivity::eight);
}

void bind_single(py::module_& module) {
  def(module, "area", &area, kAnything, "Number of pixels.", "region"_a);
  def(module, "bounding_box", &bounding_box, kAnything, "Smallest box (x0, y0, x1, y1); all 0 when empty.", "region"_a);
  def(module, "orientation", &orientation, kAnything,
      "Direction of the ellipse's long axis towards the pixel farthest from the centre, (-pi, pi].", "region"_a);
  def(module, "contour_length", &contour_length, kAnything, "Length of the outer contours [px].", "region"_a);
  def(module, "compactness", &compactness, kAnything, "max(1, contour_length^2 / (4 pi area)).", "region"_a);
  def(module, "euler_number", &euler_number, kAnything, "Components less holes.", "region"_a,
      "foreground"_a = Connectivity::eight);
  def(module, "hole_count", &hole_count, kAnything, "Number of holes.", "region"_a,
      "foreground"_a = Connectivity::eight);
  module.def(
      "roundness",
      [](const Region& region) {
        check_roundness(region);
        const Roundness r = roundness(region);
        return py::dict("distance"_a = r.distance, "deviation"_a = r.deviation, "roundness"_a = r.roundness,
                        "sides"_a = r.sides);
      },
      "How round a region is: distance of the boundary from the centre, deviation, roundness, sides.", "region"_a);
  module.def(
      "convex_hull", [](const Region& region) { return array_of_points(convex_hull(region)); },
      "(N, 2) corners (column, row) of the hull of the pixel centres, clockwise on the screen.", "region"_a);
  def(module, "convex_area", &convex_area, kAnything, "Pixels in or on the convex hull.", "region"_a);
  def(module, "convexity", &convexity, kAnything, "area / convex_area.", "region"_a);
  def(module, "rectangularity", &rectangularity, &check_rectangularity,
      "How well the rectangle with the region's moments covers it; 1 for rectangles.", "region"_a);
}

py::dict dict_of(const Circle& circle) {
  return py::dict("column"_a = circle.center.x, "row"_a = circle.center.y, "radius"_a = circle.radius);
}

void bind_shapes(py::module_& module) {
  module.def(
      "smallest_rectangle",
      [](const Region& region) {
        const RotatedRectangle r = smallest_rectangle(region);
        return py::dict("column"_a = r.center.x, "row"_a = r.center.y, "half_length"_a = r.half_length,
                        "half_width"_a = r.half_width, "phi"_a = r.phi);
      },
      "The rectangle of least area around all pixel centres: column, row, half_length, half_width, phi.", "region"_a);
  module.def(
      "smallest_circle", [](const Region& region) { return dict_of(smallest_circle(region)); },
      "The smallest circle around all pixel centres: column, row, radius.", "region"_a);
  def(module, "convex_region", &convex_region, kAnything, "Pixels in or on the convex hull.", "region"_a);
  module.def(
      "inner_circle",
      [](const Region& region) {
        check_inner_circle(region);
        return dict_of(inner_circle(region));
      },
      "The largest circle inside: column, row, radius.", "region"_a);
  def(module, "inner_rectangle", &inner_rectangle, kAnything,
      "The box (x0, y0, x1, y1) of most pixels that lies in the region.", "region"_a);
  module.def(
      "diameter",
      [](const Region& region) {
        const Diameter d = diameter(region);
        return py::dict("first"_a = std::pair(d.first.x, d.first.y), "second"_a = std::pair(d.second.x, d.second.y),
                        "length"_a = d.length);
      },
      "Two pixels as far apart as any: first and second (column, row), length.", "region"_a);
  module.def(
      "feret_diameters",
      [](const Region& region) {
        const FeretDiameters f = feret_diameters(region);
        return py::dict("max"_a = f.max.length, "max_angle"_a = f.max.angle, "min"_a = f.min.length,
                        "min_angle"_a = f.min.angle);
      },
      "Largest and smallest extent over all directions: max, max_angle, min, min_angle.", "region"_a);
  def(
      module, "feret_diameter", &feret_diameter,
      [](const Region&, double angle) {
        if (!std::isfinite(angle)) refuse("angle", "is " + std::to_string(angle) + ", must be finite");
      },
      "Extent along a direction, counter-clockwise from right [rad].", "region"_a, "angle"_a);

  const auto def_distance = [&](const char* name, auto distances, auto check, const char* doc) {
    module.def(
        name,
        [=](const Region& region, const PixelBox& window, const std::string& metric) {
          const auto chosen = choice<DistanceMetric>("metric", metric,
                                                     {{"euclidean_squared", DistanceMetric::euclidean_squared},
                                                      {"chessboard", DistanceMetric::chessboard},
                                                      {"city_block", DistanceMetric::city_block}});
          check(region, window);
          DistanceImage image;
          {
            py::gil_scoped_release unlocked;
            image = distances(region, window, chosen);
          }
          return array_of(std::vector<std::int32_t>(image.values.begin(), image.values.end()),
                          {std::max(0, window.height()), std::max(0, window.width())});
        },
        doc, "region"_a, "window"_a, "metric"_a = "euclidean_squared");
  };
  def_distance(
      "distance_to", &distance_to,
      [](const Region& region, const PixelBox& window) { check_distances(bounding_box(region), window); },
      "(height, width) of int32: for each pixel of the window the distance to the nearest pixel of the region, 2^31 - "
      "1 "
      "for the empty region; metric 'euclidean_squared', 'chessboard' or 'city_block'.");
  def_distance(
      "distance_inside", &distance_inside, &check_inside,
      "(height, width) of int32: for each pixel of the window the distance to the nearest pixel outside the region.");
}

void bind_gray(py::module_& module) {
  module.def(
      "gray_histogram",
      [](const Region& region, const GrayArgument& image) {
        const GrayHistogram histogram = gray_histogram(region, image.view);
        return array_of(std::vector<std::int64_t>(histogram.count.begin(), histogram.count.end()), {256});
      },
      "(256,) numbers of the region's pixels with each value of a gray image, or brightness of a frame.", "region"_a,
      "image"_a);
  module.def(
      "gray_features",
      [](const Region& region, const GrayArgument& image) {
        const GrayFeatures f = gray_features(region, image.view);
        return py::dict("count"_a = f.count, "mean"_a = f.mean, "deviation"_a = f.deviation, "min"_a = f.min,
                        "max"_a = f.max, "median"_a = f.median, "entropy"_a = f.entropy);
      },
      "count, mean, deviation, min, max, median, entropy of the region's pixels.", "region"_a, "image"_a);
  module.def(
      "gray_quantile",
      [](const Region& region, const GrayArgument& image, double share) {
        if (!(share >= 0 && share <= 1)) refuse("share", "is " + std::to_string(share) + ", must be 0 .. 1");
        return gray_quantile(gray_histogram(region, image.view), share);
      },
      "The smallest value that at least this share of the region's pixels does not exceed.", "region"_a, "image"_a,
      "share"_a);
  module.def(
      "gray_moments",
      [](const Region& region, const GrayArgument& image) {
        const GrayMoments m = gray_moments(region, image.view);
        return py::dict("volume"_a = m.volume, "column"_a = m.center.x, "row"_a = m.center.y, "rr"_a = m.moments.rr,
                        "rc"_a = m.moments.rc, "cc"_a = m.moments.cc, "ra"_a = m.ellipse.ra, "rb"_a = m.ellipse.rb,
                        "phi"_a = m.ellipse.phi);
      },
      "Moments with each pixel weighted by its value: volume, column, row, rr, rc, cc, ra, rb, phi.", "region"_a,
      "image"_a);
}

CocoCounts coco_counts_of(const std::string& counts) {
  return choice<CocoCounts>("counts", counts, {{"string", CocoCounts::string}, {"list", CocoCounts::list}});
}

CocoMask coco_mask_of(const Region& region, int width, int height) {
  if (width < 1 || height < 1 || width > kHigh || height > kHigh)
    refuse("image", "is " + std::to_string(width) + "x" + std::to_string(height) + ", must be 1 .. 32767");
  return {width, height, region};
}

void bind_files(py::module_& module) {
  module.def("read_png_region", &read_png_region, "The pixels of a gray PNG that are not 0.", "path"_a);
  module.def(
      "write_png_region",
      [](const std::filesystem::path& path, const Region& region, const PixelBox& window) {
        check_window(window);
        if (window.empty()) refuse("window", "is " + text_of(window) + ", must have a pixel");
        write_png_region(path, region, window);
      },
      "Writes a mask of the window, 255 in the region.", "path"_a, "region"_a, "window"_a);
  module.def(
      "coco_json",
      [](const Region& region, int width, int height, const std::string& counts) {
        return coco_json(coco_mask_of(region, width, height), coco_counts_of(counts));
      },
      "The region as a COCO mask of an image of this size: run lengths as a 'string' or a 'list', in JSON.", "region"_a,
      "width"_a, "height"_a, "counts"_a = "string");
  module.def(
      "region_from_coco_json", [](const std::string& text) { return coco_mask_from_json(text, "mask").region; },
      "The region of such a text.", "text"_a);
  module.def(
      "read_coco_masks",
      [](const std::filesystem::path& path) {
        std::vector<Region> regions;
        for (CocoMask& mask : read_coco_masks(path)) regions.push_back(std::move(mask.region));
        return regions;
      },
      "The regions of a file with a JSON list of COCO masks.", "path"_a);
  module.def(
      "write_coco_masks",
      [](const std::filesystem::path& path, const std::vector<Region>& regions, int width, int height,
         const std::string& counts) {
        std::vector<CocoMask> masks;
        for (const Region& region : regions) masks.push_back(coco_mask_of(region, width, height));
        write_coco_masks(path, masks, coco_counts_of(counts));
      },
      "Writes regions of an image of this size as a JSON list of COCO masks.", "path"_a, "regions"_a, "width"_a,
      "height"_a, "counts"_a = "string");
}

}  // namespace

void bind_features(py::module_& module) {
  bind_table(module);
  bind_single(module);
  bind_shapes(module);
  bind_gray(module);
  bind_files(module);
}

}  // namespace tassilo::python
