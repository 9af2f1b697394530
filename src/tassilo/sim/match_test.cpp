// Laws of matches without pictures: the world, eyes without pictures and the players of `behavior`, joined.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "tassilo/files/field_file.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/sim/test_match.h"

namespace tassilo::test {
namespace {

FieldModel shipped(const std::string& name) {
  return read_field(std::string(TASSILO_SOURCE_DIR) + "/config/fields/" + name + ".yaml");
}
MatchOptions with_seed(std::uint64_t seed, Players magenta = Players::seeing) {
  MatchOptions options;
  options.seed = seed;
  options.magenta = magenta;
  return options;
}
/// Does a robot touch something that stands?
bool is_at_barrier(const World& world, const SimRobot& robot) {
  return std::ranges::any_of(world.barriers(), [&](const Barrier& barrier) {
    const FieldPoint along = barrier.q - barrier.p;
    const double share = std::clamp(dot(robot.at - barrier.p, along) / dot(along, along), 0., 1.);
    return distance(robot.at, barrier.p + share * along) < robot.radius + 0.01;
  });
}

TEST(Match, ATeamThatSeesScoresMoreThanOneGoalInTwoMinutesAgainstOneThatDoesNot) {
  int scored = 0, against = 0;
  constexpr int kMatches = 3;
  for (int seed = 1; seed <= kMatches; ++seed) {
    Match match(shipped("msl98"), with_seed(static_cast<std::uint64_t>(seed), Players::blind));
    match.play(120);
    scored += match.world().score().cyan;
    against += match.world().score().magenta;
  }
  EXPECT_GT(scored, kMatches);
  EXPECT_GT(scored, against);
}

TEST(Match, ATeamWithBlackFramesStopsScoring) {
  int before = 0, after = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Match match(shipped("msl98"), with_seed(seed, Players::absent));
    match.play(40);
    before += match.world().score().cyan;
    match.set(Team::cyan, Players::black);
    // What rolls already may still roll in.
    match.play(8);
    const int then = match.world().score().cyan;
    match.play(60);
    after += match.world().score().cyan - then;
  }
  EXPECT_GT(before, 4);
  EXPECT_EQ(after, 0);
}

TEST(Match, ATeamWithBlackFramesFromTheBeginningDoesNotScore) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    MatchOptions options = with_seed(seed, Players::absent);
    options.cyan = Players::black;
    Match match(shipped("msl98"), options);
    match.play(60);
    EXPECT_EQ(match.world().score(), Score{});
  }
}

TEST(Match, FieldsOfOtherSizesArePlayedToo) {
  for (const char* field : {"msl9x5", "rcj_soccer", "rcj_soccer_walls"}) {
    SCOPED_TRACE(field);
    Match match(shipped(field), with_seed(1, Players::absent));
    match.play(60);
    EXPECT_GT(match.world().score().cyan, 1);
    EXPECT_EQ(match.world().score().magenta, 0);
  }
}

TEST(Match, WithoutAWordOfItsMatesATeamStillPlays) {
  MatchOptions options = with_seed(1, Players::absent);
  options.is_told = false;
  Match match(shipped("msl98"), options);
  match.play(60);
  EXPECT_GT(match.world().score().cyan, 0);
}

TEST(Match, PoorEyesAreEnoughToPlay) {
  for (const double frame_rate : {15., 30.}) {
    SCOPED_TRACE(frame_rate);
    MatchOptions options = with_seed(1, Players::absent);
    options.frame_rate = frame_rate;
    options.latency = 0.9 / frame_rate;
    options.team_latency = 0.4;
    options.eyes.distance_sigma = 0.1;
    options.eyes.miss = 0.4;
    options.eyes.pose_sigma = 0.1;
    options.eyes.pose_sigma_deg = 5;
    options.eyes.lost_every_s = 8;
    Match match(shipped("msl98"), options);
    match.play(90);
    EXPECT_GT(match.world().score().cyan, 1);
    EXPECT_EQ(match.world().score().magenta, 0);
  }
}

TEST(Match, EitherSideIsPlayed) {
  MatchOptions options = with_seed(1, Players::absent);
  options.world.cyan_own_goal = GoalSide::plus_x;
  Match match(shipped("msl98"), options);
  match.play(60);
  EXPECT_GT(match.world().score().cyan, 1);
  EXPECT_EQ(match.world().score().magenta, 0);
}

TEST(Match, TheSameSeedIsTheSameMatch) {
  const auto end_of = [](std::uint64_t seed) {
    Match match(shipped("msl98"), with_seed(seed));
    match.play(15);
    std::vector<double> end{match.world().state().ball.at.x, match.world().state().ball.at.y};
    for (const SimRobot& robot : match.world().state().robots)
      end.insert(end.end(), {robot.at.x, robot.at.y, robot.theta});
    return end;
  };
  EXPECT_EQ(end_of(3), end_of(3));
  EXPECT_NE(end_of(3), end_of(4));
}

// What is seen when looking at a match: nobody runs into walls, nobody fidgets, goalkeepers stay at home, all get on.
TEST(Match, PlayersBehave) {
  int frames = 0, hit_wall = 0, moves_into_robot = 0;
  double far_keeper = 0, turns_changed = 0, robot_seconds = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Match match(shipped("msl98"), with_seed(seed));
    std::map<int, double> turn_before;
    for (int k = 0; k < 60 * 20; ++k) {
      match.step();
      const World& world = match.world();
      for (const SimRobot& robot : world.state().robots) {
        ++frames;
        robot_seconds += 0.05;
        hit_wall += is_at_barrier(world, robot) && std::abs(robot.speed) > 0.3;
        for (const SimRobot& other : world.state().robots)
          moves_into_robot += other.id != robot.id && distance(other.at, robot.at) < 2 * robot.radius + 0.005 &&
                              std::abs(robot.speed) > 0.3;
        const double wanted = match.outputs().at(robot.id).wheels.right - match.outputs().at(robot.id).wheels.left;
        // Turning to the other side, by what is more than a correction.
        if (std::abs(wanted) > 0.1) {
          turns_changed += wanted * turn_before[robot.id] < 0;
          turn_before[robot.id] = wanted;
        }
        if (robot.id % 10 != 1) continue;
        const double side = world.own_goal(robot.team) == GoalSide::plus_x ? 1 : -1;
        far_keeper = std::max(far_keeper, distance(robot.at, FieldPoint{side * world.field().length / 2, 0}));
      }
    }
  }
  EXPECT_LT(hit_wall, 0.005 * frames);
  EXPECT_LT(moves_into_robot, 0.03 * frames);
  EXPECT_LT(far_keeper, 0.3 * shipped("msl98").length);
  EXPECT_LT(turns_changed / robot_seconds, 1.5);
  std::printf("at walls %.2f%%, at robots %.2f%%, goalkeeper at most %.2f m off, %.2f changes of turn a second\n",
              100. * hit_wall / frames, 100. * moves_into_robot / frames, far_keeper, turns_changed / robot_seconds);
}

}  // namespace
}  // namespace tassilo::test
