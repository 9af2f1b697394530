#include "tassilo/base/unsigned_zero.h"

#include <gtest/gtest.h>

#include <utility>

namespace tassilo {
namespace {

TEST(UnsignedZero, TakesTheSignOfZerosOnly) {
  for (const auto& [number, text] : {std::pair{"-0", "0"},
                                     {"-0.00", "0.00"},
                                     {"0.0", "0.0"},
                                     {"-0.01", "-0.01"},
                                     {"-10", "-10"},
                                     {"-inf", "-inf"},
                                     {"", ""}})
    EXPECT_EQ(unsigned_zero(number), text);
}

}  // namespace
}  // namespace tassilo
