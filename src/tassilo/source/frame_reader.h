#pragma once

#include <optional>

#include "tassilo/image/frame.h"
#include "tassilo/source/camera.h"
#include "tassilo/source/frame_source.h"

namespace tassilo {

/// What each kind of source does: see FrameSource, which reads ahead for SourceInfo and remembers end and damage. Also
/// the way in for sources that are none of this part's.
class FrameReader {
 public:
  virtual ~FrameReader() = default;
  /// Not called again after it returned nothing or threw.
  virtual std::optional<Frame> next() = 0;
  /// Name, description, frame count and live; the rest is read off the first frame. Asked after that frame was read.
  virtual SourceInfo info() const = 0;
  /// Of a camera.
  virtual CameraCounts counts() const { return {}; }
  virtual std::optional<double> now() const { return std::nullopt; }
};

}  // namespace tassilo
