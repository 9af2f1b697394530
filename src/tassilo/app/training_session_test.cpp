#include "tassilo/app/training_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <random>

#include "tassilo/app/frame_bytes.h"
#include "tassilo/app/training.h"
#include "tassilo/base/error.h"
#include "tassilo/files/test_folder.h"
#include "tassilo/files/text.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Left half one color, right half another, with a little noise.
std::shared_ptr<const std::string> picture(std::int64_t index) {
  std::mt19937 random(static_cast<unsigned>(index));
  FrameBuffer buffer = make_frame_buffer(PixelFormat::yuv422p, 64, 32, ColorRange::limited);
  const auto around = [&](int value) { return static_cast<std::uint8_t>(value - 2 + static_cast<int>(random() % 5)); };
  for (int r = 0; r < 32; ++r) {
    for (int c = 0; c < 64; ++c) buffer.planes[0][r * 64 + c] = around(c < 32 ? 110 : 160);
    for (int c = 0; c < 32; ++c) {
      buffer.planes[1][r * 32 + c] = around(c < 16 ? 110 : 80);
      buffer.planes[2][r * 32 + c] = around(c < 16 ? 100 : 180);
    }
  }
  buffer.frame.index = index;
  return std::make_shared<const std::string>(frame_bytes(buffer.frame));
}

TrainingDraft two_colors(std::int64_t version, const std::string& image) {
  TrainingDraft draft;
  draft.version = version;
  draft.samples = {{image, ColorClass::green, PixelBox{2, 2, 28, 30}},
                   {image, ColorClass::red, std::vector<PixelPoint>{{36, 2}, {60, 2}, {60, 30}, {36, 30}}},
                   {image, ColorClass::red, SampleStroke{{{40, 8}, {50, 20}}, 3.5}}};
  return draft;
}

std::string message_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(TrainingSession, ADraftIsTrainedSavedAndReadBack) {
  const TestFolder folder;
  const TrainingFiles files = training_files(folder / "colors.yaml", {});
  ColorTable table;
  {
    TrainingSession session(files, ColorRange::limited);
    EXPECT_EQ(session.state().refusal, "");
    const auto first = session.add_image(picture(7));
    const auto second = session.add_image(picture(8));
    session.add_image(picture(9));  // without samples: not written
    TrainingDraft draft = two_colors(0, first.id);
    draft.samples.push_back({second.id, ColorClass::green, PixelBox{0, 0, 20, 20}});
    draft.options.closing_px = 7;
    draft.options.brightness[static_cast<std::size_t>(class_index(ColorClass::red))] = {100, 220};
    const auto result = session.set_draft(draft);
    EXPECT_EQ(result.version, 1);
    table = result.table;
    EXPECT_EQ(classify(table, 110, 110, 100), ColorClass::green);
    EXPECT_EQ(classify(table, 160, 80, 180), ColorClass::red);
    EXPECT_FALSE(session.state().is_saved);
    session.save(1, "a note");
    EXPECT_TRUE(session.state().is_saved);
  }
  const ColorsFile saved = read_colors(files.colors);
  EXPECT_EQ(saved.table.chroma, table.chroma);
  EXPECT_EQ(saved.trained_from->samples, "samples.yaml");
  EXPECT_THAT(saved.trained_from->notes, testing::StartsWith("a note; cross-validated"));

  // The command line makes the same table of the same file.
  const auto ignore = [](const std::string&, const std::string&) {};
  const LoadedSamples loaded = load_samples(files.samples.string(), ColorRange::limited, ignore);
  TrainingOptions options;
  options.closing_px = 7;
  options.brightness[static_cast<std::size_t>(class_index(ColorClass::red))] = {100, 220};
  EXPECT_EQ(train_colors_file({"samples.yaml", loaded}, nullptr, options, ignore).file.table, saved.table);

  TrainingSession again(files, ColorRange::limited);
  const auto state = again.state();
  EXPECT_EQ(state.refusal, "");
  EXPECT_EQ(state.images.size(), 2u);
  EXPECT_EQ(state.samples.size(), 4u);
  EXPECT_EQ(state.options, options);
  EXPECT_EQ(again.result().table.chroma, table.chroma);
  ASSERT_EQ(state.history.size(), 1u);
  EXPECT_TRUE(state.history[0].colors == saved);
}

TEST(TrainingSession, FormerTablesComeBack) {
  const TestFolder folder;
  const TrainingFiles files = training_files(folder / "colors.yaml", {});
  TrainingSession session(files, ColorRange::limited);
  const auto image = session.add_image(picture(1));
  session.set_draft(two_colors(0, image.id));
  session.save(1, "");
  const ColorsFile first = read_colors(files.colors);
  TrainingDraft draft = two_colors(1, image.id);
  draft.options.noise_margin = 9;
  session.set_draft(draft);
  session.save(2, "");
  ASSERT_EQ(session.state().history.size(), 2u);
  const std::string id = session.state().history[1].id;
  EXPECT_TRUE(session.restore(id));
  EXPECT_TRUE(read_colors(files.colors) == first);
  EXPECT_EQ(session.state().history.size(), 2u);  // the one before is still there
  EXPECT_FALSE(session.restore("../colors"));
}

TEST(TrainingSession, NobodysWorkIsUndoneByAnother) {
  const TestFolder folder;
  const TrainingFiles files = training_files(folder / "colors.yaml", folder / "mine.yaml");
  TrainingSession session(files, ColorRange::limited);
  const auto image = session.add_image(picture(1));
  session.set_draft(two_colors(0, image.id));
  EXPECT_THAT(message_of([&] { session.set_draft(two_colors(0, image.id)); }), HasSubstr("must be of version 1"));
  EXPECT_THAT(message_of([&] { session.save(0, ""); }), HasSubstr("somebody else changed it"));
  EXPECT_THAT(message_of([&] { session.remove_image(image.id); }), HasSubstr("has samples"));
  EXPECT_THAT(message_of([&] { session.set_draft(two_colors(1, "17")); }), HasSubstr("image '17'"));
  TrainingDraft mask = two_colors(1, image.id);
  mask.samples.push_back({image.id, ColorClass::red, SampleMask{"/etc/passwd", 1}});
  EXPECT_THAT(message_of([&] { session.set_draft(mask); }), HasSubstr("must be drawn"));
  EXPECT_EQ(session.result().version, 1);
  session.save(1, "");
  // Written by hand meanwhile: both are kept.
  std::ofstream(files.samples) << "# by hand\n[]\n";
  session.save(1, "");
  int by_hand = 0;
  for (const auto& entry : fs::directory_iterator(files.samples.parent_path()))
    by_hand += entry.path().filename().string().starts_with("mine_2") && !entry.is_directory() &&
               read_text(entry.path(), 1000) == "# by hand\n[]\n";
  EXPECT_EQ(by_hand, 1);
}

// What is written can be read again, and what is too much is refused before anything is.
TEST(TrainingSession, DraftsAreBounded) {
  const TestFolder folder;
  TrainingSession session(training_files(folder / "colors.yaml", {}), ColorRange::limited);
  const auto image = session.add_image(picture(1));
  TrainingDraft draft = two_colors(0, image.id);
  draft.samples.assign(20'000'000 / (64 * 32) + 1, {image.id, ColorClass::green, PixelBox{0, 0, 64, 32}});
  EXPECT_THAT(message_of([&] { session.set_draft(draft); }), HasSubstr("must have at most 20000000"));
  draft.samples.assign(100, {image.id, ColorClass::green, std::vector<PixelPoint>(900, {1. / 3, 2. / 3})});
  session.set_draft(draft);
  EXPECT_THAT(message_of([&] { session.save(1, ""); }),
              testing::AnyOf(HasSubstr("to be read again"), HasSubstr("no sample")));
  EXPECT_FALSE(fs::exists(folder / "samples.yaml"));
}

TEST(TrainingSession, WhatIsReplacedIsKept) {
  const TestFolder folder;
  const TrainingFiles files = training_files(folder / "colors.yaml", {});
  TrainingSession session(files, ColorRange::limited);
  const auto image = session.add_image(picture(1));
  session.set_draft(two_colors(0, image.id));
  session.save(1, "");
  const std::string first = read_text(files.samples, 10000);
  TrainingDraft one = two_colors(1, image.id);
  one.samples.resize(1);
  EXPECT_THAT(session.set_draft(one).warnings, testing::Contains(HasSubstr("has red, of which there is no sample")));
  session.save(2, "");
  std::vector<fs::path> kept;
  for (const auto& entry : fs::directory_iterator(folder / "samples_history")) kept.push_back(entry.path());
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(read_samples(kept[0]).size(), 3u);
  EXPECT_TRUE(fs::exists(read_samples(kept[0])[0].image));
  // A broken table is put aside, and another taken in its place.
  std::ofstream(files.colors) << "range: ful\n";
  EXPECT_TRUE(session.restore(session.state().history.back().id));
  EXPECT_NO_THROW(read_colors(files.colors));
}

// What could not be read is not written over.
TEST(TrainingSession, ABrokenSamplesFileStaysAsItIs) {
  const TestFolder folder;
  const TrainingFiles files = training_files(folder / "colors.yaml", {});
  std::ofstream(files.samples) << "- {image: gone.mkv, class: red, rectangle: [0, 0, 4, 4]}\n";
  TrainingSession session(files, ColorRange::limited);
  EXPECT_THAT(session.state().refusal, HasSubstr("gone.mkv"));
  const auto image = session.add_image(picture(1));
  session.set_draft(two_colors(0, image.id));
  EXPECT_THAT(message_of([&] { session.save(1, ""); }), HasSubstr("is refused"));
  EXPECT_THAT(read_text(files.samples, 1000), HasSubstr("gone.mkv"));
  EXPECT_FALSE(fs::exists(files.colors));
}

TEST(TrainingSession, WarnsOfWhatCannotBothBeTrue) {
  const TestFolder folder;
  TrainingSession session(training_files(folder / "colors.yaml", {}), ColorRange::limited);
  const auto image = session.add_image(picture(1));
  TrainingDraft draft = two_colors(0, image.id);
  draft.samples.push_back({image.id, ColorClass::yellow, PixelBox{4, 4, 8, 8}});
  draft.samples.push_back({image.id, ColorClass::blue, PixelBox{100, 4, 108, 8}});
  EXPECT_THAT(session.set_draft(draft).warnings,
              testing::IsSupersetOf({HasSubstr("green and yellow share 16 pixels of frame 1"),
                                     HasSubstr("a sample of blue has no pixel")}));
}

TEST(TrainingSession, QualityIsMeasuredWhenADraftIsLeftAlone) {
  const TestFolder folder;
  TrainingSession session(training_files(folder / "colors.yaml", {}), ColorRange::limited);
  const auto first = session.add_image(picture(1)), second = session.add_image(picture(2));
  TrainingDraft draft = two_colors(0, first.id);
  for (const DraftSample& sample : two_colors(0, second.id).samples) draft.samples.push_back(sample);
  session.set_draft(draft);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (session.quality().is_running && std::chrono::steady_clock::now() < end) usleep(5000);
  const auto judged = session.quality();
  ASSERT_EQ(judged.version, 1);
  EXPECT_GT(*judged.quality.recall(ColorClass::green), 0.95);
  EXPECT_GT(*judged.quality.recall(ColorClass::red), 0.95);
}

TEST(TrainingSession, PicturesAreBounded) {
  const TestFolder folder;
  TrainingSession session(training_files(folder / "colors.yaml", {}), ColorRange::limited);
  for (int k = 0; k < 64; ++k) session.add_image(picture(k));
  EXPECT_THAT(message_of([&] { session.add_image(picture(64)); }), HasSubstr("must be at most 64"));
  EXPECT_TRUE(session.remove_image(session.state().images[3].id));
  EXPECT_FALSE(session.remove_image("x"));
  EXPECT_NO_THROW(session.add_image(picture(64)));
}

}  // namespace
}  // namespace tassilo
