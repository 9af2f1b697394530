#pragma once

#include <string>
#include <vector>

#include "tassilo/geometry/point.h"
#include "tassilo/overlay/picture.h"

namespace tassilo {

/// How well a camera explains calibration views, as plain numbers.
struct CalibrationDrawing {
  /// A point where it was measured and how far that is from where the camera shows it.
  struct Point {
    PixelPoint at, residual;  ///< [px]
    bool used = true;         ///< Others are drawn as rings.
  };
  int width = 0, height = 0;  ///< Of the camera's images. [px], > 0
  std::vector<Point> points;
  /// Numbers of points in equal cells of the image, row by row; none: not drawn.
  int cell_columns = 0, cell_rows = 0;
  std::vector<int> cell_points;
  std::string title;  ///< One line above the image.
};

/// The points' residuals as arrows, enlarged by a factor that the picture tells, over cells that are the brighter the
/// more points they have; cells without any are red. At least 900 wide; some ms, safe from any thread.
Picture draw_calibration(const CalibrationDrawing& drawing);

}  // namespace tassilo
