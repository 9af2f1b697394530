#include "tassilo/files/colors_history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "tassilo/files/kept_copies.h"
#include "tassilo/files/test_folder.h"

namespace tassilo {
namespace {

ColorsFile table_of(int u) {
  ColorsFile colors;
  colors.table.brightness.fill({1, 0});
  colors.table.brightness[0] = {16, 60};
  colors.table.cell(u, 128) = class_bit(ColorClass::black);
  return colors;
}

TEST(ColorsHistory, KeepsEachTableOnceNewestFirst) {
  const TestFolder folder;
  const auto file = folder / "colors.yaml";
  std::vector<FormerColors> history;
  EXPECT_TRUE(read_history(file).empty());
  EXPECT_EQ(keep_in_history(file, table_of(1), "2026-11-28T01-02-03Z", history), "2026-11-28T01-02-03Z");
  EXPECT_EQ(keep_in_history(file, table_of(2), "2026-11-28T01-02-03Z", history), "2026-11-28T01-02-03Z-2");
  EXPECT_EQ(keep_in_history(file, table_of(1), "2026-11-28T01-02-05Z", history), "2026-11-28T01-02-03Z");
  EXPECT_EQ(keep_in_history(file, table_of(3), "2026-11-28T01-02-04Z", history), "2026-11-28T01-02-04Z");
  const auto known = std::exchange(history, read_history(file));
  ASSERT_EQ(history.size(), 3u);
  for (std::size_t i = 0; i < history.size(); ++i) {
    EXPECT_EQ(known[i].id, history[i].id) << "as it would be read";
    EXPECT_TRUE(known[i].colors == history[i].colors);
  }
  EXPECT_EQ(history[0].id, "2026-11-28T01-02-04Z");
  EXPECT_TRUE(history[0].colors == table_of(3));
  EXPECT_TRUE(history[1].colors == table_of(2));
  EXPECT_TRUE(history[2].colors == table_of(1));
}

TEST(ColorsHistory, TellsOfTablesThatCannotBeRead) {
  const TestFolder folder;
  const auto file = folder / "colors.yaml";
  std::vector<FormerColors> kept;
  keep_in_history(file, table_of(1), "a", kept);
  std::filesystem::remove(folder / "colors_history/a.png");
  const auto history = read_history(file);
  ASSERT_EQ(history.size(), 1u);
  EXPECT_THAT(history[0].fault, testing::HasSubstr("a.png"));
}

TEST(ColorsHistory, TimesSortAsText) { EXPECT_THAT(time_for_names(), testing::MatchesRegex("20..-..-..T..-..-..Z")); }

}  // namespace
}  // namespace tassilo
