#pragma once

#include <functional>
#include <optional>
#include <string>

#include "tassilo/source/line_stream.h"
#include "tassilo/timeline/odometry.h"

namespace tassilo {

/// The odometry of a run: all of a file at once, or lines that come while it runs (see LineStream).
class OdometryInput {
 public:
  /// location     a file, `-`, `udp:127.0.0.1:PORT`; empty: none
  /// waits        whether `update` may wait for lines of standard input, as nothing is lost by it: sources other than
  ///              cameras and streams
  /// Throws Error when a file cannot be read.
  OdometryInput(const std::string& location, bool waits);

  /// Takes what has come, before a frame captured at t. `interrupted` ends the waiting.
  void update(double t, const std::function<bool()>& interrupted);

  /// Null: none.
  const Odometry* get() const { return odometry_ ? &*odometry_ : nullptr; }
  /// For people, a line with its end, of lines that were wrong or dropped; empty when none was.
  std::string summary() const;

 private:
  void add(const std::string& line);

  std::string location_;
  bool waits_ = false;
  std::optional<LineStream> stream_;
  std::optional<Odometry> odometry_;
  std::optional<double> newest_;  ///< Time of what came. [s]
  std::int64_t lines_ = 0, refused_ = 0;
  std::string first_refusal_;
};

}  // namespace tassilo
