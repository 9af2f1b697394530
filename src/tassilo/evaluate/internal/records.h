#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// Scene lines and truth as they are in the files. Not tassilo::Scene: other programs' lines are judged too, with boxes
// that need not be whole pixels and values that may be null one by one.

namespace tassilo {

using ScoreBox = std::array<double, 4>;  ///< x0, y0, x1, y1, exclusive ends. [px]

struct ReportedPose {
  double x = 0, y = 0, theta = 0;
  std::vector<double> covariance;  ///< 9, row-major.
  bool predicted = false, mirror = false;
};

/// Floor values of a ball or a robot.
struct ReportedPlace {
  std::optional<double> x, y, distance, near, far;
};
struct ReportedBall {
  ReportedPlace floor;
  std::vector<double> covariance;  ///< 4, or none.
  ScoreBox box{};
};
enum class GoalName { yellow, blue };
struct ReportedGoal {
  GoalName color = GoalName::yellow;
  ScoreBox box{};
  std::optional<double> bearing;
};
struct ReportedRobot {
  std::string team;
  ReportedPlace floor;
  std::optional<std::array<double, 2>> center;
  ScoreBox box{};
};
enum class ReportedState { blocked, free, unseen };
struct ReportedFreeSpace {
  std::array<double, 2> origin{};
  double angle_min = 0, angle_increment = 1;
  std::vector<double> ranges;  ///< 0 where unseen.
  std::vector<ReportedState> states;
};
struct ReportedScene {
  std::int64_t frame = 0;
  double t = 0;
  std::string image;  ///< File name without folder.
  std::optional<ReportedPose> pose;
  std::vector<ReportedBall> balls;
  std::vector<ReportedGoal> goals;
  std::vector<ReportedRobot> robots;
  std::optional<ReportedFreeSpace> free_space;
  std::vector<std::pair<std::string, double>> timing_ms;
  bool has_unscored = true;  ///< The keys that are not scored are there.
  std::string place;         ///< file:line
};

struct TruePose {
  double x = 0, y = 0, theta = 0;
};
/// What the image shows of an object.
struct TrueView {
  std::int64_t visible_px = 0;
  double visible_fraction = 0;
  std::optional<ScoreBox> visible, whole;
  bool truncated = false;
};
struct TrueBall {
  double x = 0, y = 0, distance = 0;  ///< Robot frame.
  TrueView view;
};
struct TrueGoal {
  double x = 0, y = 0;  ///< Middle of the mouth, robot frame.
  TrueView view;
};
struct TrueRobot {
  TruePose in_field, in_robot;
  std::string team;
  bool is_box = true;
  std::vector<double> size;  ///< Length, width, height; a cylinder's length is its diameter.
  TrueView view;
};
/// The foot of an obstacle that the image shows, seen from `TrueFrame::free_origin`.
struct TrueFoot {
  double angle = 0, range = 0;
};
struct TrueFrame {
  double t = 0;
  TruePose robot;
  TrueBall ball;
  std::vector<TrueRobot> robots;
  std::array<TrueGoal, 2> goals;  ///< By GoalName.
  std::array<double, 2> free_origin{};
  std::vector<TrueFoot> feet;
};

struct TrueField {
  double length = 0, width = 0, goal_width = 0, goal_depth = 0;
  bool walls = false;
};

/// {frame: truth}. All of these throw Error with file and line.
std::map<std::int64_t, TrueFrame> read_truth(const std::filesystem::path& file);
/// {frame: scene}; every frame must be in the truth.
std::map<std::int64_t, ReportedScene> read_scenes(const std::filesystem::path& file,
                                                  const std::map<std::int64_t, TrueFrame>& truth,
                                                  const std::filesystem::path& truth_file);
/// {image: its scene lines}
std::map<std::string, std::vector<ReportedScene>> read_image_scenes(const std::filesystem::path& file);
TrueField read_true_field(const std::filesystem::path& meta_file);

struct TrueBallImage {
  std::string image;
  std::vector<ScoreBox> balls, ignore;
};
std::vector<TrueBallImage> read_ball_images(const std::filesystem::path& file);
/// File names without folder of the images that training samples are drawn on.
std::vector<std::string> read_sample_images(const std::filesystem::path& file);

struct TrueImagePose {
  std::string image;
  TruePose pose;
  std::string quality;
};
/// Comma-separated without quotes, the first line names the columns; the last of several lines of an image counts.
std::vector<TrueImagePose> read_image_poses(const std::filesystem::path& file);

}  // namespace tassilo
