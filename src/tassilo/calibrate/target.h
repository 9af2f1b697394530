#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tassilo/geometry/point.h"

namespace tassilo {

/// The plane of a target. Origin: its first point (dot, inner corner); x along the columns, y along the rows, so that z
/// points away from whoever looks at its front. [m]
struct TargetFrame;
using TargetPoint = Point2<TargetFrame>;

/// What may be printed on a target.
///
/// dots: black discs on white within a black frame, one corner of which is filled by a triangle, beside dot (0, 0).
/// In units of the pitch: the frame's inner edge is 1 from the outer dots' centres, its outer edge 1.25; the triangle's
/// legs are .5. checkerboard: points are the inner corners; the square beyond corner (0, 0) is black.
enum class TargetKind { dots, checkerboard };
std::string_view to_string(TargetKind kind);

/// A flat calibration target as it was made.
struct Target {
  TargetKind kind = TargetKind::dots;
  int columns = 7, rows = 7;  ///< Of points. 3..64; a checkerboard has one side of even and one of odd length.
  double pitch = .04;         ///< From point to point. [m], > 0
  double radius = .01;        ///< Of the dots; 0 for checkerboards. [m], 0 .. pitch / 2

  friend bool operator==(const Target&, const Target&) = default;
  int size() const { return columns * rows; }  ///< Number of points.
  /// Throws Error naming the first field out of range.
  void check() const;
};

/// A target as the command line names it, `dots:COLUMNSxROWS:PITCH:RADIUS` or `checker:COLUMNSxROWS:PITCH`, in metres:
/// dots:7x7:0.04:0.01. Throws Error saying what is wrong with it.
Target target_from_text(std::string_view text);
/// The same text back.
std::string to_text(const Target& target);

/// A point of a target where an image shows it.
struct SeenPoint {
  int column = 0, row = 0;  ///< On the target.
  /// Of a dot: the centroid of its image, which perspective moves away from the image of its centre. [px]
  PixelPoint pixel;
};

/// A target in one image: points in the order of rows and columns, each at most once.
struct TargetView {
  Target target;
  std::vector<SeenPoint> points;
};

/// What looking for a target came to: a view, or the reason why there is none.
struct TargetSearch {
  std::optional<TargetView> view;
  std::string reason;  ///< Empty with a view. Lower-case, no full stop.
};

}  // namespace tassilo
