#include "tassilo/files/training_draft.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tassilo/files/internal/test_message.h"

namespace tassilo {
namespace {

TEST(TrainingDraft, SamplesSurviveTheirWayToTheBrowserAndBack) {
  const std::vector<DraftSample> samples{
      {"1", ColorClass::green, std::vector<PixelPoint>{{1, 2.5}, {30, 4}, {5, 1.0 / 3}}},
      {"a \"b\"", ColorClass::no_color, PixelBox{-1, 80, 112, 90}},
      {"3", ColorClass::white, SampleStroke{{{3, 4}, {-1.5, 7}}, 2.5}},
      {"4", ColorClass::yellow, SampleMask{"/somewhere/labels.png", 8}}};
  std::string list;
  for (const DraftSample& sample : samples) list.append(list.empty() ? "" : ",").append(draft_sample_json(sample));
  const TrainingDraft draft = draft_from_json(
      R"({"version":7,"samples":[)" + list + R"(],"options":{"closing_px":7},"brightness":{"white":[150,255]}})",
      "request");
  EXPECT_EQ(draft.version, 7);
  EXPECT_EQ(draft.samples, samples);
  TrainingOptions options;
  options.closing_px = 7;
  options.brightness[static_cast<std::size_t>(class_index(ColorClass::white))] = {150, 255};
  EXPECT_EQ(draft.options, options);
}

TEST(TrainingDraft, MalformedDraftsAreRefused) {
  const std::string good = R"({"version":0,"samples":[{"image":"1","class":"red","rectangle":[0,0,4,4]}],)"
                           R"("options":{"noise_margin":2},"brightness":{"red":[20,200]}})";
  ASSERT_NO_THROW(draft_from_json(good, "request"));
  struct Case {
    std::string from, to, message;
  };
  const Case cases[] = {
      {R"("version":0,)", "", "'version' is missing"},
      {"noise_margin", "noise_margins", "options.noise_margins is no parameter of the training"},
      {R"("noise_margin":2)", R"("noise_margin":2000)", "train.noise_margin: is 2000, must be in [0, 20]"},
      {R"("noise_margin":2)", R"("closing_px":2.5)", "train.closing_px: is 2.5, must be a whole number in [1, 31]"},
      {R"({"red":[)", R"({"no_color":[)", "brightness.no_color is no class"},
      {"[20,200]", "[200,20]", "train.brightness.red: is [200, 20], must be [low, high]"},
      {R"("class":"red")", R"("class":"rot")", "samples[0].class is 'rot'"},
      {R"("rectangle":[0,0,4,4])", R"("polygon":[[0,0],[1,1]])", "samples[0].polygon has 2 values"},
      {R"("rectangle":[0,0,4,4])", R"("lasso":[[0,0],[1,1]])", "unknown key 'lasso'"},
  };
  for (const Case& c : cases)
    EXPECT_THAT(message_of([&] { draft_from_json(spoiled(good, c.from, c.to), "request"); }),
                testing::HasSubstr(c.message));
}

}  // namespace
}  // namespace tassilo
