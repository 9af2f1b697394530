#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tassilo/evaluate/evaluate.h"

// How two runs over the same recording differ: two algorithms, two configurations, two machines. Neither is the truth;
// with it, both are measured as `evaluate` does.

namespace tassilo {

/// How many things both runs saw, and one alone. Swapping the runs swaps only_a and only_b.
struct Paired {
  std::int64_t both = 0, only_a = 0, only_b = 0;
};

struct PoseDifference {
  Paired frames;                                      ///< With a pose.
  Spread distance_m, turn_deg;                        ///< Over the frames where both have one.
  std::int64_t kind_differs = 0, mirror_differs = 0;  ///< Of these.
};
/// Balls are paired by their boxes, the best overlap first; balls of few pixels also by their middles.
struct BallDifference {
  Paired balls;
  Spread distance_m;  ///< Between the floor points of a pair; of pairs where both have one.
  Spread center_px;
};
/// Paired by color and overlap of their boxes.
struct GoalDifference {
  Paired goals;
  Spread bearing_deg, distance_m;  ///< Of pairs where both have it; distance between the middles of the mouths.
};
/// Paired by overlap of their boxes.
struct RobotDifference {
  Paired robots;
  Spread nearest_m, center_m;  ///< Between nearest points and between middles; of pairs where both have them.
  std::int64_t team_differs = 0;
};
/// Lines of one kind are paired, the nearest first, when no end is further from the other line than a quarter of the
/// longer one; circles when their middles are within 1 m.
struct LineDifference {
  Paired lines, circles;
  Spread ends_px;                  ///< Largest distance of an end of one to the other, in the image.
  Spread center_m;                 ///< Between middles of circles.
  std::int64_t model_differs = 0;  ///< Pairs of lines.
};
struct FreeSpaceDifference {
  Paired frames;                   ///< With free space.
  std::int64_t other_sectors = 0;  ///< Frames of `both` whose sectors lie elsewhere; not compared.
  std::int64_t sectors = 0, state_differs = 0;
  Spread range_m;  ///< Of sectors seen by both.
};

/// A key of the scene lines, and the frames in which its values are not equal; by number.
struct SubjectDifference {
  std::string subject;
  std::vector<std::int64_t> frames;
};

struct Comparison {
  std::string name_a, name_b;                ///< The files as they were given.
  std::int64_t frames = 0;                   ///< In both.
  std::int64_t equal_frames = 0;             ///< Of these, equal but for `timing_ms`.
  std::vector<std::int64_t> only_a, only_b;  ///< Frames that one file alone has; by number.
  /// t, pose, balls, goals, robots, lines, free_space, then other keys that any line has, by name.
  std::vector<SubjectDifference> subjects;
  PoseDifference pose;
  BallDifference balls;
  GoalDifference goals;
  RobotDifference robots;
  LineDifference lines;
  FreeSpaceDifference free_space;
  std::map<std::string, StageTimes> timing_ms_a, timing_ms_b;  ///< Over the frames in both.
  std::optional<Evaluation> truth_a, truth_b;                  ///< Both or none; where truth was given.

  /// The same frames in both, and the same seen in each.
  bool equal() const { return only_a.empty() && only_b.empty() && equal_frames == frames; }
};

struct CompareOptions {
  std::filesystem::path a, b;                  ///< Scene lines, matched by `frame`.
  std::optional<std::filesystem::path> truth;  ///< gt.jsonl of the recording.
  std::optional<std::filesystem::path> meta;   ///< With truth: the field; default: meta.json beside it.
};

/// Reads and compares. Values are equal when their JSON is; differences are told for those that are not.
///
/// Throws Error naming file and line for what cannot be read, is no scene, or has a frame twice; for files without
/// lines or without a common frame; and for another recording: capture times of one frame more than 10 ms apart, or
/// images of other names. Memory: all lines of both; time: linear in them, quadratic in the objects of a frame.
Comparison compare(const CompareOptions& options);

/// As text for people, several lines, each ended; of every subject at most `max_rows` >= 0 frame numbers.
std::string table(const Comparison& comparison, int max_rows);

/// Everything: {a, b, frames, equal, differs_in, pose, balls, goals, robots, lines, free_space, timing_ms, truth}; what
/// could not be counted is null, `truth` is left out without truth.
std::string to_json(const Comparison& comparison);

}  // namespace tassilo
