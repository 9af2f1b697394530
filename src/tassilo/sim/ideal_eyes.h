#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <span>

#include "tassilo/scene/scene.h"
#include "tassilo/sim/world.h"
#include "tassilo/timeline/odometry.h"
#include "tassilo/track/tracks.h"

namespace tassilo {

/// What a robot's vision makes of the world, without pictures. Sigmas are one standard deviation.
struct EyesOptions {
  std::uint64_t seed = 1;
  double view_deg = 90;             ///< Of the cone that is seen, around ahead. [deg], > 0, <= 360
  double max_range = 5;             ///< Nothing is seen beyond. [m], > 0
  double distance_sigma = 0.07;     ///< Of a ball's or robot's distance. [1], >= 0
  double bearing_sigma_deg = 1;     ///< [deg], >= 0
  double miss = 0.1;                ///< Share of frames in which something in view is not found. 0..1
  double pose_sigma = 0.05;         ///< Along x and y. [m], >= 0
  double pose_sigma_deg = 3;        ///< [deg], >= 0
  double pose_correlation_s = 0.5;  ///< How long the pose is wrong alike. [s], > 0
  double lost_every_s = 30;         ///< Between times in which the pose is not known, in the mean. [s], > 0
  double lost_s = 1.5;              ///< How long they are, in the mean. [s], >= 0
  void check() const;               ///< Throws Error naming the first field out of range.
};

/// Makes scenes of the truth, as the vision of one robot would: a ball and robots within the cone unless robots hide
/// them, the goals' mouths, free space, all with noise; tracks of the project's own tracker; a pose with noise that
/// lasts, and times without. What it tells as covariance is what it adds as noise.
///
/// threads  one at a time
class IdealEyes {
 public:
  /// Throws Error for options out of range.
  explicit IdealEyes(const EyesOptions& options, int robot);

  /// A scene of the world as it is now. Time must not go back from call to call.
  Scene see(const World& world);
  /// What eyes in the dark see: nothing.
  Scene see_black(const World& world);

 private:
  EyesOptions options_;
  int robot_;
  std::mt19937_64 random_;
  std::int64_t frame_ = 0;
  double seen_at_ = 0;
  double error_x_ = 0, error_y_ = 0, error_theta_ = 0;  ///< Of the pose, in sigmas.
  double lost_until_ = -1e9, next_lost_ = 0;            ///< [s]
  bool is_first_ = true;
  Odometry odometry_;
  TrackState tracks_;
};

}  // namespace tassilo
