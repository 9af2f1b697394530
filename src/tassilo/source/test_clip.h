#pragma once

extern "C" {
#include <libavutil/pixfmt.h>
}

#include <cstdint>
#include <string>
#include <vector>

namespace tassilo {

/// Pixels of one picture in FFmpeg's order, planes without padding.
using PictureBytes = std::vector<std::uint8_t>;

/// What the tests write through FFmpeg; the container follows from the path's extension.
struct TestClip {
  std::string path;
  std::string encoder = "ffv1";
  AVPixelFormat format = AV_PIX_FMT_YUV422P;
  int width = 16, height = 12;
  AVColorRange range = AVCOL_RANGE_UNSPECIFIED;
  int b_frames = 0;
  std::string muxer_options = {};  ///< "movflags=faststart"
};

/// Every sample random, the same for the same seed.
PictureBytes noise_picture(const TestClip& clip, unsigned seed);

/// One picture per time stamp. [ms]
void write_clip(const TestClip& clip, const std::vector<PictureBytes>& pictures,
                const std::vector<std::int64_t>& stamps);

std::string read_bytes(const std::string& path);
void write_bytes(const std::string& path, const std::string& bytes);

}  // namespace tassilo
