// Once they have seen what a recording shows, vision and contours allocate nothing more: every call of operator new is
// counted.

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "support/counted_new.h"
#include "support/recording.h"
#include "tassilo/color/segment.h"
#include "tassilo/contour/boundary_contours.h"
#include "tassilo/contour/skeleton_contours.h"
#include "tassilo/contour/sub_pixel_edges.h"
#include "tassilo/region/skeleton.h"

namespace tassilo {
namespace {

using test::allocations;

struct Case {
  const char* recording;
  const char* samples;
  const char* localization;
};
class SteadyState : public testing::TestWithParam<Case> {};

TEST_P(SteadyState, AllocatesNothingPerFrame) {
  test::Recording recording = test::load_recording(GetParam().recording, GetParam().samples);
  ASSERT_FALSE(recording.frames.empty());
  recording.setup.options.stages["localization"] = GetParam().localization;
  const Vision vision(recording.setup);
  VisionWorkspace workspace;
  std::size_t seen = 0;
  // The first pass finds out what is needed; in the second blocks may still move to where they are needed most.
  for (int pass = 0; pass < 4; ++pass)
    for (const Frame& frame : recording.frames) {
      const std::int64_t before = allocations;
      const Scene scene = vision(frame, workspace);
      seen += scene.balls.size() + scene.robots.size() + scene.lines.size();
      if (pass > 1) {
        EXPECT_EQ(allocations - before, 0) << "frame " << frame.index << ", pass " << pass;
      }
    }
  EXPECT_GT(seen, recording.frames.size());
}

INSTANTIATE_TEST_SUITE_P(Recordings, SteadyState,
                         testing::Values(Case{"d01_approach", "train_div/samples.yaml", "model"},
                                         Case{"d01_approach", "train_div/samples.yaml", "boundary"},
                                         Case{"d05_distract", "train_div/samples.yaml", "model"},
                                         Case{"d06_vga", "train_vga/samples.yaml", "model"}),
                         [](const auto& row) {
                           return std::string(row.param.recording) + "_" + row.param.localization;
                         });

/// How many skeleton lines, borders and edges a frame has.
std::size_t thin_lines(const Frame& frame, const Segmentation& segmentation) {
  std::size_t found = 0;
  for (const ColorClass color : kColorClasses) {
    const Region& region = segmentation.of(color);
    const SkeletonContours lines = skeleton_contours(skeleton(region));
    found += lines.contours.size() + lines.junctions.size() + boundary_contours(region).size();
  }
  const Region everywhere = Region::from_box({0, 0, segmentation.width, segmentation.height});
  return found + sub_pixel_edges(frame.view, everywhere).size();
}

TEST(SteadyStateOfContours, AllocatesNothingPerFrame) {
  const test::Recording recording = test::load_recording("d01_approach", "train_div/samples.yaml");
  ASSERT_FALSE(recording.frames.empty());
  const Classifier classifier(recording.setup.colors);
  Segmentation segmentation;
  std::size_t found = 0;
  for (int pass = 0; pass < 4; ++pass)
    for (const Frame& frame : recording.frames) {
      const std::int64_t before = allocations;
      segmentation = segment(frame.view, classifier, std::move(segmentation));
      found += thin_lines(frame, segmentation);
      if (pass > 1) {
        EXPECT_EQ(allocations - before, 0) << "frame " << frame.index << ", pass " << pass;
      }
    }
  EXPECT_GT(found, 10 * recording.frames.size());
}

TEST(AllocationCount, CountsAllocations) {
  const std::int64_t before = allocations;
  const std::vector<int> one(3);
  EXPECT_EQ(allocations - before, 1);
}

}  // namespace
}  // namespace tassilo
