#include "tassilo/region/region.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "bindings.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/features.h"
#include "tassilo/region/fill.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/raster.h"

// To add an operator, one statement in bind_operators or bind_features, in the order of docs/regions.md:
//
//   def(module, "name", function, check, "one sentence", "region"_a, "element"_a);
//
// `check` refuses what would break a promise of the function (its coordinates stay within 16 bit, its element is not
// empty, ...): one of the checks below, a lambda that takes the same arguments, or kAnything. An overloaded function
// needs a cast, see union_of; an options struct becomes keyword arguments in a lambda, see fill_holes. Then
// `tools/python_stubs.py BUILD/python` rewrites the type stubs, and tests/test_limits.py calls the operator with
// extreme regions by itself when all its arguments are regions.

namespace tassilo::python {
namespace {

constexpr int kLow = -32768, kHigh = 32767;

std::string text_of(const PixelBox& box) {
  return "(" + std::to_string(box.x0) + ", " + std::to_string(box.y0) + ", " + std::to_string(box.x1) + ", " +
         std::to_string(box.y1) + ")";
}

/// Refuses boxes whose runs would leave 16 bit.
void check_box(const std::string& name, const PixelBox& box) {
  if (box.empty() || (box.x0 >= kLow && box.y0 >= kLow && box.x1 <= kHigh && box.y1 <= kHigh + 1)) return;
  refuse(name, "is " + text_of(box) + ", must stay within -32768 .. 32767");
}

PixelBox grown(const PixelBox& box, int columns, int rows) {
  return box.empty() ? box : PixelBox{box.x0 - columns, box.y0 - rows, box.x1 + columns, box.y1 + rows};
}

/// For operators that walk the element over the region `times` times: refuses an empty element, and a region that on
/// the way might leave 16 bit.
template <int times>
void check_element(const Region& region, const Region& element) {
  if (element.empty()) refuse("element", "is empty, must have a pixel");
  const PixelBox e = bounding_box(element);
  const int columns = std::max(std::abs(e.x0), std::abs(e.x1)) + e.width();
  const int rows = std::max(std::abs(e.y0), std::abs(e.y1)) + e.height();
  check_box("box of the region, grown by the element,", grown(bounding_box(region), times * columns, times * rows));
}

void check_window(const PixelBox& window) { check_box("window", window); }

ByteView byte_view(const char* name, const py::array& array) {
  const char kind = array.dtype().kind();
  if (array.ndim() != 2 || array.itemsize() != 1 || (kind != 'u' && kind != 'b'))
    refuse(name, "is " + shown(array) + ", must be (height, width) of uint8 or bool");
  if (array.shape(0) > kHigh || array.shape(1) > kHigh)
    refuse(name, "is " + shown(array) + ", must be at most 32767 in each direction");
  if (array.shape(1) > 1 && array.strides(1) != 1)
    refuse(name, "has gaps between the pixels of a row, must have none; numpy.ascontiguousarray makes such a copy");
  return {static_cast<const std::uint8_t*>(array.data()), static_cast<int>(array.shape(1)),
          static_cast<int>(array.shape(0)), array.strides(0)};
}

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

std::string text_of(const Region& region) {
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
      .def("__repr__", [](const Region& region) { return text_of(region); })
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
  def(
      module, "reflected", &reflected,
      [](const Region& region) {
        const PixelBox box = bounding_box(region);
        check_box("box of the reflected region", {1 - box.x1, 1 - box.y1, 1 - box.x0, 1 - box.y0});
      },
      "Pixel (column, row) goes to (-column, -row).", "region"_a);

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

  // Components and holes: components.h, fill.h
  def(module, "components", &components, kAnything, "The connected parts, in the order of their first runs.",
      "region"_a, "connectivity"_a = Connectivity::eight);
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
      [](const Region& region, std::optional<std::int64_t> max_area_px, Connectivity foreground) {
        FillOptions options;
        options.foreground = foreground;
        if (max_area_px) options.max_area_px = *max_area_px;
        if (options.max_area_px < 0)
          refuse("max_area_px", "is " + std::to_string(options.max_area_px) + ", must be >= 0");
        py::gil_scoped_release unlocked;
        return fill_holes(region, options);
      },
      "The region with its holes filled; larger ones than max_area_px stay open.", "region"_a,
      "max_area_px"_a = py::none(), "foreground"_a = Connectivity::eight);

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
      [](const ArrayLike& argument, const PixelBox& window) {
        check_window(window);
        const py::array_t<double, py::array::c_style | py::array::forcecast> vertices(argument.array);
        if (vertices.size() > 0 && (vertices.ndim() != 2 || vertices.shape(1) != 2))
          refuse("vertices", "are " + shown(vertices) + ", must be (N, 2): column, row");
        std::vector<PixelPoint> points;
        for (py::ssize_t i = 0; i < vertices.size() / 2; ++i) {
          const double *corner = vertices.data() + 2 * i, limit = 1e9;
          if (!(std::abs(corner[0]) <= limit && std::abs(corner[1]) <= limit))
            refuse("vertices[" + std::to_string(i) + "]", "is not within +-1e9");
          points.push_back({corner[0], corner[1]});
        }
        py::gil_scoped_release unlocked;
        return region_from_polygon(points, window);
      },
      "Pixels of the window whose centres are inside a closed polygon of (column, row) corners, by the even-odd rule.",
      "vertices"_a, "window"_a);
}

/// shape_features as one row of an array; the names are those of docs/regions.md.
struct FeatureRow {
  std::int64_t area;
  double column, row;
  std::int32_t x0, y0, x1, y1;
  double rr, rc, cc, ra, rb, phi, anisometry, bulkiness, structure_factor, circularity;
};

FeatureRow row_of(const ShapeFeatures& f) {
  return {f.area,        f.center.x,   f.center.y,   f.box.x0,           f.box.y0,     f.box.x1,
          f.box.y1,      f.moments.rr, f.moments.rc, f.moments.cc,       f.ellipse.ra, f.ellipse.rb,
          f.ellipse.phi, f.anisometry, f.bulkiness,  f.structure_factor, f.circularity};
}

py::array feature_array(const std::vector<Region>& regions) {
  std::vector<FeatureRow> rows;
  {
    py::gil_scoped_release unlocked;
    rows.reserve(regions.size());
    for (const Region& region : regions) rows.push_back(row_of(shape_features(region)));
  }
  const auto count = static_cast<py::ssize_t>(rows.size());
  return array_of(std::move(rows), {count});
}

void bind_features(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(FeatureRow, area, column, row, x0, y0, x1, y1, rr, rc, cc, ra, rb, phi, anisometry, bulkiness,
                       structure_factor, circularity);
  module.def(
      "shape_features",
      [](const Region& region) {
        const py::array row = feature_array({region});
        return py::dict(py::module_::import("builtins").attr("zip")(row.dtype().attr("names"), row.attr("item")(0)));
      },
      "Area, centre, box, second moments, equivalent ellipse and what follows from them; all 0 when empty.",
      "region"_a);
  module.def("feature_array", &feature_array,
             "shape_features of many regions: a structured array of one row a region, with the dict's keys as fields.",
             "regions"_a);
  def(module, "area", &area, kAnything, "Number of pixels.", "region"_a);
  def(module, "bounding_box", &bounding_box, kAnything, "Smallest box (x0, y0, x1, y1); all 0 when empty.", "region"_a);
  def(module, "contour_length", &contour_length, kAnything, "Length of the outer contours [px].", "region"_a);
  def(module, "compactness", &compactness, kAnything, "max(1, contour_length^2 / (4 pi area)).", "region"_a);
  def(module, "euler_number", &euler_number, kAnything, "Components less holes.", "region"_a,
      "foreground"_a = Connectivity::eight);
  def(module, "hole_count", &hole_count, kAnything, "Number of holes.", "region"_a,
      "foreground"_a = Connectivity::eight);
  module.def(
      "convex_hull",
      [](const Region& region) {
        std::vector<double> numbers;
        for (const PixelPoint& corner : convex_hull(region)) numbers.insert(numbers.end(), {corner.x, corner.y});
        const auto count = static_cast<py::ssize_t>(numbers.size() / 2);
        return array_of(std::move(numbers), {count, 2});
      },
      "(N, 2) corners (column, row) of the hull of the pixel centres, clockwise on the screen.", "region"_a);
  def(module, "convex_area", &convex_area, kAnything, "Pixels in or on the convex hull.", "region"_a);
  def(module, "convexity", &convexity, kAnything, "area / convex_area.", "region"_a);
  def(
      module, "rectangularity", &rectangularity,
      [](const Region& region) {
        // The rectangle with the same moments may be longer than the region's box, but not by more than its diagonal.
        const PixelBox box = bounding_box(region);
        const int diagonal = static_cast<int>(std::hypot(box.width(), box.height())) + 2;
        check_box("box of the region, grown by its diagonal,", grown(box, diagonal, diagonal));
      },
      "How well the rectangle with the region's moments covers it; 1 for rectangles.", "region"_a);
}

}  // namespace

void bind_region(py::module_& module) {
  bind_class(module);
  bind_operators(module);
  bind_features(module);
}

}  // namespace tassilo::python
