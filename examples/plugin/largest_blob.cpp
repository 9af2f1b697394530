// Another way to find the ball: the largest round blob of its color, as far away as the floor at its foot.
//
//   cmake -S examples/plugin -B build/plugin -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH=WHERE_TASSILO_IS_INSTALLED
//   cmake --build build/plugin
//   tassilo info --stages --plugin build/plugin/largest_blob.so
//
// To use it, two lines in robot.yaml; the first may also be `--plugin FILE` of `tassilo run`:
//
//   plugins: [largest_blob.so]
//   vision: {balls: largest_blob, largest_blob_min_area: 30}
#include <cmath>
#include <numbers>

#include "tassilo/region/components.h"
#include "tassilo/region/features.h"
#include "tassilo/vision/plugin.h"

using namespace tassilo;

namespace {

constexpr const char* kMinArea = "largest_blob_min_area";
constexpr double kMaxAnisometry = 1.6;  ///< Of a disc 1; a highlight or a line before the ball takes some of it.
constexpr double kFootSigma = 1;        ///< Of the blob's lowest row. [px]

/// The ball's foot from the pixel at its lower rim. The ray past the rim is a tangent to the ball, which meets the
/// floor before the ball does, by radius * tan(a / 2) for a ray that falls by the angle a.
std::optional<FloorPoint> foot_at(const View& view, PixelPoint lowest) {
  const MountedCamera& camera = view.optics->camera;
  const auto point = camera.floor_point(lowest);
  if (!point) return std::nullopt;
  const FloorPoint eye = foot_of(camera);
  const double range = distance(*point, eye), height = camera.center().z;
  const double further = view.field.ball.radius.middle() * height / (range + std::hypot(range, height));
  return *point + further / range * (*point - eye);
}

/// Nothing above the horizon, and without calibration.
std::optional<BallOnFloor> on_floor(const View& view, PixelPoint lowest) {
  if (view.optics == nullptr) return std::nullopt;
  const auto foot = foot_at(view, lowest), before = foot_at(view, {lowest.x, lowest.y + 2 * kFootSigma}),
             behind = foot_at(view, {lowest.x, lowest.y - 2 * kFootSigma});
  const auto seen = floor_gaussian(view.optics->camera, lowest, kFootSigma, view.optics->mount_sigma);
  if (!foot || !before || !behind || !seen) return std::nullopt;
  BallOnFloor ball{*seen, {norm(*before), norm(*behind)}};
  ball.position.mean = *foot;
  return ball;
}

BallSearch largest_blob(const View& view, double min_area) {
  const auto color = color_class_from(view.field.ball.color).value_or(ColorClass::red);
  const Region* largest = nullptr;
  ShapeFeatures shape;
  const RecycledVector<Region> blobs = components(view.segmentation.of(color));
  for (const Region& blob : blobs) {
    const ShapeFeatures features = shape_features(blob);
    const bool round = features.anisometry >= 1 && features.anisometry <= kMaxAnisometry;
    if (!round || features.area < min_area || features.area <= shape.area) continue;
    largest = &blob;
    shape = features;
  }
  if (largest == nullptr) return {.balls = {}, .why = "no round blob of the ball's color is large enough"};

  const PixelRun foot = largest->runs().back();
  const Ball ball{.box = shape.box,
                  .center = shape.center,
                  .radius_px = std::sqrt(static_cast<double>(shape.area) / std::numbers::pi),
                  .confidence = 1 / shape.anisometry,
                  .floor = on_floor(view, {(foot.begin + foot.end - 1) / 2.0, foot.row + 0.5})};
  return {.balls = {ball}, .why = {}};
}

}  // namespace

void tassilo_register(StageRegistry& registry) {
  const OptionInfo min_area{.key = kMinArea,
                            .unit = "px^2",
                            .low = 1,
                            .high = 100000,
                            .whole = true,
                            .meaning = "smaller blobs are noise",
                            .standard = 20,
                            .stage = "balls"};
  const auto make = [](const VisionOptions& options) {
    return [least = options.own.at(kMinArea)](const View& view) { return largest_blob(view, least); };
  };
  registry.balls.alternatives.push_back(
      {"largest_blob", "largest round blob of the ball's color, by the floor at its foot", {min_area}, make});
}
