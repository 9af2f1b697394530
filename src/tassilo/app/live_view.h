#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "tassilo/app/calibration_session.h"
#include "tassilo/app/configuration_watch.h"
#include "tassilo/app/recent_median.h"
#include "tassilo/app/training_session.h"
#include "tassilo/surface/surface.h"
#include "tassilo/web/server.h"

namespace tassilo {

class Recorder;

/// Settings below `vision:` that somebody changed while running, over those of the robot file.
using VisionChanges = std::map<std::string, Setting, std::less<>>;

/// The settings of the robot file with the changes over them. Throws Error for what the vision does not know or take.
void apply_changes(RobotSetup& setup, const VisionChanges& changes);

/// What browsers see and change of a run: pages, scenes, annotated pictures, stages.
///
/// The vision never waits for it: a picture is drawn and encoded in a thread of its own, from the newest frame that was
/// there when it had time, and only while somebody looks.
///
/// threads  `begin`, `show`, `chosen`, `told` and `leave` from the run's thread, `changes` and `load_with_changes` from
///          any; requests are answered on a thread of the server's
class LiveView {
 public:
  /// Loads the configuration with these changes. Throws Error for what is wrong with them.
  using Load = std::function<std::shared_ptr<const Configuration>(const VisionChanges&)>;

  /// Serves at once. Throws Error when it cannot.
  /// samples   file of the color training; empty: beside the color table
  /// recorder   what the page's button begins and ends
  LiveView(const WebOptions& options, std::string robot_file, std::filesystem::path samples, Recorder* recorder);
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  std::string url() const { return server_.url(); }

  /// A source is open: from now on stages can be changed, and colors trained.
  /// every   of so many frames one is seen
  /// range   of the source's frames
  void begin(const std::string& source_name, const std::string& source_description, int every, ColorRange range,
             std::shared_ptr<const Configuration> now, Load load);
  /// One frame was seen. Does not wait.
  void show(const Frame& frame, const Scene& scene, const VisionWorkspace& workspace,
            const std::shared_ptr<const Configuration>& configuration);
  /// From the capture of a frame to its scene. [ms]
  void add_latency(double ms);
  /// How the mount differs from the camera file, in words; empty: it does not, as far as is known.
  void set_mount_drift(const std::string& text);
  /// No more frames come: what `begin` gave is no longer asked.
  void leave();

  /// A configuration that somebody chose since the last call, to be taken over; null: none.
  std::shared_ptr<const Configuration> chosen();
  /// What is changed over the robot file now.
  VisionChanges changes() const;
  /// What `load` makes of the changes there are; no other load runs meanwhile.
  std::shared_ptr<const Configuration> load_with_changes(const Load& load);
  /// The run has taken over, or refused, what it found in the files.
  void told(const ConfigurationWatch::News& news);

 private:
  /// All a picture is drawn from.
  struct Scenery {
    Scene scene;
    Surface surface;
    std::shared_ptr<const Configuration> configuration;
  };
  struct Snapshot {
    Frame frame;
    std::optional<Scenery> scenery;             ///< Where the picture is wanted.
    CalibrationSession* calibration = nullptr;  ///< Where it wants the frame.
  };
  struct Seen {
    std::string source_name, source_description;
    std::int64_t frame = -1, frames = 0;
    std::int64_t dropped = 0;  ///< Frames of the source that were not seen, but for those left out on purpose.
    int every = 1;
    double t = 0, rate_hz = 0;
    std::chrono::steady_clock::time_point shown_at;
    std::int64_t taken_over = 0;
    std::string refusal;
    std::string mount_drift;
    std::string picture_fault;  ///< Why the last picture could not be made; empty when it could.
  };

  WebResponse answer(const WebRequest& request);
  WebResponse change_stages(const std::string& body);
  WebResponse train(const WebRequest& request);
  WebResponse calibrate(const WebRequest& request);
  void take_over_files();
  std::shared_ptr<const std::string> shown_frame(std::optional<std::int64_t> frame);
  std::string state_json() const;
  void draw_pictures();
  void publish(const Snapshot& snapshot);

  const std::string robot_file_;
  const std::filesystem::path samples_;
  std::optional<ColorRange> range_;            ///< Once a source is open.
  std::unique_ptr<TrainingSession> training_;  ///< Since it was first asked for; used by who answers requests.
  Recorder* const recorder_;
  std::mutex loading_;        ///< Held while a configuration is loaded; before the other one.
  mutable std::mutex mutex_;  ///< Guards all down to the server.
  std::condition_variable wanted_, shown_;
  Seen seen_;
  mutable RecentMedian latency_ms_;
  std::unique_ptr<CalibrationSession> calibration_;  ///< Since it was first asked for; then it stays.
  Load load_;
  std::shared_ptr<const Configuration> now_, chosen_;
  VisionChanges changes_;
  std::optional<Snapshot> snapshot_;
  bool drawing_ = false, ending_ = false;
  bool is_frame_wanted_ = false;                                ///< By a request, though nobody listens to frames.
  std::deque<std::shared_ptr<const std::string>> last_frames_;  ///< That were sent; see frame_bytes.

  WebServer server_;
  std::thread painter_;
};

}  // namespace tassilo
