#include "tassilo/fusion/test_match.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tassilo/base/contract.h"
#include "tassilo/fusion/field_sighting.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/geometry/pose2.h"

namespace tassilo::test {
namespace {

constexpr int kRobots = 4, kOpponents = 4;
constexpr double kHalfLength = 4.5, kHalfWidth = 3;  // [m]
constexpr double kStep = 0.005;                      // [s]
constexpr double kBodyRadius = 0.2;                  // [m]
constexpr double kRange = 5;                         // [m]
const double kHalfView = radians(45);

struct Body {
  FieldPoint at, goal;
  double theta = 0;
  double until = 0;  ///< When it thinks of something else.
  bool chases = false;
};
/// How wrong a robot's pose is, in standard deviations, and a false ball that it sees for a while.
struct Mind {
  double x = 0, y = 0, theta = 0, quality = 1;
  int false_images = 0;
  FieldPoint false_ball;
};

class World {
 public:
  explicit World(const MatchOptions& options) : options_(options), random_(options.seed * 7919 + 1) {
    for (int i = 0; i < kRobots + kOpponents; ++i) {
      Body body;
      body.at = body.goal = somewhere();
      body.theta = uniform(-std::numbers::pi, std::numbers::pi);
      bodies_.push_back(body);
    }
    for (int i = 0; i < kRobots; ++i) minds_.push_back({normal(), normal(), normal(), uniform(0.7, 1.3), 0, {}});
    opponent_seen_.assign(kOpponents, -1e9);
  }

  Match play() {
    Match match;
    const int steps = static_cast<int>(options_.duration / kStep);
    const int per_moment = static_cast<int>(std::lround(0.1 / kStep));
    std::vector<double> next_image;
    for (int i = 0; i < kRobots; ++i) next_image.push_back(uniform(0, 1 / options_.rate));
    for (int k = 0; k < steps; ++k) {
      t_ = k * kStep;
      move();
      for (int i = 0; i < kRobots; ++i)
        if (t_ >= next_image[index(i)]) {
          next_image[index(i)] += 1 / options_.rate;
          match.observations.push_back(image_of(i));
        }
      for (int i = 0; i < kRobots; ++i)
        for (int j = 0; j < kOpponents; ++j)
          if (sees(i, bodies_[index(kRobots + j)].at, kRobots + j)) opponent_seen_[index(j)] = t_;
      if (k % per_moment == 0) match.moments.push_back(moment());
    }
    return match;
  }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  double normal() { return std::normal_distribution<double>()(random_); }
  FieldPoint somewhere() { return {uniform(-kHalfLength, kHalfLength), uniform(-kHalfWidth, kHalfWidth)}; }

  void move() {
    move_ball();
    for (int i = 0; i < kRobots + kOpponents; ++i) move_body(bodies_[index(i)]);
    const double kept = std::exp(-kStep / options_.pose_memory), fresh = std::sqrt(1 - kept * kept);
    for (Mind& mind : minds_)
      for (double* error : {&mind.x, &mind.y, &mind.theta}) *error = kept * *error + fresh * normal();
  }

  void move_ball() {
    const double speed = std::hypot(vx_, vy_);
    const double left = speed > 0 ? std::max(1 - 0.35 * kStep / speed, 0.) : 0;
    vx_ *= left;
    vy_ *= left;
    if (uniform(0, 1) < options_.kick_rate * kStep) {
      const double kick = uniform(0.5, 4), angle = uniform(-std::numbers::pi, std::numbers::pi);
      vx_ = kick * std::cos(angle);
      vy_ = kick * std::sin(angle);
    }
    ball_ = ball_ + FieldPoint{vx_ * kStep, vy_ * kStep};
    if (std::abs(ball_.x) > kHalfLength) vx_ = -0.6 * std::copysign(vx_, ball_.x);
    if (std::abs(ball_.y) > kHalfWidth) vy_ = -0.6 * std::copysign(vy_, ball_.y);
  }

  void move_body(Body& body) {
    if (t_ >= body.until) {
      body.until = t_ + uniform(2, 5);
      body.goal = somewhere();
      body.chases = uniform(0, 1) < 0.5;
    }
    const FieldPoint way = body.goal - body.at;
    const double far = norm(way);
    const bool is_free = std::ranges::none_of(bodies_, [&](const Body& other) {
      return &other != &body && distance(other.at, body.at + 0.1 / std::max(far, 0.1) * way) < 2 * kBodyRadius &&
             distance(other.at, body.at) > distance(other.at, body.at + 0.1 / std::max(far, 0.1) * way);
    });
    if (far > 0.1 && is_free) body.at = body.at + 0.9 * kStep / far * way;
    const double turn = body.chases ? wrap_angle(bearing(ball_ - body.at) - body.theta) : 0.6 * kStep;
    body.theta = wrap_angle(body.theta + std::clamp(turn, -2.5 * kStep, 2.5 * kStep));
  }

  /// Is the place in view of a robot, and no body but `self` before it?
  bool sees(int robot, FieldPoint place, int self) const {
    const Body& body = bodies_[index(robot)];
    const double far = distance(place, body.at);
    if (far > kRange || far < 0.15 || std::abs(wrap_angle(bearing(place - body.at) - body.theta)) > kHalfView)
      return false;
    for (int i = 0; i < kRobots + kOpponents; ++i) {
      if (i == robot || i == self) continue;
      const FieldPoint other = bodies_[index(i)].at - body.at;
      const double along = dot(other, place - body.at) / far, beside = cross(place - body.at, other) / far;
      if (along > 0 && along < far && std::abs(beside) < kBodyRadius) return false;
    }
    return true;
  }

  Gaussian2<RobotFrame> seen_from(int robot, FieldPoint place, double base, double share, double angle) {
    const Body& body = bodies_[index(robot)];
    const FloorPoint p = inverse(make_pose2<FieldFrame, RobotFrame>(body.at.x, body.at.y, body.theta)) * place;
    const double far = norm(p), along = base + share * far, across = std::hypot(base / 2, angle * far);
    const double c = p.x / far, s = p.y / far, a = along * normal(), b = across * normal();
    Gaussian2<RobotFrame> seen{{p.x + c * a - s * b, p.y + s * a + c * b}, Eigen::Matrix2d::Zero()};
    Eigen::Matrix2d turn;
    turn << c, -s, s, c;
    seen.covariance = turn * Eigen::Vector2d(along * along, across * across).asDiagonal() * turn.transpose();
    return seen;
  }
  Ball ball_seen(int robot, FieldPoint place, double confidence) {
    Ball ball;
    ball.confidence = confidence;
    ball.floor = BallOnFloor{seen_from(robot, place, 0.01, 0.01, radians(0.3)), {}};
    return ball;
  }

  TeamObservation image_of(int robot) {
    const Body& body = bodies_[index(robot)];
    Mind& mind = minds_[index(robot)];
    TeamObservation image;
    image.robot = robot;
    image.t = t_;
    image.stamp = std::llround(t_ * 1e9) + robot * 1'000'000'000'000;
    PoseSeen pose;
    const double sigma = options_.pose_sigma * mind.quality, turn = options_.heading_sigma * mind.quality;
    pose.x = body.at.x + sigma * mind.x;
    pose.y = body.at.y + sigma * mind.y;
    pose.theta = wrap_angle(body.theta + turn * mind.theta);
    const double claimed = options_.claimed * options_.claimed;
    pose.covariance[0] = pose.covariance[4] = claimed * sigma * sigma;
    pose.covariance[8] = claimed * turn * turn;
    pose.kind = PoseKind::model;
    image.pose = pose;

    if (sees(robot, ball_, -1) && uniform(0, 1) < options_.detection)
      image.balls.push_back(ball_seen(robot, ball_, uniform(0.6, 0.95)));
    if (mind.false_images == 0 && uniform(0, 1) < options_.false_balls) {
      mind.false_images = static_cast<int>(uniform(1, 7));
      const double far = uniform(1, kRange), angle = body.theta + uniform(-kHalfView, kHalfView);
      mind.false_ball = body.at + FieldPoint{far * std::cos(angle), far * std::sin(angle)};
    }
    if (mind.false_images > 0) {
      --mind.false_images;
      image.balls.push_back(ball_seen(robot, mind.false_ball, uniform(0.2, 0.7)));
    }
    for (int i = 0; i < kRobots + kOpponents; ++i) {
      const FieldPoint at = bodies_[index(i)].at;
      if (i == robot || !sees(robot, at, i) || uniform(0, 1) > 0.85) continue;
      RobotSeen seen;
      const double luck = uniform(0, 1);
      const bool is_mate = i < kRobots;
      seen.team = luck < 0.13 ? Team::unknown : (luck < 0.15) == is_mate ? Team::magenta : Team::cyan;
      const Gaussian2<RobotFrame> middle = seen_from(robot, at, 0.03, 0.015, radians(0.5));
      seen.floor = RobotOnFloor{middle, {}, middle.mean, 0.45};
      image.robots.push_back(seen);
    }
    return image;
  }

  Moment moment() const {
    Moment now{t_, ball_, vx_, vy_, {}, {}, opponent_seen_};
    for (int i = 0; i < kOpponents; ++i) now.opponents.push_back(bodies_[index(kRobots + i)].at);
    for (int i = 0; i < kRobots; ++i) now.sees_ball.push_back(sees(i, ball_, -1));
    return now;
  }

  MatchOptions options_;
  std::mt19937 random_;
  double t_ = 0;
  FieldPoint ball_;
  double vx_ = 0, vy_ = 0;
  std::vector<Body> bodies_;  ///< Robots first.
  std::vector<Mind> minds_;
  std::vector<double> opponent_seen_;
};

double squared_error(const Gaussian2<FieldFrame>& told, FieldPoint truth) {
  const Eigen::Vector2d off(told.mean.x - truth.x, told.mean.y - truth.y);
  return off.dot(told.covariance.inverse() * off);
}

Answer empty_answer(const Moment& moment, int who) {
  Answer answer;
  answer.t = moment.t;
  answer.visible = std::ranges::any_of(moment.sees_ball, [](char sees) { return sees != 0; });
  answer.own_sight = who >= 0 && moment.sees_ball[static_cast<std::size_t>(who)];
  return answer;
}

void take_ball(Answer& answer, const Gaussian2<FieldFrame>& told, const Moment& moment) {
  answer.has_ball = true;
  answer.error = distance(told.mean, moment.ball);
  answer.squared = squared_error(told, moment.ball);
  answer.sigma = std::sqrt(told.covariance.trace());
}

void take_opponents(Answer& answer, const TeamWorld& world, const Moment& moment) {
  constexpr double reach = 0.6;
  std::vector<char> is_used(world.opponents.size(), 0);
  for (std::size_t i = 0; i < moment.opponents.size(); ++i) {
    std::size_t nearest = world.opponents.size();
    double least = reach;
    for (std::size_t k = 0; k < world.opponents.size(); ++k) {
      const double far = distance(world.opponents[k].position.mean, moment.opponents[i]);
      if (!is_used[k] && far < least) least = far, nearest = k;
    }
    const bool is_known = nearest < world.opponents.size();
    if (is_known) is_used[nearest] = 1;
    if (moment.t - moment.opponent_seen[i] > 1) continue;
    answer.opponents += 1;
    answer.missed += !is_known;
    if (!is_known) continue;
    answer.opponent_errors.push_back(least);
    answer.opponent_squared.push_back(squared_error(world.opponents[nearest].position, moment.opponents[i]));
  }
  answer.ghosts = static_cast<int>(std::ranges::count(is_used, 0));
}

struct Mail {
  double arrival = 0;
  const TeamObservation* observation = nullptr;
};

std::vector<Answer> answers(const Match& match, std::vector<Mail> mails, int who, TeamFusionOptions options) {
  options.own_team = Team::cyan;
  std::ranges::stable_sort(mails, {}, &Mail::arrival);
  TeamFusion fusion(options);
  std::vector<Answer> all;
  auto next = mails.begin();
  for (const Moment& moment : match.moments) {
    for (; next != mails.end() && next->arrival <= moment.t; ++next) fusion.add(*next->observation, next->arrival);
    if (moment.t < 2) continue;
    Answer answer = empty_answer(moment, who);
    const TeamWorld world = fusion.at(moment.t);
    if (world.ball) {
      take_ball(answer, world.ball->position, moment);
      answer.age = world.ball->age;
    }
    take_opponents(answer, world, moment);
    all.push_back(answer);
  }
  return all;
}

}  // namespace

Match play(const MatchOptions& options) { return World(options).play(); }

std::vector<Answer> answers_of_team(const Match& match, const Radio& radio, int who, TeamFusionOptions options) {
  std::mt19937 random(radio.seed * 104729 + 3);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Mail> mails;
  for (const TeamObservation& one : match.observations) {
    const bool is_lost = uniform(random) < radio.loss;
    const double delay = radio.delay * (0.5 + uniform(random));
    if (one.robot == who)
      mails.push_back({one.t, &one});
    else if (!is_lost)
      mails.push_back({one.t + delay, &one});
  }
  return answers(match, std::move(mails), who, options);
}

std::vector<Answer> answers_alone(const Match& match, int robot, TeamFusionOptions options) {
  std::vector<Mail> mails;
  for (const TeamObservation& one : match.observations)
    if (one.robot == robot) mails.push_back({one.t, &one});
  return answers(match, std::move(mails), robot, options);
}

std::vector<Answer> answers_of_surest(const std::vector<std::vector<Answer>>& alone) {
  std::vector<Answer> all = alone.front();
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const auto& one : alone)
      if (one[i].has_ball && (!all[i].has_ball || one[i].sigma < all[i].sigma)) all[i] = one[i];
  return all;
}

std::vector<Answer> answers_of_best_sighting(const Match& match) {
  std::vector<Answer> all;
  std::size_t next = 0;
  std::vector<const TeamObservation*> newest(kRobots, nullptr);
  for (const Moment& moment : match.moments) {
    for (; next < match.observations.size() && match.observations[next].t <= moment.t; ++next)
      newest[static_cast<std::size_t>(match.observations[next].robot)] = &match.observations[next];
    if (moment.t < 2) continue;
    Answer answer = empty_answer(moment, kBench);
    for (const TeamObservation* one : newest)
      if (one != nullptr && moment.t - one->t < 0.1)
        for (const Ball& ball : one->balls) {
          const auto told = gaussian(on_field(*one->pose, ball.floor->position), *one->pose);
          if (!answer.has_ball || std::sqrt(told.covariance.trace()) < answer.sigma) take_ball(answer, told, moment);
        }
    all.push_back(answer);
  }
  return all;
}

Figures figures_of(const std::vector<Answer>& answers) {
  Figures figures;
  std::vector<double> errors, squares, opponent_errors, opponent_squares;
  int visible = 0, opponents = 0, missed = 0, ghosts = 0;
  for (const Answer& one : answers) {
    opponents += one.opponents;
    missed += one.missed;
    ghosts += one.ghosts;
    opponent_errors.insert(opponent_errors.end(), one.opponent_errors.begin(), one.opponent_errors.end());
    opponent_squares.insert(opponent_squares.end(), one.opponent_squared.begin(), one.opponent_squared.end());
    if (!one.visible) continue;
    ++visible;
    if (!one.has_ball) continue;
    errors.push_back(one.error);
    squares.push_back(one.squared);
  }
  const auto quantile = [](std::vector<double> values, double share) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::ranges::sort(values);
    return values[std::min(static_cast<std::size_t>(share * static_cast<double>(values.size())), values.size() - 1)];
  };
  const auto mean = [](const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
  };
  figures.available = static_cast<double>(errors.size()) / visible;
  figures.median = quantile(errors, 0.5);
  figures.ninety = quantile(errors, 0.9);
  figures.mean = mean(errors);
  figures.squared = mean(squares);
  figures.squared_median = quantile(squares, 0.5);
  figures.outside = static_cast<double>(std::ranges::count_if(squares, [](double s) { return s > 9.21; })) /
                    static_cast<double>(squares.size());
  figures.opponents_missed = static_cast<double>(missed) / opponents;
  figures.ghosts = static_cast<double>(ghosts) / static_cast<double>(answers.size());
  figures.opponent_median = quantile(opponent_errors, 0.5);
  figures.opponent_squared = mean(opponent_squares);
  return figures;
}

}  // namespace tassilo::test
