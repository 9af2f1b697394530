#include "tassilo/app/sim_match.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "tassilo/app/unix_clock.h"
#include "tassilo/base/option_check.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/localize/localize.h"
#include "tassilo/message/from_scene.h"

namespace tassilo {
namespace {

constexpr int kFirstCyan = 1, kFirstMagenta = 101;
constexpr int kNobody = 77;             // is of no team
constexpr double kOdometryStep = 0.01;  // [s]
// While there is unrest: how long a robot plays on until another one leaves, and how long that is away. [s]
constexpr double kAbsenceEvery = 8, kAbsence = 6;

/// A camera as robots of that league had: 384 x 172 pixels, 83 degrees wide.
CameraModel match_camera() {
  CameraModel camera;
  camera.name = "match";
  camera.width = 384;
  camera.height = 172;
  camera.fx = 216;
  camera.fy = 177.6;
  camera.cx = 191.5;
  camera.cy = 85.5;
  camera.distortion = Division{-0.1458};
  return camera;
}
/// On a mast at the rear, so that a ball at the robot's front is still in view.
CameraMount match_mount() { return {-0.1, 0, 0.6, 0, radians(24), 0}; }

RenderOptions rendering(std::uint64_t seed) {
  RenderOptions options = fast_rendering();
  options.seed = seed;
  return options;
}

WorldOptions world_options(const SimMatchOptions& options) {
  WorldOptions world;
  world.seed = options.seed;
  world.cyan_own_goal = options.cyan_own_goal;
  return world;
}

TeamFusionOptions fusion_of(Team team) {
  TeamFusionOptions options;
  options.own_team = team;
  return options;
}

Frame black(const Frame& like) {
  const int width = like.view.width(), height = like.view.height();
  struct Planes {
    std::vector<std::uint8_t> y, u, v;
  };
  const int half = (width + 1) / 2;
  const auto planes = std::make_shared<Planes>();
  planes->y.assign(static_cast<std::size_t>(width * height), 16);
  planes->u.assign(static_cast<std::size_t>(half * height), 128);
  planes->v = planes->u;
  Frame frame = like;
  frame.view = FrameView::planar(PixelFormat::yuv422p, width, height,
                                 {planes->y.data(), planes->u.data(), planes->v.data()}, {width, half, half});
  frame.storage = planes;
  return frame;
}

std::optional<ToldBall> told(const std::optional<TeamBall>& ball) {
  if (!ball) return std::nullopt;
  return ToldBall{ball->position, ball->vx, ball->vy, ball->age};
}

}  // namespace

void SimMatchOptions::check() const {
  check_between("match.robots", robots, 1, 8);
  check_between("match.frame_rate", frame_rate, 5, 60);
  check_between("match.opponents", opponents, 0, 1);
  check_between("match.loss", loss, 0, 0.95);
  check_between("match.delay", delay_s, 0, 1);
}

SimMatch::SimMatch(const SimMatchOptions& options)
    : options_((options.check(), options)),
      world_(options.field, world_options(options)),
      camera_(match_camera()),
      mount_(match_mount()),
      renderer_(options.field, {camera_, mount_}, rendering(options.seed)),
      hall_(train_on_stills(renderer_, options.field, options.seed)),
      air_({options.loss, options.delay_s, options.seed}),
      random_(options.seed),
      clock_(unix_now()) {
  for (int i = 0; i < options_.robots; ++i) {
    world_.add(kFirstCyan + i, Team::cyan);
    world_.add(kFirstMagenta + i, Team::magenta);
  }
  for (int i = 0; i < options_.robots; ++i) {
    seat_cyan(kFirstCyan + i);
    seat_magenta(kFirstMagenta + i);
  }
  if (options_.compares_radios)
    for (const double loss : {0., 0.1, 0.3, 0.6})
      for (const double delay_s : {0., 0.1, 0.2, 0.5}) report_.radios.push_back({loss, delay_s, {}});
  benches_.push_back({MatchAir({options_.loss, options_.delay_s, options_.seed + 1}), TeamFusion(fusion_of(Team::cyan)),
                      &report_.bench});
  for (RadioFigures& radio : report_.radios)
    benches_.push_back(
        {MatchAir({radio.loss, radio.delay_s, options_.seed + 2}), TeamFusion(fusion_of(Team::cyan)), &radio.ball});
  next_absence_ = kAbsenceEvery;
}

MatchReport SimMatch::report() const {
  MatchReport report = report_;
  report.air = air_.counts();
  report.on_the_way = static_cast<std::int64_t>(air_.on_the_way());
  return report;
}

/// 0, 1, ...
int SimMatch::any_of_team() { return static_cast<int>(random_() % static_cast<unsigned>(options_.robots)); }

/// The first of each team, when it is more than one.
bool SimMatch::is_goalkeeper(int id) const { return options_.robots > 1 && (id == kFirstCyan || id == kFirstMagenta); }

void SimMatch::seat_cyan(int id) {
  Seat seat;
  seat.id = id;
  RobotSetup setup;
  setup.vision.colors = hall_.colors;
  setup.vision.field = options_.field;
  setup.vision.camera = camera_;
  setup.vision.mount = mount_;
  setup.registry = built_in_stages();
  setup.robot.id = id;
  setup.robot.team = Team::cyan;
  Vision vision(setup.vision, setup.registry);
  seat.configuration = std::make_shared<const Configuration>(Configuration{0, 0, std::move(setup), std::move(vision)});
  seat.fusion = TeamFusion(fusion_of(Team::cyan));
  seat.alone = TeamFusion(fusion_of(Team::cyan));
  seat.player = player_options(options_.field);
  seat.player.is_goalkeeper = is_goalkeeper(id);
  if (options_.bus) {
    TeamSenderOptions told;
    told.robot = id;
    told.bus = options_.bus;
    seat.sender = std::make_unique<TeamSender>(told);
    seat.sender->begin(unix_now() - clock_, false);  // the clock of all
  }
  place_by_hand(seats_.insert_or_assign(id, std::move(seat)).first->second);
}

void SimMatch::seat_magenta(int id) {
  Opponent opponent;
  EyesOptions eyes;
  eyes.seed = options_.seed;
  opponent.eyes = std::make_unique<IdealEyes>(eyes, id);
  opponent.player = player_options(options_.field);
  opponent.player.is_goalkeeper = is_goalkeeper(id);
  opponent.player.max_speed *= options_.opponents;
  opponent.player.dribble_speed *= options_.opponents;
  opponents_.insert_or_assign(id, std::move(opponent));
}

/// Somebody puts it on its place and says where that is, as well as a hand puts it.
void SimMatch::place_by_hand(Seat& seat) {
  const SimRobot* const robot = find_robot(world_.state(), seat.id);
  constexpr double sigma = 0.05, heading_sigma = 0.05;  // of a hand [m, rad]
  std::normal_distribution<double> slip(0, sigma), turn(0, heading_sigma);
  const double x = robot->at.x + slip(random_), y = robot->at.y + slip(random_), theta = robot->theta + turn(random_);
  const PoseGaussian place = gaussian_of({x, y, theta, sigma, heading_sigma});
  // Before the next image: what is known of its own time is not asked for.
  constexpr double before = 1e-3;  // [s]
  const double t = world_.state().t - before;
  seat.workspace.history.clear();
  seat.workspace.history.beliefs.add(t, belief_in(place, t));
}

/// One robot at a time is away.
void SimMatch::let_leave_and_come_back(double now) {
  if (absence_) {
    if (now < absence_->until) return;
    const bool is_cyan = absence_->id < kFirstMagenta;
    world_.add(absence_->id, is_cyan ? Team::cyan : Team::magenta);
    is_cyan ? seat_cyan(absence_->id) : seat_magenta(absence_->id);
    absence_.reset();
    ++report_.came_back;
    return;
  }
  if (now < next_absence_) return;
  std::uniform_real_distribution<double> chance(0, 1);
  const int number = any_of_team();
  const int id = number + (random_() % 2 == 0 ? kFirstCyan : kFirstMagenta);
  world_.remove(id);
  seats_.erase(id);
  opponents_.erase(id);
  air_.leave(id);
  absence_ = {id, now + kAbsence * (0.5 + chance(random_))};
  next_absence_ = absence_->until + kAbsenceEvery * (0.5 + chance(random_));
  ++report_.left;
}

void SimMatch::see_and_play(Seat& seat) {
  const double now = world_.state().t;
  Frame frame = renderer_.render(world_.state(), seat.id);
  if (options_.is_dark) frame = black(frame);
  frame.t = now;
  frame.index = frame_;
  const Scene scene = seat.configuration->vision(frame, seat.workspace, &seat.odometry);
  ++report_.images;

  // Its own image reaches it without the air.
  TeamObservation own;
  own.robot = seat.id;
  own.stamp = nanoseconds_of(ros_time(now));  // as the others are told
  own.t = now;
  own.pose = scene.pose;
  own.balls = scene.balls;
  own.robots = scene.robots;
  seat.fusion.add(own, now);
  seat.alone.add(own, now);
  seat.team_ball = seat.fusion.at(now).ball;
  note(seat, scene);

  std::vector<Teammate> mates;
  for (const auto& [id, mate] : seat.mates) {
    mates.push_back(mate);
    mates.back().age = now - seat.heard_at.at(id);
  }
  PlayerInput input;
  input.id = seat.id;
  input.team = Team::cyan;
  input.own_goal = options_.cyan_own_goal;
  input.t = now;
  input.scene = &scene;
  input.field = &options_.field;
  input.ball = told(seat.team_ball);
  input.mates = mates;
  PlayerStep step = tassilo::play(seat.state, input, seat.player);
  seat.state = std::move(step.state);
  seat.command = step.output.wheels;
  ++report_.deeds[step.output.action];
  tell(seat, scene, step.output.role);
  if (seat.sender) {
    const TeamRole role{std::string(to_string(step.output.role)), step.output.action, step.output.planning_state};
    const double latency_s = scene.timing.back().ms / 1e3;  // the camera of the match takes no time
    seat.sender->say(frame, scene, seat.workspace, seat.configuration, &seat.odometry, latency_s, role);
  }
}

/// As messages, each to each, some lost and some late.
void SimMatch::tell(const Seat& seat, const Scene& scene, Role role) {
  const auto packet = std::make_shared<const TeamPacket>(packet_of(seat.id, Team::cyan, scene, role));
  for (const auto& [id, other] : seats_)
    if (id != seat.id) air_.tell(scene.t, seat.id, id, packet);
  for (Bench& bench : benches_) bench.air.tell(scene.t, seat.id, 0, packet);
  if (options_.has_unrest) send_garbage(scene.t, seat.id, packet);
}

/// The world outside has one time: there, what is told happened just now. Where the match cannot keep up with time, or
/// is not to, its own goes another way.
void SimMatch::keep_clock(double now) {
  constexpr double off = 0.25;  // nobody minds [s]
  if (options_.is_paced && std::abs(unix_now() - now - clock_) < off) return;
  clock_ = unix_now() - now;
  for (auto& [id, seat] : seats_) seat.sender->begin(now, false);
}

/// Spoiled, mostly in the name of the robot that told it, else of another one or of one that nobody knows.
void SimMatch::send_garbage(double now, int robot, const std::shared_ptr<const TeamPacket>& packet) {
  const auto garbage = std::make_shared<const TeamPacket>(spoiled(*packet, random_));
  const int liar = random_() % 4 == 0 ? kNobody : random_() % 4 == 0 ? kFirstCyan + any_of_team() : robot;
  for (const auto& [id, other] : seats_)
    if (id != robot) air_.tell(now, liar, id, garbage);
  benches_.front().air.tell(now, liar, 0, garbage);
}

void SimMatch::count(Contribution contribution) {
  switch (contribution) {
    case Contribution::taken:
      ++report_.taken;
      break;
    case Contribution::duplicate:
      ++report_.repeated;
      break;
    case Contribution::too_late:
      ++report_.late;
      break;
    case Contribution::refused:
      ++report_.of_no_time;
      break;
  }
}

void SimMatch::hear(double now) {
  for (const auto& [to, word] : air_.hear(now)) {
    Seat& seat = seats_.at(to);
    const TeamObservation& observation = word.observation;
    const Contribution contribution = seat.fusion.add(observation, now);
    count(contribution);
    if (contribution != Contribution::taken) continue;
    double& heard_at = seat.heard_at[observation.robot];
    if (observation.t < heard_at) continue;
    heard_at = observation.t;
    Teammate& mate = seat.mates[observation.robot];
    mate.id = observation.robot;
    mate.is_goalkeeper = is_goalkeeper(observation.robot);  // agreed before the match
    mate.role = word.role;
    mate.pose.reset();
    if (observation.pose)
      mate.pose = make_pose2<FieldFrame, RobotFrame>(observation.pose->x, observation.pose->y, observation.pose->theta);
  }
}

void SimMatch::play(int id, Opponent& opponent) {
  const Scene scene = opponent.eyes->see(world_);
  PlayerInput input;
  input.id = id;
  input.team = Team::magenta;
  input.own_goal = world_.own_goal(Team::magenta);
  input.t = world_.state().t;
  input.scene = &scene;
  input.field = &options_.field;
  PlayerStep step = tassilo::play(opponent.state, input, opponent.player);
  opponent.state = std::move(step.state);
  opponent.command = step.output.wheels;
}

void SimMatch::go_on(double seconds) {
  std::vector<RobotCommand> commands;
  for (const auto& [id, seat] : seats_) commands.push_back({id, seat.command});
  for (const auto& [id, opponent] : opponents_) commands.push_back({id, opponent.command});
  bool is_kick_off = false;
  for (double left = seconds; left > 1e-9; left -= kOdometryStep) {
    for (const RefereeEvent& event : world_.step(std::min(left, kOdometryStep), commands)) {
      calls_.push_back(event);
      called_at_ = event.t;
      is_kick_off = is_kick_off || event.call == RefereeCall::kick_off;
    }
    for (auto& [id, seat] : seats_) {
      OdometrySample sample = world_.odometry(id);
      sample.t = world_.state().t;
      seat.odometry.add(sample);
    }
  }
  if (is_kick_off && world_.options().places_robots_at_kick_off)
    for (auto& [id, seat] : seats_) place_by_hand(seat);
}

void SimMatch::step() {
  if (frame_ == 0) go_on(kOdometryStep);  // odometry begins before the first image
  const double now = world_.state().t;
  if (options_.has_unrest) let_leave_and_come_back(now);
  hear(now);
  if (options_.bus) keep_clock(now);
  for (auto& [id, seat] : seats_) see_and_play(seat);
  for (auto& [id, opponent] : opponents_) play(id, opponent);
  // Those who only listen hear at once what is not late.
  for (Bench& bench : benches_)
    for (const auto& [to, word] : bench.air.hear(now)) bench.fusion.add(word.observation, now);
  note_balls(now);
  ++frame_;
  go_on(1 / options_.frame_rate);
}

void SimMatch::note(Seat& seat, const Scene& scene) {
  const SimState& truth = world_.state();
  const SimRobot* const robot = find_robot(truth, seat.id);
  constexpr double lost = 0.5;  // further off, it is somewhere else [m]
  bool is_lost = true;
  if (scene.pose) {
    const double error = std::hypot(scene.pose->x - robot->at.x, scene.pose->y - robot->at.y);
    report_.pose_errors.add(error);
    is_lost = error > lost;
  }
  if (!is_lost)
    seat.lost_since.reset();
  else if (!seat.lost_since)
    seat.lost_since = scene.t;
  if (seat.lost_since) report_.longest_lost = std::max(report_.longest_lost, scene.t - *seat.lost_since);
  const FloorPoint ball = inverse(pose_of(*robot)) * truth.ball.at;
  seat.sees_ball = false;
  for (const Ball& seen : scene.balls) {
    if (!seen.floor) continue;
    const double error = distance(seen.floor->position.mean, ball);
    if (error > MatchReport::kAnother) continue;
    report_.ball_errors.add(error);
    seat.sees_ball = true;
    return;
  }
  if (!scene.balls.empty()) ++report_.false_balls;
}

/// What everybody makes of the ball, while anybody sees it.
void SimMatch::note_balls(double t) {
  // A ball that the referee has just carried somewhere else did not roll there: nobody can know it at once.
  constexpr double carried = 1;  // [s]
  if (std::ranges::none_of(seats_, [](const auto& seat) { return seat.second.sees_ball; }) || t - called_at_ < carried)
    return;
  const auto note = [&](BallKnowledge& knowledge, const std::optional<TeamBall>& ball) {
    ++knowledge.moments;
    if (!ball) return;
    ++knowledge.known;
    const FieldPoint off = ball->position.mean - world_.state().ball.at;
    const Eigen::Vector2d e(off.x, off.y);
    knowledge.errors.add(norm(off));
    knowledge.squared.add(e.dot(ball->position.covariance.inverse() * e));
  };
  std::optional<TeamBall> surest;
  for (auto& [id, seat] : seats_) {
    note(seat.sees_ball ? report_.seeing : report_.blind, seat.team_ball);
    auto alone = seat.alone.at(t).ball;
    if (alone && (!surest || alone->position.covariance.trace() < surest->position.covariance.trace()))
      surest = std::move(alone);
  }
  note(report_.surest, surest);
  for (Bench& bench : benches_) note(*bench.figures, bench.fusion.at(t).ball);
}

std::vector<std::string> SimMatch::news() {
  std::vector<std::string> news;
  for (auto& [id, seat] : seats_)
    if (seat.sender)
      for (const std::string& line : seat.sender->news()) news.push_back(line);
  return news;
}

}  // namespace tassilo
