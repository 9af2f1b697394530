#include "tassilo/calibrate/intrinsics.h"

#include <algorithm>
#include <cmath>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/base/option_check.h"
#include "tassilo/calibrate/internal/calibration.h"
#include "tassilo/calibrate/internal/lens.h"
#include "tassilo/calibrate/internal/report.h"

namespace tassilo {
namespace {

const std::string kSubject = "calibration";

/// Why a view cannot be used, before anything is computed; empty when it can.
std::string unusable(ImageSize size, const TargetView& view) {
  if (view.points.size() < kLeastPoints)
    return "it has " + std::to_string(view.points.size()) + " points, must be at least " + std::to_string(kLeastPoints);
  for (const SeenPoint& point : view.points)
    if (!(point.pixel.x >= -.5 && point.pixel.y >= -.5 && point.pixel.x <= size.width - .5 &&
          point.pixel.y <= size.height - .5))
      return "it has points outside the image";
  const bool is_line =
      std::ranges::all_of(view.points, [&](const SeenPoint& p) { return p.row == view.points[0].row; }) ||
      std::ranges::all_of(view.points, [&](const SeenPoint& p) { return p.column == view.points[0].column; });
  return is_line ? "its points are on one line" : "";
}

}  // namespace

std::string_view to_string(LensModel model) {
  switch (model) {
    case LensModel::plumb_bob:
      return "plumb_bob";
    case LensModel::equidistant:
      return "equidistant";
    case LensModel::division:
      break;
  }
  return "division";
}

void IntrinsicsOptions::check() const {
  const int most = model == LensModel::division ? 1 : model == LensModel::plumb_bob ? 3 : 4;
  if (radial_terms < 0 || radial_terms > most)
    throw Error("intrinsics.radial_terms", "is " + std::to_string(radial_terms) + ", must be within 0 and " +
                                               std::to_string(most) + " for " + std::string(to_string(model)));
  check_above("intrinsics.outlier_ratio", outlier_ratio, 1);
  if (folds != 0 && folds < 2) throw Error("intrinsics.folds", "is " + std::to_string(folds) + ", must be 0 or >= 2");
}

double TargetPose::tilt() const { return std::acos(std::min(1., std::abs(rotation(2, 2)))); }

Intrinsics calibrate_intrinsics(ImageSize size, std::span<const TargetView> views, const IntrinsicsOptions& options) {
  options.check();
  expects(size.width > 0 && size.height > 0, "calibrate_intrinsics: an image size");
  Intrinsics out;
  out.views.resize(views.size());
  std::vector<TargetView> usable;
  std::vector<std::size_t> place;
  for (std::size_t v = 0; v < views.size(); ++v) {
    views[v].target.check();
    out.views[v].rejected = unusable(size, views[v]);
    if (!out.views[v].rejected.empty()) continue;
    usable.push_back(views[v]);
    place.push_back(v);
  }
  if (usable.size() < static_cast<std::size_t>(kLeastViews))
    throw Error(kSubject, "has " + std::to_string(usable.size()) + " usable views, must be at least " +
                              std::to_string(kLeastViews));

  Calibration calibration(size, usable, options);
  calibration.run();
  const auto& parameters = calibration.state().camera;
  out.covariance = calibration.covariance();
  const auto names = parameter_names(options.model);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    out.values.push_back({std::string(names[i]), parameters[i], std::sqrt(std::max(0., out.covariance(k, k)))});
  }
  out.camera = camera_from(size, options.model, parameters);
  try {
    out.camera.check();
  } catch (const Error& error) {
    throw Error(kSubject, std::string("ends at no valid camera (") + error.what() +
                              "): cover the image up to its corners, or estimate fewer coefficients");
  }
  for (std::size_t v = 0; v < usable.size(); ++v) out.views[place[v]] = calibration.view_result(v);
  out.rms_px = calibration.rms();
  out.frame_places = calibration.frame_places();
  out.frames_rejected = calibration.frames_rejected();
  if (options.folds > 0) out.cross_validated_rms_px = calibration.cross_validated();
  out.worst_sigma_px = worst_sigma(size, options.model, parameters, out.covariance);
  out.coverage = coverage_of(out.camera, out.views);
  out.warnings = warnings_of(out);
  return out;
}

}  // namespace tassilo
