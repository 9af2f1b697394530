#pragma once

#include "tassilo/base/recycled.h"
#include "tassilo/base/recycled_string.h"
#include "tassilo/detect/view.h"
#include "tassilo/scene/scene.h"

namespace tassilo {

struct GoalOptions {
  int min_area_px = 20;  ///< Smaller segments are noise. [px^2], >= 1
  /// Columns of a goal below which the floor shows, of those not hidden by robots. [1], 0 .. 1
  double min_foot_share = 0.25;
  double edge_sigma_px = 0.4;  ///< Of a post's column. [px], > 0
  double foot_sigma_px = 1.0;  ///< Of a foot's row. [px], > 0
  void check() const;          ///< Throws Error naming the first field out of range.
};

struct GoalSearch {
  RecycledVector<Goal> goals;
  RecycledVector<RecycledString> why;  ///< For each color without a goal, in plain words why there is none.
};

/// Goals of the field's model, one entry a color, yellow first; empty when none.
///
/// A goal is what shows a goal's color, stands on the floor and has a goal's height there; its pieces left and right of
/// a robot are one goal. The ends of the panel are the posts' inner edges; with both seen the mouth of known width is
/// fitted to their bearings and feet. Without calibration only boxes and colors are told.
///
/// cost     O(pixels of the goal colors); safe from any thread. source: own
GoalSearch search_goals(const View& view, const GoalOptions& options = {});
/// The goals alone.
RecycledVector<Goal> find_goals(const View& view, const GoalOptions& options = {});

}  // namespace tassilo
