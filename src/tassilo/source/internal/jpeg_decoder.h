#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "tassilo/source/internal/av_support.h"

namespace tassilo {

/// Motion JPEG, picture by picture; one decoder for all of them, as they come without their tables from many cameras.
/// One thread at a time.
class JpegDecoder {
 public:
  /// name  for messages. Throws Error when FFmpeg has no decoder.
  explicit JpegDecoder(std::string name);

  /// The picture in its own layout; nothing when it is damaged, cut short, or holds no picture that we know.
  /// Index and time are left to the caller.
  std::optional<Frame> decode(std::span<const std::uint8_t> jpeg);

 private:
  std::string name_;
  AvCodec codec_;
};

}  // namespace tassilo
