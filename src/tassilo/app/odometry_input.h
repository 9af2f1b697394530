#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tassilo/files/odometry_file.h"
#include "tassilo/image/frame.h"
#include "tassilo/source/line_stream.h"
#include "tassilo/timeline/odometry.h"

namespace tassilo {

/// The odometry of a run: all of a file at once, what comes while it runs (see LineStream, TopicInput), or that of a
/// recording, which comes again with the frames it came with.
class OdometryInput {
 public:
  /// location     a file, `-`, `udp:127.0.0.1:PORT`; empty: none
  /// waits        whether `update` may wait for lines of standard input, as nothing is lost by it: sources other than
  ///              cameras and streams
  /// taken        when given, samples come from there: what it gives each time. `location` is not looked at then.
  /// Throws Error when a file cannot be read.
  OdometryInput(const std::string& location, bool waits, std::function<std::vector<OdometrySample>()> taken = {});

  /// Takes what has come before this frame. `interrupted` ends the waiting.
  void update(const Frame& frame, const std::function<bool()>& interrupted);
  /// The source begins again: a recording's lines come again with it.
  void restart();

  /// Is all that will ever be known, known?
  bool is_whole() const { return !stream_ && !taken_ && !is_recorded_; }
  /// What the last `update` took.
  const std::vector<OdometrySample>& arrived() const { return arrived_; }

  /// Null: none.
  const Odometry* get() const { return odometry_ ? &*odometry_ : nullptr; }
  /// For people, a line with its end, of lines that were wrong or dropped; empty when none was.
  std::string summary() const;

 private:
  void add(const std::string& line);

  std::string location_;
  bool waits_ = false;
  std::function<std::vector<OdometrySample>()> taken_;
  std::optional<LineStream> stream_;
  std::optional<Odometry> odometry_;
  std::optional<double> newest_;  ///< Time of what came. [s]
  bool is_recorded_ = false;
  std::vector<OdometryLine> recorded_;
  std::size_t next_recorded_ = 0;
  std::vector<OdometrySample> arrived_;
  std::int64_t lines_ = 0, refused_ = 0;
  std::string first_refusal_;
};

}  // namespace tassilo
