#include "tassilo/app/annotated_picture.h"

#include "tassilo/files/jpeg.h"
#include "tassilo/overlay/overlay.h"

namespace tassilo {

std::string annotated_jpeg(const Frame& frame, const Scene& scene, const Surface& surface, const Optics* optics) {
  OverlayOptions options;
  options.camera = optics != nullptr ? &optics->camera : nullptr;
  options.surface = &surface;
  const Picture picture = draw_overlay(frame.view, frame.range, scene, options);
  constexpr int quality = 80;
  return encode_jpeg(picture.pixels, picture.width, picture.height, quality, "frame " + std::to_string(scene.frame));
}

}  // namespace tassilo
