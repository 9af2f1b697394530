#pragma once

#include <memory>
#include <string>

#include "tassilo/image/frame.h"

namespace tassilo {

/// A frame with the pixels as they are classified, planar 4:2:2, as `/ws/frame` sends it: see openapi.yaml. Formats
/// with halved chroma rows have each row twice. O(pixels).
std::string frame_bytes(const Frame& frame);

/// The frame in such bytes, whose pixels stay where they are and live as long as the frame.
Frame frame_of_bytes(std::shared_ptr<const std::string> bytes);

}  // namespace tassilo
