#pragma once

#include "tassilo/base/recycled.h"
#include "tassilo/detect/view.h"
#include "tassilo/scene/scene.h"

namespace tassilo {

struct RobotOptions {
  int min_columns = 4;         ///< Narrower stretches are noise. [px], >= 1
  int min_rows = 4;            ///< Lower ones, too. [px], >= 1
  int gap_px = 2;              ///< Rim between two colors that is neither, and noise. [px], >= 0
  double max_step = 0.25;      ///< A foot that jumps further from column to column belongs to another robot. [m], > 0
  double foot_sigma_px = 0.6;  ///< Of the foot's row: shadow, blur and noise. [px], > 0
  double bound_sigmas = 2.5;   ///< Width of the distance bounds to either side. [1], > 0
  void check() const;          ///< Throws Error naming the first field out of range.
};

/// Robots by their black body and colored marker, from left to right; empty when none.
///
/// Every column is followed up from where a robot's colors stand on the floor; neighbors join while foot and marker
/// color stay the same, so robots that touch or hide each other come apart. Without calibration feet are compared in
/// pixels, and only boxes and teams are told.
///
/// cost     O(pixels); safe from any thread. source: own
RecycledVector<RobotSeen> find_robots(const View& view, const RobotOptions& options = {});

}  // namespace tassilo
