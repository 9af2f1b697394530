#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tassilo/scene/scene.h"
#include "tassilo/timeline/sequence.h"

namespace tassilo {

/// What is worth telling of all scenes of a run, at its end.
class RunSummary {
 public:
  void add(const Scene& scene);
  /// Odometry was given: how did its samples come?
  void set_odometry(const SequenceCounts& samples) { odometry_samples_ = samples; }
  /// Did it say where the robot was at this frame's time?
  void add_odometry(bool known) { ++(known ? odometry_known_ : odometry_missing_); }

  /// From the capture of a frame to its scene. [ms]
  void add_latency(double ms);
  /// The mount is no longer what the camera file says: how it differs, in words.
  void set_drift(std::string text) { drift_ = std::move(text); }

  /// A table for people, several lines, each ended. `source` are such lines of the source.
  std::string text(double seconds, const std::string& source) const;

 private:
  std::int64_t frames_ = 0;
  std::int64_t last_index_ = 0, dropped_ = 0;
  std::int64_t odometry_known_ = 0, odometry_missing_ = 0;
  SequenceCounts odometry_samples_;
  std::string drift_;  ///< Empty while the mount is as told.
  struct Count {
    std::int64_t frames = 0, objects = 0;
  };
  std::vector<std::pair<std::string, Count>> seen_;
  std::vector<std::pair<std::string, std::vector<double>>> times_;  ///< By stage, in the order they ran. [ms]

  std::vector<double> latencies_ms_;

  Count& count_of(const std::string& kind);
  std::string odometry_text() const;
};

}  // namespace tassilo
