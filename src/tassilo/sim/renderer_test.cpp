#include "tassilo/sim/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <string>

#include "tassilo/base/error.h"
#include "tassilo/camera/test_world.h"
#include "tassilo/files/field_file.h"
#include "tassilo/geometry/pose2.h"
#include "tassilo/image/sample.h"
#include "tassilo/sim/internal/stage.h"

namespace tassilo {
namespace {

constexpr int kMe = 1;

/// Cameras with each lens model as they sit on robots; the test's own world has three, here is the fourth.
std::vector<MountedCamera> cameras() {
  std::vector<MountedCamera> all = test::cameras();
  CameraModel rational = all[1].model();
  rational.distortion = RationalPolynomial{-0.2, 0.05, 0.0005, -0.0004, 0.01, 0.08, -0.01, 0.002};
  all.emplace_back(rational, all[1].mount());
  return all;
}

/// The robot that looks, and a ball that is nowhere near.
SimState alone_at(double x, double y, double theta) {
  SimState state;
  state.ball.at = {-30, 0};
  state.robots.push_back({.id = kMe, .at = {x, y}, .theta = theta});
  return state;
}

SimState among_others() {
  SimState state = alone_at(2.2, .6, 3.3);
  state.ball.at = {.6, .3};
  state.robots.push_back({.id = 2, .team = Team::magenta, .at = {-.5, -.8}, .theta = .3, .radius = .22, .height = .55});
  state.robots.push_back({.id = 4, .team = Team::cyan, .at = {-.2, 1.2}, .theta = .3, .radius = .2, .height = .6});
  return state;
}

/// Bytes are shares of paint.
RenderOptions measurable() {
  RenderOptions options = plain_rendering();
  options.exposure = 1;
  options.flat = true;
  options.rays_per_side = 4;
  return options;
}

/// Fat lines, so that both sides of an edge show their paint.
FieldModel measurable_field() {
  FieldModel field = read_field("msl98");
  field.line_width = .12;
  return field;
}

FieldModel without_lines(FieldModel field) {
  field.halfway_line = false;
  field.circle_radius = 0;
  field.areas.clear();
  field.segments.clear();
  return field;
}

std::string bytes_of(const Frame& frame) {
  std::string bytes;
  for (int r = 0; r < frame.view.height(); ++r)
    for (int c = 0; c < frame.view.width(); ++c)
      for (const std::uint8_t value : {frame.view.y(c, r), frame.view.u(c, r), frame.view.v(c, r)})
        bytes.push_back(static_cast<char>(value));
  return bytes;
}

double mean_y(const Frame& frame) {
  double sum = 0;
  for (int r = 0; r < frame.view.height(); ++r)
    for (int c = 0; c < frame.view.width(); ++c) sum += frame.view.y(c, r);
  return sum / (frame.view.width() * frame.view.height());
}

bool well_inside(const CameraModel& camera, PixelPoint p, double margin) {
  return p.x > margin && p.y > margin && p.x < camera.width - 1 - margin && p.y < camera.height - 1 - margin;
}

/// How far the edge lies off, along `inwards` of length 1, so that brightness has the sum it has; nothing where the two
/// sides hardly differ, or are not even. [px]
std::optional<double> edge_offset(const Frame& frame, PixelPoint at, PixelPoint inwards) {
  const auto value = [&](double offset) {
    return sample_y(frame.view, at.x + offset * inwards.x, at.y + offset * inwards.y);
  };
  constexpr double side = 2.2, step = .02;
  const double out = value(-side), in = value(side);
  if (std::abs(in - out) < 15) return std::nullopt;
  for (const double beyond : {-side - .8, side + .8})
    if (std::abs(value(beyond) - (beyond < 0 ? out : in)) > .02 * std::abs(in - out)) return std::nullopt;
  double sum = 0;
  for (double offset = -side + step / 2; offset < side; offset += step)
    sum += step * (value(offset) - out) / (in - out);
  return side - sum;
}

/// A place on an edge of the field, another one close to it on the edge, and one a little within what it bounds.
struct EdgePoint {
  Point3<FieldFrame> at, next, inside;
};

/// Places in a robot's frame, of one camera and in its image.
class Views {
 public:
  Views(const MountedCamera& camera, const SimRobot& robot)
      : camera_(camera),
        robot_from_field_(inverse(make_pose2<FieldFrame, RobotFrame>(robot.at.x, robot.at.y, robot.theta))) {}

  std::optional<PixelPoint> pixel(const Point3<FieldFrame>& p) const {
    const FloorPoint at = robot_from_field_ * FieldPoint{p.x, p.y};
    return camera_.project({at.x, at.y, p.z});
  }

 private:
  const MountedCamera& camera_;
  Pose2<RobotFrame, FieldFrame> robot_from_field_;
};

/// Across the edge, to its inner side. [1]
PixelPoint inwards(PixelPoint at, PixelPoint next, PixelPoint inside) {
  PixelPoint across{at.y - next.y, next.x - at.x};
  if (dot(across, inside - at) < 0) across = -1. * across;
  return (1 / norm(across)) * across;
}

/// Worst distance of edges from where the camera model has them; every camera must see some. [px]
double worst_edge(const FieldModel& field, const SimState& state, const std::vector<EdgePoint>& points, int least) {
  double worst = 0;
  for (const MountedCamera& camera : cameras()) {
    const Frame frame = Renderer(field, camera, measurable()).render(state, kMe);
    const Views views(camera, state.robots.front());
    int seen = 0;
    for (const EdgePoint& point : points) {
      const auto at = views.pixel(point.at), next = views.pixel(point.next), inside = views.pixel(point.inside);
      if (!at || !next || !inside || !well_inside(camera.model(), *at, 4)) continue;
      const auto offset = edge_offset(frame, *at, inwards(*at, *next, *inside));
      if (!offset) continue;
      ++seen;
      worst = std::max(worst, std::abs(*offset));
      EXPECT_LT(std::abs(*offset), .1) << distortion_name(camera.model().distortion) << " at " << at->x << ", "
                                       << at->y;
    }
    EXPECT_GE(seen, least) << distortion_name(camera.model().distortion);
  }
  return worst;
}

TEST(Renderer, EdgesOfLinesUpToTheirCornersAreWhereTheCameraModelHasThem) {
  const FieldModel field = measurable_field();
  const double front = field.length / 2 - field.areas[0].depth, side = field.areas[0].width / 2;
  std::vector<EdgePoint> points;
  for (const double along : {.015, .03, .06, .12, .2, .3, .4, .5, .6}) {
    // The outer edges that meet at the area's corner: inside is towards the goal, and towards the middle.
    points.push_back({{front, side - along, 0}, {front, side - along - .01, 0}, {front + .01, side - along, 0}});
    points.push_back({{front + along, side, 0}, {front + along + .01, side, 0}, {front + along, side - .01, 0}});
    // The inner ones.
    const double f = front + field.line_width, s = side - field.line_width;
    points.push_back({{f, s - along, 0}, {f, s - along - .01, 0}, {f - .01, s - along, 0}});
    points.push_back({{f + along, s, 0}, {f + along + .01, s, 0}, {f + along, s + .01, 0}});
  }
  RecordProperty("worst_px", std::to_string(worst_edge(field, alone_at(front - .9, side - .25, .1), points, 8)));
}

TEST(Renderer, TheCentreCircleIsWhereTheCameraModelHasIt) {
  FieldModel field = without_lines(measurable_field());
  field.circle_radius = 1;
  std::vector<EdgePoint> points;
  for (int degree = 0; degree < 360; degree += 5)
    for (const double sign : {-1., 1.}) {
      const double angle = degree * std::numbers::pi / 180, edge = field.circle_radius + sign * field.line_width / 2;
      const double inside = edge - sign * .01;
      points.push_back({{edge * std::cos(angle), edge * std::sin(angle), 0},
                        {edge * std::cos(angle + .003), edge * std::sin(angle + .003), 0},
                        {inside * std::cos(angle), inside * std::sin(angle), 0}});
    }
  RecordProperty("worst_px", std::to_string(worst_edge(field, alone_at(-1.9, .3, .15), points, 8)));
}

TEST(Renderer, GoalPostsAreWhereTheCameraModelHasThem) {
  const FieldModel field = measurable_field();
  const FieldModel::Goal& goal = field.goals[0];
  ASSERT_EQ(goal.side, GoalSide::plus_x);
  std::vector<EdgePoint> points;
  for (const double sign : {-1., 1.})
    for (double z = .1; z < goal.height; z += .05)
      points.push_back({{field.length / 2, sign * goal.width / 2, z},
                        {field.length / 2, sign * goal.width / 2, z + .01},
                        {field.length / 2, sign * (goal.width / 2 + .01), z}});
  RecordProperty("worst_px", std::to_string(worst_edge(field, alone_at(2.9, .2, 0), points, 4)));
}

TEST(Renderer, FeetOfWallsAreWhereTheCameraModelHasThem) {
  const FieldModel field = without_lines(measurable_field());
  std::vector<EdgePoint> points;
  for (double y = -2; y < 2.2; y += .05)
    points.push_back({{field.walls->x.high, y, 0}, {field.walls->x.high, y + .01, 0}, {field.walls->x.high, y, .02}});
  RecordProperty("worst_px", std::to_string(worst_edge(field, alone_at(2.6, 1.6, .1), points, 4)));
}

/// The outline of a sphere is where rays touch it: around the direction to its centre.
TEST(Renderer, BallsAreWhereTheCameraModelHasThem) {
  FieldModel field = without_lines(measurable_field());
  field.ball.color = "yellow";
  // Nothing but carpet behind it.
  field.length = field.width = 30;
  field.walls.reset();
  field.goals.clear();
  RenderOptions options = measurable();
  options.rays_per_side = 5;
  double worst = 0;
  for (const MountedCamera& camera : cameras()) {
    Renderer renderer(field, camera, options);
    for (const FloorPoint at : {FloorPoint{1.1, .05}, FloorPoint{1.4, -.4}, FloorPoint{1.6, .3}}) {
      SimState state = alone_at(0, 0, 0);
      state.ball = {.at = {at.x, at.y}, .radius = .105};
      const RobotPoint to = RobotPoint{at.x, at.y, state.ball.radius} - camera.center();
      const RobotPoint ahead = normalized(to), left = normalized(cross({0, 0, 1}, ahead)), up = cross(ahead, left);
      const double opening = std::asin(state.ball.radius / norm(to));
      const auto touching = [&](double angle) {
        return camera.project(camera.center() + std::cos(opening) * ahead +
                              std::sin(opening) * (std::cos(angle) * left + std::sin(angle) * up));
      };
      const auto center = camera.project(camera.center() + ahead);
      if (!center || !well_inside(camera.model(), *center, 30)) continue;
      const Frame frame = renderer.render(state, kMe);
      PixelPoint shift{0, 0};
      int seen = 0;
      for (int degree = 0; degree < 360; degree += 10) {
        const double angle = degree * std::numbers::pi / 180;
        const auto edge = touching(angle), next = touching(angle + .01);
        if (!edge || !next || !well_inside(camera.model(), *edge, 4)) continue;
        const PixelPoint to_center = inwards(*edge, *next, *center);
        const auto offset = edge_offset(frame, *edge, to_center);
        if (!offset) continue;
        shift = shift + *offset * to_center;
        ++seen;
        worst = std::max(worst, std::abs(*offset));
        EXPECT_LT(std::abs(*offset), .1) << distortion_name(camera.model().distortion) << " " << degree;
      }
      EXPECT_GE(seen, 15) << distortion_name(camera.model().distortion);
      shift = (2. / std::max(seen, 1)) * shift;
      EXPECT_LT(norm(shift), .05) << distortion_name(camera.model().distortion) << " " << shift.x << " " << shift.y;
    }
  }
  RecordProperty("worst_px", std::to_string(worst));
}

TEST(Renderer, SameSeedSameBytes) {
  const FieldModel field = read_field("msl98");
  RenderOptions options = fast_rendering();
  const MountedCamera camera = test::cameras()[0];
  Renderer one(field, camera, options);
  const std::string first = bytes_of(one.render(among_others(), kMe));
  one.render(alone_at(0, 0, 0), kMe);
  EXPECT_EQ(bytes_of(one.render(among_others(), kMe)), first) << "what was rendered before does not matter";
  EXPECT_EQ(bytes_of(Renderer(field, camera, options).render(among_others(), kMe)), first);
  options.seed = 2;
  EXPECT_NE(bytes_of(Renderer(field, camera, options).render(among_others(), kMe)), first);
}

TEST(Renderer, FramesThatAreKeptAreNotWrittenOver) {
  Renderer renderer(read_field("msl98"), test::cameras()[0], fast_rendering());
  const Frame kept = renderer.render(among_others(), kMe);
  const std::string before = bytes_of(kept);
  renderer.render(alone_at(0, 0, 0), kMe);
  EXPECT_EQ(bytes_of(kept), before);
}

TEST(Renderer, BrighterWithMoreExposureAndMoreLight) {
  const FieldModel field = read_field("msl98");
  Renderer renderer(field, test::cameras()[0], fast_rendering());
  const double usual = mean_y(renderer.render(among_others(), kMe));
  renderer.set_light({}, 1.4);
  EXPECT_GT(mean_y(renderer.render(among_others(), kMe)), usual + 5);
  std::vector<SimLamp> lamps{{.x = -2}, {.x = 2}};
  renderer.set_light(lamps, 1.1);
  const double both = mean_y(renderer.render(among_others(), kMe));
  lamps[0].intensity = .2;
  renderer.set_light(lamps, 1.1);
  EXPECT_LT(mean_y(renderer.render(among_others(), kMe)), both - 5);
}

/// Y at the floor point, as the camera sees it.
double floor_y(const MountedCamera& camera, const Frame& frame, FloorPoint at) {
  const auto pixel = camera.project({at.x, at.y, 0});
  return pixel ? sample_y(frame.view, pixel->x, pixel->y) : -1;
}

TEST(Renderer, ShadowsDarkenTheFloorAwayFromTheLamp) {
  const MountedCamera camera = test::cameras()[0];
  for (const RenderQuality quality : {RenderQuality::fast, RenderQuality::full}) {
    RenderOptions options = plain_rendering();
    options.quality = quality;
    options.lamps = {{.x = 1.5, .y = 3, .z = 3, .radius = .05}};  // to the left of what is seen
    Renderer renderer(read_field("msl98"), camera, options);
    SimState state = alone_at(0, 0, 0);
    const Frame empty = renderer.render(state, kMe);
    state.robots.push_back({.id = 2, .at = {1.6, .25}, .radius = .15, .height = .4});
    const Frame shaded = renderer.render(state, kMe);
    const FloorPoint right{1.6, -.1}, left{1.6, .9};
    EXPECT_LT(floor_y(camera, shaded, right), floor_y(camera, empty, right) - 10);
    EXPECT_NEAR(floor_y(camera, shaded, left), floor_y(camera, empty, left), 2);
  }
}

TEST(Renderer, LargerLampsHaveSofterShadows) {
  const MountedCamera camera = test::cameras()[0];
  const auto steps = [&](double radius) {  // how many places between light and dark lie across the shadow's edge
    RenderOptions options = plain_rendering();
    options.rays_per_side = 4;
    options.lamps = {{.x = 1.5, .y = 3, .z = 3, .radius = radius}};
    Renderer renderer(read_field("msl98"), camera, options);
    SimState state = alone_at(0, 0, 0);
    state.robots.push_back({.id = 2, .at = {1.6, .5}, .radius = .15, .height = .5});
    const Frame frame = renderer.render(state, kMe);
    double low = 255, high = 0;
    std::vector<double> values;
    for (double x = 1.15; x < 1.6; x += .005) values.push_back(floor_y(camera, frame, {x, .15}));
    for (const double v : values) low = std::min(low, v), high = std::max(high, v);
    return std::ranges::count_if(
        values, [&](double v) { return v > low + .25 * (high - low) && v < low + .75 * (high - low); });
  };
  EXPECT_GT(steps(.8), 2 * steps(.02));
}

TEST(Renderer, LabelsAreThePaintThatIsSeen) {
  // Far lines are thinner than pixels and mixed with carpet.
  const FieldModel field = without_lines(read_field("msl98"));
  const MountedCamera camera = test::cameras()[0];
  RenderOptions options = plain_rendering();
  options.rays_per_side = 1;
  options.flat = true;
  options.exposure = 1;
  Renderer renderer(field, camera, options);
  const SimState state = among_others();
  const Frame frame = renderer.render(state, kMe);
  const SimView& view = renderer.look(state, kMe);
  std::map<int, int> pixels;
  for (int r = 1; r + 1 < view.height; ++r)
    for (int c = 2; c + 2 < view.width; ++c) {
      const auto label = [&](int x, int y) { return view.labels[static_cast<std::size_t>(y * view.width + x)]; };
      const int here = label(c, r);
      // Chroma is shared by two pixels.
      bool uniform = here != 0 && here != kLabelIgnored;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) uniform = uniform && label(c + dx, r + dy) == here;
      if (!uniform) continue;
      ++pixels[here];
      const double y = (frame.view.y(c, r) - 16) / 219., pb = (frame.view.u(c, r) - 128) / 224.,
                   pr = (frame.view.v(c, r) - 128) / 224.;
      const double red = y + 1.402 * pr, blue = y + 1.772 * pb, green = (y - .299 * red - .114 * blue) / .587;
      int best = 0;
      double nearest = 1e9;
      for (const ColorClass color : kColorClasses) {
        const Light paint = paint_of(color);
        // Paint at whatever brightness up to its own, and a little more for highlights.
        const double along =
            std::clamp((red * paint[0] + green * paint[1] + blue * paint[2]) / (paint * paint).sum(), .05, 1.3);
        const double off =
            std::hypot(red - along * paint[0], std::hypot(green - along * paint[1], blue - along * paint[2]));
        const bool dark_white = color == ColorClass::white && along < .3;
        if (!dark_white && off < nearest) {
          nearest = off;
          best = static_cast<int>(color);
        }
      }
      ASSERT_EQ(best, here) << c << ", " << r;
    }
  for (const ColorClass color : {ColorClass::black, ColorClass::white, ColorClass::green, ColorClass::cyan,
                                 ColorClass::magenta, ColorClass::red, ColorClass::yellow})
    EXPECT_GT(pixels[static_cast<int>(color)], 20) << to_string(color);
}

TEST(Renderer, VisibilityIsConsistent) {
  Renderer renderer(read_field("msl98"), test::cameras()[0], plain_rendering());
  SimState state = alone_at(0, 0, 0);
  state.ball = {.at = {2, 0}, .radius = .1};
  const SimVisibility free = renderer.look(state, kMe).ball;
  EXPECT_GT(free.visible_px, 100);
  EXPECT_EQ(free.visible_px, free.silhouette_px);
  EXPECT_EQ(free.box, free.full_box);
  state.robots.push_back({.id = 2, .at = {1.4, .1}, .radius = .12, .height = .5});
  const SimView& hidden = renderer.look(state, kMe);
  EXPECT_LT(hidden.ball.visible_px, free.visible_px);
  EXPECT_NEAR(hidden.ball.silhouette_px, free.silhouette_px, 2);
  EXPECT_EQ(hidden.robots[0].silhouette_px, 0) << "oneself does not show";
  EXPECT_EQ(hidden.robots[1].visible_px, hidden.robots[1].silhouette_px);
}

int count(const SimView& view, ColorClass color) {
  return static_cast<int>(std::ranges::count(view.labels, static_cast<std::uint8_t>(color)));
}

TEST(Renderer, EveryShippedFieldShowsWhatItHas) {
  for (const char* name : {"msl98", "msl9x5", "msl", "spl", "humanoid_kid", "rcj_soccer", "rcj_soccer_walls", "ssl"}) {
    FieldModel field = read_field(name);
    RenderOptions options = fast_rendering();
    CameraModel model = test::cameras()[1].model();
    CameraMount mount = test::cameras()[1].mount();
    mount.z = field.length < 4 ? .2 : .5;
    const MountedCamera camera(model, mount);
    const double x = field.length < 4 ? .2 : field.length / 2 - 3;
    const SimState state = alone_at(x, 0, 0);
    const SimView with = Renderer(field, camera, options).look(state, kMe);
    EXPECT_GT(count(with, ColorClass::green), 1000) << name;
    if (field.line_width > 0) {
      EXPECT_GT(count(with, ColorClass::white), 20) << name;
    }
    const double bright = mean_y(Renderer(field, camera, options).render(state, kMe));
    EXPECT_GT(bright, 60) << name << ": lamps light it, whatever its size";
    EXPECT_LT(bright, 160) << name;
    ASSERT_EQ(with.goals.size(), field.goals.size());
    for (std::size_t k = 0; k < field.goals.size(); ++k) {
      if (field.goals[k].side == GoalSide::plus_x) {
        EXPECT_GT(with.goals[k].visible_px, 20) << name;
      }
    }
    if (!field.walls) continue;
    const ColorClass wall = color_class_from(field.walls->color).value();
    field.walls.reset();
    const SimView without = Renderer(field, camera, options).look(state, kMe);
    EXPECT_LT(count(without, wall) + 500, count(with, wall)) << name << ": a field without walls has none";
  }
}

TEST(Renderer, MotionBlurSmearsWhatMoves) {
  RenderOptions options = plain_rendering();
  options.shutter = .03;
  options.sub_frames = 8;
  const MountedCamera camera = test::cameras()[0];
  Renderer renderer(read_field("msl98"), camera, options);
  SimState still = among_others(), turning = still;
  turning.robots[0].turn = 3;
  const auto steepness = [](const Frame& frame) {
    double sum = 0;
    for (int r = 0; r < frame.view.height(); ++r)
      for (int c = 1; c < frame.view.width(); ++c) sum += std::pow(frame.view.y(c, r) - frame.view.y(c - 1, r), 2);
    return sum;
  };
  EXPECT_LT(steepness(renderer.render(turning, kMe)), .5 * steepness(renderer.render(still, kMe)));
}

TEST(Renderer, ChromaOf420IsTheMeanOfFourPixels) {
  RenderOptions options = plain_rendering();
  options.rays_per_side = 1;
  const MountedCamera camera = test::cameras()[1];
  const FieldModel field = read_field("msl98");
  const Frame tall = Renderer(field, camera, options).render(among_others(), kMe);
  options.format = PixelFormat::yuv420p;
  const Frame low = Renderer(field, camera, options).render(among_others(), kMe);
  for (int r = 0; r + 1 < low.view.height(); r += 2)
    for (int c = 0; c < low.view.width(); ++c) {
      ASSERT_EQ(low.view.y(c, r), tall.view.y(c, r));
      ASSERT_NEAR(low.view.u(c, r), (tall.view.u(c, r) + tall.view.u(c, r + 1)) / 2., 1.01);
    }
}

TEST(Renderer, OptionsOutOfRangeAreNamed) {
  const auto refused = [](const std::function<void(RenderOptions&)>& change) {
    RenderOptions options;
    change(options);
    try {
      options.check();
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  EXPECT_EQ(refused([](RenderOptions&) {}), "taken");
  EXPECT_NE(refused([](RenderOptions& o) { o.exposure = 0; }).find("render.exposure"), std::string::npos);
  EXPECT_NE(refused([](RenderOptions& o) { o.blur_px = NAN; }).find("render.blur_px"), std::string::npos);
  EXPECT_NE(refused([](RenderOptions& o) { o.rays_per_side = 9; }).find("render.rays_per_side"), std::string::npos);
  EXPECT_NE(refused([](RenderOptions& o) { o.lamps = {{.z = -1}}; }).find("render.lamp.z"), std::string::npos);
  EXPECT_NE(refused([](RenderOptions& o) { o.format = PixelFormat::nv12; }).find("render.format"), std::string::npos);
}

}  // namespace
}  // namespace tassilo
