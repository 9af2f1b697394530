#include "tassilo/app/sim_match.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "tassilo/base/error.h"
#include "tassilo/color/train.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/message/from_scene.h"
#include "tassilo/message/to_scene.h"

namespace tassilo {
namespace {

constexpr int kFirstMagenta = 101;
constexpr int kBench = 0;               // hears what all tell
constexpr double kOdometryStep = 0.01;  // [s]

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
CameraMount match_mount() { return {0.06, 0, 0.52, 0, radians(14), 0}; }

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

/// Sees what the camera shows of a state and says which pixels surely are of which class: those whose neighbors are,
/// too, over the width of two chroma samples.
void take_samples(const Frame& frame, const SimView& view, int group, std::vector<ColorSample>& samples) {
  std::array<std::vector<YuvPixel>, 9> pixels;
  constexpr int reach = 2;
  for (int r = reach; r < view.height - reach; ++r)
    for (int c = reach; c < view.width - reach; ++c) {
      const auto label_at = [&](int column, int row) {
        return view.labels[static_cast<std::size_t>(row * view.width + column)];
      };
      const std::uint8_t label = label_at(c, r);
      if (label >= pixels.size()) continue;
      bool is_pure = true;
      for (int dr = -reach; dr <= reach && is_pure; ++dr)
        for (int dc = -reach; dc <= reach && is_pure; ++dc) is_pure = label_at(c + dc, r + dr) == label;
      if (is_pure) pixels[label].push_back({frame.view.y(c, r), frame.view.u(c, r), frame.view.v(c, r)});
    }
  for (std::size_t label = 0; label < pixels.size(); ++label)
    if (!pixels[label].empty()) samples.push_back({static_cast<ColorClass>(label), group, std::move(pixels[label])});
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

const SimRobot* robot_of(const SimState& state, int id) {
  const auto found = std::ranges::find(state.robots, id, &SimRobot::id);
  return found == state.robots.end() ? nullptr : &*found;
}

std::optional<ToldBall> told(const std::optional<TeamBall>& ball) {
  if (!ball) return std::nullopt;
  return ToldBall{ball->position, ball->vx, ball->vy, ball->age};
}

std::optional<Role> role_named(std::string_view name) {
  for (const Role role : {Role::goalkeeper, Role::defender, Role::striker})
    if (to_string(role) == name) return role;
  return std::nullopt;
}

}  // namespace

void SimMatchOptions::check() const {
  const auto within = [](const char* name, double value, double low, double high) {
    if (!(value >= low && value <= high))
      throw Error(std::string("match.") + name,
                  "is " + std::to_string(value) + ", must be " + std::to_string(low) + " .. " + std::to_string(high));
  };
  within("robots", robots, 1, 8);
  within("frame_rate", frame_rate, 5, 60);
  within("loss", loss, 0, 0.95);
  within("delay", delay_s, 0, 1);
}

SimMatch::SimMatch(const SimMatchOptions& options)
    : options_((options.check(), options)),
      world_(options.field, world_options(options)),
      camera_(match_camera()),
      mount_(match_mount()),
      renderer_(options.field, {camera_, mount_}, rendering(options.seed)),
      bench_(fusion_of(Team::cyan)),
      random_(options.seed) {
  train_colors();
  for (int i = 0; i < options_.robots; ++i) {
    world_.add(1 + i, Team::cyan);
    world_.add(kFirstMagenta + i, Team::magenta);
  }
  for (int i = 0; i < options_.robots; ++i) {
    seat_cyan(1 + i, i == 0 && options_.robots > 1);
    seat_magenta(kFirstMagenta + i, i == 0 && options_.robots > 1);
  }
}

/// On stills of this hall, from all over the field: what a team does in the hour before a match.
void SimMatch::train_colors() {
  constexpr int stills = 16;
  std::mt19937_64 random(options_.seed + 1);
  std::uniform_real_distribution<double> place(-0.4, 0.4), angle(-3.1, 3.1);
  std::vector<ColorSample> samples;
  for (int still = 0; still < stills; ++still) {
    SimState state;
    state.ball.radius = options_.field.ball.radius.middle();
    SimRobot eye;
    eye.id = 1;
    eye.radius = options_.field.robots.width.middle() / 2;
    eye.height = options_.field.robots.height.middle();
    eye.at = {place(random) * options_.field.length, place(random) * options_.field.width};
    // Goals are what is rarest: every other still looks at one.
    const double goal_x = still % 4 < 2 ? options_.field.length / 2 : -options_.field.length / 2;
    eye.theta = still % 2 == 0 ? std::atan2(-eye.at.y, goal_x - eye.at.x) : angle(random);
    const auto before = [&](double distance, double side) {
      return FieldPoint{eye.at.x + distance * std::cos(eye.theta) - side * std::sin(eye.theta),
                        eye.at.y + distance * std::sin(eye.theta) + side * std::cos(eye.theta)};
    };
    state.ball.at = before(0.7 + 0.08 * still, still % 3 - 1.);
    SimRobot cyan = eye, magenta = eye;
    cyan.id = 2;
    cyan.at = before(1.2, 0.5);
    magenta.id = 3;
    magenta.team = Team::magenta;
    magenta.at = before(1.3, -0.6);
    state.robots = {eye, cyan, magenta};
    const Frame frame = renderer_.render(state, eye.id);
    take_samples(frame, renderer_.look(state, eye.id), still, samples);
  }
  colors_ = tassilo::train_colors(samples, renderer_.options().range);
  std::int64_t right = 0, all = 0;
  for (const ColorSample& sample : samples)
    for (const YuvPixel& pixel : sample.pixels) {
      ++all;
      right += classify(colors_, pixel.y, pixel.u, pixel.v) == sample.color ? 1 : 0;
    }
  colors_quality_ = all > 0 ? static_cast<double>(right) / static_cast<double>(all) : 0;
}

void SimMatch::seat_cyan(int id, bool is_goalkeeper) {
  Seat seat;
  seat.id = id;
  RobotSetup setup;
  setup.vision.colors = colors_;
  setup.vision.field = options_.field;
  setup.vision.camera = camera_;
  setup.vision.mount = mount_;
  setup.registry = built_in_stages();
  setup.robot.id = id;
  setup.robot.team = Team::cyan;
  // Where it was put is known, as well as a hand puts it.
  const SimRobot* const robot = robot_of(world_.state(), id);
  setup.vision.start_pose = gaussian_of({robot->at.x, robot->at.y, robot->theta, 0.1, 0.1});
  Vision vision(setup.vision, setup.registry);
  seat.configuration = std::make_shared<const Configuration>(Configuration{0, 0, std::move(setup), std::move(vision)});
  seat.fusion = TeamFusion(fusion_of(Team::cyan));
  seat.player.is_goalkeeper = is_goalkeeper;
  seat.player.radius = options_.field.robots.width.middle() / 2;
  seat.player.wheel_base = world_.wheel_base(id);
  if (options_.bus) {
    TeamSenderOptions told;
    told.robot = id;
    told.bus = options_.bus;
    seat.sender = std::make_unique<TeamSender>(told);
    seat.sender->begin(0, false);
  }
  seats_.emplace(id, std::move(seat));
}

void SimMatch::seat_magenta(int id, bool is_goalkeeper) {
  Opponent opponent;
  EyesOptions eyes;
  eyes.seed = options_.seed;
  opponent.eyes = std::make_unique<IdealEyes>(eyes, id);
  opponent.player.is_goalkeeper = is_goalkeeper;
  opponent.player.radius = options_.field.robots.width.middle() / 2;
  opponent.player.wheel_base = world_.wheel_base(id);
  opponents_.emplace(id, std::move(opponent));
}

void SimMatch::see_and_play(Seat& seat) {
  const double now = world_.state().t;
  Frame frame = renderer_.render(world_.state(), seat.id);
  if (options_.is_dark) frame = black(frame);
  frame.t = now;
  frame.index = frame_;
  const Scene scene = seat.configuration->vision(frame, seat.workspace, &seat.odometry);
  ++report_.images;
  note(seat, scene);

  // Its own image reaches it without the air.
  TeamObservation own;
  own.robot = seat.id;
  own.stamp = static_cast<std::int64_t>(now * 1e9);
  own.t = now;
  own.pose = scene.pose;
  own.balls = scene.balls;
  own.robots = scene.robots;
  seat.fusion.add(own, now);
  const TeamWorld team = seat.fusion.at(now);

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
  input.ball = told(team.ball);
  input.mates = mates;
  PlayerStep step = tassilo::play(seat.state, input, seat.player);
  seat.state = std::move(step.state);
  seat.command = step.output.wheels;
  tell(seat, scene, step.output);
  if (seat.sender) {
    const TeamRole role{std::string(to_string(step.output.role)), step.output.action, step.output.planning_state};
    seat.sender->say(frame, scene, seat.workspace, seat.configuration, &seat.odometry, std::nullopt, role);
  }
}

/// As messages, each to each, some lost and some late.
void SimMatch::tell(Seat& seat, const Scene& scene, const PlayerOutput& output) {
  const MessageContext context{.robot = seat.id, .team = Team::cyan};
  const ros::Time stamp = ros_time(scene.t);
  Packet packet;
  packet.from = seat.id;
  if (scene.pose) packet.pose = encoded(pose_message(*scene.pose, stamp));
  packet.balls = encoded(balls_message(scene, stamp, context));
  packet.robots = encoded(robots_message(scene, stamp, context));
  msgs::TeamState state = team_state_message(scene, stamp, context);
  state.role = to_string(output.role);
  state.action = output.action;
  state.planning_state = output.planning_state;
  packet.state = encoded(state);
  std::uniform_real_distribution<double> chance(0, 1);
  const auto send = [&](int to) {
    if (chance(random_) < options_.loss) return;
    packet.to = to;
    packet.due = scene.t + 2 * options_.delay_s * chance(random_);
    air_.push_back(packet);
  };
  for (const auto& [id, other] : seats_)
    if (id != seat.id) send(id);
  send(kBench);
}

void SimMatch::hear(double now) {
  for (const Packet& packet : air_) {
    if (packet.due > now) continue;
    const auto state = decoded<msgs::TeamState>(packet.state);
    const auto balls = decoded<msgs::BallArray>(packet.balls);
    const auto robots = decoded<msgs::RobotArray>(packet.robots);
    if (!state || !balls || !robots) continue;
    TeamObservation observation;
    observation.robot = packet.from;
    observation.t = seconds_of(state->header.stamp);
    observation.stamp = static_cast<std::int64_t>(observation.t * 1e9);
    if (const auto pose = decoded<ros::PoseWithCovarianceStamped>(packet.pose); pose && !packet.pose.empty()) {
      observation.pose = pose_from(*pose);
      observation.pose->kind = pose_kind_from(state->pose_kind).value_or(PoseKind::start);
      observation.pose->age = state->pose_age;
      observation.pose->mirror = state->pose_is_mirrored;
    }
    observation.balls = balls_from(*balls);
    observation.robots = robots_from(*robots);
    if (packet.to == kBench) {
      bench_.add(observation, now);
      continue;
    }
    Seat& seat = seats_.at(packet.to);
    seat.fusion.add(observation, now);
    double& heard_at = seat.heard_at[packet.from];
    if (observation.t < heard_at) continue;
    heard_at = observation.t;
    Teammate& mate = seat.mates[packet.from];
    mate.id = packet.from;
    mate.is_goalkeeper = seats_.at(packet.from).player.is_goalkeeper;  // agreed before the match
    mate.role = role_named(state->role);
    mate.pose.reset();
    if (observation.pose)
      mate.pose = make_pose2<FieldFrame, RobotFrame>(observation.pose->x, observation.pose->y, observation.pose->theta);
  }
  std::erase_if(air_, [&](const Packet& packet) { return packet.due <= now; });
}

void SimMatch::play(int id, Opponent& opponent) {
  const Scene scene = opponent.eyes->see(world_);
  PlayerInput input;
  input.id = id;
  input.team = Team::magenta;
  input.own_goal = options_.cyan_own_goal == GoalSide::minus_x ? GoalSide::plus_x : GoalSide::minus_x;
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
  for (double left = seconds; left > 1e-9; left -= kOdometryStep) {
    for (const RefereeEvent& event : world_.step(std::min(left, kOdometryStep), commands)) calls_.push_back(event);
    for (auto& [id, seat] : seats_) {
      OdometrySample sample = world_.odometry(id);
      sample.t = world_.state().t;
      seat.odometry.add(sample);
    }
  }
}

void SimMatch::step() {
  if (frame_ == 0) go_on(kOdometryStep);  // odometry begins before the first image
  const double now = world_.state().t;
  sightings_.clear();
  hear(now);
  for (auto& [id, seat] : seats_) see_and_play(seat);
  for (auto& [id, opponent] : opponents_) play(id, opponent);
  note_team(now);
  ++frame_;
  go_on(1 / options_.frame_rate);
  report_.seconds = world_.state().t;
  report_.score = world_.score();
}

void SimMatch::note(Seat& seat, const Scene& scene) {
  const SimState& truth = world_.state();
  const SimRobot* const robot = robot_of(truth, seat.id);
  const auto field_from_robot = make_pose2<FieldFrame, RobotFrame>(robot->at.x, robot->at.y, robot->theta);
  constexpr double lost = 0.5;  // further off, it is somewhere else [m]
  bool is_lost = true;
  if (scene.pose) {
    const double error = std::hypot(scene.pose->x - robot->at.x, scene.pose->y - robot->at.y);
    report_.pose_errors.push_back(error);
    is_lost = error > lost;
  }
  if (!is_lost)
    seat.lost_since.reset();
  else if (!seat.lost_since)
    seat.lost_since = scene.t;
  if (seat.lost_since) report_.longest_lost = std::max(report_.longest_lost, scene.t - *seat.lost_since);
  const FloorPoint ball = inverse(field_from_robot) * truth.ball.at;
  for (const Ball& seen : scene.balls) {
    if (!seen.floor) continue;
    const double error = distance(seen.floor->position.mean, ball);
    constexpr double another = 0.5;  // further off, it is not this ball but none [m]
    if (error > another) continue;
    report_.ball_errors.push_back(error);
    if (scene.pose) {
      const auto believed = make_pose2<FieldFrame, RobotFrame>(scene.pose->x, scene.pose->y, scene.pose->theta);
      sightings_.push_back(
          {seen.floor->position.covariance.trace(), distance(believed * seen.floor->position.mean, truth.ball.at)});
    }
    break;
  }
}

/// The team's ball as the bench knows it, against the sighting that is surest by its own account.
void SimMatch::note_team(double t) {
  if (sightings_.empty()) return;
  ++report_.seen;
  const TeamWorld team = bench_.at(t);
  if (!team.ball) return;
  ++report_.known;
  const FieldPoint off = team.ball->position.mean - world_.state().ball.at;
  report_.team_errors.push_back(norm(off));
  report_.best_errors.push_back(std::ranges::min_element(sightings_, {}, &Sighting::variance)->error);
  const Eigen::Vector2d e(off.x, off.y);
  report_.nees.push_back(e.dot(team.ball->position.covariance.inverse() * e));
}

std::vector<std::string> SimMatch::news() {
  std::vector<std::string> news;
  for (auto& [id, seat] : seats_)
    if (seat.sender)
      for (const std::string& line : seat.sender->news()) news.push_back(line);
  return news;
}

}  // namespace tassilo
