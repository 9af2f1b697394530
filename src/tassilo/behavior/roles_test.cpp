#include "tassilo/behavior/roles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

struct Team4 {
  std::vector<Candidate> robots;
  std::optional<FieldPoint> ball;
};

Team4 random_team(std::mt19937& random) {
  std::uniform_real_distribution<double> x(-4, 4), y(-2, 2), share(0, 1);
  Team4 team;
  for (int id = 1; id <= 4; ++id) {
    Candidate c{id, id == 1, {}, {}};
    if (share(random) > 0.2) c.at = FieldPoint{x(random), y(random)};
    if (share(random) > 0.5) c.role_before = share(random) > 0.5 ? Role::striker : Role::defender;
    team.robots.push_back(c);
  }
  if (share(random) > 0.2) team.ball = FieldPoint{x(random), y(random)};
  return team;
}

TEST(Roles, WithTheSameKnowledgeThereIsOneStrikerAndEachDefenderHasARankOfItsOwn) {
  const FieldPoint own_goal{-4, 0};
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Team4 team = random_team(random);
    std::vector<Assignment> all;
    for (int id = 1; id <= 4; ++id) all.push_back(assign_role(id, team.robots, team.ball, own_goal));
    EXPECT_EQ(all[0], (Assignment{Role::goalkeeper, 0}));
    EXPECT_EQ(std::ranges::count(all, Assignment{Role::striker, 0}), 1);
    EXPECT_EQ(std::ranges::count(all, Assignment{Role::defender, 0}), 1);
    EXPECT_EQ(std::ranges::count(all, Assignment{Role::defender, 1}), 1);
    // In whatever order they are told.
    std::ranges::shuffle(team.robots, random);
    for (int id = 1; id <= 4; ++id)
      EXPECT_EQ(assign_role(id, team.robots, team.ball, own_goal), all[static_cast<std::size_t>(id - 1)]);
  }
}

TEST(Roles, TheStrikerIsWhoIsNearestFromTheSideOfItsOwnGoal) {
  const std::vector<Candidate> team{{2, false, FieldPoint{-1, 0}, {}}, {3, false, FieldPoint{0.8, 0}, {}}};
  EXPECT_EQ(assign_role(2, team, FieldPoint{0, 0}, {-4, 0}).role, Role::striker);
  EXPECT_EQ(assign_role(3, team, FieldPoint{0, 0}, {4, 0}).role, Role::striker);
}

TEST(Roles, AStrikerStaysOneUntilAnotherIsClearlyNearer) {
  std::vector<Candidate> team{{2, false, FieldPoint{-1, 0}, Role::striker},
                              {3, false, FieldPoint{-0.7, 0}, Role::defender}};
  EXPECT_EQ(assign_role(2, team, FieldPoint{0, 0}, {-4, 0}).role, Role::striker);
  team[1].at = FieldPoint{-0.3, 0};
  EXPECT_EQ(assign_role(2, team, FieldPoint{0, 0}, {-4, 0}).role, Role::defender);
}

TEST(Roles, WhoDoesNotKnowWhereItIsLeavesTheBallToOthers) {
  const std::vector<Candidate> team{{2, false, {}, {}}, {3, false, FieldPoint{3, 2}, {}}};
  EXPECT_EQ(assign_role(2, team, FieldPoint{0, 0}, {-4, 0}).role, Role::defender);
  EXPECT_EQ(assign_role(2, std::vector<Candidate>{{2, false, {}, {}}}, FieldPoint{0, 0}, {-4, 0}).role, Role::striker);
}

TEST(Roles, OptionsOutOfRangeAreRefused) {
  EXPECT_THROW(RoleOptions{.wrong_side = -1}.check(), Error);
  EXPECT_THROW(RoleOptions{.keep = -1}.check(), Error);
}

}  // namespace
}  // namespace tassilo
