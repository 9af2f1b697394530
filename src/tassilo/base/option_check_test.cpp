#include "tassilo/base/option_check.h"

#include <gtest/gtest.h>

#include <limits>

namespace tassilo {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(OptionCheck, RefusesWhatLiesBelow) {
  EXPECT_THROW(check_above("a.b", 0, 0), Error);
  EXPECT_NO_THROW(check_above("a.b", 1e-300, 0));
  EXPECT_NO_THROW(check_at_least("a.b", 0, 0));
  EXPECT_THROW(check_at_least("a.b", -1e-300, 0), Error);
}

TEST(OptionCheck, RefusesNanAlwaysAndInfinityWhereAsked) {
  EXPECT_THROW(check_above("a.b", kNan, 0), Error);
  EXPECT_THROW(check_at_least("a.b", kNan, 0), Error);
  EXPECT_THROW(check_finite("a.b", kNan), Error);
  EXPECT_NO_THROW(check_above("a.b", kInfinity, 0));
  EXPECT_THROW(check_finite("a.b", kInfinity), Error);
}

TEST(OptionCheck, SaysWhatItIsAndMustBe) {
  try {
    check_above("line.max_gap", -1, 0);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), "line.max_gap: is -1.000000, must be > 0.000000");
  }
}

}  // namespace
}  // namespace tassilo
