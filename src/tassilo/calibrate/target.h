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
/// legs are .5. checkerboard: points are the inner corners; the square beyond corner (0, 0) is black. april_grid:
/// points are the corners of tags of family 36h11 with a border of two cells, ids from the lower left to the right,
/// then upwards; black squares between the tags meet each corner, as on Kalibr's targets.
enum class TargetKind { dots, checkerboard, april_grid };
inline constexpr std::size_t kTargetKinds = 3;
std::string_view to_string(TargetKind kind);

/// A flat calibration target as it was made.
struct Target {
  TargetKind kind = TargetKind::dots;
  /// Of points. 3..64; a checkerboard has one side of even and one of odd length; an AprilGrid has two a tag.
  int columns = 7, rows = 7;
  double pitch = .04;   ///< From point to point; of an AprilGrid: from corner to corner of a tag. [m], > 0
  double radius = .01;  ///< Of the dots; 0 for others. [m], 0 .. pitch / 2
  double spacing = 0;   ///< Between the tags of an AprilGrid; 0 for others. [pitch], .1 .. 1

  friend bool operator==(const Target&, const Target&) = default;
  int size() const { return columns * rows; }  ///< Number of points.
  /// Where a point is.
  TargetPoint at(int column, int row) const;
  /// Throws Error naming the first field out of range.
  void check() const;
};

/// A target as the command line names it, `dots:COLUMNSxROWS:PITCH:RADIUS`, `checker:COLUMNSxROWS:PITCH` or
/// `aprilgrid:TAGCOLSxTAGROWS:TAGSIZE:TAGSPACING`, in metres, but for the spacing, which is a share of the size:
/// dots:7x7:0.04:0.01, aprilgrid:6x6:0.088:0.3. Throws Error saying what is wrong with it.
Target target_from_text(std::string_view text);
/// The same text back.
std::string to_text(const Target& target);

/// A point of a target where an image shows it.
struct SeenPoint {
  int column = 0, row = 0;  ///< On the target.
  /// Of a dot: the centroid of its image, which perspective moves away from the image of its centre. [px]
  PixelPoint pixel;
};

/// Sides of a target's frame: before the first row, behind the last, before the first column, behind the last.
enum class FrameSide { top, bottom, left, right };

/// A place on the middle of one side of a dot target's frame. It counts across the side only.
struct FramePlace {
  FrameSide side = FrameSide::top;
  double along = 0;   ///< Column (top, bottom) or row (left, right) on the target. [pitch]
  PixelPoint pixel;   ///< [px]
  PixelPoint normal;  ///< Across the side in the image, of norm 1.
};

/// A target in one image: points in the order of rows and columns, each at most once.
struct TargetView {
  Target target;
  std::vector<SeenPoint> points;
  std::vector<FramePlace> frame = {};  ///< By side, then along; of dots only, where the frame could be measured.
};

/// What looking for a target came to: a view, or the reason why there is none.
struct TargetSearch {
  std::optional<TargetView> view;
  std::string reason;  ///< Empty with a view. Lower-case, no full stop.
  /// What was left out of what was found, and why. Lower-case, no full stop.
  std::vector<std::string> remarks = {};
};

}  // namespace tassilo
