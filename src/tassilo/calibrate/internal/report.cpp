#include "tassilo/calibrate/internal/report.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "tassilo/calibrate/internal/lens.h"

namespace tassilo {
namespace {

constexpr int kEnoughViews = 6;
constexpr double kEnoughShare = .6, kEnoughReach = .8;
constexpr double kEnoughTilt = 20;      ///< [deg]
constexpr double kFocalSigma = .005;    ///< Relative.
constexpr double kMappedSigma = .5;     ///< [px]
constexpr double kLargeRms = .5;        ///< [px]
constexpr double kUnstableRatio = 1.5;  ///< Of the cross-validated RMS and the RMS.

std::string text(const char* format, double value) {
  char out[64];
  std::snprintf(out, sizeof out, format, value);
  return out;
}

/// How the image of a ray moves with a camera parameter.
std::optional<Eigen::Vector2d> slope(ImageSize size, LensModel model, std::vector<double> camera, std::size_t which,
                                     OpticalPoint ray) {
  const double step = which < 2 ? 1e-5 * camera[which] : which < 4 ? 1e-3 : 1e-6;
  const double middle = camera[which];
  camera[which] = middle + step;
  const auto high = project(camera_from(size, model, camera), ray);
  camera[which] = middle - step;
  const auto low = project(camera_from(size, model, camera), ray);
  if (!high || !low) return std::nullopt;
  return Eigen::Vector2d(high->x - low->x, high->y - low->y) / (2 * step);
}

Coverage empty_coverage(ImageSize size) {
  Coverage out;
  out.columns = 8;
  out.rows = std::max(1, static_cast<int>(std::lround(8. * size.height / size.width)));
  out.points.assign(static_cast<std::size_t>(out.columns * out.rows), 0);
  return out;
}

void add_point(Coverage& coverage, ImageSize size, PixelPoint at) {
  const int column = std::clamp(static_cast<int>((at.x + .5) * coverage.columns / size.width), 0, coverage.columns - 1);
  const int row = std::clamp(static_cast<int>((at.y + .5) * coverage.rows / size.height), 0, coverage.rows - 1);
  ++coverage.points[static_cast<std::size_t>(row * coverage.columns + column)];
}

void set_share(Coverage& coverage) {
  const auto covered = std::ranges::count_if(coverage.points, [](int count) { return count > 0; });
  coverage.share = static_cast<double>(covered) / static_cast<double>(coverage.points.size());
}

}  // namespace

Coverage coverage_of(ImageSize size, std::span<const TargetView> views) {
  Coverage out = empty_coverage(size);
  for (const TargetView& view : views)
    for (const SeenPoint& point : view.points) add_point(out, size, point.pixel);
  set_share(out);
  return out;
}

Coverage coverage_of(const CameraModel& camera, std::span<const ViewResult> views) {
  const ImageSize size{camera.width, camera.height};
  Coverage out = empty_coverage(size);
  const double x = std::max(camera.cx, camera.width - 1 - camera.cx);
  const double y = std::max(camera.cy, camera.height - 1 - camera.cy);
  for (const ViewResult& view : views) {
    if (!view.rejected.empty()) continue;
    for (const PointResidual& point : view.points) {
      if (!point.used) continue;
      add_point(out, size, point.seen);
      // Distances as the lens counts them: pixels need not be square.
      const double far = std::hypot((point.seen.x - camera.cx) / camera.fx, (point.seen.y - camera.cy) / camera.fy);
      out.reach = std::max(out.reach, far / std::hypot(x / camera.fx, y / camera.fy));
    }
  }
  set_share(out);
  return out;
}

double worst_sigma(ImageSize size, LensModel model, std::span<const double> camera, const Eigen::MatrixXd& covariance) {
  const std::vector<double> values(camera.begin(), camera.end());
  const CameraModel exact = camera_from(size, model, values);
  constexpr int columns = 9, rows = 7;
  const auto n = static_cast<Eigen::Index>(values.size());
  Eigen::MatrixXd by_camera(2 * columns * rows, n), by_turn(2 * columns * rows, 3);
  Eigen::Index count = 0;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const auto ray = unproject(exact, {c * (size.width - 1.) / (columns - 1), r * (size.height - 1.) / (rows - 1)});
      if (!ray) return std::numeric_limits<double>::infinity();
      bool exists = true;
      for (std::size_t k = 0; k < values.size() && exists; ++k) {
        const auto moved = slope(size, model, values, k, *ray);
        if ((exists = moved.has_value())) by_camera.block<2, 1>(count, static_cast<Eigen::Index>(k)) = *moved;
      }
      for (int axis = 0; axis < 3 && exists; ++axis) {
        constexpr double step = 1e-6;
        const OpticalPoint turn =
            cross(OpticalPoint{axis == 0 ? step : 0., axis == 1 ? step : 0., axis == 2 ? step : 0.}, *ray);
        const auto high = project(exact, *ray + turn), low = project(exact, *ray - turn);
        if ((exists = high && low))
          by_turn.block<2, 1>(count, axis) = Eigen::Vector2d(high->x - low->x, high->y - low->y) / (2 * step);
      }
      if (!exists) return std::numeric_limits<double>::infinity();
      count += 2;
    }
  const Eigen::MatrixXd left = by_camera - by_turn * by_turn.colPivHouseholderQr().solve(by_camera);
  double worst = 0;
  for (Eigen::Index i = 0; i < count; i += 2) {
    const Eigen::MatrixXd at = left.middleRows(i, 2);
    worst = std::max(worst, (at * covariance * at.transpose()).trace());
  }
  return std::sqrt(worst);
}

std::vector<std::string> warnings_of(const Intrinsics& result) {
  std::vector<std::string> out;
  const auto used = std::ranges::count_if(result.views, [](const ViewResult& v) { return v.rejected.empty(); });
  if (used < kEnoughViews)
    out.push_back("only " + std::to_string(used) +
                  " views: too few to tell a wrong one or to check the result, should be at least " +
                  std::to_string(kEnoughViews) + ", tilted differently and all over the image");
  const Coverage& coverage = result.coverage;
  if (!std::isfinite(result.worst_sigma_px))
    out.push_back(
        "the lens turns back on itself before the image's corners: more radial terms than the views determine");
  if (!result.frames_rejected.empty()) out.push_back("frames of dots are not used: " + result.frames_rejected);
  if (coverage.share < kEnoughShare)
    out.push_back("points cover " + text("%.1f", 100 * coverage.share) + " % of the image, should be at least " +
                  text("%.0f", 100 * kEnoughShare) + " %");
  if (coverage.reach < kEnoughReach)
    out.push_back("points reach " + text("%.1f", 100 * coverage.reach) +
                  " % of the way to the farthest corner, should be at least " + text("%.0f", 100 * kEnoughReach) +
                  " %: beyond them the lens is a guess");
  double tilt = 0;
  for (const ViewResult& view : result.views)
    if (view.rejected.empty()) tilt = std::max(tilt, view.pose.tilt() * 180 / std::numbers::pi);
  if (tilt < kEnoughTilt)
    out.push_back("targets are tilted by at most " + text("%.0f", tilt) + " degrees, should be at least " +
                  text("%.0f", kEnoughTilt) + ": focal length and distance can hardly be told apart");
  for (const EstimatedValue& value : result.values)
    if (value.name[0] == 'f' && value.sigma > kFocalSigma * value.value)
      out.push_back(value.name + " has a standard deviation of " + text("%.2f", 100 * value.sigma / value.value) +
                    " %, should be at most " + text("%.1f", 100 * kFocalSigma) + " %");
  if (result.worst_sigma_px > kMappedSigma)
    out.push_back("somewhere in the image directions have a standard deviation of " +
                  text("%.1f", result.worst_sigma_px) + " px, should be at most " + text("%.1f", kMappedSigma));
  if (result.rms_px > kLargeRms)
    out.push_back("points lie " + text("%.2f", result.rms_px) + " px off, should be at most " +
                  text("%.1f", kLargeRms) + ": the target is not flat or not as told, or the lens is of another kind");
  if (result.cross_validated_rms_px && *result.cross_validated_rms_px > kUnstableRatio * result.rms_px + .02)
    out.push_back("views that were not used lie " + text("%.2f", *result.cross_validated_rms_px) + " px off, " +
                  text("%.2f", result.rms_px) +
                  " px those that were: there are too few of them or they are too much alike");
  return out;
}

}  // namespace tassilo
