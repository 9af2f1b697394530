#include "tassilo/overlay/overlay.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "tassilo/base/error.h"
#include "tassilo/overlay/internal/floor_view.h"
#include "tassilo/overlay/internal/label_layout.h"
#include "tassilo/overlay/internal/text.h"

namespace tassilo {
namespace {

using Rgb = std::array<int, 3>;

Rgb at(const Picture& picture, int c, int r) {
  const std::size_t i =
      3 * (static_cast<std::size_t>(r) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(c));
  return {picture.pixels[i], picture.pixels[i + 1], picture.pixels[i + 2]};
}

/// A frame of one color. [Y, U, V]
Frame plain_frame(int width, int height, std::array<std::uint8_t, 3> color) {
  const FrameBuffer buffer = make_frame_buffer(PixelFormat::yuv422p, width, height, ColorRange::full);
  for (int r = 0; r < height; ++r)
    for (int c = 0; c < width; ++c) {
      buffer.planes[0][r * buffer.strides[0] + c] = color[0];
      buffer.planes[1][r * buffer.strides[1] + c / 2] = color[1];
      buffer.planes[2][r * buffer.strides[2] + c / 2] = color[2];
    }
  return buffer.frame;
}

Frame noise_frame(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  const FrameBuffer buffer = make_frame_buffer(PixelFormat::yuv422p, width, height, ColorRange::full);
  for (std::size_t p = 0; p < 3; ++p)
    for (std::ptrdiff_t i = 0; i < buffer.strides[p] * height; ++i)
      buffer.planes[p][i] = static_cast<std::uint8_t>(random());
  return buffer.frame;
}

/// Level pinhole camera half a metre above the floor, 200 x 120 px.
MountedCamera level_camera() {
  CameraModel model;
  model.width = 200;
  model.height = 120;
  model.fx = model.fy = 120;
  model.cx = 99.5;
  model.cy = 59.5;
  return MountedCamera(model, CameraMount{.x = 0, .y = 0, .z = .5});
}

constexpr Rgb kGray{100, 100, 100};
const Frame kGrayFrame = plain_frame(200, 120, {100, 128, 128});

Picture drawn(const Scene& scene, const OverlayOptions& options) {
  return draw_overlay(kGrayFrame.view, ColorRange::full, scene, options);
}

// RGB -> YUV by the definition, quantized, -> RGB: at most what the rounding of three numbers costs.
TEST(PictureFromFrame, InvertsBt601) {
  std::mt19937 random(1);
  for (const ColorRange range : {ColorRange::full, ColorRange::limited})
    for (int i = 0; i < 500; ++i) {
      const double r = static_cast<double>(random() % 256), g = static_cast<double>(random() % 256),
                   b = static_cast<double>(random() % 256);
      const bool full = range == ColorRange::full;
      const double y = .299 * r + .587 * g + .114 * b, cb = (b - y) / 1.772, cr = (r - y) / 1.402;
      const auto quantized = [](double value) {
        return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0l, 255l));
      };
      const Frame frame =
          plain_frame(3, 1,
                      {quantized(full ? y : 16 + 219 * y / 255), quantized(128 + (full ? cb : 224 * cb / 255)),
                       quantized(128 + (full ? cr : 224 * cr / 255))});
      const Picture picture = picture_from_frame(frame.view, range);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(at(picture, c, 0)[0], r, 2);
        EXPECT_NEAR(at(picture, c, 0)[1], g, 2);
        EXPECT_NEAR(at(picture, c, 0)[2], b, 2.2);
      }
    }
}

TEST(DrawOverlay, EmptySceneLeavesTheImage) {
  const MountedCamera camera = level_camera();
  for (const MountedCamera* given : {static_cast<const MountedCamera*>(nullptr), &camera}) {
    const Frame frame = noise_frame(200, 120, 3);
    const Picture plain = picture_from_frame(frame.view, ColorRange::full);
    const Picture picture = draw_overlay(frame.view, ColorRange::full, {}, {.camera = given, .scale = 1});
    for (int r = 0; r < 120; ++r)
      for (int c = 0; c < 200; ++c) ASSERT_EQ(at(picture, c, r), at(plain, c, r)) << c << ", " << r;
  }
}

TEST(DrawOverlay, EnlargementKeepsTheMiddlesOfEvenAreas) {
  const Picture picture = drawn({}, {.scale = 5});
  for (int r = 0; r < 600; ++r)
    for (int c = 0; c < 1000; ++c) ASSERT_EQ(at(picture, c, r), kGray);
}

// A sequence makes a video: neither scene nor contents change the size, and codecs want even sides.
TEST(DrawOverlay, SizeDependsOnFrameAndOptionsOnly) {
  const MountedCamera camera = level_camera();
  Scene busy;
  busy.image = "a.png";
  busy.balls.resize(2);
  busy.timing = {{"total", 2}};
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 200}, {384, 172}, {385, 173}, {640, 480}, {1280, 960}}) {
    SCOPED_TRACE(width);
    const Frame frame = plain_frame(width, height, {50, 100, 200});
    const Picture a = draw_overlay(frame.view, ColorRange::full, {}, {.camera = &camera});
    const Picture b = draw_overlay(frame.view, ColorRange::limited, busy, {.camera = &camera});
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.width % 2, 0);
    EXPECT_EQ(a.height % 2, 0);
    EXPECT_EQ(a.pixels.size(), static_cast<std::size_t>(3 * a.width * a.height));
    const Picture without = draw_overlay(frame.view, ColorRange::full, {}, {});
    EXPECT_GE(without.width, std::min(768, 16 * width));
    EXPECT_GE(without.height, height);
    EXPECT_GT(a.width, without.width);
  }
}

TEST(DrawOverlay, BoxesShowWhereTheObjectsAre) {
  Scene scene;
  Ball ball;
  ball.box = {60, 50, 90, 80};
  ball.center = {74.5, 64.5};
  ball.radius_px = 15;
  scene.balls = {ball};
  const Picture picture = drawn(scene, {.scale = 2});
  for (const auto& [c, r] : {std::pair{120, 120}, {179, 120}, {150, 100}, {150, 159}}) {  // middles of the sides
    const auto [red, green, blue] = at(picture, c, r);
    EXPECT_GT(red, 200);
    EXPECT_GT(green, blue);
  }
  EXPECT_EQ(at(picture, 150, 130), kGray) << "the ball itself is not covered";
  EXPECT_EQ(at(picture, 20, 200), kGray) << "nor is anything far away";
  scene.balls.clear();
  scene.goals = {{.color = GoalColor::blue, .box = {60, 50, 90, 80}, .bearing = {}, .position = {}, .posts = {}}};
  const Rgb goal = at(drawn(scene, {.scale = 2}), 120, 120);
  EXPECT_GT(goal[2], 200);
  EXPECT_GT(goal[2], goal[0]);
}

FreeSpace quarter(double range, SectorState state) {
  FreeSpace space;
  space.angle_min = -.35;
  space.angle_increment = .1;
  space.ranges.assign(8, range);
  space.states.assign(8, state);
  return space;
}

// Floor nearer than the range is green, what lies behind or above is not; a blocked edge is red where it projects to.
TEST(DrawOverlay, FreeFloorIsGreenUpToItsRange) {
  const MountedCamera camera = level_camera();
  Scene scene;
  scene.free_space = quarter(2, SectorState::blocked);
  const Picture picture = drawn(scene, {.camera = &camera, .scale = 2});
  for (double x = 1.2; x < 4; x += .1)
    for (const double y : {-.2, 0., .2}) {
      SCOPED_TRACE(x);
      const double range = std::hypot(x, y);
      if (std::abs(range - 2) < .25) continue;  // the edge itself has width
      const CanvasPoint p = on_canvas(camera.project({x, y, 0}).value(), 2);
      const Rgb color = at(picture, static_cast<int>(p.x), static_cast<int>(p.y));
      if (range < 2)
        EXPECT_GT(color[1], color[0] + 20);
      else
        EXPECT_EQ(color, kGray);
    }
  EXPECT_EQ(at(picture, 200, 60), kGray) << "above the horizon";
  const CanvasPoint edge = on_canvas(camera.project({2, 0, 0}).value(), 2);
  const Rgb red = at(picture, static_cast<int>(edge.x), static_cast<int>(edge.y));
  EXPECT_GT(red[0], 150);
  EXPECT_GT(red[0], red[1] + 60);
}

// The tint tells of the floor; what lies on it keeps its color.
TEST(DrawOverlay, BallsAndLinesOnTheFreeFloorKeepTheirColor) {
  const MountedCamera camera = level_camera();
  Scene scene;
  scene.free_space = quarter(3, SectorState::free);
  Ball ball;
  ball.center = {100, 90};
  ball.radius_px = 8;
  ball.box = {92, 82, 109, 99};
  scene.balls = {ball};
  Surface surface;
  surface.width = 200;
  surface.height = 120;
  surface.kinds.assign(200 * 120, SurfaceKind::carpet);
  for (int r = 105; r < 110; ++r)
    for (int c = 0; c < 200; ++c) surface.kinds[static_cast<std::size_t>(r * 200 + c)] = SurfaceKind::line;
  const Surface* const none = nullptr;
  for (const Surface* given : {none, static_cast<const Surface*>(&surface)}) {
    SCOPED_TRACE(given != nullptr);
    const Picture picture = drawn(scene, {.camera = &camera, .surface = given, .scale = 2});
    const auto is_tinted = [&](int c, int r) {
      return at(picture, 2 * c, 2 * r)[1] > at(picture, 2 * c, 2 * r)[0] + 20;
    };
    EXPECT_EQ(at(picture, 2 * 100, 2 * 90), kGray);
    EXPECT_EQ(at(picture, 2 * 97, 2 * 93), kGray);
    EXPECT_TRUE(is_tinted(100, 102));
    EXPECT_TRUE(is_tinted(85, 90));
    EXPECT_EQ(is_tinted(100, 107), given == nullptr);
    EXPECT_TRUE(is_tinted(100, 112));
  }
}

TEST(DrawOverlay, UnseenSectorsAndMissingCameraDrawNoFloor) {
  const MountedCamera camera = level_camera();
  Scene scene;
  scene.free_space = quarter(2, SectorState::unseen);
  const Picture plain = drawn({}, {.scale = 1});
  const Picture unseen = drawn(scene, {.camera = &camera, .scale = 1});
  scene.free_space = quarter(2, SectorState::free);
  EXPECT_EQ(drawn(scene, {.scale = 1}), plain);
  for (int r = 0; r < 120; ++r)
    for (int c = 0; c < 200; ++c) ASSERT_EQ(at(unseen, c, r), kGray);
}

// Left of the robot is left in the view from above, and ahead is up.
TEST(DrawOverlay, BirdViewHasXUpAndYLeft) {
  const MountedCamera camera = level_camera();
  const Picture empty = drawn({}, {.camera = &camera, .scale = 4});
  const auto changed_middle = [&](FloorPoint ball_in_robot) {
    Scene scene;
    Ball ball;
    ball.box = {60, 50, 90, 80};
    BallOnFloor floor;
    floor.position.mean = ball_in_robot;
    floor.position.covariance *= 1e-4;
    floor.bounds = {norm(ball_in_robot) * .95, norm(ball_in_robot) * 1.05};
    ball.floor = floor;
    scene.balls = {ball};
    const Picture picture = drawn(scene, {.camera = &camera, .scale = 4});
    double column = 0, row = 0, count = 0;
    for (int r = 0; r < 480; ++r)
      for (int c = 800; c < picture.width; ++c)
        if (at(picture, c, r) != at(empty, c, r)) column += c, row += r, ++count;
    EXPECT_GT(count, 10);
    return std::pair{column / count, row / count};
  };
  const auto left = changed_middle({2, 1}), right = changed_middle({2, -1}), far = changed_middle({4, 1});
  EXPECT_LT(left.first, right.first);
  EXPECT_LT(far.second, left.second);
  EXPECT_NEAR(left.second, right.second, 2);
}

// An arrow from where it is to where it comes in half a second, on the floor and from above.
TEST(DrawOverlay, TracksShowWhereTheyCome) {
  const MountedCamera camera = level_camera();
  Scene scene;
  scene.tracks = {TrackSeen{.id = 1, .team = Team::unknown, .x = 2, .y = .6, .vx = 0, .vy = -2.4}};
  const auto is_orange = [](const Rgb& color) { return color[0] > 150 && color[0] > color[2] + 80; };
  const Picture picture = drawn(scene, {.camera = &camera, .scale = 2});
  for (const double y : {.5, .2, -.2, -.5}) {
    const CanvasPoint p = on_canvas(camera.project({2, y, 0}).value(), 2);
    EXPECT_TRUE(is_orange(at(picture, static_cast<int>(p.x), static_cast<int>(p.y)))) << y;
  }
  const CanvasPoint behind = on_canvas(camera.project({2, .8, 0}).value(), 2);
  EXPECT_EQ(at(picture, static_cast<int>(behind.x), static_cast<int>(behind.y)), kGray);
  int above = 0;
  for (int r = 0; r < 240; ++r)
    for (int c = 400; c < picture.width; ++c) above += is_orange(at(picture, c, r));
  EXPECT_GT(above, 10);
  const Picture without = drawn(scene, {.scale = 2});
  EXPECT_EQ(without, drawn({}, {.scale = 2}));
}

TEST(DrawOverlay, LabelMapTintsItsPixels) {
  std::vector<std::uint8_t> labels(200 * 120, 0);
  for (int c = 0; c < 100; ++c) labels[static_cast<std::size_t>(60 * 200 + c)] = 7;  // red
  const Picture picture = drawn({}, {.labels = labels, .scale = 2});
  for (int r = 0; r < 240; ++r)
    for (int c = 0; c < 400; ++c) {
      const Rgb color = at(picture, c, r);
      if (r / 2 == 60 && c / 2 < 100)
        EXPECT_GT(color[0], color[1] + 40);
      else
        ASSERT_EQ(color, kGray);
    }
}

// Whatever a detector may say: nothing of it may hurt.
TEST(DrawOverlay, OddScenesAreDrawn) {
  const MountedCamera camera = level_camera();
  Scene scene;
  scene.t = 1.7e9;
  scene.image = std::string(300, 'x');
  Ball outside;
  outside.box = {-500, -500, 9000, -400};
  outside.radius_px = 1e7;
  outside.floor = BallOnFloor{};
  scene.balls.assign(30, outside);
  scene.robots.resize(2);
  scene.robots[0].floor = RobotOnFloor{};
  scene.goals.resize(1);
  scene.goals[0].posts.resize(2);
  scene.lines.resize(1);
  scene.tracks.resize(3);
  scene.tracks[1].vx = 1e9;
  scene.tracks[2].age = 1e9;
  scene.circles = {{.center = {1, 1}, .radius = 1e5}};
  scene.free_space = quarter(100, SectorState::free);
  scene.free_space->angle_increment = 1;
  EXPECT_GT(drawn(scene, {.camera = &camera}).width, 0);
}

TEST(OverlayOptions, NamesWhatIsOutOfRange) {
  EXPECT_THROW(drawn({}, {.scale = -1}), Error);
  EXPECT_THROW(drawn({}, {.scale = 17}), Error);
  EXPECT_THROW(drawn({}, {.bird_range = 0}), Error);
}

// While there is room, labels hide neither boxes nor each other; in any case they stay in the picture.
TEST(LabelLayout, StaysInsideAndApart) {
  std::mt19937 random(5);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  const Rect bounds{4, 4, 760, 400};
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE(round);
    LabelLayout layout(bounds);
    std::vector<Rect> boxes, labels;
    const int count = 1 + round % 12;
    for (int i = 0; i < count; ++i)
      boxes.push_back({uniform(-50, 760), uniform(-50, 400), uniform(2, 150), uniform(2, 150)});
    for (const Rect& box : boxes) layout.keep_clear(box);
    for (const Rect& box : boxes) {
      const Rect label = layout.place(box, 120, 18);
      EXPECT_GE(label.x, bounds.x);
      EXPECT_GE(label.y, bounds.y);
      EXPECT_LE(label.right(), bounds.right());
      EXPECT_LE(label.bottom(), bounds.bottom());
      labels.push_back(label);
    }
    if (count == 1) {
      EXPECT_EQ(overlap(boxes[0], labels[0]), 0);
    }
  }
}

// Rather than onto each other or onto what is kept free, labels move away from their box.
TEST(LabelLayout, CrowdsStayReadable) {
  LabelLayout layout({4, 4, 760, 400});
  const Rect box{300, 200, 40, 40}, ball{330, 180, 60, 60};
  layout.keep_clear(box);
  layout.keep_clear(ball);
  layout.keep_free(ball);
  std::vector<Rect> labels;
  for (int i = 0; i < 12; ++i) {
    const Rect label = layout.place(box, 120, 18);
    EXPECT_EQ(overlap(label, ball), 0) << i;
    for (const Rect& other : labels) EXPECT_EQ(overlap(label, other), 0) << i;
    labels.push_back(label);
  }
}

// A label may hide a box rather than move away from its own for a few pixels of it.
TEST(LabelLayout, StaysNearItsBox) {
  LabelLayout layout({4, 4, 760, 400});
  const Rect box{300, 200, 40, 40};
  layout.keep_clear(box);
  for (const Rect& around :
       {Rect{150, 175, 340, 8}, Rect{150, 255, 340, 8}, Rect{150, 175, 30, 80}, Rect{460, 175, 30, 80}})
    layout.keep_clear(around);
  const Rect label = layout.place(box, 120, 18);
  EXPECT_GT(overlap(label, {box.x - 4 - 120, box.y - 4 - 18, box.width + 8 + 240, box.height + 8 + 36}),
            .99 * 120 * 18);
}

TEST(OverlayText, SaysNumbersAsPeopleDo) {
  EXPECT_EQ(meters(1.857), "1.86 m");
  EXPECT_EQ(meters(-.001), "0.00 m");
  EXPECT_EQ(percent(.974), "97 %");
  EXPECT_EQ(bearing_text(.2), "11° left");
  EXPECT_EQ(bearing_text(-.2), "11° right");
  EXPECT_EQ(bearing_text(.001), "ahead");
  EXPECT_EQ(joined({"a", "", "b"}), "a · b");
  EXPECT_EQ(fixed(-1e300, 0).size(), 302u);
}

}  // namespace
}  // namespace tassilo
