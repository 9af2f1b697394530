#include <fmt/core.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tassilo/app/boundary_steps.h"
#include "tassilo/app/commands.h"
#include "tassilo/app/configuration_watch.h"
#include "tassilo/app/odometry_input.h"
#include "tassilo/app/robot_setup.h"
#include "tassilo/app/run_summary.h"
#include "tassilo/app/source_arguments.h"
#include "tassilo/app/written_files.h"
#include "tassilo/base/error.h"
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
  SourceArguments source;
  std::string robot, odometry, output, overlay, overlay_step, label_maps, colors, start_pose;
  std::vector<std::string> plugins;
  std::optional<StartPose> start;  ///< What `start_pose` says.
  int every = 1;
  int threads = 1;
  bool watch = false;
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

/// Throws CLI::ValidationError: what it refuses is wrong usage.
std::optional<StartPose> start_pose_from(const std::string& text) {
  if (text.empty()) return std::nullopt;
  StartPose pose;
  const std::array values{&pose.x, &pose.y, &pose.theta, &pose.sigma_xy, &pose.sigma_theta};
  std::size_t count = 0;
  bool good = true;
  for (std::size_t begin = 0; good && begin <= text.size(); ++count) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    double value = NAN;
    const auto [rest, error] = std::from_chars(text.data() + begin, text.data() + end, value);
    good = count < values.size() && error == std::errc{} && rest == text.data() + end && std::isfinite(value);
    if (good) *values[count] = value;
    begin = end + 1;
  }
  if (!good || count < 3 || !(pose.sigma_xy > 0) || !(pose.sigma_theta > 0))
    throw CLI::ValidationError(
        "--start-pose",
        "is " + text + ", must be X,Y,THETA or X,Y,THETA,SIGMA_XY,SIGMA_THETA in m and rad, sigmas > 0");
  return pose;
}

/// Throws Error when a file that is read would be overwritten.
void check_paths(const RunArguments& arguments, std::vector<NamedFile> read) {
  const std::filesystem::path source = arguments.source.source;
  read.push_back({"--source", arguments.source.source});
  read.push_back({"--odometry", arguments.odometry});
  // Pictures are written as NNNN.png: among other pictures one may have this name.
  const std::string extension = source.extension().string();
  if (extension == ".png" || extension == ".jpg" || extension == ".jpeg")
    read.push_back({"folder of --source", source.has_parent_path() ? source.parent_path().string() : "."});
  check_written_files(read, std::array<NamedFile, 3>{{{"--output", arguments.output},
                                                      {"--overlay", arguments.overlay},
                                                      {"--label-maps", arguments.label_maps}}});
}

/// Bytes without a header open as no video; says what they may be.
FrameSource open_source_of(const SourceOptions& options) {
  try {
    return open_source(options);
  } catch (const Error& error) {
    const std::string extension = std::filesystem::path(options.location).extension().string();
    const bool may_be_raw =
        options.location == "-" || extension == ".yuv" || extension == ".raw" || extension == ".nv12";
    if (options.raw || !may_be_raw || interrupted) throw;
    throw Error(error.what(), "raw frames need --format, --size, --range and --fps");
  }
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
  /// Gives the line back to other messages, for a while.
  void clear() const {
    if (shown_) std::fprintf(stderr, "\r%78s\r", "");
  }
  void finish() {
    clear();
    shown_ = false;
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() { finish(); }

 private:
  bool shown_;
  std::optional<std::int64_t> frames_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), next_ = start_;
};

/// Where scenes, pictures and label maps go; any of them may not be wanted.
class Sinks {
 public:
  explicit Sinks(const RunArguments& arguments) : arguments_(arguments) {
    if (!arguments.overlay.empty()) overlay_.emplace(arguments.overlay, VideoOptions{.threads = arguments.threads});
    if (!arguments.label_maps.empty()) label_maps_.emplace(arguments.label_maps);
    // Last, when nothing else is wrong: it replaces the scenes of another run.
    if (!arguments.output.empty()) output_.emplace(arguments.output);
  }

  void write(const Frame& frame, const Scene& scene, const VisionWorkspace& workspace, const Optics* optics) {
    if (output_) output_->write(to_json_line(scene));
    const Segmentation& segmentation = workspace.segmentation;
    if (label_maps_)
      label_maps_->write(GrayImage{segmentation.width, segmentation.height, segmentation.labels}, scene.frame);
    if (overlay_) {
      OverlayOptions options;
      options.camera = optics != nullptr ? &optics->camera : nullptr;
      options.surface = &workspace.surface;
      StepPicture step;
      if (!arguments_.overlay_step.empty()) {
        const auto* const name = std::ranges::find(kBoundarySteps, arguments_.overlay_step);
        step.title = arguments_.overlay_step + ": nothing without a camera file";
        if (workspace.boundary && optics != nullptr)
          step = boundary_step(*workspace.boundary, static_cast<std::size_t>(name - kBoundarySteps.begin()),
                               optics->camera);
        options.step = &step;
      }
      overlay_->write(draw_overlay(frame.view, frame.range, scene, options), scene.frame, scene.t);
    }
  }

  /// Completes the video. After an error the destructor does what can be done.
  void finish() {
    if (overlay_) overlay_->finish();
  }

  /// For people, a line each; empty for scenes on standard output.
  std::string names() const {
    std::string text;
    if (output_ && arguments_.output != "-") text += fmt::format("scenes: {}\n", arguments_.output);
    if (overlay_) text += fmt::format("annotated picture: {}\n", arguments_.overlay);
    if (label_maps_) text += fmt::format("label maps: {}\n", arguments_.label_maps);
    return text.empty() ? text : "\n" + text;
  }

 private:
  const RunArguments& arguments_;
  std::optional<PictureWriter> overlay_;
  std::optional<ImageFolder> label_maps_;
  std::optional<JsonLinesWriter> output_;
};

/// As messages name a frame: the image's file, or its number in the source.
std::string name_of(const Frame& frame, const std::string& source) {
  if (frame.image.empty()) return source + ": frame " + std::to_string(frame.index);
  const std::filesystem::path path = source;
  return path.filename() == frame.image ? source : (path / frame.image).string();
}

double ms_between(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

int run_command(const RunArguments& arguments) {
  using Clock = std::chrono::steady_clock;
  const auto load = [&] {
    return load_configuration(arguments.robot, arguments.colors, arguments.plugins, [&](RobotSetup& setup) {
      if (arguments.start) setup.vision.start_pose = gaussian_of(*arguments.start);
    });
  };
  std::shared_ptr<const Configuration> configuration = load();
  check_paths(arguments, configuration->setup.read);
  const bool is_live = arguments.source.camera.has_value();
  const bool loses_nothing = !is_live && arguments.source.source.find("://") == std::string::npos;
  OdometryInput odometry_input(arguments.odometry, loses_nothing);
  const Odometry* const odometry = odometry_input.get();
  // Nothing but scene lines may go where scene lines go.
  std::FILE* report = arguments.output == "-" ? stderr : stdout;
  const auto tell = [&](const std::string& text) {
    if (!arguments.quiet) fmt::print(report, "{}", text);
  };

  SourceOptions source_options;
  source_options.location = arguments.source.source;
  source_options.raw = arguments.source.raw;
  source_options.images_range = configuration->setup.vision.colors.range;
  source_options.fps = arguments.source.fps;
  source_options.threads = arguments.threads;
  source_options.interrupted = [] { return interrupted.load(); };
  if (is_live) source_options.camera = *arguments.source.camera;
  // Frames that fit the camera file need no --size.
  if (const auto& camera = configuration->setup.vision.camera; camera && arguments.source.size.empty()) {
    source_options.camera.width = camera->width;
    source_options.camera.height = camera->height;
  }
  std::optional<Progress> progress;
  source_options.camera_news = [&](const CameraNews& news) {
    if (progress) progress->clear();
    tell(fmt::format("{}: {}\n", to_string(news.state), news.text));
    std::fflush(report);  // somebody waits for it
  };
  end_cleanly_on_signals();
  std::optional<FrameSource> opened;
  try {
    opened = open_source_of(source_options);
  } catch (const Error&) {
    if (!interrupted) throw;
    tell("ended by a signal before the first frame\n");
    return 0;
  }
  FrameSource& source = *opened;
  const std::string name = source.info().name;
  const auto check_source = [&](const Vision& vision) {
    vision.check_frames(name, source.info().width, source.info().height, source.info().range);
  };
  check_source(configuration->vision);
  tell(fmt::format("{}: {}\n", name, source.info().description));
  if (is_live) std::fflush(report);  // somebody watches

  Sinks sinks(arguments);
  VisionWorkspace workspace;
  workspace.watch_boundary = !arguments.overlay_step.empty();
  RunSummary summary;
  progress.emplace(!arguments.quiet, source.info().frame_count);
  std::optional<Error> damage;
  std::int64_t read = 0, done = 0;
  std::optional<ConfigurationWatch> watch;
  if (arguments.watch)
    watch.emplace(*configuration, [&] {
      auto loaded = load();
      check_source(loaded->vision);
      check_paths(arguments, loaded->setup.read);
      return loaded;
    });
  const auto begin = Clock::now();
  try {
    while (!interrupted) {
      const auto before = Clock::now();
      const std::optional<Frame> frame = source.next();
      if (!frame) break;
      if (read++ % arguments.every != 0) continue;
      const double decode_ms = ms_between(before, Clock::now());
      RecycledString changes;
      if (auto news = watch ? watch->news() : std::nullopt) {
        progress->clear();
        if (news->configuration) {
          configuration = std::move(news->configuration);
          changes = "a changed one was taken over";
          tell(fmt::format("frame {}: the changed configuration is taken over\n", frame->index));
        }
        if (!news->refusal.empty()) {
          changes.append(changes.empty() ? "" : "; ").append("refused, the former one goes on: ").append(news->refusal);
          tell(fmt::format("frame {}: a changed configuration is refused, the former one goes on: {}\n", frame->index,
                           news->refusal));
        }
        std::fflush(report);  // somebody waits for it
      }
      odometry_input.update(frame->t, source_options.interrupted);
      const Vision& vision = configuration->vision;
      vision.check_frames(name_of(*frame, name), frame->view.width(), frame->view.height(), frame->range);
      Scene scene = vision(*frame, workspace, odometry);
      scene.timing.insert(scene.timing.begin(), {is_live ? "wait" : "decode", decode_ms});
      if (!changes.empty()) scene.why.emplace_back("configuration", std::move(changes));
      if (odometry) {
        const bool known = odometry->at(frame->t).has_value();
        summary.add_odometry(known);
        if (!known) scene.why.emplace_back("odometry", "missing at this time");
      }
      sinks.write(*frame, scene, workspace, vision.optics());
      summary.add(scene);
      progress->frame(++done);
    }
    sinks.finish();
  } catch (const Error& error) {
    damage = error;
  }
  const double seconds = ms_between(begin, Clock::now()) / 1000;
  progress->finish();
  if (odometry) summary.set_odometry(odometry->counts());
  tell(summary.text(seconds, camera_summary(source.camera_counts()) + odometry_input.summary()));
  if (interrupted) tell("\nended by a signal; all lines are complete\n");
  tell(sinks.names());
  if (damage) throw *damage;
  return 0;
}

}  // namespace

Command add_run(CLI::App& program) {
  auto* command =
      program.add_subcommand("run", "see: balls, goals, robots, lines and free space in every frame of a source");
  auto arguments = std::make_shared<RunArguments>();
  command->add_option("-r,--robot", arguments->robot, "robot.yaml: camera, colors, field and options of one robot");
  arguments->source.add_to(*command);
  command->add_option("--odometry", arguments->odometry,
                      "odometry.jsonl on the clock of the frames; live: - for standard input, or udp:127.0.0.1:PORT");
  command->add_option("--start-pose", arguments->start_pose,
                      "X,Y,THETA[,SIGMA_XY,SIGMA_THETA] on the field, instead of the robot file's [m, rad]");
  command->add_option("-o,--output", arguments->output, "scenes as JSON Lines; - for standard output");
  command->add_option("--overlay", arguments->overlay, "annotated pictures: a .mkv or .mp4 video, or a folder of PNGs");
  command
      ->add_option("--overlay-step", arguments->overlay_step,
                   "draw what this step of finding the boundary saw, instead of what is in the scene")
      ->check(CLI::IsMember(std::vector<std::string>(kBoundarySteps.begin(), kBoundarySteps.end())));
  command->add_option("--label-maps", arguments->label_maps, "folder for color classes 0..8 as NNNN.png");
  command->add_option("--colors", arguments->colors, "color table, instead of the robot file's");
  add_plugin_option(*command, arguments->plugins);
  command->add_option("--threads", arguments->threads, "for decoding and encoding; seeing itself takes one core")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->add_option("--every", arguments->every, "look at every N-th frame only, as if the others had been lost")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_flag("--watch", arguments->watch,
                    "take changes of the robot file, and of the files it names, over between two frames");
  command->add_flag("-q,--quiet", arguments->quiet, "print nothing but errors");
  command->callback([arguments] {
    if (!arguments->overlay_step.empty() && arguments->overlay.empty())
      throw CLI::ValidationError("--overlay-step", "says what is drawn, --overlay is missing");
    if (arguments->watch && arguments->robot.empty())
      throw CLI::ValidationError("--watch", "watches the robot file, --robot is missing");
    if (arguments->odometry == "-" && arguments->source.source == "-")
      throw CLI::ValidationError("--odometry", "and --source cannot both be standard input");
    arguments->source.understand();
    arguments->start = start_pose_from(arguments->start_pose);
  });
  return [arguments] { return run_command(*arguments); };
}

}  // namespace tassilo
