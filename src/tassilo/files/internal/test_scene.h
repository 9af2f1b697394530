#pragma once

#include <limits>
#include <random>
#include <string>

#include "tassilo/scene/scene.h"

namespace tassilo {

/// A scene with something in every corner of the format; what is missing and what is there changes with the seed. Tests
/// only.
inline Scene random_scene(unsigned seed) {
  std::mt19937 random(seed);
  const auto number = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  const auto count = [&](int max) { return std::uniform_int_distribution(0, max)(random); };
  const auto coin = [&] { return count(1) == 1; };
  const auto box = [&] { return PixelBox{count(100), count(100), 100 + count(100), 100 + count(100)}; };
  const auto pixel = [&] { return PixelPoint{number(-10, 700), number(-10, 500)}; };
  const auto floor = [&] { return FloorPoint{number(-5, 5), number(-5, 5)}; };
  const auto gaussian = [&] {
    Gaussian2<RobotFrame> g{floor(), {}};
    const double xy = number(-1e-5, 1e-5);
    g.covariance << number(1e-4, 1), xy, xy, number(1e-7, 1e-3);
    return g;
  };
  const auto bounds = [&] {
    return DistanceBounds{number(0, 1), coin() ? number(1, 3) : std::numeric_limits<double>::infinity()};
  };
  const bool calibrated = seed % 3 != 0;

  Scene scene;
  scene.frame = count(1000);
  scene.t = seed % 2 ? 1.7e9 + number(0, 1000) : number(0, 100);
  if (coin()) scene.image = "image \"" + std::to_string(seed) + "\"\\.png";
  if (coin()) {
    constexpr PoseKind kinds[] = {PoseKind::two_lines, PoseKind::one_line, PoseKind::predicted,
                                  PoseKind::goal,      PoseKind::model,    PoseKind::start};
    scene.pose = PoseSeen{number(-4, 4), number(-2, 2), number(-3, 3), {}, kinds[count(5)], number(0, 2), coin()};
    for (double& value : scene.pose->covariance) value = number(-1e-3, 1e-3);
  }
  for (int i = count(3); i > 0; --i) {
    Ball ball{box(), pixel(), number(1, 50), number(0, 1), {}};
    if (calibrated) ball.floor = BallOnFloor{gaussian(), bounds()};
    scene.balls.push_back(ball);
  }
  for (int i = count(2); i > 0; --i) {
    Goal goal{coin() ? GoalColor::yellow : GoalColor::blue, box(), {}, {}, {}};
    if (calibrated) {
      goal.bearing = number(-1, 1);
      if (coin()) goal.position = floor();
      if (coin()) goal.posts.push_back({PostSide::left, floor()});
      if (coin()) goal.posts.push_back({PostSide::right, floor()});
    }
    scene.goals.push_back(goal);
  }
  for (int i = count(3); i > 0; --i) {
    constexpr Team teams[] = {Team::unknown, Team::cyan, Team::magenta};
    RobotSeen robot{teams[count(2)], box(), {}};
    if (calibrated) robot.floor = RobotOnFloor{gaussian(), bounds(), floor(), number(0.2, 0.6)};
    scene.robots.push_back(robot);
  }
  for (int i = count(3); i > 0; --i) {
    LineSeen line{coin() ? LineKind::line : LineKind::boundary, pixel(), pixel(), {}, coin() ? "x_plus" : ""};
    if (calibrated) line.floor = {floor(), floor()};
    scene.lines.push_back(line);
  }
  if (calibrated) {
    if (coin()) scene.circles.push_back({floor(), number(0.5, 1.5)});
    FreeSpace space{floor(), number(-1, 0), 0.17453292519943295, {}, {}};
    constexpr SectorState states[] = {SectorState::unseen, SectorState::free, SectorState::blocked};
    for (int i = count(8); i > 0; --i) {
      space.states.push_back(states[count(2)]);
      space.ranges.push_back(space.states.back() == SectorState::unseen ? 0 : number(0, 4));
    }
    scene.free_space = space;
  }
  for (int i = calibrated ? count(3) : 0; i > 0; --i) {
    constexpr Team teams[] = {Team::unknown, Team::cyan, Team::magenta};
    const bool ball = coin();
    TrackSeen track{1 + count(1000),
                    ball ? TrackKind::ball : TrackKind::robot,
                    ball ? Team::unknown : teams[count(2)],
                    number(-5, 5),
                    number(-5, 5),
                    number(-3, 3),
                    number(-3, 3),
                    {},
                    coin() ? 0 : number(0, 1)};
    for (double& value : track.covariance) value = number(-1e-3, 1e-3);
    scene.tracks.push_back(track);
  }
  if (coin()) scene.why = {{"pose", "no line: too dark"}, {"balls", "1 refused, above the wall"}};
  if (coin()) scene.timing = {{"decode", number(0, 2)}, {"segment", number(0, 2)}};
  scene.timing.push_back({"total", number(0, 8)});
  return scene;
}

}  // namespace tassilo
