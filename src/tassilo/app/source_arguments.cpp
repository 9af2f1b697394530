#include "tassilo/app/source_arguments.h"

#include <fmt/core.h>

#include <charconv>
#include <stdexcept>

#include "tassilo/app/topic_input.h"
#include "tassilo/base/error.h"

namespace tassilo {
namespace {

CameraControl control_from(const std::string& option, const std::string& text) {
  if (text.empty()) return {};
  if (text == "auto") return {.automatic = true};
  int value = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || rest != text.data() + text.size())
    throw CLI::ValidationError(option, "is " + text + ", must be auto or a whole number");
  return {.value = value};
}

ColorRange range_from(const std::string& text) { return text == "full" ? ColorRange::full : ColorRange::limited; }

struct FrameSize {
  int width = 0, height = 0;  ///< [px]
};

/// Throws CLI::ValidationError: what it refuses is wrong usage.
FrameSize size_from(const std::string& text) {
  FrameSize size;
  const auto cross = text.find('x');
  try {
    std::size_t used_width = 0, used_height = 0;
    const std::string height = cross == std::string::npos ? "" : text.substr(cross + 1);
    size.width = std::stoi(text, &used_width);
    size.height = std::stoi(height, &used_height);
    if (used_width != cross || used_height != height.size()) throw std::invalid_argument("size");
  } catch (const std::logic_error&) {
    throw CLI::ValidationError("--size", "is " + text + ", must be like 640x480");
  }
  return size;
}

/// Throws CLI::ValidationError: what it refuses is wrong usage.
std::optional<RawFormat> raw_format(const SourceArguments& arguments) {
  if (arguments.format.empty()) {
    if (!arguments.size.empty() || !arguments.range.empty())
      throw CLI::ValidationError("--size and --range", "belong to raw frames, --format is missing");
    return std::nullopt;
  }
  if (arguments.size.empty() || arguments.range.empty() || arguments.fps <= 0)
    throw CLI::ValidationError(
        "--format", "raw frames do not say what they are: give --size WxH, --range full|limited and --fps N, too");
  RawFormat raw;
  for (const PixelFormat format :
       {PixelFormat::yuyv422, PixelFormat::uyvy422, PixelFormat::yuv422p, PixelFormat::yuv420p, PixelFormat::nv12})
    if (arguments.format == to_string(format)) raw.format = format;
  const FrameSize size = size_from(arguments.size);
  raw.width = size.width;
  raw.height = size.height;
  raw.range = range_from(arguments.range);
  raw.fps = arguments.fps;
  try {
    raw.check();
  } catch (const Error& error) {
    throw CLI::ValidationError("--size", error.what());
  }
  return raw;
}

/// Throws CLI::ValidationError: what it refuses is wrong usage.
CameraOptions camera_options(const SourceArguments& arguments) {
  if (!arguments.format.empty())
    throw CLI::ValidationError("--format", "belongs to raw frames, of a camera it is --camera-format");
  CameraOptions options;
  options.format = camera_format(arguments.camera_format);
  options.exposure = control_from("--exposure", arguments.exposure);
  options.gain = control_from("--gain", arguments.gain);
  options.white_balance = control_from("--white-balance", arguments.white_balance);
  if (!arguments.size.empty()) {
    const FrameSize size = size_from(arguments.size);
    options.width = size.width;
    options.height = size.height;
  }
  if (arguments.fps > 0) options.fps = arguments.fps;
  if (!arguments.range.empty()) options.range = range_from(arguments.range);
  try {
    options.check();
  } catch (const Error& error) {
    throw CLI::ValidationError("--size", error.what());
  }
  return options;
}

/// Throws CLI::ValidationError: what it refuses is wrong usage.
std::string understood_topic(const SourceArguments& arguments) {
  const std::string topic = topic_from("--source", arguments.source);
  if (!arguments.camera_info.empty()) topic_from("--camera-info", "topic:" + arguments.camera_info);
  if (!arguments.format.empty() || !arguments.size.empty() || arguments.fps > 0)
    throw CLI::ValidationError("--format, --size and --fps",
                               "are what the images of a topic say, --source is " + arguments.source);
  if (!arguments.camera_format.empty() || !arguments.exposure.empty() || !arguments.gain.empty() ||
      !arguments.white_balance.empty())
    throw CLI::ValidationError("--camera-format, --exposure, --gain and --white-balance",
                               "are the driver's, --source is " + arguments.source);
  return topic;
}

}  // namespace

std::string topic_from(const std::string& option, const std::string& location) {
  const std::string topic = topic_of(location);
  if (!is_ros_topic_name(topic))
    throw CLI::ValidationError(option, "names the topic " + topic + ", must be like /camera/image_raw");
  return topic;
}

void SourceArguments::add_to(CLI::App& command) {
  command
      .add_option("-s,--source", source,
                  "video or image file, folder of images, URL, camera such as /dev/video0, topic of ROS 2 such as "
                  "topic:/camera/image_raw, or - for standard input")
      ->required();
  command.add_option("--format", format, "raw frames: pixel format")
      ->check(CLI::IsMember({"yuv420p", "yuv422p", "yuyv422", "uyvy422", "nv12"}));
  command.add_option("--size", size,
                     "raw frames: WIDTHxHEIGHT; camera: what is asked for, instead of the camera file's, else 640x480");
  command.add_option("--range", range, "raw frames: color range; camera, YUV of a topic: instead of what it says")
      ->check(CLI::IsMember({"limited", "full"}));
  command.add_option("--fps", fps, "raw frames, folders: frames per second; camera: what is asked for, else 30")
      ->check(CLI::Range(0.001, 10000.0));
  command.add_option("--camera-format", camera_format, "camera: format, instead of the one that keeps size and rate")
      ->check(CLI::IsMember({"yuyv", "uyvy", "nv12", "mjpeg"}));
  command.add_option("--exposure", exposure, "camera: auto, or a time [100 us], instead of the time it has now");
  command.add_option("--gain", gain, "camera: auto, or its own number, instead of the gain it has now");
  command.add_option("--white-balance", white_balance,
                     "camera: auto, or a temperature [K], instead of what it has now");
  command.add_option(
      "--camera-info", camera_info,
      "topic: name of its CameraInfo, which is compared with the camera file, instead of that beside it");
}

void SourceArguments::understand() {
  if (is_topic(source)) {
    topic = understood_topic(*this);
    if (!range.empty()) yuv_range = range_from(range);
    return;
  }
  if (!camera_info.empty()) throw CLI::ValidationError("--camera-info", "belongs to topics, --source is " + source);
  if (is_camera(source)) {
    camera = camera_options(*this);
    return;
  }
  if (!camera_format.empty() || !exposure.empty() || !gain.empty() || !white_balance.empty())
    throw CLI::ValidationError("--camera-format, --exposure, --gain and --white-balance",
                               "belong to cameras, --source is " + source);
  raw = raw_format(*this);
}

std::string camera_summary(const CameraCounts& counts) {
  std::string text;
  const auto add = [&](std::int64_t count, std::string_view separator, const std::string& words) {
    if (count > 0) text += fmt::format("{}{}", text.empty() ? "camera: " : separator, words);
  };
  const auto times = [](std::int64_t count) { return fmt::format("{} time{}", count, count == 1 ? "" : "s"); };
  add(counts.replaced, ", ", fmt::format("{} replaced by newer ones", counts.replaced));
  add(counts.lost, ", ", fmt::format("{} lost by the driver", counts.lost));
  add(counts.broken, ", ", fmt::format("{} broken", counts.broken));
  add(counts.stalls, "; ", fmt::format("stalled {}", times(counts.stalls)));
  add(counts.unplugged, counts.stalls > 0 ? ", " : "; ", fmt::format("unplugged {}", times(counts.unplugged)));
  return text.empty() ? text : text + "\n";
}

}  // namespace tassilo
