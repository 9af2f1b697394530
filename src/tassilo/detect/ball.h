#pragma once

#include "tassilo/base/recycled.h"
#include "tassilo/base/recycled_string.h"
#include "tassilo/detect/view.h"
#include "tassilo/scene/scene.h"

namespace tassilo {

struct BallOptions {
  int min_area_px = 4;  ///< Fewer pixels of the ball's color are noise. [px^2], >= 1
  int max_balls = 5;    ///< Hypotheses reported, best first. >= 1
  /// The segment may be smaller than the projected disc by these factors, for a highlight or a shadow; the highlight is
  /// on top, so rows may miss more than columns. Asked of balls that are not cut or hidden. [1], 0 .. 1
  double min_width = 0.7, min_height = 0.55;
  /// Least share of the visible disc that shows the ball's color. [1], 0 .. 1
  double min_cover = 0.5;
  /// One edge point across the outline: quantization and noise. [px], > 0
  double edge_sigma_px = 0.3;
  /// What all edges of one ball have in common: shading and blur move them together. [px], > 0
  double common_sigma_px = 0.1;
  /// Bounds on the distance reach this many standard deviations beyond the tangents' own. [1], > 0
  double bound_sigmas = 2.5;
  /// While driving the robot nods, and a ball's size no longer fits where it seems to lie. What fits no ball with the
  /// mount as calibrated may fit one with the camera pitched by up to this angle, tried in steps; trusted half as much,
  /// with the step as uncertainty. 0: never. [deg], 0 .. 10
  double max_nod_deg = 2.0;
  double nod_step_deg = 0.5;  ///< [deg], > 0
  void check() const;         ///< Throws Error naming the first field out of range.
};

struct BallSearch {
  RecycledVector<Ball> balls;  ///< Best first; empty when none.
  RecycledString why;          ///< In plain words why there is none; empty when there is one.
};

/// Balls.
///
/// With calibration a ball is a sphere that rests on the floor: its outline is fitted at sub-pixel accuracy, and what
/// does not fit one (too large, too small, no carpet at its foot, off the field) is rejected. Without calibration a
/// ball is a round segment of the ball's color above carpet, or above nothing known.
///
/// cost     O(pixels of the ball's color); safe from any thread. source: DESIGN 6.5 and 6.6, fit own
BallSearch search_balls(const View& view, const BallOptions& options = {});
/// The balls alone.
RecycledVector<Ball> find_balls(const View& view, const BallOptions& options = {});

}  // namespace tassilo
