#pragma once

#include <vector>

#include "tassilo/calibrate/target.h"
#include "tassilo/region/raster.h"

namespace tassilo {

/// Cells of a tag along each of its sides: 6 of code within a black border of 2.
inline constexpr int kTagCells = 10;
/// Different tags that there are: ids 0 .. kTagCount - 1.
inline constexpr int kTagCount = 587;

/// What is black of a tag seen upright, row by row from the top, kTagCells x kTagCells. `id` within 0 and kTagCount.
std::vector<bool> tag_cells(int id);

/// Finds the corners of an AprilGrid's tags in a gray image; the target may leave the image.
///
/// Tags by libapriltag; those whose id is beyond the grid or seen twice, and those whose neighbors are not where the
/// tag lets expect them, are thrown out, each with a remark. Corners are then placed by two crossing edges fitted to
/// the brightness around them, as those of checkerboards: each corner of a tag meets that of a black square.
///
/// image    gray, any size up to 16000 px; a tag should be at least some 20 pixels wide
/// target   of kind april_grid; checked
/// returns  a view with at least 12 corners; or why not
/// cost     some 100 ms for 640 x 480; pure, safe from any thread. Throws Error for a bad target.
/// source   E. Olson, "AprilTag: A robust and flexible visual fiducial system", ICRA 2011; J. Wang, E. Olson, "AprilTag
///          2: Efficient and robust fiducial detection", IROS 2016. The layout is that of Kalibr's aprilgrid.
TargetSearch find_april_grid(ByteView image, const Target& target);

}  // namespace tassilo
