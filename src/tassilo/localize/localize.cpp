#include "tassilo/localize/localize.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tassilo/base/option_check.h"
#include "tassilo/base/sort_stably.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

/// Is it one place, of half a meter and 15 degrees, but for the twentieth that is beyond two standard deviations?
/// Less is of no use to anyone who wants to drive somewhere.
bool is_one_place(const PoseGaussian& pose) {
  constexpr double most_sigma = 0.25, most_turn_sigma = 0.13;  // [m], [rad]
  const double mean = 0.5 * (pose.covariance(0, 0) + pose.covariance(1, 1));
  const double widest = mean + std::hypot(0.5 * (pose.covariance(0, 0) - pose.covariance(1, 1)), pose.covariance(0, 1));
  return widest <= most_sigma * most_sigma && pose.covariance(2, 2) <= most_turn_sigma * most_turn_sigma;
}

/// Two fits to the same lines end closer than this.
bool is_same_place(const PoseGaussian& a, const PoseGaussian& b) {
  return are_near(a, b, 0.3, 0.2) && is_one_place(a) == is_one_place(b);
}

/// May wheels that lost their grip have brought us there?
bool is_slip(const PoseGaussian& from, const PoseGaussian& to) { return are_near(from, to, 0.7, 0.5); }

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
    if (std::ranges::any_of(kept, [&](const PoseHypothesis& other) { return is_same_place(one.pose, other.pose); }))
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
    if (is_same_place(one.pose, mirrored(belief.hypotheses.front().pose))) mirror += weight;
  }
  return all > 0 ? Shares{1 / all, mirror / all} : Shares{};
}

}  // namespace

void LocalizeOptions::check() const {
  check_at_least("localize.max_hypotheses", max_hypotheses, 2);
  if (!(certain >= 0.5 && certain < 1))
    throw Error("localize.certain", "is " + std::to_string(certain) + ", must be from 0.5 to below 1");
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

PoseSeen told_pose(const PoseGaussian& pose, PoseKind kind, double age) {
  PoseSeen told;
  told.x = pose.x;
  told.y = pose.y;
  told.theta = pose.theta;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) told.covariance[static_cast<std::size_t>(3 * r + c)] = pose.covariance(r, c);
  told.kind = kind;
  told.age = age;
  return told;
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
  belief.tied = before.tied;

  std::optional<PoseFit> best;
  double best_weight = 0;
  const auto believe = [&](PoseFit fit, double before_seen) {
    const double weight = before_seen + fit.log_likelihood;
    belief.hypotheses.push_back({fit.pose, weight});
    if (best && weight <= best_weight) return;
    best = std::move(fit);
    best_weight = weight;
  };
  for (const PoseHypothesis& one : before.hypotheses) {
    const PoseGaussian prior = moved(one.pose, motion);
    if (is_one_place(prior))
      believe(fit_pose(target, seen, prior), one.log_weight);
    else
      for (PoseFit& fit : fit_poses(target, seen, prior, !before.tied)) believe(std::move(fit), one.log_weight);
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
    std::optional<PoseGaussian> expected;
    if (!before.hypotheses.empty()) expected = moved(before.hypotheses.front().pose, motion);
    for (PoseFit& fit : search_poses(target, seen)) {
      const double newcomer = !expected ? 0 : is_slip(*expected, fit.pose) ? slipped : carried_away;
      believe(std::move(fit), newcomer);
    }
  }
  tidy(belief, static_cast<std::size_t>(options.max_hypotheses));
  if (belief.hypotheses.empty()) {
    result.why = "no line, circle or goal ties the pose down";
    return result;
  }
  const bool tied = best->lines_explained > 0;
  result.line_of = best->line_of;

  const Shares shares = shares_of(belief);
  if (shares.best + shares.mirror < options.certain) {
    result.why.append(std::to_string(belief.hypotheses.size())).append(" places explain what is seen");
    return result;
  }
  if (!is_one_place(belief.hypotheses.front().pose)) {
    result.why.append("too uncertain to be told: ").append(std::to_string(best->lines_explained)).append(" of ");
    result.why.append(std::to_string(best->lines_seen)).append(" lines explained");
    return result;
  }
  const bool mirror = shares.best < options.certain;
  if (tied && !mirror) belief.fixed_at = t;
  PoseSeen told =
      told_pose(belief.hypotheses.front().pose, tied ? PoseKind::model : PoseKind::predicted, t - belief.fixed_at);
  told.mirror = mirror;
  result.pose = told;
  belief.told = true;
  belief.tied = belief.tied || tied;
  result.why.append(std::to_string(best->lines_explained)).append(" of ").append(std::to_string(best->lines_seen));
  result.why.append(told.mirror ? " lines explained, by the mirrored place as well" : " lines explained");
  return result;
}

}  // namespace tassilo
