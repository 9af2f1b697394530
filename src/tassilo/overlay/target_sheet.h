#pragma once

#include <string>
#include <vector>

#include "tassilo/overlay/picture.h"

namespace tassilo {

/// A calibration target to be printed, to scale.
struct TargetSheet {
  /// dots: black discs within a frame, its corner beside dot (0, 0) filled by a triangle; the frame's inner edge is one
  /// pitch from the outer dots' centres, its outer edge 1.25, the triangle's legs .5. checkerboard: squares around
  /// columns x rows inner corners, the first one black. tags: columns x rows of them, black squares between.
  enum class Marks { dots, checkerboard, tags };
  Marks marks = Marks::dots;
  int columns = 7, rows = 7;         ///< Of dots or inner corners. >= 1
  double pitch = .04, radius = .01;  ///< From point to point, and of a dot. [m], > 0
  std::string caption = {};          ///< Beside the ruler.
  /// tags: pitch is their size; between them is this share of it. 0..1
  double spacing = 0;
  /// tags: which cells of each are black, row by row from the top left, of equal and square number.
  std::vector<std::vector<bool>> cells = {};
};

enum class SheetFormat { svg, pdf };

/// The bytes of a page as large as the target with a white margin of .4 pitches, and below it a ruler of 100 mm (or as
/// many as fit) to check the print with.
std::string target_sheet(const TargetSheet& sheet, SheetFormat format);

/// The same page as a picture, for a screen that shows it to scale. [px/m], > 0
Picture target_picture(const TargetSheet& sheet, double pixels_per_metre);

}  // namespace tassilo
