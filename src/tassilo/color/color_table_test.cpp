#include "tassilo/color/color_table.h"

#include <gtest/gtest.h>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

TEST(ColorClass, NamesAreReadBack) {
  for (int label = 0; label <= kColorClassCount; ++label) {
    const auto color = static_cast<ColorClass>(label);
    EXPECT_EQ(color_class_from(to_string(color)), color);
  }
  EXPECT_EQ(color_class_from("orange"), std::nullopt);
}

TEST(ColorTable, PriorityDecidesWhereClassesOverlapAndBrightnessTellsThemApart) {
  ColorTable table;
  table.brightness.fill({1, 0});
  table.brightness[static_cast<std::size_t>(class_index(ColorClass::black))] = {0, 60};
  table.brightness[static_cast<std::size_t>(class_index(ColorClass::white))] = {150, 255};
  table.brightness[static_cast<std::size_t>(class_index(ColorClass::red))] = {50, 200};
  table.cell(128, 128) = class_bit(ColorClass::black) | class_bit(ColorClass::white);
  table.cell(100, 180) = class_bit(ColorClass::red) | class_bit(ColorClass::black);
  EXPECT_EQ(classify(table, 60, 128, 128), ColorClass::black);
  EXPECT_EQ(classify(table, 61, 128, 128), ColorClass::no_color);
  EXPECT_EQ(classify(table, 150, 128, 128), ColorClass::white);
  EXPECT_EQ(classify(table, 55, 100, 180), ColorClass::red);
  EXPECT_EQ(classify(table, 40, 100, 180), ColorClass::black);
  std::swap(table.priority[0], table.priority[7]);  // black first
  EXPECT_EQ(classify(table, 55, 100, 180), ColorClass::black);
}

TEST(ColorTable, CheckNamesWhatIsWrong) {
  ColorTable table;
  EXPECT_NO_THROW(table.check());
  table.brightness[2].high = 256;
  try {
    table.check();
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "brightness.green: is [0, 256], must lie in [0, 255]");
  }
  table.brightness[2].high = 255;
  table.priority[0] = table.priority[1];
  EXPECT_THROW(table.check(), Error);
}

}  // namespace
}  // namespace tassilo
