#include "support/recording.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <variant>

#include "tassilo/color/train.h"
#include "tassilo/files/camera_file.h"
#include "tassilo/files/field_file.h"
#include "tassilo/files/robot_file.h"
#include "tassilo/files/samples_file.h"
#include "tassilo/region/raster.h"
#include "tassilo/source/frame_source.h"

namespace tassilo::test {
namespace {

const std::filesystem::path kData = TASSILO_SOURCE_DIR "/data/msl98";

}  // namespace

Frame resized(const Frame& frame, int width, int height, AddedNoise noise, std::mt19937& random) {
  FrameBuffer buffer = make_frame_buffer(PixelFormat::yuv422p, width, height, frame.range);
  std::normal_distribution<double> normal;
  const auto noisy = [&](int value, double sigma) {
    if (sigma == 0) return static_cast<std::uint8_t>(value);
    return static_cast<std::uint8_t>(std::clamp(std::lround(value + sigma * normal(random)), 0l, 255l));
  };
  const FrameView& from = frame.view;
  for (int r = 0; r < height; ++r) {
    const int from_row = r * from.height() / height;
    for (int c = 0; c < width; ++c) {
      const int from_column = c * from.width() / width;
      buffer.planes[0][r * buffer.strides[0] + c] = noisy(from.y(from_column, from_row), noise.y);
      if (c % 2 != 0) continue;
      buffer.planes[1][r * buffer.strides[1] + c / 2] = noisy(from.u(from_column, from_row), noise.uv);
      buffer.planes[2][r * buffer.strides[2] + c / 2] = noisy(from.v(from_column, from_row), noise.uv);
    }
  }
  return buffer.frame;
}

ColorTable trained_colors(const std::string& samples_file, AddedNoise noise) {
  std::mt19937 random(3);
  std::vector<ColorSample> samples;
  ColorRange range = ColorRange::limited;
  for (const TrainingSample& sample : read_samples(kData / samples_file)) {
    SourceOptions options;
    options.location = sample.image.string();
    Frame frame = read_frame(options, sample.frame);
    if (noise.y > 0) frame = resized(frame, frame.view.width(), frame.view.height(), noise, random);
    range = frame.range;
    Region region;
    if (const auto* rectangle = std::get_if<PixelBox>(&sample.shape)) region = Region::from_box(*rectangle);
    if (const auto* polygon = std::get_if<std::vector<PixelPoint>>(&sample.shape))
      region = region_from_polygon(*polygon, {0, 0, frame.view.width(), frame.view.height()});
    samples.push_back({sample.color, 0, pixels_of(frame.view, region)});
  }
  return train_colors(samples, range);
}

Recording load_recording(const std::string& name, const std::string& samples_file) {
  Recording recording;
  const RobotFile robot = read_robot(kData / name / "robot.yaml");
  const CameraFile camera = read_camera(robot.camera.value());
  recording.setup.colors = trained_colors(samples_file);
  recording.setup.field = read_field(robot.field.value());
  recording.setup.camera = camera.model;
  recording.setup.camera->name = "a camera with a name too long for a string to hold by itself";
  recording.setup.mount = camera.mount;
  SourceOptions options;
  options.location = (kData / name / "video.mkv").string();
  FrameSource source = open_source(options);
  while (auto frame = source.next()) recording.frames.push_back(std::move(*frame));
  return recording;
}

}  // namespace tassilo::test
