#pragma once

#include <vector>

#include "tassilo/region/raster.h"

namespace tassilo {

/// Gray values with fractions, rows from the top without padding; values beyond the border are those of the border.
struct GrayPlane {
  int width = 0, height = 0;  ///< [px]
  std::vector<float> values;

  float at(int column, int row) const;             ///< Clamped to the border.
  double sample(double column, double row) const;  ///< Bilinear, clamped to the border.
};

/// The image blurred by a Gaussian of `sigma`. [px], >= 0; 0 copies. O(pixels * sigma).
GrayPlane blurred(ByteView image, double sigma);

/// 255 where a pixel is darker than half way between the darkest and the brightest within `radius` (a square), and
/// these differ by `contrast` or more; else 0. Rows without padding. Blurred lightly before, for noise. source   J.
/// Bernsen, "Dynamic thresholding of grey-level images", ICPR 1986. O(pixels).
std::vector<std::uint8_t> locally_dark(ByteView image, int radius, double contrast);

}  // namespace tassilo
