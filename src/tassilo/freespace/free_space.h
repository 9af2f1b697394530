#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "tassilo/base/recycled.h"
#include "tassilo/camera/mount.h"
#include "tassilo/scene/scene.h"
#include "tassilo/surface/surface.h"

namespace tassilo {

struct FreeSpaceOptions {
  double sector_deg = 2;  ///< Width of a sector. [deg], .1 .. 90
  int rays = 5;           ///< Lines of sight followed per sector; the shortest counts. 1 .. 99
  double max_range = 8;   ///< Floor further away is not asked for. [m], > 0
  int noise_px = 2;       ///< So many odd pixels in a row are noise, when floor follows. [px], >= 0
  void check() const;     ///< Throws Error naming the first field out of range.
};

/// For one mounted camera: which pixels lie along which direction, from near to far. Computed once; immutable.
///
/// Sector i is centred on angle_min + i * angle_increment in the robot frame; centres are multiples of the increment.
/// Only the arc in which floor is in view has sectors: none when the camera sees no floor. The arc lies around the
/// camera's heading, so a camera looking back has angles beyond pi.
class SectorMap {
 public:
  SectorMap(const MountedCamera& camera, const FreeSpaceOptions& options);

  /// A pixel on a line of sight along the floor, and its distance from the origin. [m]
  struct Step {
    std::int16_t column, row;
    float range;
  };
  /// Steps that follow one another within one of the surface's tiles.
  struct Stretch {
    std::uint32_t tile;
    std::uint32_t end;  ///< One behind its last step.
    float range;        ///< Of its last step. [m]
  };
  struct Ray {
    RecycledVector<Step> steps;          ///< Empty where no floor of this direction is in view.
    RecycledVector<Stretch> stretches;   ///< All steps, in order.
    bool is_in_view_to_the_end = false;  ///< What ends it is the maximal range, not the edge of the view.
  };

  const MountedCamera& camera() const { return camera_; }
  const FreeSpaceOptions& options() const { return options_; }
  FloorPoint origin() const { return origin_; }                ///< Below the camera.
  double angle_min() const { return angle_min_; }              ///< In [-pi, pi); 0 without sectors. [rad]
  double angle_increment() const { return angle_increment_; }  ///< [rad]
  std::size_t sectors() const { return rays_.size() / static_cast<std::size_t>(options_.rays); }
  std::span<const Ray> rays(std::size_t sector) const {
    return std::span(rays_).subspan(sector * static_cast<std::size_t>(options_.rays),
                                    static_cast<std::size_t>(options_.rays));
  }

 private:
  MountedCamera camera_;
  FreeSpaceOptions options_;
  FloorPoint origin_;
  double angle_min_ = 0, angle_increment_ = 0;
  RecycledVector<Ray> rays_;
};

/// Free motion space around the floor point under the camera (DESIGN 5 and 6.7).
///
/// Each line of sight is followed over carpet and lines; the first thing that is neither, and is more than noise, ends
/// it. An accepted ball is no obstacle but hides the floor behind it.
///
/// surface  of an image of the map's camera
/// balls    accepted balls, by their box and outline in the image
/// returns  one state and one range for each of the map's sectors
/// cost     O(pixels + tiles on the lines of sight + pixels of tiles that are not all floor); safe from any thread.
/// source: own, after the AGILO free motion space
FreeSpace find_free_space(const SectorMap& map, const Surface& surface, std::span<const Ball> balls);

}  // namespace tassilo
