#include "tassilo/base/error.h"

#include <gtest/gtest.h>

#include "tassilo/base/contract.h"

namespace tassilo {
namespace {

TEST(Error, NamesSubjectThenReason) {
  EXPECT_STREQ(Error("merge.min_area_px", "is 0, must be >= 1").what(), "merge.min_area_px: is 0, must be >= 1");
}

TEST(ContractDeathTest, StopsWithPromiseAndPlace) {
  expects(true, "never printed");
  EXPECT_DEATH(expects(false, "one label per key"), "broken promise: one label per key .*error_test.cpp");
}

}  // namespace
}  // namespace tassilo
