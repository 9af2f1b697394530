#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>

#include "tassilo/base/error.h"
#include "tassilo/calibrate/dot_grid.h"
#include "tassilo/calibrate/find_target.h"
#include "tassilo/calibrate/internal/grid_walk.h"
#include "tassilo/calibrate/test_targets.h"

namespace tassilo {
namespace {

const CameraModel kCamera{.name = {},
                          .width = 320,
                          .height = 240,
                          .fx = 200,
                          .fy = 190,
                          .cx = 161.3,
                          .cy = 118.2,
                          .distortion = Division{-.2}};
const CameraModel kPlumb{.name = {},
                         .width = 320,
                         .height = 240,
                         .fx = 220,
                         .fy = 221,
                         .cx = 157,
                         .cy = 121,
                         .distortion = PlumbBob{-.25, .07, .001, -.001, -.01}};

/// Turned every way, so that no image axis or corner is special.
std::vector<TargetPose> poses(const CameraModel& camera, const Target& target) {
  std::vector<TargetPose> out;
  const std::array<double, 6> turns{.1, 1.7, 3.2, -1.4, .8, 2.5};
  const std::array<std::array<double, 2>, 6> tilts{{{.4, .2}, {-.5, .3}, {.1, -.6}, {.05, .02}, {-.3, -.5}, {.7, 0}}};
  for (std::size_t i = 0; i < turns.size(); ++i)
    out.push_back(pose_at(camera, target, {130. + 10 * static_cast<double>(i), 125. - 3 * static_cast<double>(i)}, .5,
                          {tilts[i][0], tilts[i][1], turns[i]}));
  return out;
}

void expect_found(const CameraModel& camera, const Target& target, double tolerance) {
  unsigned seed = 0;
  for (const TargetPose& pose : poses(camera, target)) {
    SCOPED_TRACE(seed);
    const TestImage image = render(camera, target, pose, seed++);
    const TargetSearch search = find_target(image.view(), target);
    ASSERT_TRUE(search.view) << search.reason;
    EXPECT_EQ(search.view->points.size(), static_cast<std::size_t>(target.size()));
    EXPECT_EQ(search.view->target, target);
    double sum = 0;
    for (const SeenPoint& point : search.view->points) {
      const double off = distance(point.pixel, seen_at(camera, pose, target, point.column, point.row).value());
      EXPECT_LT(off, 6 * tolerance) << point.column << " " << point.row;
      sum += off * off;
    }
    EXPECT_LT(std::sqrt(sum / static_cast<double>(search.view->points.size())), tolerance);
  }
}

TEST(FindDotGrid, TellsEachDotAndItsPlace) {
  expect_found(kCamera, kDots, .05);
  expect_found(kPlumb, kDots, .05);
}

TEST(FindDotGrid, NeedNotBeSquare) { expect_found(kCamera, {TargetKind::dots, 8, 5, .04, .011}, .05); }

TEST(FindCheckerboard, TellsEachCornerAndItsPlace) {
  expect_found(kCamera, kChecker, .06);
  expect_found(kPlumb, kChecker, .06);
}

TEST(FindTarget, OneKindIsNotTheOther) {
  for (const auto& [shown, asked] : {std::pair{kDots, kChecker}, std::pair{kChecker, kDots}}) {
    unsigned seed = 0;
    for (const TargetPose& pose : poses(kCamera, shown)) {
      SCOPED_TRACE(seed);
      const TargetSearch search = find_target(render(kCamera, shown, pose, seed++).view(), asked);
      EXPECT_FALSE(search.view);
      EXPECT_FALSE(search.reason.empty());
    }
  }
}

TEST(FindDotGrid, MeasuresTheFrame) {
  for (const CameraModel& camera : {kCamera, kPlumb}) {
    double squares = 0, count = 0;
    unsigned seed = 30;
    for (const TargetPose& pose : poses(camera, kDots)) {
      const TargetSearch search = find_target(render(camera, kDots, pose, seed++).view(), kDots);
      ASSERT_TRUE(search.view) << search.reason;
      for (const FramePlace& place : search.view->frame) {
        EXPECT_NEAR(norm(place.normal), 1, 1e-9);
        const bool is_row = place.side == FrameSide::top || place.side == FrameSide::bottom;
        const bool is_first = place.side == FrameSide::top || place.side == FrameSide::left;
        const double across = is_first ? -1.125 : 7.125;
        const auto shown = is_row ? project_at(camera, pose, place.along * kDots.pitch, across * kDots.pitch)
                                  : project_at(camera, pose, across * kDots.pitch, place.along * kDots.pitch);
        ASSERT_TRUE(shown);
        const double off = dot(place.pixel - *shown, place.normal);
        EXPECT_LT(std::abs(off), .5);
        squares += off * off;
        ++count;
      }
    }
    EXPECT_GT(count, 300);
    EXPECT_LT(std::sqrt(squares / count), .04);
    RecordProperty("rms_px", std::to_string(std::sqrt(squares / count)));
  }
}

/// Places and poses at which parts of a grid of tags are beyond the image, corners of the image among what it covers.
std::vector<TargetPose> poses_of_tags(const CameraModel& camera) {
  std::vector<TargetPose> out;
  const std::array<std::array<double, 2>, 5> places{{{150, 120}, {70, 60}, {260, 60}, {70, 190}, {250, 180}}};
  for (std::size_t i = 0; i < places.size(); ++i)
    out.push_back(pose_at(camera, kTags, {places[i][0] * camera.width / 320, places[i][1] * camera.width / 320}, .2,
                          {.3 - .1 * static_cast<double>(i), .2, .3 * static_cast<double>(i)}));
  return out;
}

TEST(FindAprilGrid, PlacesCornersAlsoWhereTheTargetLeavesTheImage) {
  const CameraModel fisheye{.name = {},
                            .width = 640,
                            .height = 480,
                            .fx = 320,
                            .fy = 316,
                            .cx = 316,
                            .cy = 242,
                            .distortion = Equidistant{-.02, .01, -.004, .0006}};
  for (const CameraModel& camera : {kCamera, kPlumb, fisheye}) {
    double squares = 0, count = 0, worst = 0;
    unsigned seed = 60;
    for (const TargetPose& pose : poses_of_tags(camera)) {
      const TargetSearch search = find_target(render(camera, kTags, pose, seed++).view(), kTags);
      ASSERT_TRUE(search.view) << search.reason;
      EXPECT_TRUE(search.remarks.empty()) << search.remarks.front();
      for (const SeenPoint& point : search.view->points) {
        const auto shown = seen_at(camera, pose, kTags, point.column, point.row);
        ASSERT_TRUE(shown);
        const double off = distance(point.pixel, *shown);
        squares += off * off;
        worst = std::max(worst, off);
        ++count;
      }
    }
    EXPECT_GT(count, 120);
    EXPECT_LT(worst, .25);
    EXPECT_LT(std::sqrt(squares / count), .06);
    RecordProperty("corners", std::to_string(count));
    RecordProperty("rms_px", std::to_string(std::sqrt(squares / count)));
  }
}

TEST(FindAprilGrid, TagsThatAreNoPartOfItAreThrownOutWithReason) {
  const TargetPose pose = poses_of_tags(kCamera)[0];
  const TestImage image = render(kCamera, kTags, pose, 70);
  Target smaller = kTags;
  smaller.rows = 4;  // has ids of the lower two rows only
  const TargetSearch search = find_target(image.view(), smaller);
  EXPECT_FALSE(search.remarks.empty());
  EXPECT_NE(search.remarks.at(0).find("ids of the grid end at"), std::string::npos) << search.remarks[0];
  // The same image twice, side by side: each tag is there two times.
  TestImage twice{2 * image.width, image.height, {}};
  for (int r = 0; r < image.height; ++r)
    for (int c = 0; c < twice.width; ++c)
      twice.pixels.push_back(image.pixels[static_cast<std::size_t>(r * image.width + c % image.width)]);
  const TargetSearch doubled = find_target(twice.view(), kTags);
  EXPECT_FALSE(doubled.view);
  EXPECT_NE(doubled.remarks.at(0).find("seen 2 times"), std::string::npos) << doubled.remarks[0];
}

TEST(FindAprilGrid, TagsAreThoseOfKalibr) {
  // Its code for tag 0, 0xd5d628584, row by row from the top: a set bit is white.
  const auto black = tag_cells(0);
  for (std::size_t i = 0; i < 36; ++i)
    EXPECT_EQ(black[(2 + i / 6) * kTagCells + 2 + i % 6], !(0xd5d628584 >> (35 - i) & 1)) << i;
}

TEST(FindTarget, ALargerGridIsAnotherTarget) {
  const Target large_dots{TargetKind::dots, 9, 9, .03, .008}, large_board{TargetKind::checkerboard, 10, 7, .03, 0};
  const TestImage dots = render(kCamera, large_dots, poses(kCamera, large_dots)[0], 1);
  EXPECT_FALSE(find_target(dots.view(), {TargetKind::dots, 7, 7, .03, .008}).view);
  const TestImage board = render(kCamera, large_board, poses(kCamera, large_board)[0], 1);
  EXPECT_FALSE(find_target(board.view(), {TargetKind::checkerboard, 8, 5, .03, 0}).view);
}

TEST(FindTarget, PartOfATargetIsRefusedWithAReason) {
  for (const Target& target : {kDots, kChecker}) {
    const TestImage image = render(kCamera, target, pose_at(kCamera, target, {300, 120}, .5, {.2, .1, 0}), 3);
    const TargetSearch search = find_target(image.view(), target);
    EXPECT_FALSE(search.view);
    EXPECT_NE(search.reason.find("must be at least"), std::string::npos) << search.reason;
  }
}

TEST(FindDotGrid, NeedsItsMark) {
  Target target = kDots;
  const TargetPose pose = poses(kCamera, target)[0];
  TestImage image = render(kCamera, target, pose, 5);
  // The triangle painted over.
  for (double u = -.99; u < -.4; u += .02)
    for (double v = -.99; v < -.4 - (u + 1) + .1; v += .02)
      if (const auto at = project_at(kCamera, pose, u * target.pitch, v * target.pitch))
        image.pixels[static_cast<std::size_t>(std::lround(at->y) * image.width + std::lround(at->x))] = 190;
  const TargetSearch search = find_target(image.view(), target);
  EXPECT_FALSE(search.view);
  EXPECT_NE(search.reason.find("triangle"), std::string::npos) << search.reason;
}

TEST(FindTarget, AnyImageIsSurvived) {
  std::mt19937 random(7);
  const std::array<std::array<int, 2>, 6> sizes{{{1, 1}, {15, 40}, {16, 16}, {64, 48}, {97, 33}, {200, 150}}};
  for (const auto& [width, height] : sizes)
    for (int kind = 0; kind < 4; ++kind) {
      SCOPED_TRACE(testing::Message() << width << " x " << height << ", kind " << kind);
      TestImage image{width, height, {}};
      for (int r = 0; r < height; ++r)
        for (int c = 0; c < width; ++c) {
          const int noise = static_cast<int>(random() % 256);
          const int value = kind == 0   ? noise
                            : kind == 1 ? 128
                            : kind == 2 ? ((c / 4 + r / 4) % 2 * 255)
                                        : (noise > 250) * 255;
          image.pixels.push_back(static_cast<std::uint8_t>(value));
        }
      for (const Target& target : {kDots, kChecker, kTags}) EXPECT_FALSE(find_target(image.view(), target).view);
    }
}

TEST(GridWalk, FourQuarterTurnsAreNone) {
  const Lattice lattice{3, 2, {0, 1, 2, 3, 4, 5}};
  const Lattice turned = quarter_turn(lattice);
  EXPECT_EQ(turned.columns, 2);
  EXPECT_EQ(turned.index, (std::vector<int>{3, 0, 4, 1, 5, 2}));
  EXPECT_EQ(quarter_turn(quarter_turn(quarter_turn(turned))).index, lattice.index);
}

TEST(GridWalk, ToleratesStrayAndMissingPoints) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(0, 400), jitter(-.5, .5);
    std::vector<PixelPoint> points;
    for (int i = 0; i < 30; ++i) points.push_back({place(random), 300 + place(random)});
    const std::size_t first = points.size();
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 9; ++c)
        if (!(c == 4 && r == 2))
          points.push_back({50 + 20. * c + 3 * r + jitter(random), 40 + 18. * r - 2 * c + .3 * c * c + jitter(random)});
    const LatticeSearch found = walk_grid(points, 9, 6, [](int, int) { return true; });
    ASSERT_TRUE(found.lattice) << found.reason;
    EXPECT_EQ(found.lattice->count(), 53);
    for (const int point : found.lattice->index) EXPECT_TRUE(point < 0 || static_cast<std::size_t>(point) >= first);
  }
}

TEST(Target, TextRoundTrip) {
  for (const char* text :
       {"dots:7x7:0.04:0.01", "checker:9x6:0.04", "dots:12x5:0.0255:0.008", "aprilgrid:6x6:0.088:0.3"})
    EXPECT_EQ(to_text(target_from_text(text)), text);
  EXPECT_EQ(target_from_text("checker:9x6:0.04"), kChecker);
}

TEST(Target, BadTextsAreRefused) {
  for (const char* text :
       {"", "dots", "dots:7x7:0.04", "dots:7:0.04:0.01", "dots:7x7:0.04:0.03", "dots:7x7:-1:0.01", "dots:2x7:0.04:0.01",
        "dots:7x700:0.04:0.01", "dots:7x7:nan:0.01", "checker:9x6:0.04:0.01", "checker:8x6:0.04", "grid:9x6:0.04",
        "checker:9x6:0.04m", "checker:9x6x1:0.04", "aprilgrid:6x6:0.04", "aprilgrid:1x6:0.04:0.3",
        "aprilgrid:30x30:0.04:0.3", "aprilgrid:6x6:0.04:0"})
    EXPECT_THROW(target_from_text(text), Error) << text;
}

}  // namespace
}  // namespace tassilo
