#include "tassilo/app/sim_match.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <type_traits>

#include "tassilo/base/option_check.h"
#include "tassilo/color/quality.h"
#include "tassilo/color/train.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/message/from_scene.h"
#include "tassilo/message/to_scene.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/raster.h"

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

/// Pixels that surely are of a class: those whose neighbors are, too, over the width of two chroma samples.
void take_samples(const Frame& frame, const SimView& view, int group, std::vector<ColorSample>& samples) {
  const ByteView labels{view.labels.data(), view.width, view.height, view.width};
  for (int label = 0; label <= kColorClassCount; ++label) {
    const Region region = region_where(labels, [&](int value) { return value == label; });
    std::vector<YuvPixel> pixels = pixels_of(frame.view, erosion(region, rectangle(5, 5)));
    if (!pixels.empty()) samples.push_back({static_cast<ColorClass>(label), group, std::move(pixels)});
  }
}

/// Share of the samples' pixels that a table of the other stills classifies right.
double quality_of(const std::vector<ColorSample>& samples, ColorRange range) {
  const ColorQuality quality = cross_validate(samples, range);
  std::int64_t right = 0, all = 0;
  for (std::size_t label = 0; label < quality.confusion.size(); ++label) {
    right += quality.confusion[label][label];
    for (const std::int64_t pixels : quality.confusion[label]) all += pixels;
  }
  return all > 0 ? static_cast<double>(right) / static_cast<double>(all) : 0;
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
  check_between("match.loss", loss, 0, 0.95);
  check_between("match.delay", delay_s, 0, 1);
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
  colors_quality_ = quality_of(samples, renderer_.options().range);
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
  const SimRobot* const robot = find_robot(world_.state(), id);
  setup.vision.start_pose = gaussian_of({robot->at.x, robot->at.y, robot->theta, 0.1, 0.1});
  Vision vision(setup.vision, setup.registry);
  seat.configuration = std::make_shared<const Configuration>(Configuration{0, 0, std::move(setup), std::move(vision)});
  seat.fusion = TeamFusion(fusion_of(Team::cyan));
  seat.player = player_options(options_.field);
  seat.player.is_goalkeeper = is_goalkeeper;
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
  opponent.player = player_options(options_.field);
  opponent.player.is_goalkeeper = is_goalkeeper;
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
  const auto word = std::make_shared<const Word>(word_of(seat.id, scene, output));
  std::uniform_real_distribution<double> chance(0, 1);
  const auto send = [&](int to) {
    if (chance(random_) < options_.loss) return;
    air_.push_back({scene.t + 2 * options_.delay_s * chance(random_), to, word});
  };
  for (const auto& [id, other] : seats_)
    if (id != seat.id) send(id);
  send(kBench);
}

/// What is left of it when it has been told: everybody reads the same bytes.
SimMatch::Word SimMatch::word_of(int robot, const Scene& scene, const PlayerOutput& output) {
  const MessageContext context{.robot = robot, .team = Team::cyan};
  const ros::Time stamp = ros_time(scene.t);
  const auto over_the_air = [](const auto& message) {
    return *decoded<std::remove_cvref_t<decltype(message)>>(encoded(message));
  };
  const msgs::TeamState state = over_the_air(team_state_message(scene, stamp, context));
  Word word;
  word.role = output.role;
  word.observation.robot = robot;
  word.observation.t = seconds_of(state.header.stamp);
  word.observation.stamp = static_cast<std::int64_t>(word.observation.t * 1e9);
  if (scene.pose) {
    word.observation.pose = pose_from(over_the_air(pose_message(*scene.pose, stamp)));
    add_state(*word.observation.pose, state);
  }
  word.observation.balls = balls_from(over_the_air(balls_message(scene, stamp, context)));
  word.observation.robots = robots_from(over_the_air(robots_message(scene, stamp, context)));
  return word;
}

void SimMatch::hear(double now) {
  for (const Packet& packet : air_) {
    if (packet.due > now) continue;
    const TeamObservation& observation = packet.word->observation;
    if (packet.to == kBench) {
      bench_.add(observation, now);
      continue;
    }
    Seat& seat = seats_.at(packet.to);
    seat.fusion.add(observation, now);
    double& heard_at = seat.heard_at[observation.robot];
    if (observation.t < heard_at) continue;
    heard_at = observation.t;
    Teammate& mate = seat.mates[observation.robot];
    mate.id = observation.robot;
    mate.is_goalkeeper = seats_.at(observation.robot).player.is_goalkeeper;  // agreed before the match
    mate.role = packet.word->role;
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
  const SimRobot* const robot = find_robot(truth, seat.id);
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
  const FloorPoint ball = inverse(pose_of(*robot)) * truth.ball.at;
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
  // A ball that the referee has just carried somewhere else did not roll there: nobody can know it at once.
  constexpr double carried = 1;  // [s]
  if (sightings_.empty() || (!calls_.empty() && t - calls_.back().t < carried)) return;
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
