#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tassilo/app/bus_complaints.h"
#include "tassilo/app/team_bench.h"
#include "tassilo/app/team_history.h"
#include "tassilo/app/team_log.h"
#include "tassilo/app/team_trails.h"
#include "tassilo/app/unix_clock.h"
#include "tassilo/field/field_model.h"
#include "tassilo/record/mcap_writer.h"
#include "tassilo/team/bus.h"
#include "tassilo/team/team_view.h"
#include "tassilo/web/server.h"

namespace tassilo {

struct MonitorOptions {
  WebOptions web;
  TeamViewOptions view;
  FieldModel field;
  BusOptions bus;
  std::string record;     ///< MCAP file of all that is heard; empty: none.
  double rate = 30;       ///< Team pictures to browsers. [1/s], 1..100
  double memory_s = 300;  ///< That can be looked back at, at most; 512 KiB are kept for each of it. [s]
  void check() const;     ///< Throws Error naming the first field out of range.
};

/// Listens to the team bus and shows it to browsers, until it is interrupted.
///
/// It finds robots by the topics that are published, and listens to pictures only while a browser does. Nothing that
/// comes over the bus ends it.
///
/// threads  one for the bus; requests of browsers are answered on the server's
class LiveMonitor {
 public:
  /// Throws Error when bus, server or record cannot be had.
  explicit LiveMonitor(const MonitorOptions& options);
  std::string url() const { return server_.url(); }
  /// Until `is_over` says so.
  void run(const std::function<bool()>& is_over);
  /// For people, lines with their ends.
  std::string summary() const;

 private:
  struct Ear {
    BusReader reader;
    std::string topic;  ///< As ROS 2 names it.
    bool is_picture = false;
    int robot = 0;
    double published_at = 0;  ///< When somebody was last known to publish it. [s]
  };
  /// Who said what is written down: two that use one number can be told apart.
  struct Recorded {
    std::string topic, sender;
    auto operator<=>(const Recorded&) const = default;
  };

  WebResponse answer(const WebRequest& request);
  void find_ears(double now);
  void listen(double now);
  void record(const BusSample& sample, const Ear& ear);
  void publish(double now);
  void tell(double now, const std::string& complaint);
  bool is_known(int robot) const;

  const MonitorOptions options_;
  Bus bus_;
  std::map<std::string, Ear, std::less<>> ears_;  ///< By topic on the wire.
  std::vector<int> with_pictures_;
  struct Trouble {
    double t = 0;
    std::string text;
  };
  EvenClock clock_;
  BusComplaints complaints_;
  std::vector<Trouble> bus_troubles_;
  std::vector<std::string> deaf_;  ///< Topics that cannot be listened to, in words.
  std::optional<McapWriter> record_;
  std::map<Recorded, std::uint16_t> channels_;
  std::int64_t recorded_ = 0;
  std::string record_trouble_;
  std::array<std::string, 256> picture_channels_;

  mutable std::mutex mutex_;  ///< Guards all down to the server.
  TeamView view_;
  TeamBench bench_;
  TeamHistory history_;
  TeamTrails trails_;
  double kept_at_ = 0;
  WebServer server_;
};

/// Shows a log to browsers, until it is interrupted.
class LogMonitor {
 public:
  /// Throws Error when the log cannot be read, or there is no server.
  LogMonitor(const MonitorOptions& options, const std::string& log);
  std::string url() const { return server_.url(); }
  void run(const std::function<bool()>& is_over);

 private:
  WebResponse answer(const WebRequest& request);

  const MonitorOptions options_;
  const std::string name_;
  TeamLog log_;  ///< Used by who answers requests.
  WebServer server_;
};

}  // namespace tassilo
