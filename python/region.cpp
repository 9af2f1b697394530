#include "tassilo/region/region.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "bindings.h"
#include "region_checks.h"
#include "tassilo/region/affine.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/elements.h"
#include "tassilo/region/fill.h"
#include "tassilo/region/hit_or_miss.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/outline.h"
#include "tassilo/region/partition.h"
#include "tassilo/region/raster.h"
#include "tassilo/region/relation.h"
#include "tassilo/region/remove_noise.h"
#include "tassilo/region/residue.h"
#include "tassilo/region/shapes.h"
#include "tassilo/region/skeleton.h"
#include "tassilo/region/transform.h"

// To add an operator, one statement in bind_operators (or in region_features.cpp), in the order of docs/regions.md:
//
//   def(module, "name", function, check, "one sentence", "region"_a, "element"_a);
//
// `check` refuses what would break a promise of the function (its coordinates stay within 16 bit, its element is not
// empty, ...): one of region_checks.h, a lambda that takes the same arguments, or kAnything. An overloaded function
// needs a cast, see union_of; an options struct becomes keyword arguments in a lambda, see fill_holes. Then
// `tools/python_stubs.py BUILD/python` rewrites the type stubs, and tests/test_limits.py calls the operator with
// extreme regions by itself when all its arguments are regions.

namespace tassilo::python {
namespace {

Region region_from_mask(const py::array& mask) {
  const ByteView view = byte_view("mask", mask);
  py::gil_scoped_release unlocked;
  return region_where(view, [](int byte) { return byte != 0; });
}

Region region_from_runs(const ArrayLike& argument) {
  const py::array& runs = argument.array;
  if (runs.size() == 0) return {};
  const char kind = runs.dtype().kind();
  if (runs.ndim() != 2 || runs.shape(1) != 3 || (kind != 'i' && kind != 'u'))
    refuse("runs", "are " + shown(runs) + ", must be (N, 3) of whole numbers: row, begin, end");
  const py::array_t<std::int64_t, py::array::forcecast> whole(runs);
  const auto numbers = whole.unchecked<2>();
  RunVector vector;
  vector.reserve(static_cast<std::size_t>(numbers.shape(0)));
  for (py::ssize_t i = 0; i < numbers.shape(0); ++i) {
    std::array<std::int16_t, 3> run{};
    for (py::ssize_t k = 0; k < 3; ++k) {
      const std::int64_t number = numbers(i, k);
      if (number < kLow || number > kHigh || (kind == 'u' && number < 0))
        refuse("runs[" + std::to_string(i) + "]", "holds " + std::to_string(number) + ", must be -32768 .. 32767");
      run[static_cast<std::size_t>(k)] = static_cast<std::int16_t>(number);
    }
    vector.push_back({run[0], run[1], run[2]});
  }
  return Region::from_runs(std::move(vector));
}

std::string repr_of(const Region& region) {
  if (region.empty()) return "<tassilo.Region: empty>";
  return "<tassilo.Region: " + std::to_string(area(region)) + " px, " + std::to_string(region.runs().size()) +
         (region.runs().size() == 1 ? " run" : " runs") + ", box " + text_of(bounding_box(region)) + ">";
}

py::bytes bytes_of(const Region& region) {
  const auto bytes = std::as_bytes(region.runs());
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void bind_class(py::module_& module) {
  static_assert(sizeof(PixelRun) == 3 * sizeof(std::int16_t));
  py::class_<Region>(module, "Region", R"(A set of pixels as sorted runs; need not be connected, may be empty.

Immutable, hashable, picklable; equal sets are equal. It is a set of pixels: len() counts them, an empty region is false,
`(column, row) in region` asks for one, and | & - ^ <= are those of sets.)")
      .def(py::init<>(), "The empty region.")
      .def(py::init(&region_from_runs),
           "From an (N, 3) array of whole numbers (row, begin, end), in any order; end is "
           "exclusive, empty runs are dropped, overlapping and touching ones joined.",
           "runs"_a)
      .def_static("from_mask", &region_from_mask, "The pixels of a (height, width) array that are true or not 0.",
                  "mask"_a)
      .def_static(
          "from_box",
          [](const PixelBox& box) {
            check_box("box", box);
            return Region::from_box(box);
          },
          "All pixels of a box (x0, y0, x1, y1), ends exclusive.", "box"_a)
      .def_property_readonly(
          "runs",
          [](const py::object& self) {
            const auto runs = self.cast<const Region&>().runs();
            return view_of(reinterpret_cast<const std::int16_t*>(runs.data()),
                           {static_cast<py::ssize_t>(runs.size()), 3}, self);
          },
          "(N, 3) read-only array of (row, begin, end), without a copy; keeps the region alive.")
      .def_property_readonly("area", &area, "Number of pixels.")
      .def_property_readonly("box", &bounding_box, "Smallest box (x0, y0, x1, y1), ends exclusive; all 0 when empty.")
      .def("__len__", &area, "Number of pixels.")
      .def(
          "__bool__", [](const Region& region) { return !region.empty(); }, "Whether it has pixels.")
      .def(
          "__contains__",
          [](const Region& region, std::pair<std::int64_t, std::int64_t> pixel) {
            const auto [column, row] = pixel;
            return std::min(column, row) >= kLow && std::max(column, row) <= kHigh &&
                   contains(region, static_cast<int>(column), static_cast<int>(row));
          },
          "Whether pixel (column, row) is in it.", "pixel"_a)
      .def(
          "__eq__", [](const Region& a, const Region& b) { return a == b; }, py::is_operator(), "other"_a)
      .def("__hash__", [](const Region& region) { return py::hash(bytes_of(region)); })
      .def(
          "__or__", [](const Region& a, const Region& b) { return union_of(a, b); }, py::is_operator(), "other"_a)
      .def(
          "__and__", [](const Region& a, const Region& b) { return intersection(a, b); }, py::is_operator(), "other"_a)
      .def(
          "__sub__", [](const Region& a, const Region& b) { return difference(a, b); }, py::is_operator(), "other"_a)
      .def(
          "__xor__", [](const Region& a, const Region& b) { return symmetric_difference(a, b); }, py::is_operator(),
          "other"_a)
      .def(
          "__le__", [](const Region& a, const Region& b) { return difference(a, b).empty(); }, py::is_operator(),
          "other"_a)
      .def("__repr__", &repr_of)
      .def(py::pickle([](const Region& region) { return py::make_tuple(bytes_of(region)); },
                      [](const py::tuple& state) {
                        const auto bytes = state[0].cast<std::string>();
                        if (state.size() != 1 || bytes.size() % sizeof(PixelRun) != 0)
                          refuse("pickled region", "is damaged, must be whole runs");
                        RunVector runs(bytes.size() / sizeof(PixelRun));
                        std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(runs.data()));
                        return Region::from_runs(std::move(runs));
                      }));
}

/// 2 about, once it is known to be a place of a mirror.
int check_mirror(double about) {
  if (!(std::abs(about) <= 65536) || 2 * about != std::floor(2 * about))
    refuse("about", "is " + std::to_string(about) + ", must be a multiple of .5 within +-65536");
  return static_cast<int>(2 * about);
}

void check_zoom(const PixelBox& box, double columns, double rows) {
  for (const double factor : {columns, rows})
    if (!(factor > 0 && std::isfinite(factor))) refuse("factor", "is " + std::to_string(factor) + ", must be > 0");
  const auto fits = [](int edge, double factor) {
    const double scaled = std::ceil(edge * factor - .5);
    return scaled >= kLow && scaled <= kHigh;
  };
  if (!fits(box.x0, columns) || !fits(box.x1, columns) || !fits(box.y0, rows) || !fits(box.y1, rows))
    refuse("box of the region", "is " + text_of(box) + ", must stay within -32768 .. 32767 when zoomed");
}

AffineMap map_of(const ArrayLike& argument) {
  const py::array_t<double, py::array::c_style | py::array::forcecast> m(argument.array);
  if (m.ndim() != 2 || m.shape(0) != 2 || m.shape(1) != 3) refuse("matrix", "is " + shown(m) + ", must be (2, 3)");
  return {m.at(0, 0), m.at(0, 1), m.at(0, 2), m.at(1, 0), m.at(1, 1), m.at(1, 2)};
}

/// Pixels are squares: a box reaches half a pixel beyond its centres.
void check_mapped(const PixelBox& box, const AffineMap& map) {
  if (box.empty()) return;
  for (const double x : {box.x0 - .5, box.x1 - .5})
    for (const double y : {box.y0 - .5, box.y1 - .5}) {
      const PixelPoint corner = map * PixelPoint{x, y};
      if (!(std::max(std::abs(corner.x), std::abs(corner.y)) < kHigh - 1))
        refuse("mapped region", "reaches (" + std::to_string(corner.x) + ", " + std::to_string(corner.y) +
                                    "), must stay within -32766 .. 32766");
    }
}

void check_angle(double angle) {
  if (!std::isfinite(angle)) refuse("phi", "is " + std::to_string(angle) + ", must be finite");
}

void check_shape(PixelPoint center, double length, double width) {
  if (!(length >= 0 && width >= 0)) refuse("size", "is " + std::to_string(std::min(length, width)) + ", must be >= 0");
  const double reach = std::max(std::abs(center.x), std::abs(center.y)) + std::hypot(length, width);
  if (!(reach < kHigh - 1)) refuse("shape", "reaches " + std::to_string(reach) + ", must stay within -32766 .. 32766");
}

void check_reflected(const Region& region) {
  const PixelBox box = bounding_box(region);
  check_box("box of the reflected region", {1 - box.x1, 1 - box.y1, 1 - box.x0, 1 - box.y0});
}

void check_neighbors(const Region& region, Connectivity) { check_element<1>(region, rectangle(3, 3)); }

void check_radius(int radius) {
  if (radius < 0 || radius >= kHigh) refuse("radius", "is " + std::to_string(radius) + ", must be 0 .. 32766");
}

RecycledVector<PixelPoint> points_of(const char* name, const ArrayLike& argument) {
  const py::array_t<double, py::array::c_style | py::array::forcecast> vertices(argument.array);
  if (vertices.size() > 0 && (vertices.ndim() != 2 || vertices.shape(1) != 2))
    refuse(name, "are " + shown(vertices) + ", must be (N, 2): column, row");
  RecycledVector<PixelPoint> points;
  for (py::ssize_t i = 0; i < vertices.size() / 2; ++i) {
    const double *corner = vertices.data() + 2 * i, limit = 1e9;
    if (!(std::abs(corner[0]) <= limit && std::abs(corner[1]) <= limit))
      refuse(std::string(name) + "[" + std::to_string(i) + "]", "is beyond +-1e9, must be within");
    points.push_back({corner[0], corner[1]});
  }
  return points;
}

std::vector<std::pair<py::array_t<double>, bool>> listed(const RecycledVector<Outline>& outlines) {
  std::vector<std::pair<py::array_t<double>, bool>> list;
  for (const Outline& outline : outlines) list.emplace_back(array_of_points(outline.corners), outline.is_hole);
  return list;
}

void bind_operators(py::module_& module) {
  // Set algebra: algebra.h
  def(module, "union_of", static_cast<Region (*)(const Region&, const Region&)>(&union_of), kAnything,
      "Pixels in a or in b.", "a"_a, "b"_a);
  module.def(
      "union_of",
      [](const std::vector<Region>& regions) {
        py::gil_scoped_release unlocked;
        return union_of(std::span<const Region>(regions));
      },
      "Pixels in any of the regions.", "regions"_a);
  def(module, "intersection", static_cast<Region (*)(const Region&, const Region&)>(&intersection), kAnything,
      "Pixels in a and in b.", "a"_a, "b"_a);
  def(module, "difference", &difference, kAnything, "Pixels in a, not in b.", "a"_a, "b"_a);
  def(module, "symmetric_difference", &symmetric_difference, kAnything, "Pixels in exactly one of a and b.", "a"_a,
      "b"_a);
  def(
      module, "complement", &complement, [](const Region&, const PixelBox& domain) { check_box("domain", domain); },
      "Pixels of the box `domain` that are not in the region.", "region"_a, "domain"_a);
  module.def(
      "translated",
      [](const Region& region, int columns, int rows) {
        if (std::abs(columns / 2) > kHigh || std::abs(rows / 2) > kHigh)
          refuse("shift",
                 "is (" + std::to_string(columns) + ", " + std::to_string(rows) + "), must be within -65535 .. 65535");
        const PixelBox box = bounding_box(region);
        if (!region.empty())
          check_box("box of the moved region", {box.x0 + columns, box.y0 + rows, box.x1 + columns, box.y1 + rows});
        return translated(region, {.columns = columns, .rows = rows});
      },
      "The region moved to the right and down.", "region"_a, "columns"_a = 0, "rows"_a = 0);
  def(module, "clipped", &clipped, kAnything, "Pixels of the region inside the box.", "region"_a, "box"_a);
  def(
      module, "transposed", &transposed,
      [](const Region& region) {
        const PixelBox box = bounding_box(region);
        check_box("box of the transposed region", {box.y0, box.x0, box.y1, box.x1});
      },
      "Pixel (column, row) goes to (row, column).", "region"_a);
  def(module, "reflected", &reflected, &check_reflected, "Pixel (column, row) goes to (-column, -row).", "region"_a);

  // Relations: relation.h
  def(module, "common_area", &common_area, kAnything, "Number of pixels in both.", "a"_a, "b"_a);
  def(module, "overlaps", &overlaps, kAnything, "Whether a pixel is in both.", "a"_a, "b"_a);
  def(module, "is_subset", &is_subset, kAnything, "Whether every pixel of `inner` is in `outer`.", "inner"_a,
      "outer"_a);
  def(module, "hamming_distance", &hamming_distance, kAnything, "Number of pixels in exactly one.", "a"_a, "b"_a);
  def(module, "intersection_over_union",
      static_cast<double (*)(const Region&, const Region&)>(&intersection_over_union), kAnything,
      "Pixels in both over pixels in any, 0 to 1.", "a"_a, "b"_a);

  // Transforms: transform.h, partition.h
  def(
      module, "mirrored_left_right", &mirrored_left_right,
      [](const Region& region, double about) {
        const int sum = check_mirror(about);
        const PixelBox box = bounding_box(region);
        if (!box.empty()) check_box("box of the mirrored region", {sum + 1 - box.x1, box.y0, sum + 1 - box.x0, box.y1});
      },
      "Pixel (column, row) goes to (2 about - column, row); about is a multiple of .5.", "region"_a, "about"_a);
  def(
      module, "mirrored_top_bottom", &mirrored_top_bottom,
      [](const Region& region, double about) {
        const int sum = check_mirror(about);
        const PixelBox box = bounding_box(region);
        if (!box.empty()) check_box("box of the mirrored region", {box.x0, sum + 1 - box.y1, box.x1, sum + 1 - box.y0});
      },
      "Pixel (column, row) goes to (column, 2 about - row); about is a multiple of .5.", "region"_a, "about"_a);
  module.def(
      "zoomed",
      [](const Region& region, double columns, double rows) {
        check_zoom(bounding_box(region), columns, rows);
        py::gil_scoped_release unlocked;
        return zoomed(region, {.columns = columns, .rows = rows});
      },
      "The region drawn larger or smaller by factors > 0.", "region"_a, "columns"_a, "rows"_a);
  module.def(
      "partition_into_rectangles",
      [](const Region& region, int width, int height) {
        if (width < 1 || height < 1)
          refuse("part", "is " + std::to_string(width) + " x " + std::to_string(height) + " pixels, must be >= 1");
        py::gil_scoped_release unlocked;
        return partition_into_rectangles(region, {.width = width, .height = height});
      },
      "The region cut along a grid of cells of about this size.", "region"_a, "width"_a, "height"_a);
  module.def(
      "mapped",
      [](const Region& region, const ArrayLike& matrix) {
        const AffineMap map = map_of(matrix);
        check_mapped(bounding_box(region), map);
        py::gil_scoped_release unlocked;
        return mapped(region, map);
      },
      "The region moved by an affine map, a (2, 3) array: column and row of a pixel, then 1.", "region"_a, "matrix"_a);
  module.def(
      "rotation_about",
      [](double column, double row, double angle) {
        for (const double value : {column, row, angle})
          if (!std::isfinite(value)) refuse("rotation", "has " + std::to_string(value) + ", must be finite");
        const AffineMap m = rotation_about({column, row}, angle);
        return array_of(std::vector<double>{m.xx, m.xy, m.x0, m.yx, m.yy, m.y0}, {2, 3});
      },
      "The map that turns about a point, counter-clockwise on the screen [rad]; see mapped.", "column"_a, "row"_a,
      "angle"_a);

  // Shapes: shapes.h
  module.def(
      "circle_region",
      [](double column, double row, double radius) {
        check_shape({column, row}, radius, 0);
        return circle_region({{column, row}, radius});
      },
      "Pixels whose centres lie in a circle or on it.", "column"_a, "row"_a, "radius"_a);
  module.def(
      "ellipse_region",
      [](double column, double row, double ra, double rb, double phi) {
        check_shape({column, row}, ra, rb);
        check_angle(phi);
        return ellipse_region({column, row}, {.ra = ra, .rb = rb, .phi = phi});
      },
      "Pixels whose centres lie in an ellipse or on it.", "column"_a, "row"_a, "ra"_a, "rb"_a, "phi"_a = 0.0);
  module.def(
      "rectangle_region",
      [](double column, double row, double half_length, double half_width, double phi) {
        check_shape({column, row}, half_length, half_width);
        check_angle(phi);
        return rectangle_region(
            {.center = {column, row}, .half_length = half_length, .half_width = half_width, .phi = phi});
      },
      "Pixels whose centres lie in a rectangle at any angle or on it.", "column"_a, "row"_a, "half_length"_a,
      "half_width"_a, "phi"_a = 0.0);

  // Morphology: morphology.h
  def(
      module, "rectangle", &rectangle,
      [](int width, int height) {
        if (width < 1 || height < 1 || width > kHigh || height > kHigh)
          refuse("rectangle", "is " + std::to_string(width) + " x " + std::to_string(height) +
                                  " pixels, must be 1 .. 32767 in each direction");
      },
      "Centred element of width x height pixels.", "width"_a, "height"_a);
  def(
      module, "disc", &disc,
      [](double radius) {
        if (!(radius >= 0 && radius < kHigh)) refuse("radius", "is " + std::to_string(radius) + ", must be 0 .. 32766");
      },
      "Element of the pixels whose centres lie within the radius of the origin; 3.5 or so.", "radius"_a);
  def(module, "dilation", &dilation, &check_element<1>, "{p + e: p in region, e in element}.", "region"_a, "element"_a);
  def(module, "erosion", &erosion, &check_element<1>, "{p: p + e in region for all e in element}.", "region"_a,
      "element"_a);
  def(module, "opening", &opening, &check_element<2>, "All places the element can reach inside the region.", "region"_a,
      "element"_a);
  def(module, "closing", &closing, &check_element<2>, "What the element cannot enter from outside.", "region"_a,
      "element"_a);

  // More elements and operators: elements.h, residue.h, hit_or_miss.h, remove_noise.h
  def(module, "diamond", &diamond, &check_radius,
      "Element of the pixels at most `radius` steps along rows and columns away.", "radius"_a);
  def(module, "octagon", &octagon, &check_radius, "Element of the pixels in a regular octagon, cheaper than a disc.",
      "radius"_a);
  module.def(
      "line_element",
      [](double length_px, double angle) {
        if (!(length_px >= 1 && length_px <= kHigh))
          refuse("length_px", "is " + std::to_string(length_px) + ", must be 1 .. 32767");
        if (!std::isfinite(angle)) refuse("angle", "is " + std::to_string(angle) + ", must be finite");
        return line_element({.length_px = length_px, .angle = angle});
      },
      "Element one pixel wide through the origin; angle counter-clockwise from right [rad].", "length_px"_a,
      "angle"_a = 0.0);
  def(module, "top_hat", &top_hat, &check_element<2>, "What an opening takes away.", "region"_a, "element"_a);
  def(module, "bottom_hat", &bottom_hat, &check_element<2>, "What a closing adds.", "region"_a, "element"_a);
  def(
      module, "hit_or_miss", &hit_or_miss,
      [](const Region& region, const Region& hit, const Region& miss) {
        check_element<1>(region, hit);
        if (miss.empty()) return;
        check_reflected(miss);
        check_element<1>(region, reflected(miss));
      },
      "Places where `hit` lies in the region and `miss` outside.", "region"_a, "hit"_a, "miss"_a);
  def(module, "inner_boundary", &inner_boundary, &check_neighbors, "Pixels of the region that have a neighbor outside.",
      "region"_a, "neighbors"_a = Connectivity::four);
  def(module, "outer_boundary", &outer_boundary, &check_neighbors,
      "Pixels outside the region that have a neighbor in it.", "region"_a, "neighbors"_a = Connectivity::four);
  module.def(
      "remove_noise",
      [](const Region& region, const std::string& neighbors) {
        using Neighbors = NoiseNeighbors;
        const auto chosen = choice<Neighbors>(
            "neighbors", neighbors, {{"n_4", Neighbors::n_4}, {"n_8", Neighbors::n_8}, {"n_48", Neighbors::n_48}});
        check_neighbors(region, Connectivity::eight);
        py::gil_scoped_release unlocked;
        return remove_noise(region, chosen);
      },
      "Pixels that have a neighbor in the region, of 'n_4' by edges, 'n_8' by corners, 'n_48' by either.", "region"_a,
      "neighbors"_a = "n_48");

  def(module, "skeleton", &skeleton, kAnything, "The middle lines of a region, one pixel wide.", "region"_a);

  // Components and holes: components.h, fill.h
  def(module, "components", &components, kAnything, "The connected parts, in the order of their first runs.",
      "region"_a, "connectivity"_a = Connectivity::eight);
  module.def(
      "component_features",
      [](const Region& region, Connectivity connectivity) {
        RecycledVector<ComponentFeatures> parts;
        {
          py::gil_scoped_release unlocked;
          parts = component_features(region, connectivity);
        }
        std::vector<py::dict> found;
        for (const ComponentFeatures& part : parts) {
          py::dict features;
          features["area"] = part.area;
          features["center"] = std::pair(part.center.x, part.center.y);
          features["box"] = part.box;
          found.push_back(std::move(features));
        }
        return found;
      },
      "Area, center and box of every component, without making the components.", "region"_a,
      "connectivity"_a = Connectivity::eight);
  module.def(
      "label_runs",
      [](const Region& region, Connectivity connectivity) {
        const RunLabels labels = label_runs(region, connectivity);
        return std::pair(array_of(std::vector<int>(labels.label.begin(), labels.label.end()),
                                  {static_cast<py::ssize_t>(labels.label.size())}),
                         labels.count);
      },
      "The component of each run, 0 .. count - 1, and the count.", "region"_a, "connectivity"_a = Connectivity::eight);
  def(module, "holes", &holes, kAnything, "Background that the region cuts off from outside.", "region"_a,
      "foreground"_a = Connectivity::eight);
  module.def(
      "fill_holes",
      [](const Region& region, std::optional<std::int64_t> max_area_px, Connectivity foreground,
         std::int64_t min_area_px) {
        FillOptions options;
        options.min_area_px = min_area_px;
        options.foreground = foreground;
        if (max_area_px) options.max_area_px = *max_area_px;
        if (options.min_area_px < 0 || options.max_area_px < 0)
          refuse("area", "is " + std::to_string(std::min(options.min_area_px, options.max_area_px)) + ", must be >= 0");
        py::gil_scoped_release unlocked;
        return fill_holes(region, options);
      },
      "The region with its holes filled; smaller ones than min_area_px and larger ones than max_area_px stay open.",
      "region"_a, "max_area_px"_a = py::none(), "foreground"_a = Connectivity::eight, "min_area_px"_a = 1);

  // Pixels, labels, polygons: raster.h
  module.def(
      "regions_of_labels",
      [](const py::array& labels, int count) {
        if (count < 0 || count > 256) refuse("count", "is " + std::to_string(count) + ", must be 0 .. 256");
        const ByteView view = byte_view("labels", labels);
        py::gil_scoped_release unlocked;
        return regions_of_labels(view, count);
      },
      "One region a label 0 .. count - 1 of a (height, width) array.", "labels"_a, "count"_a);
  module.def(
      "to_mask",
      [](const Region& region, const PixelBox& window, std::uint8_t inside) {
        check_window(window);
        return array_of(to_mask(region, window, inside), {std::max(0, window.height()), std::max(0, window.width())});
      },
      "(height, width) of uint8 for the pixels of a window (x0, y0, x1, y1): `inside` where the region is, else 0.",
      "region"_a, "window"_a, "inside"_a = 255);
  module.def(
      "to_labels",
      [](const std::vector<Region>& regions, const PixelBox& window) {
        check_window(window);
        if (regions.size() > 256) refuse("regions", "are " + std::to_string(regions.size()) + ", must be at most 256");
        return array_of(to_labels(regions, window), {std::max(0, window.height()), std::max(0, window.width())});
      },
      "(height, width) of uint8 for the pixels of a window: k where regions[k] is, the last one wins, else 0.",
      "regions"_a, "window"_a);
  module.def(
      "region_from_polygon",
      [](const ArrayLike& vertices, const PixelBox& window) {
        check_window(window);
        const auto corners = points_of("vertices", vertices);
        py::gil_scoped_release unlocked;
        return region_from_polygon(corners, window);
      },
      "Pixels of the window whose centres are inside a closed polygon of (column, row) corners, by the even-odd rule.",
      "vertices"_a, "window"_a);

  // Outlines: outline.h
  module.def(
      "outlines", [](const Region& region, Connectivity foreground) { return listed(outlines(region, foreground)); },
      "Closed polygons along the pixels' edges, one around each component and each hole: (corners, is_hole), corners "
      "(N, 2) of column, row.",
      "region"_a, "foreground"_a = Connectivity::eight);
  module.def(
      "center_outlines", [](const Region& region) { return listed(center_outlines(region)); },
      "Closed polygons through the centres of the border pixels, as `outlines`.", "region"_a);
  module.def(
      "region_from_outlines",
      [](const std::vector<std::pair<ArrayLike, bool>>& polygons, const PixelBox& window) {
        check_window(window);
        std::vector<Outline> corners;
        for (const auto& [vertices, is_hole] : polygons) corners.push_back({points_of("corners", vertices), is_hole});
        py::gil_scoped_release unlocked;
        return region_from_outlines(corners, window);
      },
      "Pixels of the window whose centres are inside an odd number of the polygons; undoes `outlines`.", "outlines"_a,
      "window"_a);
}

}  // namespace

void bind_region(py::module_& module) {
  bind_class(module);
  bind_operators(module);
}

}  // namespace tassilo::python
