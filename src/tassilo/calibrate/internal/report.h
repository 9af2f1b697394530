#pragma once

#include <span>

#include "tassilo/calibrate/intrinsics.h"

namespace tassilo {

/// Where the used points of the views that count lie.
Coverage coverage_of(const CameraModel& camera, std::span<const ViewResult> views);

/// `Intrinsics::worst_sigma_px` for camera parameters (see lens.h) with their covariance.
double worst_sigma(ImageSize size, LensModel model, std::span<const double> camera, const Eigen::MatrixXd& covariance);

/// What makes a calibration doubtful, for `Intrinsics::warnings`; everything else in `result` is there.
std::vector<std::string> warnings_of(const Intrinsics& result);

}  // namespace tassilo
