#include "tassilo/files/samples_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tassilo/files/internal/test_data.h"
#include "tassilo/files/internal/test_message.h"
#include "tassilo/files/test_folder.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

const std::string kSamples = R"(# drawn by hand
- {image: stills.mkv, frame: 3, class: green, polygon: [[1, 2.5], [30, 4], [5, 60]]}
- {image: a/photo.png, class: red, rectangle: [-1, 80, 112, 90]}
- image: stills.mkv
  class: no_color
  mask: labels.png
  value: 3
- {image: a/photo.png, class: white, stroke: [[3, 4], [-1.5, 7]], radius: 2.5}
)";

TEST(SamplesFile, ReadsAllShapes) {
  const auto samples = samples_from_yaml(kSamples, "data/samples.yaml");
  ASSERT_EQ(samples.size(), 4u);
  EXPECT_EQ(samples[0].image, "data/stills.mkv");
  EXPECT_EQ(samples[0].frame, 3);
  EXPECT_EQ(samples[0].color, ColorClass::green);
  EXPECT_EQ(samples[0].line, 2);
  EXPECT_EQ(std::get<std::vector<PixelPoint>>(samples[0].shape), (std::vector<PixelPoint>{{1, 2.5}, {30, 4}, {5, 60}}));
  EXPECT_EQ(samples[1].frame, 0);
  EXPECT_EQ(std::get<PixelBox>(samples[1].shape), (PixelBox{-1, 80, 112, 90}));
  EXPECT_EQ(samples[2].color, ColorClass::no_color);
  EXPECT_EQ(samples[2].line, 4);
  EXPECT_EQ(std::get<SampleMask>(samples[2].shape), (SampleMask{"data/labels.png", 3}));
  EXPECT_EQ(std::get<SampleStroke>(samples[3].shape), (SampleStroke{{{3, 4}, {-1.5, 7}}, 2.5}));
}

TEST(SamplesFile, WrittenSamplesReadBackEqualFromAnotherFolder) {
  const TestFolder folder;
  fs::create_directories(folder / "out put");
  auto samples = samples_from_yaml(kSamples, folder / "samples.yaml");
  samples.push_back({"/abs/im, age.png", 7, ColorClass::blue, PixelBox{0, 0, 1, 1}, 0});
  write_samples(folder / "out put/s.yaml", samples);
  const auto read = read_samples(folder / "out put/s.yaml");
  ASSERT_EQ(read.size(), samples.size());
  const auto same_file = [](const fs::path& a, const fs::path& b) {
    return a.lexically_normal() == b.lexically_normal();
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_TRUE(same_file(read[i].image, samples[i].image)) << read[i].image;
    EXPECT_EQ(read[i].frame, samples[i].frame);
    EXPECT_EQ(read[i].color, samples[i].color);
    ASSERT_EQ(read[i].shape.index(), samples[i].shape.index());
    if (const auto* mask = std::get_if<SampleMask>(&samples[i].shape)) {
      EXPECT_TRUE(same_file(std::get<SampleMask>(read[i].shape).path, mask->path));
      EXPECT_EQ(std::get<SampleMask>(read[i].shape).value, mask->value);
    } else {
      EXPECT_EQ(read[i].shape, samples[i].shape);
    }
  }
  write_samples(folder / "none.yaml", {});
  EXPECT_TRUE(read_samples(folder / "none.yaml").empty());
}

TEST(SamplesFile, MalformedFilesAreRefused) {
  struct Case {
    std::string from, to, message;
  };
  const std::string keys = "image, frame, class, rectangle, polygon, stroke, radius, mask or value";
  const Case cases[] = {
      {"polygon:", "poligon:", "s:2:47: unknown key 'poligon', must be " + keys + "; did you mean polygon?"},
      {"frame: 3", "frame: -3", "s:2:30: [0].frame is '-3', must be >= 0"},
      {"class: green", "class: gren",
       "s:2:40: [0].class is 'gren', must be no_color, black, white, green, blue, cyan, magenta, red or yellow; did "
       "you mean green?"},
      {"class: green, ", "", "s:2:3: key '[0].class' is missing"},
      {", [5, 60]", "", "s:2:56: [0].polygon has 2 values, must have 3 to 10000"},
      {"[5, 60]", "[5, 60, 7]", "s:2:76: [0].polygon[2] has 3 values, must have 2"},
      {"[5, 60]", "[5, 1e9]", "s:2:80: [0].polygon[2][1] is '1e9', must be >= -32000 and <= 32000"},
      {"[-1, 80, 112, 90]", "[-1, 80, -1, 90]",
       "s:3:47: [1].rectangle is empty, must be [x0, y0, x1, y1] with x0 < x1 and y0 < y1"},
      {"[-1, 80, 112, 90]", "[-1, 80, 11.5, 90]", "s:3:56: [1].rectangle[2] is '11.5', must be a whole number"},
      {", rectangle: [-1, 80, 112, 90]", "", "s:3:3: [1] must have one of rectangle, polygon, stroke or mask"},
      {"  mask: labels.png", "  rectangle: [1, 2, 3, 4]", "s:7:10: [2].value stands without a mask, must go with one"},
      {"  value: 3\n", "", "s:4:3: key '[2].value' is missing"},
      {"  value: 3\n", "  value: 256\n", "s:7:10: [2].value is '256', must be >= 0 and <= 255"},
      {"  value: 3\n", "  value: 3\n  polygon: [[1, 2], [3, 4], [5, 6]]\n",
       "s:4:3: [2] must have one of rectangle, polygon, stroke or mask"},
      {", radius: 2.5", "", "s:8:3: key '[3].radius' is missing"},
      {"radius: 2.5", "radius: -1", "s:8:75: [3].radius is '-1', must be >= 0 and <= 1000"},
      {"stroke: [[3, 4], [-1.5, 7]]", "rectangle: [1, 2, 3, 4]",
       "s:8:71: [3].radius stands without a stroke, must go with one"},
  };
  for (const Case& c : cases)
    EXPECT_THAT(message_of([&] { samples_from_yaml(spoiled(kSamples, c.from, c.to), "s"); }),
                testing::StartsWith(c.message));
  EXPECT_EQ(message_of([] { samples_from_yaml("image: a.png", "s"); }), "s:1:1: is a map, must be a list");
}

TEST(SamplesFile, SharedSamplesLoad) {
  if (!fs::exists(shared_data())) GTEST_SKIP() << "../shared/data is not there";
  for (const char* name : {"samples.yaml", "samples_mask.yaml"})
    for (const fs::path& file : files_named(shared_data(), name)) {
      SCOPED_TRACE(file);
      const auto samples = read_samples(file);
      EXPECT_FALSE(samples.empty());
      for (const TrainingSample& sample : samples) EXPECT_TRUE(fs::exists(sample.image)) << sample.image;
    }
}

}  // namespace
}  // namespace tassilo
