#include "tassilo/files/setting.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <random>

#include "tassilo/base/error.h"
#include "tassilo/files/nearest_name.h"

namespace tassilo {
namespace {

Setting setting(std::string text, bool quoted = false) { return {"a.yaml:1:2", "key", std::move(text), quoted}; }

TEST(Setting, ReadsNumbersExactly) {
  EXPECT_EQ(setting("1.5").number(), 1.5);
  EXPECT_EQ(setting(".1").number(), .1);
  EXPECT_EQ(setting("+2.").number(), 2);
  EXPECT_EQ(setting("-1e-3").number(), -1e-3);
  EXPECT_EQ(setting("-7").integer(), -7);
  EXPECT_EQ(setting("+7").integer(0, 7), 7);
  EXPECT_TRUE(setting("true").boolean());
  EXPECT_FALSE(setting("false").boolean());
  EXPECT_EQ(number_text(-0.0), "0");
  std::mt19937_64 random(1);
  for (int i = 0; i < 1000; ++i) {
    const double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    EXPECT_EQ(setting(number_text(value)).number(), value);
  }
}

TEST(Setting, SaysWhatItIsAndWhatItMustBe) {
  const std::array<std::string_view, 3> names{"skeleton", "subpixel", "none"};
  struct Case {
    std::function<void()> read;
    std::string message;
  };
  const Case cases[] = {
      {[] { setting("abc").number(); }, "key is 'abc', must be a finite number"},
      {[] { setting("1.5 m").number(); }, "key is '1.5 m', must be a finite number"},
      {[] { setting("nan").number(); }, "key is 'nan', must be a finite number"},
      {[] { setting(".inf").number(); }, "key is '.inf', must be a finite number"},
      {[] { setting("1e999").number(); }, "key is '1e999', must be a finite number"},
      {[] { setting("+-1").number(); }, "key is '+-1', must be a finite number"},
      {[] { setting("").number(); }, "key is '', must be a finite number"},
      {[] { setting("1.5", true).number(); }, "key is the text '1.5', must be a finite number"},
      {[] { setting("3").number(0, 2.5); }, "key is '3', must be >= 0 and <= 2.5"},
      {[] { setting("-1").number(0); }, "key is '-1', must be >= 0"},
      {[] { setting("0").positive(); }, "key is '0', must be > 0"},
      {[] { setting("3.0").integer(); }, "key is '3.0', must be a whole number"},
      {[] { setting("99999999999999999999").integer(); }, "key is '99999999999999999999', must be a whole number"},
      {[] { setting("300").integer(0, 255); }, "key is '300', must be >= 0 and <= 255"},
      {[] { setting("yes").boolean(); }, "key is 'yes', must be true or false"},
      {[] { setting("true", true).boolean(); }, "key is the text 'true', must be true or false"},
      {[&] { setting("skelton").choice(names); },
       "key is 'skelton', must be skeleton, subpixel or none; did you mean skeleton?"},
      {[&] { setting("zzz").choice(names); }, "key is 'zzz', must be skeleton, subpixel or none"},
      {[] { setting(std::string(100, 'x') + "\n").number(); },
       "key is '" + std::string(40, 'x') + "...', must be a finite number"},
      {[] { setting("a\nb").number(); }, "key is 'a?b', must be a finite number"},
  };
  for (const Case& c : cases) EXPECT_THAT(c.read, testing::ThrowsMessage<Error>("a.yaml:1:2: " + c.message));
}

TEST(NearestName, FindsTypingErrorsOnly) {
  const std::array<std::string_view, 3> known{"robot", "camera", "colors"};
  EXPECT_EQ(nearest_name("colours", known), "colors");
  EXPECT_EQ(nearest_name("camrea", known), "camera");
  EXPECT_EQ(nearest_name("Robot", known), "robot");
  EXPECT_EQ(nearest_name("field", known), std::nullopt);
  EXPECT_EQ(nearest_name("", known), std::nullopt);
  EXPECT_EQ(nearest_name(std::string(1000, 'r'), known), std::nullopt);
}

}  // namespace
}  // namespace tassilo
