#include "support/recording.h"

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

ColorTable trained_colors(const std::string& samples_file) {
  std::vector<ColorSample> samples;
  ColorRange range = ColorRange::limited;
  for (const TrainingSample& sample : read_samples(kData / samples_file)) {
    SourceOptions options;
    options.location = sample.image.string();
    const Frame frame = read_frame(options, sample.frame);
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
  recording.setup.mount = camera.mount;
  SourceOptions options;
  options.location = (kData / name / "video.mkv").string();
  FrameSource source = open_source(options);
  while (auto frame = source.next()) recording.frames.push_back(std::move(*frame));
  return recording;
}

}  // namespace tassilo::test
