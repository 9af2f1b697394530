#pragma once

#include <embree3/rtcore.h>

#include <memory>
#include <span>
#include <vector>

#include "tassilo/sim/internal/stage.h"

namespace tassilo {

/// Embree's objects, released in time.
struct RtcRelease {
  void operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
  void operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometryTy* geometry) const { rtcReleaseGeometry(geometry); }
};
using RtcDevice = std::unique_ptr<RTCDeviceTy, RtcRelease>;
using RtcScene = std::unique_ptr<RTCSceneTy, RtcRelease>;
using RtcGeometry = std::unique_ptr<RTCGeometryTy, RtcRelease>;

/// Which of eight rays are asked for: -1, else 0.
struct alignas(32) LaneMask {
  int lane[8] = {};
};

/// A sphere, or an upright cylinder with its top.
struct MovingPart {
  enum class Shape { sphere, cylinder };
  Shape shape = Shape::sphere;
  float x = 0, y = 0, z = 0;  ///< Middle of a sphere; of a cylinder's bottom. [m]
  float radius = 0, height = 0;
  int object = 0;  ///< As SimView has it.
  Light paint = Light::Zero(), band = Light::Zero();
  float band_low = 2, band_high = 2;  ///< Of the height; there it shows `band`.
  std::uint8_t label = 0, band_label = 0;
  float gloss = 0;
};

/// Eight rays through the stage and what moves on it.
class RayWorld {
 public:
  /// Watertight: no ray slips through between triangles, for a tenth of the time.
  explicit RayWorld(const Stage& stage, bool watertight = true);

  /// Where everything stands from now on. Allocates only when there are more parts than ever before.
  void place(std::span<const MovingPart> parts);

  /// The nearest hits. instID of moving parts is their index; others have RTC_INVALID_GEOMETRY_ID there.
  void intersect(const LaneMask& valid, RTCRayHit8& rays) const;
  /// tfar becomes negative where something is in the way; the hall and what stands in it never is: lamps may hang
  /// beyond its ceiling.
  void occluded(const LaneMask& valid, RTCRay8& rays, bool by_stage, bool by_parts) const;
  /// A part alone.
  void intersect_part(const LaneMask& valid, const MovingPart& part, RTCRayHit8& rays) const;

 private:
  RtcScene new_scene(RTCSceneFlags flags) const;

  RtcDevice device_;
  RtcScene stage_, casters_, moving_, sphere_, cylinder_;  ///< casters_: what of the stage casts shadows.
  std::vector<RtcGeometry> instances_;
  std::vector<MovingPart::Shape> shapes_;
};

}  // namespace tassilo
