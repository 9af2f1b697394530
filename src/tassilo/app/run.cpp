#include "tassilo/app/run.h"

#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "tassilo/app/configuration_watch.h"
#include "tassilo/app/live_view.h"
#include "tassilo/app/odometry_input.h"
#include "tassilo/app/progress.h"
#include "tassilo/app/recorder.h"
#include "tassilo/app/run_sinks.h"
#include "tassilo/app/run_summary.h"
#include "tassilo/app/signals.h"
#include "tassilo/app/team_sender.h"
#include "tassilo/app/topic_input.h"
#include "tassilo/app/written_files.h"
#include "tassilo/base/error.h"
#include "tassilo/localize/mount_drift.h"

namespace tassilo {
namespace {

/// Throws Error when a file that is read would be overwritten.
void check_paths(const RunArguments& arguments, std::vector<NamedFile> read) {
  const std::filesystem::path source = arguments.source.source;
  read.push_back({"--source", arguments.source.source});
  read.push_back({"--odometry", arguments.odometry});
  // Pictures are written as NNNN.png: among other pictures one may have this name.
  const std::string extension = source.extension().string();
  if (extension == ".png" || extension == ".jpg" || extension == ".jpeg")
    read.push_back({"folder of --source", source.has_parent_path() ? source.parent_path().string() : "."});
  check_written_files(read, std::array<NamedFile, 4>{{{"--output", arguments.output},
                                                      {"--overlay", arguments.overlay},
                                                      {"--record", arguments.log},
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
    if (options.raw || !may_be_raw || is_interrupted()) throw;
    throw Error(error.what(), "raw frames need --format, --size, --range and --fps");
  }
}

/// As messages name a frame: the image's file, or its number in the source.
std::string name_of(const Frame& frame, const std::string& source) {
  if (frame.image.empty()) return source + ": frame " + std::to_string(frame.index);
  const std::filesystem::path path = source;
  return path.filename() == frame.image ? source : (path / frame.image).string();
}

/// A pipe, a socket or a terminal: who reads it waits for somebody else.
bool comes_as_it_comes(int descriptor) {
  struct stat status {};
  return fstat(descriptor, &status) == 0 && !S_ISREG(status.st_mode);
}

/// A line with its end.
std::string recording_summary(const RecordingState& recording) {
  if (recording.name.empty()) return "";
  std::string text = fmt::format("recording: {}, {} frames",
                                 (std::filesystem::path(recording.folder) / recording.name).string(), recording.frames);
  if (recording.parts > 1) text += fmt::format(" in {} parts", recording.parts);
  if (recording.dropped > 0) text += fmt::format(", {} not recorded", recording.dropped);
  return text + "\n";
}

InputTopics input_topics(const RunArguments& arguments) {
  InputTopics topics;
  topics.images = arguments.source.topic.value_or("");
  topics.camera_info = arguments.source.camera_info;
  if (is_topic(arguments.odometry)) topics.odometry = topic_of(arguments.odometry);
  return topics;
}

/// The same for all that a run has on the bus: what is said and what is listened to.
BusOptions bus_options(const RunArguments& arguments, const RobotFile& robot) {
  BusOptions options = arguments.bus.options(robot.bus);
  if (arguments.source.topic) options.max_bytes = kMostImageBytes;
  return options;
}

/// Null where nothing comes from ROS 2.
std::unique_ptr<TopicInput> topic_input(const RunArguments& arguments, const RobotFile& robot) {
  const InputTopics topics = input_topics(arguments);
  return topics.empty() ? nullptr : std::make_unique<TopicInput>(bus_options(arguments, robot), topics);
}

/// Nothing where odometry is no topic.
std::function<std::vector<OdometrySample>()> odometry_of(TopicInput* topics, const RunArguments& arguments) {
  if (topics == nullptr || !is_topic(arguments.odometry)) return {};
  return [topics] { return topics->take_odometry(); };
}

double ms_between(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

/// One run, from the configuration to the summary.
class Run {
 public:
  Run(const RunArguments& arguments, LiveView* live, Recorder* recorder)
      : arguments_(arguments),
        live_(live),
        recorder_(recorder),
        // Nothing but scene lines may go where scene lines go.
        report_(arguments.output == "-" ? stderr : stdout),
        configuration_(load(live != nullptr ? live->changes() : VisionChanges{})),
        topics_(topic_input(arguments, configuration_->setup.robot)),
        odometry_(arguments.odometry, loses_nothing(arguments.source), odometry_of(topics_.get(), arguments)) {
    check_paths(arguments_, configuration_->setup.read);
    workspace_.watch_boundary = !arguments_.overlay_step.empty();
  }

  /// However it ends: nobody asks it for configurations any more.
  ~Run() {
    if (live_ != nullptr) live_->leave();
  }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  void operator()() {
    end_cleanly_on_signals();
    try {
      open();
    } catch (const Error&) {
      if (!is_interrupted()) throw;
      tell("ended by a signal before the first frame\n");
      return;
    }
    tell(fmt::format("{}: {}\n", name(), info_.description));
    if (is_live()) std::fflush(report_);  // somebody watches
    RunSinks sinks(arguments_);
    begin_telling();
    if (recorder_ != nullptr && !arguments_.record.empty()) recorder_->start();
    progress_.emplace(!arguments_.quiet && live_ == nullptr, info_.frame_count);
    const auto load_checked = [this](const VisionChanges& changes) { return checked(load(changes)); };
    if (arguments_.watch)
      watch_.emplace(*configuration_, [this, load_checked] {
        // One load after the other: what is chosen in a browser meanwhile is not lost by an older one.
        return live_ != nullptr ? live_->load_with_changes(load_checked) : load_checked({});
      });
    if (live_ != nullptr)
      live_->begin(name(), info_.description, arguments_.every, info_.range, configuration_, load_checked);

    std::optional<Error> damage;
    const auto begin = Clock::now();
    try {
      see_all(sinks);
      while (plays_again()) {
        open();
        see_all(sinks);
      }
      sinks.finish();
    } catch (const Error& error) {
      damage = error;
    }
    const double seconds = ms_between(begin, Clock::now()) / 1000;
    if (recorder_ != nullptr) recorder_->finish();
    try {
      if (sender_) sender_->finish();
    } catch (const Error& error) {
      if (!damage) damage = error;
    }
    progress_->finish();
    tell_news();
    if (odometry_.get() != nullptr) summary_.set_odometry(odometry_.get()->counts());
    tell(summary_.text(
        seconds, camera_summary(source_->camera_counts()) + (topics_ ? topics_->summary() : "") + odometry_.summary()));
    if (is_interrupted()) tell("\nended by a signal; all lines are complete\n");
    tell(sinks.names());
    if (sender_) tell(sender_->summary());
    if (recorder_ != nullptr && !arguments_.record.empty()) tell(recording_summary(recorder_->state()));
    if (damage) throw *damage;
    // What was asked for at the start and is not whole is a failure; a button's is told where it was pressed.
    if (live_ == nullptr && recorder_ != nullptr && !recorder_->state().trouble.empty())
      throw Error("recording", recorder_->state().trouble);
  }

 private:
  using Clock = std::chrono::steady_clock;

  /// For people who look at it, a file has no end; unless somebody keeps what is seen of it.
  bool plays_again() const {
    std::error_code ignored;
    const std::filesystem::path path = arguments_.source.source;
    return live_ != nullptr && done_ > 0 && !is_interrupted() && arguments_.output.empty() &&
           arguments_.overlay.empty() && arguments_.label_maps.empty() &&
           (std::filesystem::is_regular_file(path, ignored) || std::filesystem::is_directory(path, ignored));
  }
  bool is_live() const { return arguments_.source.camera || arguments_.source.topic; }
  /// Is the time until a frame is there that of waiting for it?
  bool waits_for_frames() const { return info_.live || is_piped_; }
  const std::string& name() const { return info_.name; }
  void tell(const std::string& text) const {
    if (!arguments_.quiet) fmt::print(report_, "{}", text);
  }
  /// Something happened during the run; somebody may wait for it.
  void tell_now(const std::string& text) const {
    if (progress_) progress_->clear();
    tell(text);
    std::fflush(report_);
  }

  void tell_news() {
    if (sender_)
      for (const std::string& news : sender_->news()) tell_now(news + "\n");
    if (recorder_ == nullptr) return;
    for (const std::string& news : recorder_->news()) tell_now(news + "\n");
  }

  std::shared_ptr<const Configuration> load(const VisionChanges& changes) const {
    return load_configuration(arguments_.robot, arguments_.colors, arguments_.plugins, [&](RobotSetup& setup) {
      if (arguments_.start) {
        setup.vision.start_pose = gaussian_of(*arguments_.start);
        setup.start_state.reset();
      }
      if (!changes.empty()) apply_changes(setup, changes);
    });
  }
  void check_source(const Vision& vision) const {
    vision.check_frames(info_.name, info_.width, info_.height, info_.range);
  }
  /// A configuration loaded while running must fit what is being seen.
  std::shared_ptr<const Configuration> checked(std::shared_ptr<const Configuration> loaded) const {
    check_source(loaded->vision);
    check_paths(arguments_, loaded->setup.read);
    return loaded;
  }

  void open() {
    SourceOptions options;
    options.location = arguments_.source.source;
    options.raw = arguments_.source.raw;
    options.images_range = configuration_->setup.vision.colors.range;
    options.fps = arguments_.source.fps;
    options.threads = arguments_.threads;
    options.interrupted = is_interrupted;
    if (arguments_.source.camera) options.camera = *arguments_.source.camera;
    // Frames that fit the camera file need no --size.
    if (const auto& camera = configuration_->setup.vision.camera; camera && arguments_.source.size.empty()) {
      options.camera.width = camera->width;
      options.camera.height = camera->height;
    }
    options.camera_news = [this](const CameraNews& news) {
      tell_now(fmt::format("{}: {}\n", to_string(news.state), news.text));
    };
    if (topics_) topics_->set_news([this](const std::string& line) { tell_now(line + "\n"); });
    const bool is_first = !source_;
    source_.emplace(arguments_.source.topic ? topics_->open_images(options, arguments_.source.yuv_range)
                                            : open_source_of(options));
    if (is_first) info_ = source_->info();  // a file that is played again is the same
    begin_history();
    check_source(configuration_->vision);
  }

  /// A recording goes on from where it was begun.
  void begin_history() {
    odometry_.restart();
    workspace_.history.clear();
    const std::optional<StartState>& start = configuration_->setup.start_state;
    if (!start) return;
    workspace_.history.beliefs.add(start->t, start->belief);
    workspace_.history.tracks.add(start->t, start->tracks);
  }

  void begin_telling() {
    if (!arguments_.says_on_bus && arguments_.log.empty()) return;
    const RobotFile& robot = configuration_->setup.robot;
    TeamSenderOptions options;
    options.robot = arguments_.robot_id.value_or(robot.id);
    if (arguments_.says_on_bus) options.bus = bus_options(arguments_, robot);
    if (const auto bytes = robot.bus.bytes_per_second) options.budget.bytes_per_second = *bytes;
    if (const auto rate = robot.bus.picture_rate) options.budget.picture_rate = *rate;
    options.budget.rates = robot.bus.rates;
    options.reliable = robot.bus.reliable;
    options.log = arguments_.log;
    options.waits = loses_nothing(arguments_.source) && !arguments_.says_on_bus;
    sender_.emplace(options);
  }

  /// Somebody looks or listens: a file plays as it was recorded.
  bool plays_in_real_time() const { return (live_ != nullptr || arguments_.says_on_bus) && !is_live(); }

  void see_all(RunSinks& sinks) {
    std::optional<double> last_t;
    bool is_first = true;
    // Played again: the last frame is seen as long as the one before it, also by those who look at single images.
    auto due = Clock::now() + last_step_;
    while (!is_interrupted()) {
      const auto before = Clock::now();
      const std::optional<Frame> frame = source_->next();
      if (!frame) return;
      if (read_++ % arguments_.every != 0) continue;
      const double decode_ms = ms_between(before, Clock::now());
      if (sender_ && std::exchange(is_first, false)) sender_->begin(frame->t, source_->now().has_value());
      if (plays_in_real_time()) {
        // In real time, but a gap in the recording does not stop it for long.
        constexpr double longest_gap = 1;  // [s]
        const double step = last_t ? std::clamp(frame->t - *last_t, 0., longest_gap) : 0;
        last_step_ = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(step));
        due = std::max(due + last_step_, Clock::now() - std::chrono::seconds(1));
        last_t = frame->t;
        wait_until(due);
      }
      see(*frame, decode_ms, sinks);
    }
  }

  /// What a stage of a shared library throws is the world's failure, too.
  Scene seen_by(const Vision& vision, const Frame& frame, const Odometry* odometry) {
    try {
      return vision(frame, workspace_, odometry);
    } catch (const Error&) {
      throw;
    } catch (const std::exception& error) {
      throw Error(name_of(frame, name()), std::string("a stage failed: ") + error.what());
    }
  }

  static void wait_until(Clock::time_point then) {
    constexpr auto patience = std::chrono::milliseconds(50);  // until a signal is noticed
    while (!is_interrupted() && Clock::now() < then)
      std::this_thread::sleep_for(std::min<Clock::duration>(patience, then - Clock::now()));
  }

  void see(const Frame& frame, double decode_ms, RunSinks& sinks) {
    RecycledString changes = taken_over(frame.index);
    const Vision& vision = configuration_->vision;
    vision.check_frames(name_of(frame, name()), frame.view.width(), frame.view.height(), frame.range);
    odometry_.update(frame, is_interrupted);
    if (topics_) topics_->check_camera(configuration_->setup.vision.camera);
    const Odometry* const odometry = odometry_.get();
    if (recorder_ != nullptr) recorder_->before(frame, configuration_, workspace_.history, odometry_);
    Scene scene = seen_by(vision, frame, odometry);
    std::optional<double> latency_s;
    if (const std::optional<double> now = source_->now()) {
      latency_s = *now - frame.t;
      const double latency_ms = 1000 * *latency_s;
      summary_.add_latency(latency_ms);
      if (live_ != nullptr) live_->add_latency(latency_ms);
    }
    scene.timing.insert(scene.timing.begin(), {waits_for_frames() ? "wait" : "decode", decode_ms});
    if (!changes.empty()) scene.why.emplace_back("configuration", std::move(changes));
    if (odometry != nullptr) {
      const bool known = odometry->at(frame.t).has_value();
      summary_.add_odometry(known);
      if (!known) scene.why.emplace_back("odometry", "missing at this time");
    }
    sinks.write(frame, scene, workspace_, vision.optics());
    if (live_ != nullptr) live_->show(frame, scene, workspace_, configuration_);
    if (recorder_ != nullptr) recorder_->after(frame, scene, odometry_);
    if (sender_) sender_->say(frame, scene, workspace_, configuration_, odometry, latency_s);
    tell_news();
    watch_mount(scene);
    summary_.add(scene);
    progress_->frame(++done_);
  }

  /// Do lines lie where the mount says? Looks at what was seen, changes nothing of it.
  void watch_mount(const Scene& scene) {
    const Optics* const optics = configuration_->vision.optics();
    if (optics == nullptr || !scene.pose) return;
    if (drift_of_ != configuration_) {
      const VisionSetup& setup = configuration_->setup.vision;
      // What another camera or mount showed says nothing of this one.
      if (drift_of_ &&
          (drift_of_->setup.vision.mount != setup.mount || drift_of_->setup.vision.camera != setup.camera)) {
        drift_ = {};
        tell_drift("");
      }
      drift_of_ = configuration_;
      drift_target_.emplace(setup.field);
    }
    PoseGaussian pose;
    pose.x = scene.pose->x;
    pose.y = scene.pose->y;
    pose.theta = scene.pose->theta;
    drift_ = watched(drift_, *drift_target_,
                     {optics->camera, optics->mount_sigma, workspace_.marks, workspace_.line_of, pose, scene.t});
    // The last one that was told: a robot that sees no lines in the end has not been mended.
    if (const auto found = drifted(drift_)) tell_drift(to_text(*found));
  }
  void tell_drift(const std::string& text) {
    summary_.set_drift(text);
    if (live_ != nullptr) live_->set_mount_drift(text);
  }

  /// Between two frames: what was chosen or written meanwhile. Says in words what happened, nothing when nothing did.
  RecycledString taken_over(std::int64_t frame) {
    RecycledString changes;
    if (auto chosen = live_ != nullptr ? live_->chosen() : nullptr) {
      configuration_ = std::move(chosen);
      has_chosen_ = true;
      changes = "a changed one was taken over";
      tell_now(fmt::format("frame {}: as chosen in the browser\n", frame));
    }
    auto news = watch_ ? watch_->news() : std::nullopt;
    if (!news) return changes;
    // A browser's save is loaded at once, and found by the watch a moment later.
    if (news->configuration && std::exchange(has_chosen_, false) &&
        see_alike(news->configuration->setup, configuration_->setup))
      news->configuration = nullptr;
    if (live_ != nullptr) live_->told(*news);
    // A choice that was made after the files were read is in neither of them alone; the later load has both.
    if (news->configuration && news->configuration->load > configuration_->load) {
      configuration_ = std::move(news->configuration);
      changes = "a changed one was taken over";
      tell_now(fmt::format("frame {}: the changed configuration is taken over\n", frame));
    }
    if (!news->refusal.empty()) {
      changes.append(changes.empty() ? "" : "; ").append("refused, the former one goes on: ").append(news->refusal);
      tell_now(fmt::format("frame {}: a changed configuration is refused, the former one goes on: {}\n", frame,
                           news->refusal));
    }
    return changes;
  }

  const RunArguments& arguments_;
  LiveView* live_;
  Recorder* recorder_;
  std::FILE* report_;
  std::shared_ptr<const Configuration> configuration_;
  std::unique_ptr<TopicInput> topics_;  ///< Outlives what reads from it.
  OdometryInput odometry_;
  std::optional<FrameSource> source_;
  const bool is_piped_ = arguments_.source.source == "-" && comes_as_it_comes(STDIN_FILENO);
  SourceInfo info_;  ///< Stays as it is once other threads may look at it.
  VisionWorkspace workspace_;
  RunSummary summary_;
  MountDrift drift_;
  std::shared_ptr<const Configuration> drift_of_;  ///< Whose field `drift_target_` is.
  std::optional<FieldTarget> drift_target_;
  std::optional<Progress> progress_;
  std::optional<TeamSender> sender_;
  bool has_chosen_ = false;  ///< Taken over from a browser since the watch last had news.
  std::int64_t read_ = 0, done_ = 0;
  Clock::duration last_step_{};              ///< From frame to frame of a file that is played in real time.
  std::optional<ConfigurationWatch> watch_;  ///< Last: its thread uses the above.
};

}  // namespace

bool loses_nothing(const SourceArguments& source) {
  return !source.camera && !source.topic && source.source.find("://") == std::string::npos;
}

int run(const RunArguments& arguments, LiveView* live, Recorder* recorder) {
  Run one(arguments, live, recorder);
  one();
  return 0;
}

}  // namespace tassilo
