#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "tassilo/evaluate/evaluate.h"
#include "tassilo/evaluate/internal/records.h"
#include "tassilo/evaluate/internal/statistics.h"

namespace tassilo {

/// Everything counted in frames, of one sequence or of several.
struct Samples {
  Tally missing, time_differs, unscored_missing;
  struct Pose {
    Tally there, good, good_mirrored, wrong, mirror, bad_covariance, after_fix, good_after_fix;
    Numbers position_m, heading_deg, nees, first_fix;  ///< first_fix infinite: never.
  } pose;
  /// What balls and robots have in common.
  struct Placed {
    Tally bracketed, without_floor, inconsistent;
    Numbers bracket_width;
  };
  struct Ball : Placed {
    Tally recall_best, recall_any, precision_best, precision_all, bad_covariance;
    Numbers error_m, error_relative, nees;
  } ball;
  struct Goal {
    Tally recall, precision;
    Numbers bearing_deg;
  } yellow, blue;
  struct Robot : Placed {
    Tally recall, precision, team_right, team_swapped;
    Numbers to_nearest_m, center_m;
  } robot;
  struct FreeSpace {
    Tally dangerous, timid, coverage, state_free;
    Numbers error_m, range_relative;
  } free_space;
  std::map<std::string, Numbers> timing_ms;
};

/// Adds one sequence. Without a field free space is left out.
void add_sequence(Samples& samples, const std::map<std::int64_t, TrueFrame>& truth,
                  const std::map<std::int64_t, ReportedScene>& scenes, const std::optional<TrueField>& field);

SequenceScore summarize(const Samples& samples);

}  // namespace tassilo
