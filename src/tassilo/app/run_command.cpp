#include <fmt/core.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "tassilo/app/commands.h"
#include "tassilo/app/run_summary.h"
#include "tassilo/base/error.h"
#include "tassilo/files/camera_file.h"
#include "tassilo/files/colors_file.h"
#include "tassilo/files/field_file.h"
#include "tassilo/files/odometry_file.h"
#include "tassilo/files/robot_file.h"
#include "tassilo/files/scene_json.h"
#include "tassilo/overlay/overlay.h"
#include "tassilo/record/image_folder.h"
#include "tassilo/record/json_lines_writer.h"
#include "tassilo/record/picture_writer.h"
#include "tassilo/source/frame_source.h"
#include "tassilo/vision/vision.h"

namespace tassilo {
namespace {

struct RunArguments {
  std::string robot, source, odometry, output, overlay, label_maps, colors;
  std::string format, size, range;
  double fps = 0;
  int threads = 1;
  bool quiet = false;
};

std::atomic<bool> interrupted = false;

void on_signal(int) { interrupted = true; }

/// Ctrl-C and a friendly kill end the run after the frame at work; a second one ends the program at once.
void end_cleanly_on_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

std::optional<RawFormat> raw_format(const RunArguments& arguments) {
  if (arguments.format.empty()) {
    if (!arguments.size.empty() || !arguments.range.empty())
      throw Error("--size and --range", "belong to raw frames, --format is missing");
    return std::nullopt;
  }
  if (arguments.size.empty() || arguments.range.empty() || arguments.fps <= 0)
    throw Error("--format",
                "raw frames do not say what they are: give --size WxH, --range full|limited and --fps N, too");
  RawFormat raw;
  for (const PixelFormat format :
       {PixelFormat::yuyv422, PixelFormat::uyvy422, PixelFormat::yuv422p, PixelFormat::yuv420p, PixelFormat::nv12})
    if (arguments.format == to_string(format)) raw.format = format;
  const auto cross = arguments.size.find('x');
  try {
    std::size_t used_width = 0, used_height = 0;
    const std::string height = cross == std::string::npos ? "" : arguments.size.substr(cross + 1);
    raw.width = std::stoi(arguments.size, &used_width);
    raw.height = std::stoi(height, &used_height);
    if (used_width != cross || used_height != height.size()) throw std::invalid_argument("size");
  } catch (const std::logic_error&) {
    throw Error("--size", "is " + arguments.size + ", must be like 640x480");
  }
  raw.range = arguments.range == "full" ? ColorRange::full : ColorRange::limited;
  raw.fps = arguments.fps;
  raw.check();
  return raw;
}

/// All files that the robot file names, and what the command line says instead.
VisionSetup load_setup(const RunArguments& arguments) {
  const RobotFile robot = arguments.robot.empty() ? RobotFile{} : read_robot(arguments.robot);
  VisionSetup setup;
  if (!arguments.colors.empty())
    setup.colors = read_colors(arguments.colors).table;
  else if (robot.colors)
    setup.colors = read_colors(*robot.colors).table;
  else
    throw Error(arguments.robot.empty() ? "colors" : arguments.robot,
                "no color table: give --colors FILE, or `colors:` in the robot file; `tassilo train colors` makes one");
  if (robot.camera) {
    const CameraFile camera = read_camera(*robot.camera);
    if (!camera.mount)
      throw Error(robot.camera->string(),
                  "has no camera_pose_in_robot; without a mount leave `camera:` out of the robot file");
    setup.camera = camera.model;
    setup.mount = camera.mount;
  }
  if (robot.field) {
    setup.field = read_field(*robot.field);
  } else {
    // Without a field file: whatever may be there, in the image alone.
    setup.field = read_field("msl98");
    if (setup.camera)
      throw Error(arguments.robot,
                  "has a camera but no `field:`; sizes of ball, goals and lines are needed on the floor");
  }
  setup.options = vision_options(robot.vision);
  return setup;
}

/// "frame 12 of 40  35.2 frames/s", rewritten in place on a terminal.
class Progress {
 public:
  Progress(bool wanted, std::optional<std::int64_t> frames)
      : shown_(wanted && isatty(STDERR_FILENO) == 1), frames_(frames) {}

  void frame(std::int64_t done) {
    const auto now = std::chrono::steady_clock::now();
    if (!shown_ || now < next_) return;
    next_ = now + std::chrono::milliseconds(100);
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const double rate = seconds > 0 ? static_cast<double>(done) / seconds : 0;
    std::string text = fmt::format("\rframe {}", done);
    if (frames_ && *frames_ > 0) {
      constexpr int width = 24;
      const int full = static_cast<int>(std::min<std::int64_t>(width, width * done / *frames_));
      text += fmt::format(" of {}  [{:#<{}}{:.<{}}]", *frames_, "", full, "", width - full);
    }
    fmt::print(stderr, "{}  {:.1f} frames/s   ", text, rate);
  }
  void finish() {
    if (shown_) fmt::print(stderr, "\r{:78}\r", "");
  }

 private:
  bool shown_;
  std::optional<std::int64_t> frames_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), next_ = start_;
};

double ms_between(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

int run_command(const RunArguments& arguments) {
  using Clock = std::chrono::steady_clock;
  const VisionSetup setup = load_setup(arguments);
  const Vision vision(setup);
  Odometry odometry;
  bool has_odometry = false;
  if (!arguments.odometry.empty()) {
    const std::vector<OdometrySample> samples = read_odometry(arguments.odometry);
    odometry = Odometry(std::max<std::size_t>(2, samples.size()));
    for (const OdometrySample& sample : samples) odometry.add(sample);
    has_odometry = true;
  }

  SourceOptions source_options;
  source_options.location = arguments.source;
  source_options.raw = raw_format(arguments);
  source_options.images_range = setup.colors.range;
  source_options.fps = arguments.fps;
  source_options.threads = arguments.threads;
  source_options.interrupted = [] { return interrupted.load(); };
  end_cleanly_on_signals();
  FrameSource source = open_source(source_options);

  std::optional<JsonLinesWriter> output;
  if (!arguments.output.empty()) output.emplace(arguments.output);
  std::optional<PictureWriter> overlay;
  if (!arguments.overlay.empty()) overlay.emplace(arguments.overlay, VideoOptions{.threads = arguments.threads});
  std::optional<ImageFolder> label_maps;
  if (!arguments.label_maps.empty()) label_maps.emplace(arguments.label_maps);
  // Nothing but scene lines may go where scene lines go.
  std::FILE* report = arguments.output == "-" ? stderr : stdout;
  if (!arguments.quiet) fmt::print(report, "{}: {}\n", source.info().name, source.info().description);

  VisionWorkspace workspace;
  RunSummary summary;
  Progress progress(!arguments.quiet, source.info().frame_count);
  std::optional<Error> damage;
  std::int64_t done = 0;
  const auto begin = Clock::now();
  while (!interrupted) {
    const auto before = Clock::now();
    std::optional<Frame> frame;
    try {
      frame = source.next();
    } catch (const Error& error) {
      damage = error;  // what came before it is kept
    }
    if (!frame) break;
    const double decode_ms = ms_between(before, Clock::now());
    Scene scene = vision(*frame, workspace);
    scene.timing.insert(scene.timing.begin(), {"decode", decode_ms});
    if (has_odometry) {
      const bool known = odometry.at(frame->t).has_value();
      summary.add_odometry(known);
      if (!known) scene.why.emplace_back("odometry", "missing at this time");
    }
    if (output) output->write(to_json_line(scene));
    if (label_maps)
      label_maps->write(
          GrayImage{workspace.segmentation.width, workspace.segmentation.height, workspace.segmentation.labels},
          scene.frame);
    if (overlay) {
      OverlayOptions options;
      options.camera = vision.optics() != nullptr ? &vision.optics()->camera : nullptr;
      overlay->write(draw_overlay(frame->view, frame->range, scene, options), scene.frame, scene.t);
    }
    summary.add(scene);
    progress.frame(++done);
  }
  const double seconds = ms_between(begin, Clock::now()) / 1000;
  if (overlay) overlay->finish();
  progress.finish();
  if (!arguments.quiet) {
    fmt::print(report, "{}", summary.text(seconds));
    if (interrupted) fmt::print(report, "\nended by a signal; all lines are complete\n");
    if (output && arguments.output != "-") fmt::print(report, "\nscenes: {}\n", arguments.output);
    if (overlay) fmt::print(report, "annotated picture: {}\n", arguments.overlay);
    if (label_maps) fmt::print(report, "label maps: {}\n", arguments.label_maps);
  }
  if (damage) throw *damage;
  return 0;
}

}  // namespace

Command add_run(CLI::App& program) {
  auto* command =
      program.add_subcommand("run", "see: balls, goals, robots, lines and free space in every frame of a source");
  auto arguments = std::make_shared<RunArguments>();
  command->add_option("-r,--robot", arguments->robot, "robot.yaml: camera, colors, field and options of one robot");
  command
      ->add_option("-s,--source", arguments->source,
                   "video or image file, folder of images, URL, or - for standard input")
      ->required();
  command->add_option("--odometry", arguments->odometry, "odometry.jsonl on the clock of the frames");
  command->add_option("-o,--output", arguments->output, "scenes as JSON Lines; - for standard output");
  command->add_option("--overlay", arguments->overlay, "annotated pictures: a .mkv or .mp4 video, or a folder of PNGs");
  command->add_option("--label-maps", arguments->label_maps, "folder for color classes 0..8 as NNNN.png");
  command->add_option("--colors", arguments->colors, "color table, instead of the robot file's");
  command->add_option("--format", arguments->format, "raw frames: pixel format")
      ->check(CLI::IsMember({"yuv420p", "yuv422p", "yuyv422", "uyvy422", "nv12"}));
  command->add_option("--size", arguments->size, "raw frames: WIDTHxHEIGHT");
  command->add_option("--range", arguments->range, "raw frames: color range")
      ->check(CLI::IsMember({"limited", "full"}));
  command->add_option("--fps", arguments->fps, "raw frames, folders: frames per second")
      ->check(CLI::Range(0.001, 10000.0));
  command->add_option("--threads", arguments->threads, "for decoding and encoding; seeing itself takes one core")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->add_flag("-q,--quiet", arguments->quiet, "print nothing but errors");
  return [arguments] { return run_command(*arguments); };
}

}  // namespace tassilo
