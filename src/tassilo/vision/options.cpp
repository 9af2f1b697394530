#include "tassilo/vision/options.h"

#include <algorithm>
#include <cmath>

#include "tassilo/base/error.h"
#include "tassilo/files/nearest_name.h"
#include "tassilo/vision/stages.h"

namespace tassilo {
namespace {

struct Option {
  std::string_view stage, key, unit;
  double low, high;
  std::string_view meaning;
  double& (*real)(VisionOptions&);  ///< Exactly one of these two is set.
  int& (*whole)(VisionOptions&);
};

constexpr Option real(std::string_view stage, std::string_view key, std::string_view unit, double low, double high,
                      std::string_view meaning, double& (*at)(VisionOptions&)) {
  return {stage, key, unit, low, high, meaning, at, nullptr};
}
constexpr Option whole(std::string_view stage, std::string_view key, std::string_view unit, double low, double high,
                       std::string_view meaning, int& (*at)(VisionOptions&)) {
  return {stage, key, unit, low, high, meaning, nullptr, at};
}

using V = VisionOptions;

constexpr Option kOptions[] = {
    real("camera", "mount_angle_sigma", "rad", 0, 0.5,
         "how well the camera's roll, pitch and yaw are known while driving",
         [](V& o) -> double& { return o.mount_angle_sigma; }),
    real("camera", "mount_height_sigma", "m", 0, 1, "how well the camera's height is known",
         [](V& o) -> double& { return o.mount_height_sigma; }),
    real("surface", "line_slant", "1", 1, 4, "a field line counts up to so many times its width along a row or column",
         [](V& o) -> double& { return o.surface.slant; }),
    whole("surface", "line_blur", "px", 0, 20, "rim between line and carpet that is neither color",
          [](V& o) -> int& { return o.surface.blur_px; }),
    whole("balls", "ball_min_area", "px^2", 1, 10000, "smaller segments of the ball's color are noise",
          [](V& o) -> int& { return o.ball.min_area_px; }),
    whole("balls", "ball_max", "1", 1, 100, "ball hypotheses reported", [](V& o) -> int& { return o.ball.max_balls; }),
    real("balls", "ball_min_width", "1", 0, 1, "least width of the segment relative to the projected ball",
         [](V& o) -> double& { return o.ball.min_width; }),
    real("balls", "ball_min_height", "1", 0, 1, "least height of the segment relative to the projected ball",
         [](V& o) -> double& { return o.ball.min_height; }),
    real("balls", "ball_min_cover", "1", 0, 1, "least share of the visible disc that has the ball's color",
         [](V& o) -> double& { return o.ball.min_cover; }),
    real("balls", "ball_edge_sigma", "px", 0.01, 10, "uncertainty of one point of the ball's outline",
         [](V& o) -> double& { return o.ball.edge_sigma_px; }),
    real("balls", "ball_common_sigma", "px", 0.01, 10, "uncertainty that all points of the outline share",
         [](V& o) -> double& { return o.ball.common_sigma_px; }),
    real("balls", "ball_bound_sigmas", "1", 0.1, 10, "standard deviations between a ball and its near and far bound",
         [](V& o) -> double& { return o.ball.bound_sigmas; }),
    real("balls", "ball_max_nod", "deg", 0, 10, "pitch of a nodding robot that may excuse a ball's size; 0: never",
         [](V& o) -> double& { return o.ball.max_nod_deg; }),
    real("balls", "ball_nod_step", "deg", 0.05, 10, "step in which nodding is tried, and its uncertainty",
         [](V& o) -> double& { return o.ball.nod_step_deg; }),
    whole("goals", "goal_min_area", "px^2", 1, 10000, "smaller segments of a goal's color are noise",
          [](V& o) -> int& { return o.goal.min_area_px; }),
    real("goals", "goal_min_foot_share", "1", 0, 1, "least share of a goal's columns below which the floor shows",
         [](V& o) -> double& { return o.goal.min_foot_share; }),
    real("goals", "goal_edge_sigma", "px", 0.01, 10, "uncertainty of a post's column",
         [](V& o) -> double& { return o.goal.edge_sigma_px; }),
    real("goals", "goal_foot_sigma", "px", 0.01, 10, "uncertainty of a post's foot",
         [](V& o) -> double& { return o.goal.foot_sigma_px; }),
    whole("robots", "robot_min_columns", "px", 1, 1000, "narrower robots are noise",
          [](V& o) -> int& { return o.robot.min_columns; }),
    whole("robots", "robot_min_rows", "px", 1, 1000, "lower robots are noise",
          [](V& o) -> int& { return o.robot.min_rows; }),
    whole("robots", "robot_gap", "px", 0, 100, "rim between two colors of a robot that is neither",
          [](V& o) -> int& { return o.robot.gap_px; }),
    real("robots", "robot_max_step", "m", 0.01, 10, "a foot that jumps further begins another robot",
         [](V& o) -> double& { return o.robot.max_step; }),
    real("robots", "robot_foot_sigma", "px", 0.01, 10, "uncertainty of a robot's foot",
         [](V& o) -> double& { return o.robot.foot_sigma_px; }),
    real("robots", "robot_bound_sigmas", "1", 0.1, 10, "standard deviations between a robot and its near and far bound",
         [](V& o) -> double& { return o.robot.bound_sigmas; }),
    real("lines", "line_tolerance", "px", 0.1, 20, "a point so far from a line still lies on it",
         [](V& o) -> double& { return o.line.tolerance_px; }),
    whole("lines", "line_min_points", "1", 3, 1000, "rows or columns that show a line",
          [](V& o) -> int& { return o.line.min_points; }),
    real("lines", "line_min_length", "m", 0.01, 10, "shorter lines are dropped",
         [](V& o) -> double& { return o.line.min_length; }),
    real("lines", "line_max_gap", "m", 0.01, 10, "longer gaps end a line",
         [](V& o) -> double& { return o.line.max_gap; }),
    whole("lines", "line_max", "1", 1, 100, "lines reported of each kind",
          [](V& o) -> int& { return o.line.max_lines; }),
    real("lines", "circle_min_arc", "rad", 0.1, 6.2, "least arc of the centre circle in view",
         [](V& o) -> double& { return o.line.min_arc; }),
    real("free_space", "free_space_sector", "deg", 0.1, 90, "width of a sector of the free motion space",
         [](V& o) -> double& { return o.free_space.sector_deg; }),
    whole("free_space", "free_space_rays", "1", 1, 99, "lines of sight followed per sector",
          [](V& o) -> int& { return o.free_space.rays; }),
    real("free_space", "free_space_max_range", "m", 0.1, 100, "free motion space is not asked for further away",
         [](V& o) -> double& { return o.free_space.max_range; }),
    real("field_boundary", "boundary_reach", "px", 0.1, 100, "how far wall and field are dilated to meet",
         [](V& o) -> double& { return o.boundary.reach_px; }),
    real("field_boundary", "boundary_split", "px", 0.1, 100, "a contour is cut where it leaves its chord by more",
         [](V& o) -> double& { return o.boundary.split_px; }),
    real("field_boundary", "boundary_min_length", "px", 1.01, 10000, "shorter pieces are dropped",
         [](V& o) -> double& { return o.boundary.min_length_px; }),
    real("field_boundary", "boundary_max_inclination", "deg", 1, 90, "steeper pieces are rims of posts and robots",
         [](V& o) -> double& { return o.boundary.max_inclination_deg; }),
    real("field_boundary", "boundary_join_angle", "deg", 0.01, 90, "pieces of one line in the image differ by less",
         [](V& o) -> double& { return o.boundary.join_angle_deg; }),
    real("field_boundary", "boundary_join_offset", "px", 0.01, 1000, "and lie so near each other's line",
         [](V& o) -> double& { return o.boundary.join_offset_px; }),
    real("field_boundary", "boundary_join_gap", "px", 0.01, 10000, "end to end",
         [](V& o) -> double& { return o.boundary.join_gap_px; }),
    real("field_boundary", "boundary_floor_join_angle", "deg", 0.01, 90, "segments of one wall differ by less",
         [](V& o) -> double& { return o.boundary.floor_join_angle_deg; }),
    real("field_boundary", "boundary_floor_join_offset", "m", 0.001, 10, "and lie so near each other's line",
         [](V& o) -> double& { return o.boundary.floor_join_offset; }),
    real("field_boundary", "boundary_floor_join_gap", "m", 0.001, 100, "end to end",
         [](V& o) -> double& { return o.boundary.floor_join_gap; }),
    real("motion", "odometry_distance_sigma", "1", 0, 1, "uncertainty of odometry, of the distance driven",
         [](V& o) -> double& { return o.motion.odometry_distance_sigma; }),
    real("motion", "odometry_turn_sigma", "1", 0, 1, "uncertainty of odometry, of the angle turned",
         [](V& o) -> double& { return o.motion.odometry_turn_sigma; }),
    real("motion", "odometry_drift_sigma", "m, rad", 0.0001, 10,
         "uncertainty of odometry after a second, however little it says",
         [](V& o) -> double& { return o.motion.odometry_drift_sigma; }),
    real("motion", "pose_speed_sigma", "m/s", 0.01, 100, "how fast a robot without odometry may drive",
         [](V& o) -> double& { return o.motion.speed_sigma; }),
    real("motion", "pose_turn_rate_sigma", "rad/s", 0.01, 100, "how fast a robot without odometry may turn",
         [](V& o) -> double& { return o.motion.turn_rate_sigma; }),
    real("localization", "pose_certain", "1", 0.5, 0.9999,
         "share of the belief that one place must have to be the pose",
         [](V& o) -> double& { return o.localize.certain; }),
    whole("localization", "pose_max_hypotheses", "1", 2, 100, "places kept until goals or odometry decide",
          [](V& o) -> int& { return o.localize.max_hypotheses; }),
    real("track", "track_ball_acceleration", "m/s/sqrt(s)", 0.01, 100,
         "change of a rolling ball's velocity within a second",
         [](V& o) -> double& { return o.track.ball_acceleration; }),
    real("track", "track_robot_acceleration", "m/s/sqrt(s)", 0.01, 100, "change of a robot's velocity within a second",
         [](V& o) -> double& { return o.track.robot_acceleration; }),
    real("track", "track_ball_speed", "m/s", 0.01, 100, "how fast a ball just found may be",
         [](V& o) -> double& { return o.track.ball_speed; }),
    real("track", "track_robot_speed", "m/s", 0.01, 100, "how fast a robot just found may be",
         [](V& o) -> double& { return o.track.robot_speed; }),
    real("track", "track_kick_speed", "m/s", 0, 100,
         "change of the ball's velocity by a kick; 0: none is reckoned with",
         [](V& o) -> double& { return o.track.kick_speed; }),
    real("track", "track_ball_common", "1", 0, 1, "share of a ball's distance that all frames have wrong alike",
         [](V& o) -> double& { return o.track.ball_common; }),
    real("track", "track_robot_width", "m", 0.01, 10,
         "width of a robot in full view; of a narrower one something is hidden",
         [](V& o) -> double& { return o.track.robot_width; }),
    real("track", "track_robot_common", "m", 0, 1, "uncertainty of a robot's middle that does not average out",
         [](V& o) -> double& { return o.track.robot_common; }),
    real("track", "track_gate", "1", 0.1, 1000,
         "largest squared Mahalanobis distance of a sighting that belongs to a track",
         [](V& o) -> double& { return o.track.gate; }),
    real("track", "track_sure_ball", "1", 0, 1, "a ball of this confidence is told at once while there is no other",
         [](V& o) -> double& { return o.track.sure_ball; }),
    whole("track", "track_sightings", "1", 1, 100, "other objects are told after so many sightings",
          [](V& o) -> int& { return o.track.sightings; }),
    real("track", "track_max_age", "s", 0.01, 100, "objects are kept so long without being seen",
         [](V& o) -> double& { return o.track.max_age; }),
    real("track", "track_max_sigma", "m", 0.01, 100, "objects are kept while they are at least so certain",
         [](V& o) -> double& { return o.track.max_sigma; }),
    whole("track", "track_clear_misses", "1", 1, 100,
          "frames in a row that show free floor where an object should be, until it is given up",
          [](V& o) -> int& { return o.track.clear_misses; }),
    whole("track", "track_max_tracks", "1", 1, 100, "objects followed at a time",
          [](V& o) -> int& { return o.track.max_tracks; }),
    whole("free_space", "free_space_noise", "px", 0, 100, "so many odd pixels in a row are noise when floor follows",
          [](V& o) -> int& { return o.free_space.noise_px; }),
};

}  // namespace

MountSigma VisionOptions::mount_sigma() const {
  return {.x = 0,
          .y = 0,
          .z = mount_height_sigma,
          .roll = mount_angle_sigma,
          .pitch = mount_angle_sigma,
          .yaw = mount_angle_sigma};
}

void VisionOptions::check() const {
  const auto sigma = [](const char* name, double value) {
    if (!(value >= 0 && std::isfinite(value))) throw Error(name, "is " + std::to_string(value) + ", must be >= 0");
  };
  sigma("mount_angle_sigma", mount_angle_sigma);
  sigma("mount_height_sigma", mount_height_sigma);
  surface.check();
  ball.check();
  goal.check();
  robot.check();
  line.check();
  free_space.check();
  boundary.check();
  motion.check();
  localize.check();
  track.check();
}

std::vector<OptionInfo> vision_option_infos() {
  VisionOptions standard;
  std::vector<OptionInfo> infos;
  for (const Option& option : kOptions)
    infos.push_back({std::string(option.key), std::string(option.unit), option.low, option.high,
                     option.whole != nullptr, std::string(option.meaning),
                     option.whole != nullptr ? option.whole(standard) : option.real(standard),
                     std::string(option.stage)});
  return infos;
}

std::map<std::string, double, std::less<>> option_values(VisionOptions options) {
  std::map<std::string, double, std::less<>> values = options.own;
  for (const Option& option : kOptions)
    values[std::string(option.key)] = option.whole != nullptr ? option.whole(options) : option.real(options);
  return values;
}

VisionOptions vision_options(std::span<const std::pair<std::string, Setting>> settings) {
  return vision_options(settings, built_in_stages());
}

VisionOptions vision_options(std::span<const std::pair<std::string, Setting>> settings, const StageRegistry& registry) {
  VisionOptions options;
  // What shared libraries brought along, and which names a stage has.
  std::vector<OptionInfo> own;
  std::vector<std::pair<std::string_view, std::vector<std::string_view>>> stages;
  registry.for_each([&](const auto& stage) {
    stages.emplace_back(stage.key, std::vector<std::string_view>{});
    for (const auto& alternative : stage.alternatives) {
      stages.back().second.push_back(alternative.name);
      own.insert(own.end(), alternative.options.begin(), alternative.options.end());
    }
  });
  for (const OptionInfo& info : own) options.own[info.key] = info.standard;

  const auto number_of = [](const Setting& setting, double low, double high, bool whole) {
    if (!whole) return setting.number(low, high);
    return static_cast<double>(setting.integer(static_cast<std::int64_t>(low), static_cast<std::int64_t>(high)));
  };
  for (const auto& [key, setting] : settings) {
    const std::string_view name = key;
    if (const auto* option = std::ranges::find(kOptions, name, &Option::key); option != std::end(kOptions)) {
      const double value = number_of(setting, option->low, option->high, option->whole != nullptr);
      if (option->whole != nullptr)
        option->whole(options) = static_cast<int>(value);
      else
        option->real(options) = value;
    } else if (const auto stage = std::ranges::find(stages, name, [](const auto& one) { return one.first; });
               stage != stages.end()) {
      options.stages[key] = stage->second[setting.choice(stage->second)];
    } else if (const auto info = std::ranges::find(own, name, &OptionInfo::key); info != own.end()) {
      options.own[key] = number_of(setting, info->low, info->high, info->whole);
    } else {
      std::vector<std::string_view> keys;
      for (const Option& known : kOptions) keys.push_back(known.key);
      for (const auto& known : stages) keys.push_back(known.first);
      for (const OptionInfo& known : own) keys.push_back(known.key);
      const auto meant = nearest_name(name, keys);
      throw Error(setting.place, "unknown key 'vision." + key + "'" +
                                     (meant ? ", did you mean '" + std::string(*meant) + "'"
                                            : ", `tassilo info --options` lists the known ones"));
    }
  }
  options.check();
  return options;
}

}  // namespace tassilo
