#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// How well the scenes of `tassilo run` agree with the truth. docs/accuracy.md tells what each figure means.
//
// A quantity of which nothing could be counted is nothing, never zero. Shares are 0..1.

namespace tassilo {

/// Linearly interpolated quantiles and the maximum of a list of values.
struct Spread {
  std::optional<double> median, p90, max;
  std::int64_t count = 0;
};

struct PoseScore {
  std::optional<double> share;            ///< Frames with a pose.
  std::optional<double> share_after_fix;  ///< Of the frames after the first fix; a `mirror` pose is none.
  Spread position_m, heading_deg;         ///< With `mirror`: from the nearer of the true pose and its point mirror.
  std::optional<double> good;             ///< Within 0.10 m and 3 degrees; of all frames.
  std::optional<double> good_mirrored;    ///< The same, or so for the point-mirrored pose.
  std::optional<double> good_after_fix;
  std::optional<double> wrong;      ///< Beyond 0.5 m or 15 degrees; of the frames with a pose.
  std::optional<double> mirror;     ///< Marked as possibly mirrored; of the frames with a pose.
  std::optional<double> first_fix;  ///< Median over sequences; nothing where it falls on one never fixed. [frame]
  std::int64_t never_fixed = 0;     ///< Sequences.
  std::optional<double> nees_mean, nees_median;  ///< Normalized squared error; 3 and 2.37 are exact.
  std::int64_t bad_covariances = 0;              ///< Not positive definite.
};

struct BallScore {
  std::optional<double> recall_best, recall_any;  ///< Over `frames`, those where the ball is clearly visible.
  std::int64_t frames = 0;
  std::optional<double> precision_best, precision_all;
  std::int64_t reported_best = 0, reported = 0;
  Spread error_m, error_relative;                ///< Of the best ball, when it is the true one.
  std::optional<double> bracketed;               ///< The true distance lies within [near, far].
  std::optional<double> bracket_width_relative;  ///< Median of (far - near) / distance.
  std::optional<double> nees_mean;               ///< 2 is exact.
};

struct GoalScore {
  std::optional<double> recall, precision;
  std::int64_t frames = 0, reported = 0;
  Spread bearing_deg;  ///< Of goals not cut by the image border.
};

struct RobotScore {
  std::optional<double> recall, precision;
  std::int64_t robots = 0, reported = 0;
  std::optional<double> team_right, team_swapped;
  Spread to_nearest_m;  ///< (x, y) from the true outline point nearest to us.
  Spread center_m;
  std::optional<double> bracketed;
  std::optional<double> bracket_width_m;  ///< Median.
};

struct FreeSpaceScore {
  std::int64_t sectors = 0, blocked = 0;      ///< Judged; of these with state `blocked`.
  Spread error_m;                             ///< Of blocked sectors.
  std::optional<double> dangerous, timid;     ///< Of judged; of blocked sectors.
  std::optional<double> coverage;             ///< Obstacle feet in view whose sector is blocked.
  std::optional<double> state_free;           ///< Judged sectors with state `free`.
  std::optional<double> free_range_relative;  ///< Median of claimed / true range of these.
};

struct StageTimes {
  std::optional<double> median, p99, max;  ///< [ms]
};

/// Figures of one sequence, or of several pooled.
struct SequenceScore {
  std::int64_t frames = 0, frames_missing = 0;  ///< In the truth; of these without a scene line.
  PoseScore pose;
  BallScore ball;
  GoalScore yellow, blue, goals;  ///< `goals`: both colors pooled.
  RobotScore robots;
  FreeSpaceScore free_space;
  std::map<std::string, StageTimes> timing_ms;
  std::vector<std::string> notes;  ///< What a reader should know, each with its count first.
};

/// Figures of label maps: every true class eroded by one pixel.
struct ColorScore {
  struct Class {
    std::int64_t pixels = 0;
    std::optional<double> recall, precision;
  };
  std::int64_t maps = 0, missing = 0;
  std::optional<double> accuracy, mean_recall, mean_precision;  ///< Means over the `mean_over` classes in the truth.
  std::int64_t mean_over = 0;
  std::array<Class, 9> classes;                            ///< no_color, black, ... by label.
  std::array<std::array<std::int64_t, 9>, 9> confusion{};  ///< [true][found], pixels.
};

/// Figures of balls in single images.
struct BallImageScore {
  struct Place {
    std::string image;
    std::array<double, 4> box{};  ///< Exclusive ends. [px]
    bool best = false;            ///< Was reported first.
  };
  std::int64_t images = 0, excluded = 0;
  std::vector<std::string> missing, unknown;  ///< Images without a scene line; scene lines without truth.
  std::int64_t balls = 0, found = 0, found_best = 0, reported = 0, reported_best = 0;
  std::vector<Place> missed, wrong;
  std::optional<double> recall_best, recall_any, precision_best, precision_all;
};

/// Figures of poses in single images; several scene lines an image are several draws.
struct PoseImageScore {
  std::int64_t images = 0, images_with_pose = 0, images_missing = 0, draws = 0, poses = 0;
  Spread position_m, heading_deg;
  std::optional<double> wrong;
};

template <class Score>
using Named = std::vector<std::pair<std::string, Score>>;

/// What to compare; every list may be empty.
struct EvaluateOptions {
  struct Sequence {
    std::filesystem::path truth, scenes;  ///< gt.jsonl; scene lines, matched by `frame`.
  };
  struct LabelMaps {
    std::filesystem::path labels, maps;  ///< Folders of NNNN.png.
  };
  struct BallImages {
    std::filesystem::path balls, scenes;                   ///< balls.json; scene lines, matched by `image`.
    std::vector<std::string> exclude;                      ///< Images to leave out.
    std::optional<std::filesystem::path> exclude_samples;  ///< samples.yaml whose images to leave out.
  };
  struct PoseImages {
    std::filesystem::path poses, scenes;  ///< CSV with image, x, y, theta, quality; scene lines, matched by `image`.
  };

  std::vector<Sequence> sequences;
  std::optional<std::filesystem::path>
      meta;  ///< The field; default: meta.json beside each truth, without: no free space.
  std::vector<LabelMaps> colors;
  std::optional<BallImages> balls;
  std::optional<PoseImages> poses;
};

struct Evaluation {
  Named<SequenceScore> sequences;        ///< By the folder of gt.jsonl, or the file's own name.
  std::optional<SequenceScore> overall;  ///< All frames pooled.
  Named<ColorScore> color_sets;
  std::optional<ColorScore> colors;  ///< All pixels pooled.
  std::optional<BallImageScore> balls;
  Named<PoseImageScore> poses;  ///< By quality of the truth, and "all" at the end.
};

/// Reads and compares. Throws Error naming file and line for what cannot be read or does not belong together, or the
/// same sequence twice. Memory: all lines of one sequence at a time.
Evaluation evaluate(const EvaluateOptions& options);

/// The figures as text for people, several lines, each ended.
std::string table(const Evaluation& evaluation);

/// All figures: {sequences: {name: ..}, overall, colors: {sets, overall}, balls, poses}, what was not asked for left
/// out, what could not be counted null.
std::string to_json(const Evaluation& evaluation);

}  // namespace tassilo
