#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tassilo/app/bus_complaints.h"
#include "tassilo/app/configuration_watch.h"
#include "tassilo/message/from_scene.h"
#include "tassilo/record/mcap_writer.h"
#include "tassilo/team/bus.h"
#include "tassilo/team/robot_voice.h"

namespace tassilo {

/// Where a run tells what it sees.
struct TeamSenderOptions {
  int robot = 0;                  ///< 0..255
  std::optional<BusOptions> bus;  ///< Nothing: not on the bus.
  BudgetOptions budget;           ///< Of the bus; a log has all.
  bool reliable = false;
  std::string log;     ///< An MCAP file; empty: none.
  bool waits = false;  ///< The run waits for room: nothing is dropped.
};

/// What a player says of itself.
struct TeamRole {
  std::string role, action, planning_state;
};

/// Tells the team, and a log, what one robot sees, as messages of ROS 2.
///
/// Messages are made where it is called; a thread of its own sends them, and draws and encodes pictures. The vision
/// does not wait for it: of what it cannot send in time the oldest is dropped and counted.
///
/// threads  begin, say and finish from the run's thread
class TeamSender {
 public:
  /// Throws Error when the bus cannot be entered, or the log cannot be made.
  explicit TeamSender(const TeamSenderOptions& options);
  ~TeamSender();
  TeamSender(const TeamSender&) = delete;
  TeamSender& operator=(const TeamSender&) = delete;

  /// A source begins, or begins again. Of a live source its times are told; of a file, on the bus, as if it happened
  /// now, for nobody believes in two times; in a log alone as they are, where they are since the UNIX epoch.
  void begin(double first_t, bool is_live);
  /// One frame was seen.
  /// latency_s   from its capture until now; nothing when that is not known
  void say(const Frame& frame, const Scene& scene, const VisionWorkspace& workspace,
           const std::shared_ptr<const Configuration>& configuration, const Odometry* odometry,
           std::optional<double> latency_s, const TeamRole& role = {});
  /// All is sent, and the log complete. Throws Error when that failed.
  void finish();
  /// What happened since the last call, for people, in lines without their ends.
  std::vector<std::string> news();
  /// For people, lines with their ends.
  std::string summary() const;

 private:
  struct Drawing {
    Frame frame;
    Scene scene;
    Surface surface;
    std::shared_ptr<const Configuration> configuration;
  };
  struct Item {
    std::vector<Spoken> messages;
    msgs::TeamState state;
    double t = 0;  ///< Capture time since the UNIX epoch. [s]
    std::int64_t log_time_ns = 0;
    std::optional<Drawing> drawing;
    bool is_drawing_logged = false;
  };

  void send_all();
  void send(Item& item);
  void show(const Item& item);
  void lose(const std::string& why);
  void tell_complaints();
  void log(const Topic& topic, const Item& item, std::span<const std::byte> data);

  const TeamSenderOptions options_;
  std::optional<Bus> bus_;
  std::optional<RobotVoice> voice_;
  std::optional<McapWriter> log_;
  std::map<std::string_view, std::uint16_t> channels_;
  double offset_ = 0;  ///< From the source's clock to the UNIX epoch. [s]
  RateMeter frames_;
  std::uint64_t seen_ = 0;
  double next_logged_picture_ = 0;  ///< [s]
  std::atomic<bool> is_picture_wanted_ = false;

  mutable std::mutex mutex_;  ///< Guards all down to the thread.
  std::condition_variable there_is_work_, there_is_room_;
  std::deque<Item> queue_;
  bool busy_ = false, ending_ = false;
  std::int64_t dropped_ = 0;
  std::uint64_t sent_ = 0, withheld_ = 0, logged_ = 0;
  double bytes_ = 0;
  std::int64_t lost_ = 0;    ///< Messages that could not be sent, frames without a time.
  std::string log_trouble_;  ///< Why the log ended early.
  std::vector<std::string> news_;
  BusComplaints complaints_;
  // The thread's own while it is busy.
  bool has_log_failed_ = false;
  std::chrono::steady_clock::time_point next_complaints_{};
  std::optional<Item> picture_;  ///< To be drawn; the thread's own while it is busy.
  std::thread thread_;
};

}  // namespace tassilo
