#pragma once

#include <span>
#include <vector>

#include "tassilo/calibrate/intrinsics.h"
#include "tassilo/files/png.h"
#include "tassilo/overlay/calibration_picture.h"

namespace tassilo {

/// The points of views that count.
std::vector<CalibrationDrawing::Point> drawn_points(std::span<const ViewResult> views);

/// The residuals of a camera over where its points are.
CalibrationDrawing residual_drawing(const Intrinsics& result);
/// The same drawn; some ms, safe from any thread.
RgbImage residual_picture(const Intrinsics& result);

}  // namespace tassilo
