#include "tassilo/localize/localize.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tassilo/base/error.h"
#include "tassilo/base/sort_stably.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

bool near_each_other(const PoseGaussian& a, const PoseGaussian& b) {
  constexpr double distance = 0.3, turn = 0.2;  // [m], [rad] two fits to the same lines end closer than this
  return std::hypot(a.x - b.x, a.y - b.y) < distance && std::abs(wrap_angle(a.theta - b.theta)) < turn;
}

/// May wheels that lost their grip have brought us there?
bool is_slip(const PoseGaussian& from, const PoseGaussian& to) {
  constexpr double distance = 0.7, turn = 0.5;  // [m], [rad]
  return std::hypot(from.x - to.x, from.y - to.y) < distance && std::abs(wrap_angle(from.theta - to.theta)) < turn;
}

PoseGaussian mirrored(const PoseGaussian& pose) {
  return {-pose.x, -pose.y, wrap_angle(pose.theta + std::numbers::pi), pose.covariance};
}

/// Best first, near ones as one, unlikely ones gone; weights relative to the best.
void tidy(PoseBelief& belief, std::size_t most) {
  auto& all = belief.hypotheses;
  sort_stably(all, std::greater<>{}, &PoseHypothesis::log_weight);
  RecycledVector<PoseHypothesis> kept;
  constexpr double least = -14;  // one in a million
  for (const PoseHypothesis& one : all) {
    if (kept.size() == most || one.log_weight < all.front().log_weight + least) break;
    if (std::ranges::any_of(kept, [&](const PoseHypothesis& other) { return near_each_other(one.pose, other.pose); }))
      continue;
    kept.push_back(one);
  }
  if (!kept.empty()) {
    const double best = kept.front().log_weight;
    for (PoseHypothesis& one : kept) one.log_weight -= best;
  }
  all = std::move(kept);
}

/// Shares of the belief: of the best place, and of its point mirror.
struct Shares {
  double best = 0, mirror = 0;
};
Shares shares_of(const PoseBelief& belief) {
  double all = 0, mirror = 0;
  for (const PoseHypothesis& one : belief.hypotheses) {
    const double weight = std::exp(one.log_weight);
    all += weight;
    if (near_each_other(one.pose, mirrored(belief.hypotheses.front().pose))) mirror += weight;
  }
  return all > 0 ? Shares{1 / all, mirror / all} : Shares{};
}

}  // namespace

void LocalizeOptions::check() const {
  const auto above = [](const char* name, double value, double low, bool equal) {
    if (!(value > low || (equal && value == low)) || !std::isfinite(value))
      throw Error(std::string("localize.") + name,
                  "is " + std::to_string(value) + ", must be " + (equal ? ">= " : "> ") + std::to_string(low));
  };
  above("odometry_distance_sigma", odometry_distance_sigma, 0, true);
  above("odometry_turn_sigma", odometry_turn_sigma, 0, true);
  above("odometry_drift_sigma", odometry_drift_sigma, 0, false);
  above("speed_sigma", speed_sigma, 0, false);
  above("turn_rate_sigma", turn_rate_sigma, 0, false);
  above("max_hypotheses", max_hypotheses, 2, true);
  if (!(certain >= 0.5 && certain < 1))
    throw Error("localize.certain", "is " + std::to_string(certain) + ", must be from 0.5 to below 1");
}

RobotMotion robot_motion(const Odometry* odometry, double from, double to, const LocalizeOptions& options) {
  RobotMotion motion;
  const double dt = std::max(to - from, 0.);
  const auto before = odometry != nullptr ? odometry->at(from) : std::nullopt;
  const auto after = odometry != nullptr ? odometry->at(to) : std::nullopt;
  if (!before || !after) {
    const double place = options.speed_sigma * dt, turn = options.turn_rate_sigma * dt;
    motion.covariance = Eigen::Vector3d(place * place, place * place, turn * turn).asDiagonal();
    return motion;
  }
  const double c = std::cos(before->theta), s = std::sin(before->theta);
  const double dx = after->x - before->x, dy = after->y - before->y;
  motion.x = c * dx + s * dy;
  motion.y = -s * dx + c * dy;
  motion.theta = wrap_angle(after->theta - before->theta);
  const double driven = std::hypot(dx, dy), turned = std::abs(motion.theta);
  const double drift = options.odometry_drift_sigma * options.odometry_drift_sigma * dt;
  const double place = options.odometry_distance_sigma * driven, turn = options.odometry_turn_sigma * turned;
  motion.covariance = Eigen::Vector3d(place * place + drift, place * place + drift, turn * turn + drift).asDiagonal();
  return motion;
}

PoseGaussian moved(const PoseGaussian& pose, const RobotMotion& motion) {
  const double c = std::cos(pose.theta), s = std::sin(pose.theta);
  PoseGaussian result;
  const double dx = c * motion.x - s * motion.y, dy = s * motion.x + c * motion.y;
  result.x = pose.x + dx;
  result.y = pose.y + dy;
  result.theta = wrap_angle(pose.theta + motion.theta);
  Eigen::Matrix3d by_pose = Eigen::Matrix3d::Identity(), turned = Eigen::Matrix3d::Identity();
  by_pose(0, 2) = -dy;
  by_pose(1, 2) = dx;
  turned.topLeftCorner<2, 2>() << c, -s, s, c;
  result.covariance = by_pose * pose.covariance * by_pose.transpose() + turned * motion.covariance * turned.transpose();
  return result;
}

PoseBelief belief_in(const PoseGaussian& pose, double t) {
  PoseBelief belief;
  belief.t = t;
  belief.fixed_at = t;
  belief.told = true;
  belief.hypotheses.push_back({pose, 0});
  return belief;
}

Localized localize(const FieldTarget& target, const PoseBelief& before, const RobotMotion& motion,
                   const PoseObservation& seen, double t, const LocalizeOptions& options) {
  Localized result;
  PoseBelief& belief = result.belief;
  belief.t = t;
  belief.fixed_at = before.fixed_at;
  belief.doubts = before.doubts;

  std::optional<PoseFit> best;
  double best_weight = 0;
  for (const PoseHypothesis& one : before.hypotheses) {
    const PoseGaussian predicted = moved(one.pose, motion);
    PoseFit fit = fit_pose(target, seen, predicted);
    const double weight = one.log_weight + fit.log_likelihood;
    belief.hypotheses.push_back({fit.pose, weight});
    if (!best || weight > best_weight) {
      best = std::move(fit);
      best_weight = weight;
    }
  }
  // Two lines and more that the best place does not explain: perhaps it is another.
  constexpr int enough_marks = 16, enough_doubts = 3;
  if (best && best->marks_seen >= enough_marks) {
    const bool explained = 2 * best->marks_explained >= best->marks_seen;
    belief.doubts = explained ? std::max(belief.doubts - 1, 0) : std::min(belief.doubts + 1, 2 * enough_doubts);
  }
  const bool lost = belief.hypotheses.empty() || belief.doubts >= enough_doubts || !before.told;
  if (lost) {
    // Log weights of newcomers: a robot slips now and then, is carried away once in an hour's hundred thousand frames,
    // and a place that was not believed in before did not explain what was seen then.
    constexpr double slipped = -4, carried_away = -12;
    for (PoseFit& fit : search_poses(target, seen)) {
      double weight = fit.log_likelihood;
      if (!before.hypotheses.empty())
        weight += is_slip(moved(before.hypotheses.front().pose, motion), fit.pose) ? slipped : carried_away;
      belief.hypotheses.push_back({fit.pose, weight});
      if (!best || weight > best_weight) {
        best = std::move(fit);
        best_weight = weight;
      }
    }
  }
  tidy(belief, static_cast<std::size_t>(options.max_hypotheses));
  if (belief.hypotheses.empty()) {
    result.why = "no line, circle or goal ties the pose down";
    return result;
  }
  belief.tied = best->lines_explained > 0;
  if (belief.tied) belief.fixed_at = t;
  result.line_of = best->line_of;

  const Shares shares = shares_of(belief);
  if (shares.best + shares.mirror < options.certain) {
    result.why.append(std::to_string(belief.hypotheses.size())).append(" places explain what is seen");
    return result;
  }
  const PoseGaussian& pose = belief.hypotheses.front().pose;
  PoseSeen told;
  told.x = pose.x;
  told.y = pose.y;
  told.theta = pose.theta;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) told.covariance[static_cast<std::size_t>(3 * r + c)] = pose.covariance(r, c);
  told.kind = belief.tied ? PoseKind::model : PoseKind::predicted;
  told.mirror = shares.best < options.certain;
  told.age = t - belief.fixed_at;
  result.pose = told;
  belief.told = true;
  result.why.append(std::to_string(best->lines_explained)).append(" of ").append(std::to_string(best->lines_seen));
  result.why.append(told.mirror ? " lines explained, by the mirrored place as well" : " lines explained");
  return result;
}

}  // namespace tassilo
