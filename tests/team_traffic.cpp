// Robots that only talk: for tests of those who listen. Each drives an ellipse on an msl98 field, sees a ball that all
// see, an opponent and free floor, and says so at its rate, with a picture for whoever listens.
//
// usage: team_traffic --domain D --robots 1,2,3 [--rate 30] [--seconds S] [--clock-ahead S] [--garbage]
//   --garbage  what is sent is spoiled: bytes changed, cut short, values out of range

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "tassilo/app/unix_clock.h"
#include "tassilo/base/error.h"
#include "tassilo/files/jpeg.h"
#include "tassilo/message/from_scene.h"
#include "tassilo/team/robot_voice.h"

namespace tassilo {
namespace {

struct Arguments {
  int domain = 0;
  std::vector<int> robots;
  double rate = 30, seconds = 1e9, clock_ahead = 0;
  bool is_garbage = false;
};

Arguments arguments_from(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--garbage") {
      arguments.is_garbage = true;
      continue;
    }
    if (i + 1 >= argc) throw Error(option, "needs a value");
    const std::string value = argv[++i];
    if (option == "--domain")
      arguments.domain = std::stoi(value);
    else if (option == "--rate")
      arguments.rate = std::stod(value);
    else if (option == "--seconds")
      arguments.seconds = std::stod(value);
    else if (option == "--clock-ahead")
      arguments.clock_ahead = std::stod(value);
    else if (option == "--robots") {
      for (std::size_t at = 0; at < value.size();) {
        const std::size_t comma = std::min(value.find(',', at), value.size());
        arguments.robots.push_back(std::stoi(value.substr(at, comma - at)));
        at = comma + 1;
      }
    } else
      throw Error(option, "is no option");
  }
  return arguments;
}

struct Placed {
  double x = 0, y = 0, theta = 0;
};

/// From field to robot.
FloorPoint in_robot(const Placed& robot, FieldPoint point) {
  const double dx = point.x - robot.x, dy = point.y - robot.y;
  const double c = std::cos(robot.theta), s = std::sin(robot.theta);
  return {c * dx + s * dy, -s * dx + c * dy};
}

Placed place_of(int robot, double t) {
  const double phase = 0.4 * t + robot * 2 * std::numbers::pi / 10;
  return {3 * std::cos(phase), 1.6 * std::sin(phase), std::atan2(1.6 * std::cos(phase), -3 * std::sin(phase))};
}

Scene scene_of(int robot, double t, std::mt19937& random) {
  std::normal_distribution<double> noise(0, 0.03);
  const Placed place = place_of(robot, t);
  const FieldPoint ball{1.5 * std::cos(0.3 * t), 0.8 * std::sin(0.5 * t)};
  Scene scene;
  scene.t = t;
  PoseSeen pose;
  pose.x = place.x + noise(random);
  pose.y = place.y + noise(random);
  pose.theta = place.theta;
  pose.covariance = {.01, .004, 0, .004, .005, 0, 0, 0, .002};
  pose.kind = robot % 3 == 0 ? PoseKind::one_line : PoseKind::two_lines;
  pose.age = robot % 3 == 0 ? 0.4 : 0;
  scene.pose = pose;
  Ball seen;
  seen.confidence = 0.8;
  seen.floor.emplace();
  seen.floor->position.mean = in_robot(place, ball) + FloorPoint{noise(random), noise(random)};
  seen.floor->position.covariance << .02, 0, 0, .01;
  scene.balls.push_back(seen);
  RobotSeen other;
  other.team = Team::magenta;
  other.floor.emplace();
  other.floor->center = in_robot(place, {-1, 0.5});
  other.floor->nearest.mean = other.floor->center;
  other.floor->nearest.covariance << .01, 0, 0, .01;
  other.floor->width = 0.4;
  scene.robots.push_back(other);
  TrackSeen track;
  track.id = 1;
  track.x = seen.floor->position.mean.x;
  track.y = seen.floor->position.mean.y;
  track.vx = 0.3;
  for (std::size_t i = 0; i < 4; ++i) track.covariance[5 * i] = 0.01;
  scene.tracks.push_back(track);
  FreeSpace space;
  space.angle_min = -0.9;
  space.angle_increment = 0.03;
  for (int i = 0; i <= 60; ++i) {
    space.ranges.push_back(1.5 + 0.8 * std::sin(i * 0.2 + t));
    space.states.push_back(i % 20 == 0 ? SectorState::unseen : i % 3 == 0 ? SectorState::free : SectorState::blocked);
  }
  scene.free_space = space;
  return scene;
}

std::string picture_of(int robot, double t) {
  constexpr int width = 192, height = 86;
  std::vector<std::uint8_t> rgb;
  for (int r = 0; r < height; ++r)
    for (int c = 0; c < width; ++c) {
      const int ball = static_cast<int>(96 + 80 * std::sin(t));
      const bool is_ball = std::hypot(c - ball, r - 50) < 10;
      rgb.insert(rgb.end(), {static_cast<std::uint8_t>(is_ball ? 230 : 20 * robot),
                             static_cast<std::uint8_t>(is_ball  ? 90
                                                       : r > 30 ? 120
                                                                : 200),
                             static_cast<std::uint8_t>(40)});
    }
  return encode_jpeg(rgb, width, height, 80);
}

void spoil(std::vector<std::byte>& data, std::mt19937& random) {
  switch (random() % 3) {
    case 0:
      data.resize(4 + random() % (data.size() - 3));
      break;
    case 1:
      for (std::byte& byte : data)
        if (random() % 4 == 0) byte = static_cast<std::byte>(random());
      break;
    default:  // all is there, but what no place, no variance and no number can be
      for (std::size_t at = 8 + 4 * (random() % 4); at + 8 <= data.size(); at += 8)
        std::fill_n(data.begin() + static_cast<std::ptrdiff_t>(at), 8, std::byte{0xff});
  }
}

/// One robot, with a bus of its own.
class Talker {
 public:
  Talker(const Arguments& arguments, int robot)
      : arguments_(arguments), robot_(robot), bus_(options(arguments)), random_(static_cast<unsigned>(robot)) {
    BudgetOptions budget;
    budget.bytes_per_second = 1e6;
    voice_.emplace(bus_, robot, budget, BusReliability::best_effort);
  }

  void talk(double now) {
    const double t = now + arguments_.clock_ahead;
    const ros::Time stamp = ros_time(t);
    const MessageContext context{.robot = robot_, .team = Team::cyan};
    const Scene scene = scene_of(robot_, now, random_);
    std::vector<Spoken> messages;
    const auto add = [&](const Topic& topic, const auto& message) { messages.push_back({&topic, encoded(message)}); };
    add(kPoseTopic, pose_message(*scene.pose, stamp));
    add(kBallsTopic, balls_message(scene, stamp, context));
    add(kRobotsTopic, robots_message(scene, stamp, context));
    add(kTracksTopic, tracks_message(scene, stamp, context));
    add(kFreeSpaceTopic, free_space_message(*scene.free_space, stamp, context));
    add(kScanTopic, scan_message(*scene.free_space, stamp, context));
    msgs::TeamState state = team_state_message(scene, stamp, context);
    state.role = robot_ == 1 ? "goalkeeper" : robot_ < 5 ? "defender" : "striker";
    state.action = robot_ == 1 ? "guard" : "go to ball";
    state.planning_state = "step " + std::to_string(static_cast<int>(now) % 5);
    state.frames = ++frames_;
    state.frame_rate = arguments_.rate;
    state.latency = 0.021;
    if (arguments_.is_garbage) {
      for (Spoken& message : messages) spoil(message.data, random_);
      state.frame_rate = std::numeric_limits<double>::quiet_NaN();
    }
    voice_->say(messages, state, now);
    if (voice_->is_picture_wanted(now)) {
      const std::string jpeg = picture_of(robot_, now);
      voice_->show({{stamp, "camera"}, "jpeg", {jpeg.begin(), jpeg.end()}}, now);
    }
  }

 private:
  static BusOptions options(const Arguments& arguments) {
    BusOptions options;
    options.domain = arguments.domain;
    return options;
  }
  const Arguments& arguments_;
  int robot_;
  Bus bus_;
  std::optional<RobotVoice> voice_;
  std::mt19937 random_;
  std::uint64_t frames_ = 0;
};

void talk(const Arguments& arguments) {
  std::vector<std::unique_ptr<Talker>> talkers;
  for (const int robot : arguments.robots) talkers.push_back(std::make_unique<Talker>(arguments, robot));
  using Clock = std::chrono::steady_clock;
  const auto step = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / arguments.rate));
  const auto begin = Clock::now();
  auto next = begin;
  while (std::chrono::duration<double>(Clock::now() - begin).count() < arguments.seconds) {
    for (const auto& talker : talkers) talker->talk(unix_now());
    next += step;
    std::this_thread::sleep_until(next);
  }
}

}  // namespace
}  // namespace tassilo

int main(int argc, char** argv) {
  try {
    tassilo::talk(tassilo::arguments_from(argc, argv));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "team_traffic: %s\n", error.what());
    return 1;
  }
}
