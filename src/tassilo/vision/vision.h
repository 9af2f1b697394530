#pragma once

#include <memory>
#include <optional>
#include <string>

#include "tassilo/camera/mount.h"
#include "tassilo/color/color_table.h"
#include "tassilo/color/segment.h"
#include "tassilo/detect/view.h"
#include "tassilo/image/frame.h"
#include "tassilo/localize/localize.h"
#include "tassilo/scene/scene.h"
#include "tassilo/timeline/sequence.h"
#include "tassilo/track/tracks.h"
#include "tassilo/vision/options.h"
#include "tassilo/vision/stages.h"

namespace tassilo {

/// All that stays the same from frame to frame.
struct VisionSetup {
  ColorTable colors;
  FieldModel field;
  std::optional<CameraModel> camera;  ///< Without camera or mount, all floor values stay empty.
  std::optional<CameraMount> mount;
  VisionOptions options;
  std::optional<PoseGaussian> start_pose;
};

/// What is known from the frames before, asked for by time; no stage keeps anything of its own. A run that is given
/// another's history goes on as that one would.
struct VisionHistory {
  static constexpr std::size_t kFrames = 64;  ///< Two seconds and more of a usual camera.
  Sequence<PoseBelief> beliefs{kFrames};
  Sequence<TrackState> tracks{kFrames};

  void clear() {
    beliefs.clear();
    tracks.clear();
  }
};

/// Memory that is used again from frame to frame, and what the last frame left in it, to be shown or stored.
struct VisionWorkspace {
  Segmentation segmentation;
  Surface surface;
  bool watch_boundary = false;       ///< Find the boundary even when the localization does not ask for it.
  std::optional<Boundary> boundary;  ///< Where somebody asked for it.
  RecycledVector<LineMark> marks;    ///< Of lines, as the localization was given them.
  RecycledVector<int> line_of;  ///< By a mark's `line`: the line of the field it was taken for, -1 or beyond: none.
  VisionHistory history;
};

/// The one place where stages are put in order: from frame to scene.
///
/// Immutable after construction; one call at a time per workspace, from any thread.
class Vision {
 public:
  /// Throws Error when options, camera or table are out of range, or a stage has no alternative of the chosen name.
  explicit Vision(const VisionSetup& setup);
  /// With alternatives from elsewhere, too.
  Vision(const VisionSetup& setup, const StageRegistry& registry);

  /// Sees one frame. `timing` has a row for each stage and "total". A frame that is not later than the one before
  /// begins another drive: the history is forgotten.
  /// odometry   null where there is none
  /// Throws Error when the frame is not what check_frames asks for.
  Scene operator()(const Frame& frame, VisionWorkspace& workspace, const Odometry* odometry = nullptr) const;

  /// Throws Error naming `name` when frames of this size are not the camera's, or their range is not the table's.
  void check_frames(const std::string& name, int width, int height, ColorRange range) const;

  const Optics* optics() const { return optics_.get(); }

 private:
  Classifier classifier_;
  FieldModel field_;
  VisionOptions options_;
  Stages stages_;
  std::unique_ptr<const Optics> optics_;
  std::unique_ptr<const SectorMap> sectors_;
  std::unique_ptr<const FieldTarget> target_;
  std::optional<PoseGaussian> start_pose_;
};

}  // namespace tassilo
