#include "tassilo/files/colors_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tassilo/files/internal/test_message.h"
#include "tassilo/files/png.h"
#include "tassilo/files/test_folder.h"
#include "tassilo/files/text.h"

namespace tassilo {
namespace {

ColorsFile random_colors(unsigned seed) {
  std::mt19937 random(seed);
  ColorsFile colors;
  for (ClassBits& bits : colors.table.chroma) bits = static_cast<ClassBits>(random());
  for (BrightnessInterval& interval : colors.table.brightness) {
    interval.low = static_cast<int>(random() % 256);
    interval.high = interval.low + static_cast<int>(random() % static_cast<unsigned>(256 - interval.low));
  }
  colors.table.range = seed % 2 ? ColorRange::full : ColorRange::limited;
  if (seed % 3) std::ranges::shuffle(colors.table.priority, random);
  if (seed % 4)
    colors.trained_from = Provenance{
        "../samples: 1.yaml",
        "2026-11-22",
        {{ColorClass::red, {0.98, 1.0 / 3}}, {ColorClass::white, {std::nullopt, 1.0}}, {ColorClass::black, {}}},
        seed % 5 ? "" : "by hand, \"twice\"\nchecked",
        {{"closing_px", 7}, {"noise_margin", 1.0 / 3}},
        {{ColorClass::white, {150, 255}}, {ColorClass::blue, {0, 0}}}};
  return colors;
}

TEST(ColorsFile, WrittenTablesReadBackEqual) {
  const TestFolder folder;
  for (unsigned seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    const ColorsFile colors = random_colors(seed);
    write_colors(folder / "colors_a.yaml", colors);
    EXPECT_TRUE(read_colors(folder / "colors_a.yaml") == colors);
  }
}

// A power cut after the PNG, and before the file that names it, leaves the old table.
TEST(ColorsFile, WritingLeavesTheTableThatIsNamed) {
  const TestFolder folder;
  const auto file = folder / "colors.yaml";
  for (unsigned seed = 0; seed < 4; ++seed) {
    const TablePaths paths = table_paths(file);
    if (seed == 0) {
      EXPECT_EQ(paths.next, folder / "colors.png");
    } else {
      const ColorsFile before = random_colors(seed - 1);
      write_png_gray(paths.next, {256, 256, std::vector<std::uint8_t>(256 * 256)});
      EXPECT_TRUE(read_colors(file) == before);
    }
    write_colors(file, random_colors(seed));
    EXPECT_EQ(table_paths(file).now, paths.next);
    EXPECT_TRUE(read_colors(file) == random_colors(seed));
  }
}

// The layout is fixed by other programs that read it: column = U, row = V, bit 0 = black .. bit 7 = yellow.
TEST(ColorsFile, PictureHasUAcrossAndVDown) {
  const TestFolder folder;
  ColorsFile colors;
  colors.table.cell(100, 200) = class_bit(ColorClass::red);
  write_colors(folder / "colors.yaml", colors);
  const GrayImage image = read_png_gray(folder / "colors.png");
  ASSERT_EQ(image.width, 256);
  EXPECT_EQ(image.pixels[200 * 256 + 100], 1 << 6);
  EXPECT_EQ(std::ranges::count(image.pixels, 0), 256 * 256 - 1);
}

TEST(ColorsFile, EmptyClassesStayEmpty) {
  const TestFolder folder;
  ColorsFile colors = random_colors(0);
  colors.table.brightness[static_cast<std::size_t>(class_index(ColorClass::cyan))] = {200, 100};
  write_colors(folder / "colors.yaml", colors);
  const ColorTable read = read_colors(folder / "colors.yaml").table;
  for (int u = 0; u < 256; u += 5)
    for (int v = 0; v < 256; v += 5)
      for (int y = 0; y < 256; y += 15) EXPECT_EQ(classify(read, y, u, v), classify(colors.table, y, u, v));
}

TEST(ColorsFile, MalformedFilesAreRefused) {
  const TestFolder folder;
  ColorsFile colors;
  colors.table.cell(1, 2) = class_bit(ColorClass::black);
  colors.table.brightness.fill({1, 0});
  colors.table.brightness[0] = {16, 60};
  std::ranges::reverse(colors.table.priority);
  colors.trained_from = Provenance{"s.yaml", "2026-11-22", {{ColorClass::black, {0.5, 0.75}}}, "", {}, {}};
  const auto file = folder / "colors.yaml";
  write_colors(file, colors);
  const std::string good = read_text(file, 10000);
  write_png_gray(folder / "small.png", {16, 16, std::vector<std::uint8_t>(256)});
  write_png_rgb(folder / "rgb.png", {1, 1, {1, 2, 3}});
  const std::string names = "black, white, green, blue, cyan, magenta, red or yellow";
  struct Case {
    std::string from, to, message;
  };
  const Case cases[] = {
      {"table: colors.png\n", "", "FILE:1:1: key 'table' is missing"},
      {"colors.png", "none.png", "FOLDER/none.png: cannot be opened: No such file or directory"},
      {"colors.png", "small.png", "FOLDER/small.png: has 16x16 pixels, must have 256x256"},
      {"colors.png", "rgb.png", "FOLDER/rgb.png: is 8-bit RGB, must be 8-bit gray"},
      {"colors.png", "colors.yaml", "FILE: is no PNG file"},
      {"limited", "limit", "FILE:2:8: range is 'limit', must be limited or full"},
      {"range: limited\n", "", "FILE:1:1: key 'range' is missing"},
      {"  black: [16, 60]", "  blak: [16, 60]",
       "FILE:4:3: unknown key 'blak', must be " + names + "; did you mean black?"},
      {"[16, 60]", "[16, 260]", "FILE:4:15: brightness.black[1] is '260', must be >= 0 and <= 255"},
      {"[16, 60]", "[60, 16]", "FILE:4:10: brightness.black is [60, 16], must be [low, high]"},
      {"[16, 60]", "[16]", "FILE:4:10: brightness.black has 1 values, must have 2"},
      {"[16, 60]", "[16, 60.5]", "FILE:4:15: brightness.black[1] is '60.5', must be a whole number"},
      {"black: [16, 60]", "white: [16, 60]", "FILE:1:8: table has cells of black, but brightness.black is missing"},
      {"[black, white", "[white, white", "FILE:5:19: priority[1] is a second white, must name each class once"},
      {"[black, white", "[white", "FILE:5:11: priority has 7 values, must have 8"},
      {"recall: 0.75", "recall: 75", "FILE:10:37: trained_from.quality.black.recall is '75', must be >= 0 and <= 1"},
      {"date:", "when:", "FILE:8:3: unknown key 'when', must be samples, date, quality, notes, options or brightness"},
  };
  const auto message_with_paths = [&](std::string message) {
    if (message.starts_with("FILE")) message.replace(0, 4, file.string());
    if (message.starts_with("FOLDER")) message.replace(0, 6, folder.path().string());
    return message;
  };
  for (const Case& c : cases) {
    folder.with("colors.yaml", spoiled(good, c.from, c.to));
    EXPECT_EQ(message_of([&] { read_colors(file); }), message_with_paths(c.message));
  }
}

}  // namespace
}  // namespace tassilo
