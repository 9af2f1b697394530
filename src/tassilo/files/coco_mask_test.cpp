#include "tassilo/files/coco_mask.h"

#include <gtest/gtest.h>

#include "tassilo/files/internal/test_mask.h"
#include "tassilo/files/internal/test_message.h"
#include "tassilo/files/test_folder.h"
#include "tassilo/files/text.h"

namespace tassilo {
namespace {

using Counts = std::vector<std::uint32_t>;

/// Pixel by pixel, column by column.
Counts counts_by_definition(const CocoMask& mask) {
  Counts counts{0};
  bool inside = false;
  for (int c = 0; c < mask.width; ++c)
    for (int r = 0; r < mask.height; ++r) {
      if (contains(mask.region, c, r) != inside) {
        counts.push_back(0);
        inside = !inside;
      }
      ++counts.back();
    }
  return counts;
}

TEST(CocoMask, CountsRunDownTheColumnsAndComeBack) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    const CocoMask mask = random_mask(seed);
    const Counts counts = coco_counts(mask);
    EXPECT_EQ(counts, counts_by_definition(mask));
    EXPECT_EQ(coco_mask_from_counts({mask.width, mask.height, {}}, counts, "a"), mask);
    EXPECT_EQ(coco_counts_from_string(coco_string(counts), "a"), counts);
    for (const CocoCounts form : {CocoCounts::string, CocoCounts::list})
      EXPECT_EQ(coco_mask_from_json(coco_json(mask, form), "a"), mask);
  }
}

TEST(CocoMask, CutsWhatLiesOutside) {
  const CocoMask mask{4, 3, Region::from_box({-5, 1, 2, 90})};
  EXPECT_EQ(coco_counts(mask), (Counts{1, 2, 1, 2, 6}));
  EXPECT_EQ(coco_counts({4, 3, Region{}}), (Counts{12}));
  EXPECT_EQ(coco_counts({4, 3, Region::from_box({0, 0, 4, 3})}), (Counts{0, 12}));
}

TEST(CocoMask, StringsAreThoseOfTheFormat) {
  const std::pair<Counts, std::string> known[] = {{{}, ""},
                                                  {{2, 3, 1, 1}, "231N"},
                                                  {{0, 6, 1}, "061"},
                                                  {{0, 6, 1, 3}, "061M"},
                                                  {{0, 6, 1, 6}, "0610"},
                                                  {{0, 1024}, "0PP1"},
                                                  {{15, 16, 100}, "?`0T3"},
                                                  {{0, 1, 1, 2, 1, 3, 1, 4, 1}, "011101010"},
                                                  {{1 << 30, 0, 0, 0, 1 << 30, 1 << 30, 0}, ""}};
  for (const auto& [counts, text] : known) {
    if (!text.empty()) {
      EXPECT_EQ(coco_string(counts), text);
    }
    EXPECT_EQ(coco_counts_from_string(coco_string(counts), "a"), counts);
  }
}

TEST(CocoMask, CountsOfZeroJoinWhatTheySeparate) {
  const CocoMask mask = coco_mask_from_counts({2, 3, {}}, Counts{1, 1, 0, 2, 0, 0, 2}, "a");
  EXPECT_EQ(mask.region, Region::from_runs({{1, 0, 1}, {2, 0, 1}, {0, 1, 2}}));
}

TEST(CocoMask, FilesReadBackEqual) {
  const TestFolder folder;
  std::vector<CocoMask> masks;
  for (const CocoCounts form : {CocoCounts::string, CocoCounts::list})
    for (unsigned seed = 0; seed < 20; ++seed) {
      write_coco_masks(folder / "masks.json", masks, form);
      ASSERT_EQ(read_coco_masks(folder / "masks.json"), masks);
      masks.push_back(random_mask(seed));
    }
  write_coco_masks(folder / "one.json", std::vector{CocoMask{3, 2, Region::from_box({1, 0, 2, 2})}}, CocoCounts::list);
  EXPECT_EQ(read_text(folder / "one.json", 1000), "[\n{\"size\": [2, 3], \"counts\": [2, 2, 2]}\n]\n");
}

TEST(CocoMask, RefusesWhatIsNoMask) {
  const auto refused = [](const std::string& text) { return message_of([&] { coco_mask_from_json(text, "m.json"); }); };
  EXPECT_EQ(refused(R"({"size": [2, 3], "counts": [2, 3]})"),
            "m.json: counts add up to 5, must be height x width, 2 x 3 = 6");
  EXPECT_EQ(refused(R"({"size": [2, 3], "counts": [2, -2, 6]})"),
            "m.json: counts[1] is '-2', must be >= 0 and <= 1073741824");
  EXPECT_EQ(refused(R"({"size": [2, 3], "counts": [2, 2.5, 6]})"),
            "m.json: counts[1] is '2.5', must be a whole number");
  EXPECT_EQ(refused(R"({"size": [2, 3], "counts": 6})"),
            "m.json: counts is no text, must be a text or a list of numbers");
  EXPECT_EQ(refused(R"({"size": [2, 0], "counts": []})"), "m.json: size[1] is '0', must be >= 1 and <= 32767");
  EXPECT_EQ(refused(R"({"size": [2], "counts": []})"), "m.json: size has 1 values, must have 2");
  EXPECT_EQ(refused(R"({"size": [32767, 32767], "counts": []})"),
            "m.json: size is 1073676289 pixels, must be at most 67108864");
  EXPECT_EQ(refused(R"({"size": [2, 3]})"), "m.json: key 'counts' is missing");
  EXPECT_EQ(refused(R"({"size": [2, 3], "counts": "6", "area": 0})"),
            "m.json: unknown key 'area', must be size or counts");
  EXPECT_EQ(refused(R"({"size": [2, 3], "counts": "2p"})"), "m.json: counts, character 1: is 'p', must be '0' to 'o'");
  EXPECT_EQ(refused(R"({"size": [2, 3], "counts": "2P"})"), "m.json: counts end within a number, they are cut");
  EXPECT_EQ(refused(R"({"size": [2, 3], "counts": "2PPPPPPPP"})"),
            "m.json: counts, character 8: the number goes on, must have at most 7 characters");
  EXPECT_EQ(refused(R"({"size": [2, 3], "counts": "2N"})"),
            "m.json: counts, character 1: count 1 is -2, must be 0 to 1073741824");
  const TestFolder folder;
  const auto file = folder.with("masks.json", R"([{"size": [1, 1], "counts": "1"}, {"size": [1, 1], "counts": [2]}])");
  EXPECT_EQ(message_of([&] { read_coco_masks(file); }),
            file.string() + ": mask 1: counts add up to 2, must be height x width, 1 x 1 = 1");
}

}  // namespace
}  // namespace tassilo
