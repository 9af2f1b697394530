#include "tassilo/contour/contour.h"

#include "bindings.h"
#include "region_checks.h"
#include "tassilo/base/error.h"
#include "tassilo/contour/boundary_contours.h"
#include "tassilo/contour/skeleton_contours.h"
#include "tassilo/contour/sub_pixel_edges.h"

// Contours are (points, closed): an (N, 2) array of column, row, and whether the last point is connected to the first.

namespace tassilo::python {
namespace {

using PythonContour = std::pair<py::array_t<double>, bool>;

PythonContour contour_of(const Contour& contour) { return {array_of_points(contour.points), contour.closed}; }

py::list boundaries(const Region& region) {
  py::list list;
  for (const BoundaryContour& boundary : boundary_contours(region))
    list.append(py::make_tuple(array_of_points(boundary.contour.points), boundary.hole));
  return list;
}

py::dict skeleton_parts(const Region& region, int min_points) {
  if (min_points < 1) refuse("min_points", "is " + std::to_string(min_points) + ", must be >= 1");
  const SkeletonContours parts = skeleton_contours(region, {.min_points = min_points});
  py::list contours, junctions;
  for (const SkeletonContour& part : parts.contours)
    contours.append(py::dict("points"_a = array_of_points(part.contour.points), "closed"_a = part.contour.closed,
                             "from"_a = part.from, "to"_a = part.to));
  for (const Junction& junction : parts.junctions)
    junctions.append(py::dict("column"_a = junction.center.x, "row"_a = junction.center.y,
                              "pixels"_a = array_of_points(junction.pixels)));
  return py::dict("contours"_a = contours, "junctions"_a = junctions, "ends"_a = array_of_points(parts.ends));
}

std::vector<PythonContour> edges(const Frame& frame, const Region& region, int filter_size_px, double low, double high,
                                 int min_points) {
  EdgeOptions options;
  options.filter_size_px = filter_size_px;
  options.low = low;
  options.high = high;
  options.min_points = min_points;
  RecycledVector<Contour> found;
  try {
    options.check();
  } catch (const Error& error) {
    throw py::value_error(error.what());
  }
  {
    py::gil_scoped_release unlocked;
    found = sub_pixel_edges(frame.view, region, options);
  }
  std::vector<PythonContour> contours;
  for (const Contour& contour : found) contours.push_back(contour_of(contour));
  return contours;
}

}  // namespace

void bind_contour(py::module_& module) {
  module.def("boundary_contours", &boundaries,
             "All borders of a region through its border pixels, one step a point: (points, is_hole), points (N, 2) of "
             "column, row; all are closed.",
             "region"_a);
  module.def("skeleton_contours", &skeleton_parts,
             "A skeleton taken apart: contours (points, closed, from and to: the junctions at its ends or -1), "
             "junctions (column, row, pixels), ends (N, 2).",
             "skeleton"_a, "min_points"_a = 1);
  const EdgeOptions standard;
  module.def("sub_pixel_edges", &edges,
             "Edges of a frame's brightness inside a region: (points, closed), points (N, 2) of column, row between "
             "pixels, the brighter side to the right; filter_size_px 3, 5 or 7, low and high [gray levels / px].",
             "frame"_a, "region"_a, "filter_size_px"_a = standard.filter_size_px, "low"_a = standard.low,
             "high"_a = standard.high, "min_points"_a = standard.min_points);
}

}  // namespace tassilo::python
