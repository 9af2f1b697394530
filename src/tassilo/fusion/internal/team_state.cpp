#include "tassilo/fusion/internal/team_state.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "tassilo/base/assignment.h"
#include "tassilo/fusion/field_sighting.h"

namespace tassilo {
namespace {

constexpr double kFarthest = 1000;     ///< No field reaches there. [m]
constexpr double kLeastSigma = 0.001;  ///< Nothing is seen better. [m]
constexpr double kLongestStep = 0.1;   ///< Between rolling and kicked it may change so often. [s]
constexpr double kWeightMemory = 0.7;  ///< [s]
constexpr double kLately = 0.3;        ///< [s]
constexpr double kDoubt = 0.7;
constexpr double kMateSpeed = 1;   ///< A teammate may drive on so fast since it told where it is. Sigma, [m/s]
constexpr double kMateMemory = 1;  ///< Of one silent for longer nothing is known. [s]
constexpr double kNever = 1e9;     ///< A cost that no pair is worth.
/// Two things of a kind whose middles are closer than this are one: least diameters of a ball and of a robot, and what
/// poses add. [m]
constexpr double least_apart(TrackKind kind) { return kind == TrackKind::ball ? 0.25 : 0.3; }
/// An opponent is not where a teammate stands. [m]
constexpr double kGhost = 0.25;
/// -2 log likelihood that a sighting is something new and the thing was missed. One of ten is missed; a robot may come
/// into view on 20 m^2, but there is one ball, and false ones show up once in thousand m^2.
constexpr double alone(TrackKind kind) { return kind == TrackKind::ball ? 18 : 10.6; }

double largest_sigma(const Eigen::Matrix2d& covariance) {
  const double a = covariance(0, 0), b = covariance(1, 1), c = covariance(0, 1);
  return std::sqrt(std::max((a + b) / 2 + std::hypot((a - b) / 2, c), 0.));
}

double max_sigma(TrackKind kind, const TeamFusionOptions& options) {
  return kind == TrackKind::ball ? options.max_ball_sigma : options.max_robot_sigma;
}

bool is_place(double x, double y) { return std::abs(x) <= kFarthest && std::abs(y) <= kFarthest; }

/// The nearest symmetric matrix, lifted until it is positive.
Eigen::Matrix2d repaired(const Eigen::Matrix2d& covariance) {
  Eigen::Matrix2d all = (covariance + covariance.transpose()) / 2;
  const double a = all(0, 0), b = all(1, 1), c = all(0, 1);
  const double least = (a + b) / 2 - std::hypot((a - b) / 2, c);
  all.diagonal().array() += kLeastSigma * kLeastSigma - std::min(least, 0.);
  return all;
}

bool is_usable(const PoseSeen& pose, const TeamFusionOptions& options) {
  if (pose.mirror || !(pose.age <= options.max_pose_age)) return false;
  if (!is_place(pose.x, pose.y) || !std::isfinite(pose.theta)) return false;
  for (const double value : pose.covariance)
    if (!std::isfinite(value)) return false;
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> covariance(pose.covariance.data());
  if (!(covariance.diagonal().minCoeff() >= 0)) return false;
  return largest_sigma(covariance.topLeftCorner<2, 2>()) <= options.max_pose_sigma &&
         covariance(2, 2) <= options.max_heading_sigma * options.max_heading_sigma;
}

/// Which witness a robot is, -1: none yet.
int witness_of(const FieldTrack& track, int robot) {
  const auto known = track.known_witnesses();
  for (std::size_t i = 0; i < known.size(); ++i)
    if (known[i].robot == robot) return static_cast<int>(i);
  return -1;
}

/// How well a sighting by a robot fits a thing that rolls or was kicked.
Fit fit_of(const FieldTrack& track, const SeenThing& thing, int robot) {
  const int witness = witness_of(track, robot);
  const Fit rolls = fit(track.beliefs[0], thing.evidence, witness);
  if (!track.may_be_kicked()) return rolls;
  const Fit kicked = fit(track.beliefs[1], thing.evidence, witness);
  const double least = std::min(rolls.minus_two_log, kicked.minus_two_log);
  const double both = (1 - track.kicked) * std::exp((least - rolls.minus_two_log) / 2) +
                      track.kicked * std::exp((least - kicked.minus_two_log) / 2);
  // How fast a ball is kicked has no Gaussian's thin tails; that it would be another ball is reckoned with elsewhere.
  return {std::min(rolls.squared, kicked.squared / 2), least - 2 * std::log(std::max(both, 1e-300))};
}

constexpr double kWrongTeam = 6;  ///< One marker color in twenty is misread: -2 log(.05).
bool contradict(Team a, Team b) { return a != Team::unknown && b != Team::unknown && a != b; }

double cost_of(const FieldTrack& track, const SeenThing& thing, int robot, const TeamFusionOptions& options) {
  if (thing.team != Team::unknown && thing.team == options.own_team) return kNever;
  const Fit how = fit_of(track, thing, robot);
  if (!(how.squared <= options.gate)) return kNever;
  return how.minus_two_log + (contradict(track.team(), thing.team) ? kWrongTeam : 0);
}
double cost_of(const Mate& mate, const SeenThing& thing, double t, const TeamFusionOptions& options) {
  const double driven = kMateSpeed * (t - mate.t);
  Eigen::Matrix2d spread =
      mate.covariance + thing.evidence.noise + thing.evidence.by_error * thing.evidence.by_error.transpose();
  spread.diagonal().array() += driven * driven;
  const Eigen::Vector2d off = thing.evidence.place - mate.place;
  const double squared = off.dot(spread.inverse() * off);
  if (!(squared <= options.gate)) return kNever;
  return squared + 2 * std::log(2 * std::numbers::pi) + std::log(spread.determinant()) +
         (contradict(options.own_team, thing.team) ? kWrongTeam : 0);
}

/// Share of the time in which a ball is being kicked.
double usually_kicked(const TeamFusionOptions& options) {
  return options.kick_rate * options.kick_duration / (1 + options.kick_rate * options.kick_duration);
}

void roll_on(FieldTrack& track, double dt, const TeamFusionOptions& options) {
  track.weight *= std::exp(-dt / kWeightMemory);
  Rolling rolling{0, options.robot_acceleration * options.robot_acceleration, options.pose_memory};
  if (!track.may_be_kicked()) {
    roll(track.beliefs[0], dt, rolling);
    return;
  }
  rolling.friction = options.ball_friction;
  rolling.walk = options.ball_acceleration * options.ball_acceleration;
  Rolling kicked = rolling;
  kicked.walk += options.kick_speed * options.kick_speed / options.kick_duration;
  const double steps = std::clamp(std::ceil(dt / kLongestStep), 1., 64.);
  const double usual = usually_kicked(options);
  for (int i = 0; i < static_cast<int>(steps); ++i) {
    // Two states of a Markov chain in continuous time.
    const double changed = 1 - std::exp(-dt / steps * (options.kick_rate + 1 / options.kick_duration));
    const double to_kicked = usual * changed, to_rolling = (1 - usual) * changed;
    const double after = (1 - track.kicked) * to_kicked + track.kicked * (1 - to_rolling);
    const Belief before_rolling = mixed(track.beliefs[0], track.beliefs[1],
                                        std::min(track.kicked * to_rolling / std::max(1 - after, 1e-300), 1.));
    const Belief before_kicked = mixed(track.beliefs[0], track.beliefs[1],
                                       after > 0 ? std::min(track.kicked * (1 - to_rolling) / after, 1.) : 0.);
    track.beliefs = {before_rolling, before_kicked};
    track.kicked = after;
    roll(track.beliefs[0], dt / steps, rolling);
    roll(track.beliefs[1], dt / steps, kicked);
  }
}

/// One of both, for who needs not tell them apart.
Belief overall(const FieldTrack& track) {
  return track.may_be_kicked() ? mixed(track.beliefs[0], track.beliefs[1], track.kicked) : track.beliefs[0];
}

Eigen::Vector2d place_of(const FieldTrack& track) {
  const Eigen::Vector2d rolls = track.beliefs[0].mean.head<2>();
  if (!track.may_be_kicked()) return rolls;
  return (1 - track.kicked) * rolls + track.kicked * track.beliefs[1].mean.head<2>();
}

void count_in(FieldTrack& track, const SeenThing& thing, const SeenImage& image, int witness) {
  track.witnesses[static_cast<std::size_t>(witness)] = {image.robot, image.t};
  track.seen_at = image.t;
  track.support += thing.confidence;
  track.misses = 0;
  track.weight += thing.confidence;
  track.cyan += thing.team == Team::cyan;
  track.magenta += thing.team == Team::magenta;
}

void observe(FieldTrack& track, const SeenThing& thing, const SeenImage& image) {
  const int beliefs = track.may_be_kicked() ? 2 : 1;
  int witness = witness_of(track, image.robot);
  if (witness < 0) {
    const auto known = track.known_witnesses();
    if (known.size() == kMaxWitnesses) {
      const auto longest_ago = std::ranges::min_element(known, {}, &Witness::seen_at) - known.begin();
      for (int i = 0; i < beliefs; ++i)
        remove_witness(track.beliefs[static_cast<std::size_t>(i)], static_cast<int>(longest_ago));
      track.witnesses[static_cast<std::size_t>(longest_ago)] = track.witnesses[kMaxWitnesses - 1];
    }
    witness = witness_count(track.beliefs[0]);
    for (int i = 0; i < beliefs; ++i) add_witness(track.beliefs[static_cast<std::size_t>(i)]);
  }
  if (track.may_be_kicked()) {
    const double rolls = fit(track.beliefs[0], thing.evidence, witness).minus_two_log;
    const double kicked = fit(track.beliefs[1], thing.evidence, witness).minus_two_log;
    const double least = std::min(rolls, kicked);
    const double as_rolling = (1 - track.kicked) * std::exp((least - rolls) / 2);
    const double as_kicked = track.kicked * std::exp((least - kicked) / 2);
    if (as_rolling + as_kicked > 0) track.kicked = as_kicked / (as_rolling + as_kicked);
    observe(track.beliefs[1], thing.evidence, witness);
  }
  observe(track.beliefs[0], thing.evidence, witness);
  count_in(track, thing, image, witness);
}

FieldTrack begun(const SeenThing& thing, const SeenImage& image, const TeamFusionOptions& options) {
  FieldTrack track;
  track.kind = thing.kind;
  track.beliefs[0] = begun(thing.evidence, thing.kind == TrackKind::ball ? options.ball_speed : options.robot_speed);
  if (track.may_be_kicked()) {
    track.beliefs[1] = track.beliefs[0];
    track.kicked = usually_kicked(options);
  }
  count_in(track, thing, image, 0);
  return track;
}

/// Hands things of one kind to tracks, and robots to teammates, as likely as possible altogether. What nobody takes
/// begins a track.
void hand_out(TeamState& state, const SeenImage& image, TrackKind kind, const TeamFusionOptions& options) {
  RecycledVector<std::size_t> tracks, things;
  RecycledVector<const Mate*> mates;
  for (std::size_t i = 0; i < state.tracks.size(); ++i)
    if (state.tracks[i].kind == kind) tracks.push_back(i);
  for (std::size_t i = 0; i < image.things.size(); ++i)
    if (image.things[i].kind == kind) things.push_back(i);
  if (kind == TrackKind::robot)
    for (const Mate& mate : state.mates)
      if (mate.robot != image.robot) mates.push_back(&mate);
  CostTable table(tracks.size() + mates.size(), things.size(), kNever);
  for (std::size_t k = 0; k < things.size(); ++k) {
    const SeenThing& thing = image.things[things[k]];
    for (std::size_t i = 0; i < tracks.size(); ++i)
      table.at(i, k) = cost_of(state.tracks[tracks[i]], thing, image.robot, options);
    for (std::size_t i = 0; i < mates.size(); ++i)
      table.at(tracks.size() + i, k) = cost_of(*mates[i], thing, image.t, options);
  }
  const RecycledVector<int> thing_of = assign(table, alone(kind));
  RecycledVector<char> is_taken(things.size(), 0), was_seen(state.tracks.size(), 0);
  for (std::size_t i = 0; i < thing_of.size(); ++i) {
    if (thing_of[i] < 0) continue;
    const auto k = static_cast<std::size_t>(thing_of[i]);
    is_taken[k] = 1;
    if (i >= tracks.size()) continue;
    observe(state.tracks[tracks[i]], image.things[things[k]], image);
    was_seen[tracks[i]] = 1;
  }
  RecycledVector<char> is_gone(state.tracks.size(), 0);
  for (const std::size_t i : tracks) {
    FieldTrack& track = state.tracks[i];
    if (was_seen[i]) continue;
    const int witness = witness_of(track, image.robot);
    // Who saw this ball lately, and now another one instead, speaks against it.
    if (kind == TrackKind::ball && !things.empty() && witness >= 0 &&
        image.t - track.witnesses[static_cast<std::size_t>(witness)].seen_at < kLately)
      track.weight *= kDoubt;
    if (track.id == 0 && witness >= 0) is_gone[i] = ++track.misses >= options.misses;
    // Where a thing was seen there is no other one that was not.
    for (const std::size_t other : tracks)
      if (was_seen[other] && state.tracks[other].weight >= track.weight &&
          (place_of(state.tracks[other]) - place_of(track)).norm() < least_apart(kind))
        is_gone[i] = 1;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < state.tracks.size(); ++i) {
    if (is_gone[i]) continue;
    if (kept != i) state.tracks[kept] = state.tracks[i];
    ++kept;
  }
  state.tracks.resize(kept);
  const auto most = static_cast<std::ptrdiff_t>(kind == TrackKind::ball ? options.max_balls : options.max_opponents);
  for (std::size_t k = 0; k < things.size(); ++k) {
    const SeenThing& thing = image.things[things[k]];
    if (is_taken[k] || (thing.team != Team::unknown && thing.team == options.own_team)) continue;
    if (std::ranges::count(state.tracks, kind, &FieldTrack::kind) >= most) break;
    state.tracks.push_back(begun(thing, image, options));
  }
}

void remember_mate(TeamState& state, const SeenImage& image) {
  const auto place = std::ranges::lower_bound(state.mates, image.robot, {}, &Mate::robot);
  const Mate mate{image.robot, image.t, image.place, image.covariance};
  if (place != state.mates.end() && place->robot == image.robot)
    *place = mate;
  else
    state.mates.insert(place, mate);
  std::erase_if(state.tracks, [&](const FieldTrack& track) {
    return track.kind == TrackKind::robot && (place_of(track) - image.place).norm() < kGhost;
  });
}

TeamThing told_thing(const FieldTrack& track, const TeamState& state, const TeamFusionOptions& options) {
  TeamThing thing;
  const Belief all = overall(track);
  thing.id = track.id;
  thing.vx = all.mean(2);
  thing.vy = all.mean(3);
  thing.covariance = all.covariance.topLeftCorner<4, 4>();
  // What all sightings of a robot have wrong alike does not average out.
  if (track.kind == TrackKind::robot)
    thing.covariance.diagonal().head<2>().array() += options.robot_common * options.robot_common;
  thing.position = {{all.mean(0), all.mean(1)}, thing.covariance.topLeftCorner<2, 2>()};
  thing.age = state.t - track.seen_at;
  for (const Witness& witness : track.known_witnesses())
    if (state.t - witness.seen_at <= options.max_age) thing.robots.push_back(witness.robot);
  std::ranges::sort(thing.robots);
  return thing;
}

}  // namespace

SeenImage seen_image(const TeamObservation& observation, const TeamFusionOptions& options) {
  SeenImage image;
  image.robot = observation.robot;
  image.stamp = observation.stamp;
  image.t = observation.t;
  if (!observation.pose || !is_usable(*observation.pose, options)) return image;
  const PoseSeen& pose = *observation.pose;
  const Eigen::Matrix3d pose_covariance =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.covariance.data());
  const Eigen::Matrix3d root = square_root((pose_covariance + pose_covariance.transpose()) / 2);
  image.has_pose = true;
  image.place = {pose.x, pose.y};
  image.covariance = (root * root.transpose()).topLeftCorner<2, 2>();
  const auto add = [&](SeenThing thing, const Gaussian2<RobotFrame>& seen) {
    if (!is_place(seen.mean.x, seen.mean.y) || !seen.covariance.allFinite() || !std::isfinite(thing.confidence)) return;
    const FieldSighting sighting = on_field(pose, {seen.mean, repaired(seen.covariance)});
    thing.evidence.place = {sighting.place.x, sighting.place.y};
    thing.evidence.noise = sighting.own;
    thing.evidence.by_error = sighting.by_pose * root;
    const Eigen::Matrix2d all = sighting.own + thing.evidence.by_error * thing.evidence.by_error.transpose();
    if (largest_sigma(all) <= max_sigma(thing.kind, options)) image.things.push_back(thing);
  };
  for (const Ball& ball : observation.balls)
    if (ball.floor)
      add({TrackKind::ball, Team::unknown, std::clamp(ball.confidence, 0., 1.), {}}, ball.floor->position);
  for (const RobotSeen& robot : observation.robots) {
    if (!robot.floor || !std::isfinite(robot.floor->width)) continue;
    // As in track: where a part is hidden the middle may be off across the line of sight by half of what is missing.
    const Eigen::Vector2d middle(robot.floor->center.x, robot.floor->center.y);
    const double half = std::min(std::abs(robot.floor->width - options.robot_width) / 2, 1.);
    const Eigen::Vector2d slack = half * Eigen::Vector2d(-middle.y(), middle.x()).stableNormalized();
    add({TrackKind::robot, robot.team, 1, {}},
        {robot.floor->center, robot.floor->nearest.covariance + slack * slack.transpose() +
                                  options.robot_common * options.robot_common * Eigen::Matrix2d::Identity()});
  }
  std::ranges::sort(image.things, {}, [](const SeenThing& thing) {
    const Evidence& e = thing.evidence;
    return std::tuple(thing.kind, -thing.confidence, e.place.x(), e.place.y(), thing.team, e.noise(0, 0), e.noise(1, 1),
                      e.noise(0, 1));
  });
  return image;
}

void advance(TeamState& state, double t, const TeamFusionOptions& options) {
  const double dt = t - state.t;
  if (!(dt > 0)) return;
  state.t = t;
  std::erase_if(state.tracks, [&](const FieldTrack& track) {
    return !(t - track.seen_at <= (track.id > 0 ? options.max_age : options.confirm_time));
  });
  for (FieldTrack& track : state.tracks) roll_on(track, dt, options);
  std::erase_if(state.tracks, [&](const FieldTrack& track) {
    return !(largest_sigma(overall(track).covariance.topLeftCorner<2, 2>()) <= max_sigma(track.kind, options));
  });
  std::erase_if(state.mates, [&](const Mate& mate) { return !(t - mate.t <= kMateMemory); });
}

void take(TeamState& state, const SeenImage& image, const TeamFusionOptions& options) {
  advance(state, image.t, options);
  if (!image.has_pose) return;
  remember_mate(state, image);
  for (const TrackKind kind : {TrackKind::ball, TrackKind::robot}) hand_out(state, image, kind, options);
  for (FieldTrack& track : state.tracks)
    if (track.id == 0 && track.support >= options.support) track.id = state.next_id++;
}

TeamWorld told(const TeamState& state, const TeamFusionOptions& options) {
  TeamWorld world;
  world.t = state.t;
  RecycledVector<const FieldTrack*> balls, robots;
  for (const FieldTrack& track : state.tracks)
    if (track.id > 0) (track.kind == TrackKind::ball ? balls : robots).push_back(&track);
  std::ranges::sort(balls, {}, [](const FieldTrack* ball) { return std::tuple(-ball->weight, ball->id); });
  std::ranges::sort(robots, {}, &FieldTrack::id);
  for (const FieldTrack* track : balls) {
    TeamBall ball{told_thing(*track, state, options), track->weight};
    if (track == balls.front())
      world.ball = std::move(ball);
    else
      world.other_balls.push_back(std::move(ball));
  }
  for (const FieldTrack* track : robots) world.opponents.push_back({told_thing(*track, state, options), track->team()});
  return world;
}

}  // namespace tassilo
