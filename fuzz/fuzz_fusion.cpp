// Whatever robots send, what the team is told are numbers, and the order of arrival makes no difference.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "bytes.h"
#include "tassilo/base/contract.h"
#include "tassilo/fusion/team_fusion.h"

namespace {

using namespace tassilo;

/// A number of a usual size, or any at all.
double number(Bytes& bytes) {
  const std::uint8_t kind = bytes.next();
  if (kind < 250) return (kind - 125) / 25.0;
  std::uint64_t bits = 0;
  for (int i = 0; i < 8; ++i) bits = bits << 8 | bytes.next();
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}
double variance(Bytes& bytes) { return bytes.next() < 240 ? bytes.next() / 2550.0 : number(bytes); }

TeamObservation observation(Bytes& bytes) {
  TeamObservation one;
  one.robot = bytes.below(10);
  one.stamp = bytes.next();
  one.t = bytes.next() < 240 ? 9.1 + bytes.next() / 300.0 : number(bytes);
  PoseSeen pose;
  pose.x = number(bytes);
  pose.y = number(bytes);
  pose.theta = number(bytes);
  for (const std::size_t i : {0u, 4u, 8u}) pose.covariance[i] = variance(bytes);
  if (bytes.below(4) == 0) pose.covariance[static_cast<std::size_t>(bytes.below(9))] = number(bytes);
  one.pose = pose;
  for (int count = bytes.below(4); count > 0; --count) {
    Ball ball;
    ball.confidence = number(bytes);
    ball.floor = BallOnFloor{{{number(bytes), number(bytes)}, Eigen::Matrix2d::Zero()}, {}};
    for (double& value : ball.floor->position.covariance.reshaped()) value = variance(bytes);
    one.balls.push_back(ball);
  }
  for (int count = bytes.below(4); count > 0; --count) {
    RobotSeen robot;
    robot.team = static_cast<Team>(bytes.below(3));
    robot.floor = RobotOnFloor{{{}, Eigen::Matrix2d::Zero()}, {}, {number(bytes), number(bytes)}, variance(bytes)};
    for (double& value : robot.floor->nearest.covariance.reshaped()) value = variance(bytes);
    one.robots.push_back(robot);
  }
  return one;
}

void check(const TeamThing& a, const TeamThing& b) {
  expects(a.covariance.allFinite() && std::isfinite(a.position.mean.x) && std::isfinite(a.position.mean.y) &&
              std::isfinite(a.vx) && std::isfinite(a.vy) && a.covariance.diagonal().minCoeff() >= 0,
          "what is told are numbers");
  expects(a.id == b.id && a.position.mean == b.position.mean && a.vx == b.vx && a.vy == b.vy &&
              a.covariance == b.covariance && a.age == b.age && a.robots == b.robots,
          "in whatever order it came");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 1 << 13) return 0;
  Bytes bytes(data, size);
  std::vector<TeamObservation> all;
  while (!bytes.empty()) all.push_back(observation(bytes));
  constexpr double now = 10;
  TeamFusion forth, back;
  std::vector<const TeamObservation*> taken;  // of two for one image the first counts
  for (const TeamObservation& one : all) {
    if (forth.add(one, now) == Contribution::taken) taken.push_back(&one);
    if (one.stamp % 4 == 0) forth.at(one.t);
  }
  for (auto one = taken.rbegin(); one != taken.rend(); ++one) {
    expects(back.add(**one, now) == Contribution::taken, "taken once, taken again");
    if ((*one)->stamp % 5 == 0) back.at(now);
  }
  for (const double t : {9.5, now, now + 0.5}) {
    const TeamWorld a = forth.at(t), b = back.at(t);
    expects(a.ball.has_value() == b.ball.has_value() && a.other_balls.size() == b.other_balls.size() &&
                a.opponents.size() == b.opponents.size(),
            "the same things");
    if (a.ball) check(*a.ball, *b.ball);
    for (std::size_t i = 0; i < a.other_balls.size(); ++i) check(a.other_balls[i], b.other_balls[i]);
    for (std::size_t i = 0; i < a.opponents.size(); ++i) check(a.opponents[i], b.opponents[i]);
  }
  return 0;
}
