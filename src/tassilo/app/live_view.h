#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "tassilo/app/configuration_watch.h"
#include "tassilo/app/recent_median.h"
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
///          any; requests are answered on the server's
class LiveView {
 public:
  /// Loads the configuration with these changes. Throws Error for what is wrong with them.
  using Load = std::function<std::shared_ptr<const Configuration>(const VisionChanges&)>;

  /// Serves at once. Throws Error when it cannot.
  /// recorder   what the page's button begins and ends
  LiveView(const WebOptions& options, std::string robot_file, Recorder* recorder);
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  std::string url() const { return server_.url(); }

  /// A source is open: from now on stages can be changed.
  /// every   of so many frames one is seen
  void begin(const std::string& source_name, const std::string& source_description, int every,
             std::shared_ptr<const Configuration> now, Load load);
  /// One frame was seen. Does not wait.
  void show(const Frame& frame, const Scene& scene, const VisionWorkspace& workspace,
            const std::shared_ptr<const Configuration>& configuration);
  /// From the capture of a frame to its scene. [ms]
  void add_latency(double ms);
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
  struct Snapshot {
    Frame frame;
    Scene scene;
    Surface surface;
    std::shared_ptr<const Configuration> configuration;
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
    std::string picture_fault;  ///< Why the last picture could not be made; empty when it could.
  };

  WebResponse answer(const WebRequest& request);
  WebResponse change_stages(const std::string& body);
  std::string state_json() const;
  void draw_pictures();
  static std::string picture_of(const Snapshot& snapshot);

  const std::string robot_file_;
  Recorder* const recorder_;
  std::mutex loading_;        ///< Held while a configuration is loaded; before the other one.
  mutable std::mutex mutex_;  ///< Guards all down to the server.
  std::condition_variable wanted_;
  Seen seen_;
  mutable RecentMedian latency_ms_;
  Load load_;
  std::shared_ptr<const Configuration> now_, chosen_;
  VisionChanges changes_;
  std::optional<Snapshot> snapshot_;
  bool drawing_ = false, ending_ = false;

  WebServer server_;
  std::thread painter_;
};

}  // namespace tassilo
