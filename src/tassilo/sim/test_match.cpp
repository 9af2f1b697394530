#include "tassilo/sim/test_match.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "tassilo/geometry/angle.h"
#include "tassilo/geometry/pose2.h"

namespace tassilo::test {
namespace {

WorldOptions with_seed(WorldOptions options, std::uint64_t seed) {
  options.seed = seed;
  return options;
}

}  // namespace

Match::Match(const FieldModel& field, const MatchOptions& options)
    : world_(field, with_seed(options.world, options.seed)), options_(options) {
  const auto add = [&](Team team, Players kind, int first) {
    for (int k = 0; k < (kind == Players::absent ? 0 : options.each); ++k) {
      const int id = first + k;
      world_.add(id, team);
      Seat seat;
      seat.team = team;
      seat.kind = kind;
      seat.options.is_goalkeeper = k == 0 && options.each > 1;
      seat.options.radius = field.robots.width.middle() / 2;
      seat.options.wheel_base = world_.wheel_base(id);
      EyesOptions eyes = options.eyes;
      eyes.seed = options.seed;
      seat.eyes = std::make_unique<IdealEyes>(eyes, id);
      seat.random.seed(static_cast<unsigned>(options.seed * 1000) + static_cast<unsigned>(id));
      seats_.emplace(id, std::move(seat));
    }
  };
  add(Team::cyan, options.cyan, 1);
  add(Team::magenta, options.magenta, 11);
}

void Match::step() {
  std::map<int, Scene> scenes;
  for (auto& [id, seat] : seats_) {
    if (seat.kind == Players::seeing) scenes[id] = seat.eyes->see(world_);
    if (seat.kind == Players::black) scenes[id] = seat.eyes->see_black(world_);
  }
  const auto go_on = [&](double dt) {
    std::vector<RobotCommand> commands;
    for (const auto& [id, seat] : seats_) commands.push_back({id, seat.command});
    for (const RefereeEvent& event : world_.step(dt, commands)) calls_.push_back(event);
  };
  go_on(options_.latency);
  const double t = world_.state().t;
  while (!words_.empty() && words_.front().t < t - 5) words_.pop_front();
  for (auto& [id, seat] : seats_) {
    if (seat.kind == Players::blind) {
      std::uniform_real_distribution<double> speed(-1, 1);
      if (seat.random() % 20 == 0) seat.command = {speed(seat.random), speed(seat.random), true};
      continue;
    }
    std::map<int, Teammate> mates;
    std::optional<ToldBall> ball;
    for (const Word& word : words_) {
      if (word.team != seat.team || word.t > t - options_.team_latency || !options_.is_told) continue;
      if (word.id != id) {
        mates[word.id] = word.mate;
        mates[word.id].age = t - word.t;
      }
      if (!word.ball) continue;
      // The youngest; of the same age, the surest.
      ToldBall heard = *word.ball;
      heard.age += t - word.t;
      if (!ball || heard.age + heard.position.covariance.trace() < ball->age + ball->position.covariance.trace())
        ball = heard;
    }
    std::vector<Teammate> told;
    for (const auto& [mate, word] : mates) told.push_back(word);
    const Scene& scene = scenes[id];
    PlayerInput input;
    input.id = id;
    input.team = seat.team;
    input.own_goal = world_.own_goal(seat.team);
    input.t = t;
    input.scene = &scene;
    input.field = &world_.field();
    input.ball = ball;
    input.mates = told;
    const PlayerStep played = tassilo::play(seat.state, input, seat.options);
    seat.state = played.state;
    seat.command = played.output.wheels;
    outputs_[id] = played.output;

    Word word{t, id, seat.team, {}, {}};
    word.mate.id = id;
    word.mate.is_goalkeeper = seat.options.is_goalkeeper;
    word.mate.role = played.output.role;
    if (scene.pose) {
      const auto field_from_robot = make_pose2<FieldFrame, RobotFrame>(scene.pose->x, scene.pose->y, scene.pose->theta);
      word.mate.pose = field_from_robot;
      for (const TrackSeen& track : scene.tracks) {
        if (track.kind != TrackKind::ball) continue;
        ToldBall seen;
        seen.position.mean = field_from_robot * FloorPoint{track.x, track.y};
        const double pose_share =
            scene.pose->covariance[0] + (track.x * track.x + track.y * track.y) * scene.pose->covariance[8];
        seen.position.covariance =
            (track.covariance[0] + track.covariance[5] + pose_share) / 2 * Eigen::Matrix2d::Identity();
        seen.vx = field_from_robot.cos * track.vx - field_from_robot.sin * track.vy;
        seen.vy = field_from_robot.sin * track.vx + field_from_robot.cos * track.vy;
        seen.age = track.age + t - scene.t;
        word.ball = seen;
        break;
      }
    }
    words_.push_back(word);
  }
  go_on(1 / options_.frame_rate - options_.latency);
}

void Match::play(double seconds) {
  const double until = world_.state().t + seconds;
  while (world_.state().t < until - 1e-9) step();
}

void Match::set(Team team, Players players) {
  for (auto& [id, seat] : seats_)
    if (seat.team == team) seat.kind = players;
}

std::string svg_of(const std::vector<Trace>& traces, const World& world, double panel_s) {
  const double scale = 90, margin = 0.7;
  const FieldModel& field = world.field();
  const double width = (field.length + 2 * margin) * scale, height = (field.width + 2 * margin) * scale;
  const int panels = traces.empty() ? 1 : static_cast<int>((traces.back().t - traces.front().t) / panel_s) + 1;
  const int columns = std::min(panels, 3), rows = (panels + columns - 1) / columns;
  std::ostringstream out;
  out << "<svg xmlns='http://www.w3.org/2000/svg' width='" << columns * width << "' height='" << rows * height << "'>\n"
      << "<rect width='100%' height='100%' fill='#e8efe6'/>\n";
  for (int panel = 0; panel < panels; ++panel) {
    const double left = (panel % columns) * width + width / 2, top = (panel / columns) * height + height / 2;
    const double from = traces.front().t + panel * panel_s, to = from + panel_s;
    const auto x = [&](FieldPoint p) { return left + p.x * scale; };
    const auto y = [&](FieldPoint p) { return top - p.y * scale; };
    for (const Barrier& barrier : world.barriers())
      out << "<line x1='" << x(barrier.p) << "' y1='" << y(barrier.p) << "' x2='" << x(barrier.q) << "' y2='"
          << y(barrier.q) << "' stroke='#444' stroke-width='2'/>\n";
    out << "<text x='" << left - width / 2 + 8 << "' y='" << top - height / 2 + 22 << "' font-size='20'>" << from
        << " s</text>\n";
    std::map<int, std::string> paths;
    std::string ball;
    const Trace* last = nullptr;
    const auto add = [](std::string& path, double px, double py) {
      path += std::to_string(px) + "," + std::to_string(py) + " ";
    };
    for (const Trace& trace : traces) {
      if (trace.t < from || trace.t >= to) continue;
      for (const SimRobot& robot : trace.state.robots) add(paths[robot.id], x(robot.at), y(robot.at));
      add(ball, x(trace.state.ball.at), y(trace.state.ball.at));
      last = &trace;
    }
    if (last == nullptr) continue;
    for (const SimRobot& robot : last->state.robots) {
      const char* color = robot.team == Team::cyan ? "#0090a8" : "#c02090";
      out << "<polyline points='" << paths[robot.id] << "' fill='none' stroke='" << color << "' stroke-width='1.5'/>\n"
          << "<circle cx='" << x(robot.at) << "' cy='" << y(robot.at) << "' r='" << robot.radius * scale << "' fill='"
          << color << "' fill-opacity='0.5' stroke='black'/>\n"
          << "<line x1='" << x(robot.at) << "' y1='" << y(robot.at) << "' x2='"
          << x(robot.at) + robot.radius * scale * std::cos(robot.theta) << "' y2='"
          << y(robot.at) - robot.radius * scale * std::sin(robot.theta) << "' stroke='black' stroke-width='3'/>\n";
      const auto did = last->outputs.find(robot.id);
      out << "<text x='" << x(robot.at) - 30 << "' y='" << y(robot.at) - robot.radius * scale - 3 << "' font-size='13'>"
          << robot.id << " " << (did == last->outputs.end() ? "" : did->second.action) << "</text>\n";
    }
    out << "<polyline points='" << ball << "' fill='none' stroke='#f06000' stroke-width='2' stroke-dasharray='4 3'/>\n"
        << "<circle cx='" << x(last->state.ball.at) << "' cy='" << y(last->state.ball.at) << "' r='"
        << last->state.ball.radius * scale << "' fill='#f06000'/>\n";
  }
  out << "</svg>\n";
  return out.str();
}

}  // namespace tassilo::test
