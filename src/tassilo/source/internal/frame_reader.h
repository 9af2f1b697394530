#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "tassilo/image/frame.h"
#include "tassilo/source/frame_reader.h"
#include "tassilo/source/frame_source.h"
#include "tassilo/source/internal/system_calls.h"

namespace tassilo {

inline constexpr int kMaxFrameSize = 32767;  ///< Runs have 16-bit coordinates. [px]

/// Throws Error(subject, ...) unless 1 <= width, height <= kMaxFrameSize.
void check_frame_size(const std::string& subject, int width, int height);

/// "yuv422p 384x172 px, limited range"
std::string describe_pixels(std::string_view format, const Frame& frame);

std::unique_ptr<FrameReader> make_raw_reader(const SourceOptions& options);
/// `folder`: all its images in natural order; else one image file.
std::unique_ptr<FrameReader> make_image_reader(const SourceOptions& options);
std::unique_ptr<FrameReader> make_video_reader(const SourceOptions& options);
/// `video`, a file at `location`, with the stamps of the file beside it (see stamps_file_of); as it is without one.
std::unique_ptr<FrameReader> make_stamped_reader(std::unique_ptr<FrameReader> video, const std::string& location);
/// A camera, see is_camera; `calls` outlives the reader and all its frames.
std::unique_ptr<FrameReader> make_camera_reader(const SourceOptions& options, SystemCalls& calls);

/// Whether the file begins as PNG or JPEG files do and is no Motion JPEG by its name. False for unreadable files.
bool is_image_file(const std::string& path);

}  // namespace tassilo
