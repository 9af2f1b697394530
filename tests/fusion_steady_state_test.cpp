// Once it has seen what a match shows, the fusion of what all robots see allocates nothing more, whatever comes late:
// every call of operator new is counted.

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

#include "support/counted_new.h"
#include "tassilo/fusion/test_match.h"

namespace tassilo {
namespace {

using test::allocations;

TEST(TeamFusionSteadyState, AllocatesNothingPerObservation) {
  const test::Match match = test::play({.seed = 3, .duration = 20});
  std::size_t seen = 0;
  for (int pass = 0; pass < 3; ++pass) {
    TeamFusion fusion;
    std::mt19937 random(1);
    const auto& all = match.observations;
    for (std::size_t i = 0; i + 64 < all.size(); ++i) {
      // Every other one comes half a second late.
      const TeamObservation& one = all[i % 2 == 0 ? i : i + 64];
      const double now = all[i + 64].t;
      const std::int64_t before = allocations;
      fusion.add(one, now);
      const TeamWorld world = fusion.at(now);
      seen += world.ball.has_value() + world.opponents.size();
      if (pass > 1 && now > 3) {
        EXPECT_EQ(allocations - before, 0) << "observation " << i;
      }
    }
    EXPECT_GT(fusion.counts().replayed, 1000);
  }
  EXPECT_GT(seen, match.observations.size());
}

}  // namespace
}  // namespace tassilo
