#include "tassilo/track/tracks.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>

#include "tassilo/base/assignment.h"
#include "tassilo/base/option_check.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

/// Two bodies whose middles are closer than this are one: least diameters of a ball and of a robot. [m]
constexpr double least_apart(TrackKind kind) { return kind == TrackKind::ball ? 0.2 : 0.3; }

/// One object in one frame.
struct Sighting {
  TrackKind kind = TrackKind::ball;
  Team team = Team::unknown;
  double confidence = 1;
  Eigen::Vector2d place;
  Eigen::Matrix2d covariance;
  Eigen::Vector2d slack =
      Eigen::Vector2d::Zero();  ///< What is seen fits all places from place - slack to place + slack.
};

/// From where a track is to the nearest place that a sighting fits.
Eigen::Vector2d offset(const Track& track, const Sighting& sighting) {
  const Eigen::Vector2d straight = sighting.place - track.mean.head<2>();
  const double length = sighting.slack.squaredNorm();
  if (!(length > 0)) return straight;
  return straight - std::clamp(straight.dot(sighting.slack) / length, -1., 1.) * sighting.slack;
}

double common_sigma(TrackKind kind, double distance, const TrackOptions& options) {
  return kind == TrackKind::ball ? options.ball_common * distance : options.robot_common;
}

/// In an order that says nothing of how they were found: surest balls first, then nearest robots.
RecycledVector<Sighting> sightings_of(const TrackObservation& seen, const TrackOptions& options) {
  RecycledVector<Sighting> sightings;
  for (const Ball& ball : seen.balls) {
    if (!ball.floor) continue;
    const auto& [mean, covariance] = ball.floor->position;
    sightings.push_back({TrackKind::ball, Team::unknown, ball.confidence, {mean.x, mean.y}, covariance, {0, 0}});
  }
  for (const RobotSeen& robot : seen.robots) {
    if (!robot.floor) continue;
    // The nearest point wanders over the body as we drive, its middle does not. Of a robot narrower than robots are
    // another body or the image's border hides a part, on a side that is not known; a wider one may be two, one beside
    // the other: the middle may be off by half of the difference, across the line of sight.
    const Eigen::Vector2d middle(robot.floor->center.x, robot.floor->center.y);
    const Eigen::Vector2d across = Eigen::Vector2d(-middle.y(), middle.x()).normalized();
    const Eigen::Vector2d slack = (robot.floor->width - options.robot_width) / 2 * across;
    const double turning = options.robot_common * options.robot_common;  // it shows another side of itself
    const Eigen::Matrix2d spread =
        robot.floor->nearest.covariance + slack * slack.transpose() + turning * Eigen::Matrix2d::Identity();
    sightings.push_back({TrackKind::robot, robot.team, 1, middle, spread, slack});
  }
  std::ranges::sort(sightings, {}, [](const Sighting& s) {
    return std::tuple(s.kind, -s.confidence, s.place.squaredNorm(), s.place.x(), s.place.y(), s.team);
  });
  return sightings;
}

/// Uncertainty that a velocity's change adds which comes little by little over a time, or at once at some moment of it.
Eigen::Matrix4d random_walk(double variance_rate, double dt) {
  const Eigen::Matrix2d one = variance_rate * Eigen::Matrix2d::Identity();
  Eigen::Matrix4d noise;
  noise << dt * dt * dt / 3 * one, dt * dt / 2 * one, dt * dt / 2 * one, dt * one;
  return noise;
}

double largest_sigma(const Eigen::Matrix4d& covariance) {
  const double a = covariance(0, 0), b = covariance(1, 1), c = covariance(0, 1);
  return std::sqrt((a + b) / 2 + std::hypot((a - b) / 2, c));
}

void predict(Track& track, const RobotMotion& motion, double dt, const TrackOptions& options) {
  const double walk = track.kind == TrackKind::ball ? options.ball_acceleration : options.robot_acceleration;
  Eigen::Matrix4d roll = Eigen::Matrix4d::Identity();
  roll.topRightCorner<2, 2>().diagonal().setConstant(dt);
  const Eigen::Vector4d rolled = roll * track.mean - Eigen::Vector4d(motion.x, motion.y, 0, 0);

  const double c = std::cos(motion.theta), s = std::sin(motion.theta);
  Eigen::Matrix4d turn = Eigen::Matrix4d::Zero();
  turn.topLeftCorner<2, 2>() << c, s, -s, c;
  turn.bottomRightCorner<2, 2>() = turn.topLeftCorner<2, 2>();
  track.mean = turn * rolled;

  Eigen::Matrix<double, 4, 3> by_motion = Eigen::Matrix<double, 4, 3>::Zero();
  by_motion.topLeftCorner<2, 2>() = -turn.topLeftCorner<2, 2>();
  by_motion.col(2) << track.mean(1), -track.mean(0), track.mean(3), -track.mean(2);
  const Eigen::Matrix4d moved = turn * roll;
  const Eigen::Matrix4d covariance = moved * track.covariance * moved.transpose() +
                                     by_motion * motion.covariance * by_motion.transpose() +
                                     random_walk(walk * walk, dt);  // alike in all directions: turning changes nothing
  track.covariance = (covariance + covariance.transpose()) / 2;
}

/// The covariance of a track had it been kicked since it was seen last.
Eigen::Matrix4d kicked(const Track& track, double t, const TrackOptions& options) {
  const double dt = t - track.seen_at;
  if (!(dt > 0)) return track.covariance;
  return track.covariance + random_walk(options.kick_speed * options.kick_speed / dt, dt);
}

bool is_told_ball(const Track& track) { return track.kind == TrackKind::ball && track.id > 0; }

bool contradict(Team team, const Sighting& sighting) {
  return team != Team::unknown && sighting.team != Team::unknown && team != sighting.team;
}

constexpr double kNever = 1e9;  ///< A cost that no pair is worth.

/// -2 log likelihood of a sighting of this track.
double cost_of(const Track& track, const Eigen::Matrix4d& covariance, const Sighting& sighting, double gate) {
  if (track.kind != sighting.kind) return kNever;
  const Eigen::Matrix2d spread = covariance.topLeftCorner<2, 2>() + sighting.covariance;
  const Eigen::Vector2d off = offset(track, sighting);
  const double squared = off.dot(spread.inverse() * off);
  if (!(squared <= gate)) return kNever;
  constexpr double wrong_team = 6;  // one marker color in twenty is misread: -2 log(.05)
  return squared + 2 * std::log(2 * std::numbers::pi) + std::log(spread.determinant()) +
         (contradict(track.team(), sighting) ? wrong_team : 0);
}

/// -2 log likelihood that a sighting is something new and the track was missed: a new body appears once on 20 m^2,
/// and one of ten is missed.
constexpr double kAlone = 10.6;

void update(Track& track, const Sighting& sighting, double t) {
  Eigen::Matrix<double, 2, 4> place = Eigen::Matrix<double, 2, 4>::Zero();
  place.leftCols<2>().setIdentity();
  const Eigen::Matrix4d& before = track.covariance;
  const Eigen::Matrix2d spread = before.topLeftCorner<2, 2>() + sighting.covariance;
  const Eigen::Matrix<double, 4, 2> gain = before.leftCols<2>() * spread.inverse();
  track.mean += gain * offset(track, sighting);
  const Eigen::Matrix4d left = Eigen::Matrix4d::Identity() - gain * place;
  const Eigen::Matrix4d after = left * before * left.transpose() + gain * sighting.covariance * gain.transpose();
  track.covariance = (after + after.transpose()) / 2;
  track.seen_at = t;
  track.sightings += 1;
  track.clear_misses = 0;
  track.cyan += sighting.team == Team::cyan;
  track.magenta += sighting.team == Team::magenta;
}

Track begun(const Sighting& sighting, double t, const TrackOptions& options) {
  Track track;
  track.kind = sighting.kind;
  track.mean.head<2>() = sighting.place;
  const double speed = track.kind == TrackKind::ball ? options.ball_speed : options.robot_speed;
  track.covariance.setZero();
  track.covariance.topLeftCorner<2, 2>() = sighting.covariance;
  track.covariance.bottomRightCorner<2, 2>().diagonal().setConstant(speed * speed);
  track.seen_at = t;
  track.sightings = 1;
  track.cyan = sighting.team == Team::cyan;
  track.magenta = sighting.team == Team::magenta;
  return track;
}

/// Does the floor show, free, wherever the object may stand?
bool is_in_clear_view(const Track& track, const TrackObservation& seen) {
  if (seen.free_space == nullptr || seen.camera == nullptr || seen.free_space->states.empty()) return false;
  const FreeSpace& space = *seen.free_space;
  const FloorPoint place{track.mean(0), track.mean(1)};
  const double range = distance(place, space.origin);
  const double reach = least_apart(track.kind) + 2 * largest_sigma(track.covariance);
  if (range <= reach) return false;
  // Floor below the lowest row counts as free without being seen.
  const CameraModel& image = seen.camera->model();
  for (const double r : {range - reach, range + reach}) {
    const FloorPoint p = space.origin + r / range * (place - space.origin);
    const auto pixel = seen.camera->project({p.x, p.y, 0});
    if (!pixel || pixel->x < 0 || pixel->y < 0 || pixel->x > image.width - 1 || pixel->y > image.height - 1)
      return false;
  }
  const auto sectors = static_cast<double>(space.states.size());
  const double middle_of_all = (sectors - 1) / 2 * space.angle_increment;
  const double angle = wrap_angle(bearing(place - space.origin) - space.angle_min - middle_of_all) + middle_of_all;
  const double half = std::asin(reach / range);
  const double first = std::round((angle - half) / space.angle_increment),
               last = std::round((angle + half) / space.angle_increment);
  if (!(first >= 0 && last < sectors)) return false;
  for (auto i = static_cast<std::size_t>(first); i <= static_cast<std::size_t>(last); ++i)
    if (space.states[i] == SectorState::unseen || space.ranges[i] < range + reach) return false;
  return true;
}

/// Hands sightings to tracks, as likely as possible altogether, and takes them in; pairs are `cost(track, sighting)`.
template <class Cost, class Take>
void hand_out(const RecycledVector<Track>& tracks, const RecycledVector<Sighting>& sightings, Cost cost, Take take) {
  CostTable table(tracks.size(), sightings.size(), kNever);
  for (std::size_t i = 0; i < tracks.size(); ++i)
    for (std::size_t k = 0; k < sightings.size(); ++k) table.at(i, k) = cost(i, k);
  const RecycledVector<int> sighting_of = assign(table, kAlone);
  for (std::size_t i = 0; i < tracks.size(); ++i)
    if (sighting_of[i] >= 0) take(i, static_cast<std::size_t>(sighting_of[i]));
}

/// Counts misses and gives up what was not seen though it should have been, or where another one is.
void forget_missed(RecycledVector<Track>& tracks, const RecycledVector<char>& was_seen, const TrackObservation& seen,
                   const TrackOptions& options) {
  RecycledVector<char> is_gone(tracks.size(), 0);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    Track& missed = tracks[i];
    if (was_seen[i]) continue;
    const bool is_sure = missed.id > 0;
    if (!is_sure || is_in_clear_view(missed, seen)) missed.clear_misses += 1;
    is_gone[i] = missed.clear_misses >= (is_sure ? options.clear_misses : std::min(options.clear_misses, 2));
    for (std::size_t k = 0; k < tracks.size() && !is_gone[i]; ++k)
      is_gone[i] = was_seen[k] && tracks[k].kind == missed.kind &&
                   (tracks[k].mean - missed.mean).head<2>().norm() < least_apart(missed.kind);
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < tracks.size(); ++i)
    if (!is_gone[i]) tracks[kept++] = tracks[i];
  tracks.resize(kept);
}

}  // namespace

void TrackOptions::check() const {
  const auto above = [](const std::string& name, double value, double low) {
    check_above("track." + name, value, low);
    check_finite("track." + name, value);
  };
  const auto at_least = [](const std::string& name, double value, double low) {
    check_at_least("track." + name, value, low);
    check_finite("track." + name, value);
  };
  above("ball_acceleration", ball_acceleration, 0);
  above("robot_acceleration", robot_acceleration, 0);
  above("ball_speed", ball_speed, 0);
  above("robot_speed", robot_speed, 0);
  at_least("kick_speed", kick_speed, 0);
  above("robot_width", robot_width, 0);
  at_least("ball_common", ball_common, 0);
  at_least("robot_common", robot_common, 0);
  above("gate", gate, 0);
  if (!(sure_ball >= 0 && sure_ball <= 1))
    throw Error("track.sure_ball", "is " + std::to_string(sure_ball) + ", must be >= 0 and <= 1");
  check_at_least("track.sightings", sightings, 1);
  above("max_age", max_age, 0);
  above("max_sigma", max_sigma, 0);
  check_at_least("track.clear_misses", clear_misses, 1);
  check_at_least("track.max_tracks", max_tracks, 1);
}

TrackState predicted(const TrackState& before, const RobotMotion& motion, double t, const TrackOptions& options) {
  TrackState state;
  state.t = std::max(t, before.t);
  state.next_id = before.next_id;
  const double dt = state.t - before.t;
  if (motion.is_measured)
    state.own_velocity_covariance.setZero();
  else if (dt > 0)
    state.own_velocity_covariance = motion.covariance / (dt * dt);
  else
    state.own_velocity_covariance = before.own_velocity_covariance;
  state.tracks.reserve(before.tracks.size());
  for (Track track : before.tracks) {
    predict(track, motion, dt, options);
    if (state.t - track.seen_at <= options.max_age && largest_sigma(track.covariance) <= options.max_sigma)
      state.tracks.push_back(track);
  }
  return state;
}

TrackState track(const TrackState& before, const RobotMotion& motion, const TrackObservation& seen, double t,
                 const TrackOptions& options) {
  TrackState state = predicted(before, motion, t, options);
  RecycledVector<Track>& tracks = state.tracks;
  const RecycledVector<Sighting> sightings = sightings_of(seen, options);
  RecycledVector<char> taken(sightings.size(), 0), was_seen(tracks.size(), 0);
  const auto take = [&](std::size_t i, std::size_t k) {
    update(tracks[i], sightings[k], state.t);
    was_seen[i] = taken[k] = 1;
  };
  hand_out(
      tracks, sightings,
      [&](std::size_t i, std::size_t k) {
        return cost_of(tracks[i], tracks[i].covariance, sightings[k], options.gate);
      },
      take);
  hand_out(
      tracks, sightings,
      [&](std::size_t i, std::size_t k) {
        if (was_seen[i] || !is_told_ball(tracks[i]) || taken[k]) return kNever;
        if (sightings[k].confidence < options.sure_ball) return kNever;
        return cost_of(tracks[i], kicked(tracks[i], state.t, options), sightings[k], options.gate);
      },
      [&](std::size_t i, std::size_t k) {
        tracks[i].covariance = kicked(tracks[i], state.t, options);
        take(i, k);
      });

  forget_missed(tracks, was_seen, seen, options);
  for (std::size_t k = 0; k < sightings.size() && tracks.size() < static_cast<std::size_t>(options.max_tracks); ++k)
    if (!taken[k]) {
      Track newcomer = begun(sightings[k], state.t, options);
      if (!(largest_sigma(newcomer.covariance) <= options.max_sigma)) continue;
      const bool is_only_ball = newcomer.kind == TrackKind::ball && std::ranges::none_of(tracks, is_told_ball);
      if (is_only_ball && sightings[k].confidence >= options.sure_ball) newcomer.id = state.next_id++;
      tracks.push_back(newcomer);
    }
  for (Track& one : tracks)
    if (one.id == 0 && one.sightings >= options.sightings) one.id = state.next_id++;
  return state;
}

RecycledVector<TrackSeen> told(const TrackState& state, const TrackOptions& options) {
  RecycledVector<TrackSeen> all;
  RecycledVector<const Track*> order;
  for (const Track& one : state.tracks)
    if (one.id > 0) order.push_back(&one);
  std::ranges::sort(order, {}, [](const Track* one) {
    return std::tuple(one->kind, one->kind == TrackKind::ball ? -one->sightings : 0, one->id);
  });
  for (const Track* one : order) {
    TrackSeen seen;
    seen.id = one->id;
    seen.kind = one->kind;
    seen.team = one->team();
    seen.x = one->mean(0);
    seen.y = one->mean(1);
    seen.vx = one->mean(2);
    seen.vy = one->mean(3);
    seen.age = state.t - one->seen_at;
    Eigen::Matrix<double, 4, 4, Eigen::RowMajor> covariance = one->covariance;
    // What all sightings have wrong alike does not average out.
    const double common = common_sigma(one->kind, one->mean.head<2>().norm(), options);
    covariance.topLeftCorner<2, 2>().diagonal().array() += common * common;
    Eigen::Matrix<double, 2, 3> by_own_velocity;
    by_own_velocity << 1, 0, -seen.y, 0, 1, seen.x;
    const Eigen::Matrix2d own = by_own_velocity * state.own_velocity_covariance * by_own_velocity.transpose();
    covariance.bottomRightCorner<2, 2>() += (own + own.transpose()) / 2;
    std::copy_n(covariance.data(), 16, seen.covariance.begin());
    all.push_back(seen);
  }
  return all;
}

}  // namespace tassilo
