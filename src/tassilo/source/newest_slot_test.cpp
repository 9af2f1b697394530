#include "tassilo/source/newest_slot.h"

#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

namespace tassilo {
namespace {

using std::chrono::milliseconds;

TEST(NewestSlot, HoldsTheNewestAndCountsTheOthers) {
  NewestSlot<int> slot;
  EXPECT_EQ(slot.take(milliseconds(0)), std::nullopt);
  for (int value = 1; value <= 3; ++value) slot.put(value);
  EXPECT_EQ(slot.take(milliseconds(0)), 3);
  EXPECT_EQ(slot.take(milliseconds(0)), std::nullopt);
  EXPECT_EQ(slot.replaced(), 2);
}

TEST(NewestSlot, LetsGoOfWhatIsReplacedOrLeft) {
  const auto value = std::make_shared<int>(1);
  {
    NewestSlot<std::shared_ptr<int>> slot;
    slot.put(value);
    slot.put(value);
    EXPECT_EQ(value.use_count(), 2);
  }
  EXPECT_EQ(value.use_count(), 1);
}

TEST(NewestSlot, EveryValueIsTakenOnceInOrderOrDropped) {
  constexpr int kValues = 20000;
  NewestSlot<int> slot;
  std::jthread writer([&] {
    for (int value = 1; value <= kValues; ++value) slot.put(value);
  });
  std::vector<int> taken;
  while (taken.empty() || taken.back() != kValues) {
    const auto value = slot.take(milliseconds(1000));
    ASSERT_TRUE(value);
    ASSERT_LT(taken.empty() ? 0 : taken.back(), *value);
    taken.push_back(*value);
  }
  EXPECT_EQ(static_cast<std::int64_t>(taken.size()) + slot.replaced(), kValues);
}

}  // namespace
}  // namespace tassilo
