#pragma once

#include <span>
#include <vector>

#include "tassilo/camera/camera_model.h"
#include "tassilo/sim/internal/stage.h"
#include "tassilo/sim/renderer.h"

namespace tassilo {

/// From light to bytes: blur, vignetting, exposure, noise, tone, BT.601, chroma subsampling.
class Sensor {
 public:
  Sensor(const CameraModel& camera, const RenderOptions& options);

  /// `light` is by rows, and is spoiled. `seed` is of this frame's noise.
  void develop(std::span<Light> light, std::uint64_t seed, const RenderOptions& options, const FrameBuffer& into);

 private:
  void blur(std::span<Light> light);

  int width_, height_;
  std::vector<float> kernel_;  ///< From the middle outwards.
  std::vector<float> vignette_;
  std::vector<float> tone_;
  std::vector<Light> noise_;
  std::vector<Light> row_, ring_;
  std::vector<float> chroma_;  ///< Of the row above, for 4:2:0: Pb, Pr sums.
};

}  // namespace tassilo
