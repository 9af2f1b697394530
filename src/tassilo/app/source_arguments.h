#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "tassilo/source/camera.h"
#include "tassilo/source/frame_source.h"

namespace tassilo {

/// What the command line says of a source, as words, and what they mean.
struct SourceArguments {
  std::string source;
  std::string format, size, range;
  double fps = 0;
  std::string camera_format, exposure, gain, white_balance;
  std::string camera_info;  ///< The topic's name.

  std::optional<RawFormat> raw;         ///< Of raw frames.
  std::optional<CameraOptions> camera;  ///< Of a camera.
  std::optional<std::string> topic;     ///< Of images of ROS 2: "/camera/image_raw".
  std::optional<ColorRange> yuv_range;  ///< Of a topic, when it was said.

  /// Adds the options, which all go together.
  void add_to(CLI::App& command);
  /// Fills `raw`, `camera` or `topic`. Throws CLI::ValidationError: what it refuses is wrong usage.
  void understand();
};

/// "/odom" of `topic:/odom`. Throws CLI::ValidationError when that can be no topic's name.
std::string topic_from(const std::string& option, const std::string& location);

/// "camera: 3 lost by the driver, 12 replaced by newer ones, 1 broken; stalled 1 time, unplugged 2 times" with an end
/// of line, without what is zero; empty when all is.
std::string camera_summary(const CameraCounts& counts);

}  // namespace tassilo
