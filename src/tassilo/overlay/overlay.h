#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tassilo/camera/mount.h"
#include "tassilo/contour/contour.h"
#include "tassilo/image/frame.h"
#include "tassilo/overlay/picture.h"
#include "tassilo/region/region.h"
#include "tassilo/scene/scene.h"
#include "tassilo/surface/surface.h"

namespace tassilo {

/// What one step of the vision saw, to be looked at by itself.
struct StepPicture {
  std::string title;              ///< Shown in the status line.
  Region region;                  ///< Tinted.
  std::vector<Contour> contours;  ///< Polylines in the image, neighbors of the list in different colors. [px]
};

struct OverlayOptions {
  const MountedCamera* camera = nullptr;      ///< Borrowed. Without it nothing is drawn that lies on the floor.
  std::span<const std::uint8_t> labels = {};  ///< Color classes 0..8 of all pixels, row by row; empty: none.
  /// Of the frame, borrowed. With it the free floor is tinted where carpet shows: lines keep their white. Without it
  /// only the balls keep their color.
  const Surface* surface = nullptr;
  const StepPicture* step = nullptr;  ///< Borrowed. With it this is drawn on the image, and nothing else.
  int scale = 0;          ///< Picture pixels an image pixel, 1..16; 0: the smallest that makes the image 768 wide. [1]
  bool bird_view = true;  ///< The view from above beside the image; there is none without a camera.
  double bird_range = 6;  ///< The view from above reaches at least so far ahead of the robot. [m], > 0
  /// Throws Error naming the first value out of range.
  void check() const;
};

/// A frame with what was seen in it, for people.
///
/// On the image, enlarged by a whole number: the free floor in green with a red edge where something blocks it, lines
/// (white; field boundary violet), goals, robots and balls as boxes in their color with distance, bearing or
/// confidence; further ball hypotheses thinner; the numbers of tracks, where they come within half a second, and a
/// dashed ring around those not seen in this frame. Below it a line with frame number, time and total processing time.
/// View from above: rings of 1 m around the robot (x up, y left), free space (unseen sectors grey), ball with 2-sigma
/// ellipse and bracket from near to far, robots, goals, lines. The size depends on the frame's size and the options
/// only, so that pictures of a sequence make a video; both sides are even. `options.labels` has width * height entries
/// or none, `options.surface` the size of the frame. A few milliseconds; safe from any thread.
Picture draw_overlay(const FrameView& frame, ColorRange range, const Scene& scene, const OverlayOptions& options = {});

}  // namespace tassilo
