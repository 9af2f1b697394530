#include "tassilo/overlay/overlay.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/overlay/internal/bird_view.h"
#include "tassilo/overlay/internal/canvas.h"
#include "tassilo/overlay/internal/floor_view.h"
#include "tassilo/overlay/internal/label_layout.h"
#include "tassilo/overlay/internal/text.h"
#include "tassilo/region/raster.h"

namespace tassilo {
namespace {

constexpr int kReadableWidth = 768;  // [px]
constexpr int kLargestScale = 16;
constexpr int kLargestSide = 32767;  // of a Cairo surface [px]

int even(double value) { return 2 * static_cast<int>(std::lround(value / 2)); }

/// Where everything goes; from the frame's size and the options only.
struct Layout {
  int scale = 1;
  Rect image, status, bird;
  int width = 0, height = 0;
  double text = 12;  ///< Text size. [px]
};

Layout make_layout(const FrameView& frame, const OverlayOptions& options) {
  Layout layout;
  const int width = std::max(frame.width(), 1);
  layout.scale = options.scale > 0 ? options.scale : std::min(kLargestScale, (kReadableWidth + width - 1) / width);
  layout.image = {0, 0, static_cast<double>(frame.width() * layout.scale),
                  static_cast<double>(frame.height() * layout.scale)};
  layout.text = std::clamp(layout.image.width / 64, 10.0, 30.0);
  const double height = layout.image.height;
  double right = layout.image.width;
  if (options.camera != nullptr && options.bird_view) {
    layout.bird = {right, 0, std::round(std::clamp(.9 * height, .3 * right, .4 * right)), height};
    right = layout.bird.right();
  }
  const double bar = std::round(2.1 * layout.text);
  layout.width = even(std::ceil(right));
  layout.height = even(height + bar);
  layout.status = {0, height, static_cast<double>(layout.width), layout.height - height};
  if (layout.bird.width > 0) layout.bird.width = layout.width - layout.bird.x;
  if (layout.width > kLargestSide || layout.height > kLargestSide)
    throw Error("overlay", "is " + std::to_string(layout.width) + "x" + std::to_string(layout.height) +
                               " px, must be at most " + std::to_string(kLargestSide) + " in both directions");
  return layout;
}

/// 255 for each pixel of the frame that may be tinted as free floor, 0 where something shows that should keep its
/// color.
std::vector<std::uint8_t> tinted_pixels(const FrameView& frame, const Scene& scene, const Surface* surface) {
  const auto columns = static_cast<std::size_t>(frame.width()), rows = static_cast<std::size_t>(frame.height());
  std::vector<std::uint8_t> tinted(columns * rows, 255);
  if (surface != nullptr)
    std::ranges::transform(surface->kinds, tinted.begin(),
                           [](SurfaceKind kind) { return kind == SurfaceKind::carpet ? 255 : 0; });
  for (const Ball& ball : scene.balls) {
    constexpr double kRim = 1;  // of mixed colors, beside the disc [px]
    const double reach = ball.radius_px + kRim;
    const auto clamped = [](double value, int size) { return static_cast<int>(std::clamp(value, 0.0, double(size))); };
    const int top = clamped(ball.center.y - reach, frame.height()),
              bottom = clamped(ball.center.y + reach + 1, frame.height()),
              left = clamped(ball.center.x - reach, frame.width()),
              right = clamped(ball.center.x + reach + 1, frame.width());
    for (int r = top; r < bottom; ++r)
      for (int c = left; c < right; ++c)
        if (std::hypot(c - ball.center.x, r - ball.center.y) <= reach)
          tinted[static_cast<std::size_t>(r) * columns + static_cast<std::size_t>(c)] = 0;
  }
  return tinted;
}

/// One step by itself.
void draw_step(Canvas& canvas, const Layout& layout, const StepPicture& step, int columns, int rows) {
  const std::vector<std::uint8_t> inside = to_mask(step.region, {0, 0, columns, rows});
  const Rect& all = layout.image;
  const std::vector<std::vector<CanvasPoint>> everything{
      {{all.x, all.y}, {all.right(), all.y}, {all.right(), all.bottom()}, {all.x, all.bottom()}}};
  canvas.fill_polygons_where(everything, team_ink(Team::cyan).with_alpha(.45), inside, columns, all);
  const Ink inks[] = {kBallInk, goal_ink(GoalColor::yellow), kBoundaryInk, kFreeInk};
  for (std::size_t k = 0; k < step.contours.size(); ++k) {
    std::vector<CanvasPoint> points;
    for (const PixelPoint& point : step.contours[k].points) points.push_back(on_canvas(point, layout.scale));
    if (step.contours[k].closed) points.push_back(points.front());
    const double width_px = 1.6 * layout.text / 12;
    if (points.size() == 1)
      canvas.fill_circle(points.front(), width_px, inks[k % std::size(inks)]);
    else
      canvas.polyline(points, {.ink = inks[k % std::size(inks)], .width = width_px, .cased = true});
  }
}

/// Draws onto the enlarged image.
class ImageDrawing {
 public:
  ImageDrawing(Canvas& canvas, const Layout& layout)
      : canvas_(canvas), layout_(layout), unit_(layout.text / 12), labels_(label_bounds(layout)) {}

  void draw(const FrameView& frame, const Scene& scene, const OverlayOptions& options) {
    if (options.camera != nullptr && scene.free_space)
      free_space(project_free_space(*scene.free_space, *options.camera, layout_.scale),
                 tinted_pixels(frame, scene, options.surface), frame.width());
    for (const LineSeen& line : scene.lines) {
      const CanvasPoint p = on_canvas(line.image_p, layout_.scale), q = on_canvas(line.image_q, layout_.scale);
      canvas_.polyline(std::vector{p, q}, {.ink = line_ink(line.kind), .width = 2 * unit_, .cased = true});
    }
    for (const Goal& goal : scene.goals)
      box(goal.box, {.ink = goal_ink(goal.color), .width = 2 * unit_, .cased = true});
    for (const RobotSeen& robot : scene.robots)
      box(robot.box, {.ink = team_ink(robot.team), .width = 2 * unit_, .cased = true});
    for (std::size_t i = scene.balls.size(); i-- > 0;) ball(scene.balls[i], i == 0);
    if (options.camera != nullptr)
      for (const TrackSeen& track : scene.tracks) this->track(track, *options.camera);

    for (const Ball& ball : scene.balls) {
      const bool is_best = &ball == &scene.balls.front();
      std::string name = is_best ? "ball" : "";
      if (is_best && ball.floor) name.append(" ").append(meters(norm(ball.floor->position.mean)));
      label(ball.box, joined({name, percent(ball.confidence)}), kBallInk);
    }
    for (const RobotSeen& robot : scene.robots) {
      std::string name(robot.team == Team::unknown ? "robot" : to_string(robot.team));
      if (robot.floor) name.append(" ").append(meters(norm(robot.floor->nearest.mean)));
      label(robot.box, name, team_ink(robot.team));
    }
    for (const Goal& goal : scene.goals) {
      std::string name(to_string(goal.color));
      name += " goal";
      if (goal.position) name.append(" ").append(meters(norm(*goal.position)));
      label(goal.box, joined({name, goal.bearing ? bearing_text(*goal.bearing) : ""}), goal_ink(goal.color));
    }
  }

 private:
  static Rect label_bounds(const Layout& layout) {
    const double margin = layout.text / 4;
    return {margin, margin, layout.image.width - 2 * margin, layout.image.height - 2 * margin};
  }

  Rect on_image(const PixelBox& box) const {
    const double s = layout_.scale;
    return {box.x0 * s, box.y0 * s, box.width() * s, box.height() * s};
  }

  void free_space(const FreeSpaceInImage& space, const std::vector<std::uint8_t>& tinted, int columns) {
    canvas_.fill_polygons_where(space.floor, kFreeInk.with_alpha(.22), tinted, columns, layout_.image);
    for (const auto& edge : space.open) canvas_.polyline(edge, {.ink = kFreeInk.with_alpha(.75), .width = 1.4 * unit_});
    for (const auto& edge : space.blocked)
      canvas_.polyline(edge, {.ink = kBlockedInk, .width = 2.4 * unit_, .cased = true});
  }

  void box(const PixelBox& pixels, const Pen& pen) {
    labels_.keep_clear(on_image(pixels));
    canvas_.stroke_rounded(on_image(pixels), 3 * unit_, pen);
  }

  void ball(const Ball& ball, bool is_best) {
    const Ink color = kBallInk.with_alpha(is_best ? 1 : .6);
    const CanvasPoint center = on_canvas(ball.center, layout_.scale);
    box(ball.box, {.ink = color, .width = (is_best ? 2 : 1.2) * unit_, .cased = is_best});
    if (!is_best) return;
    labels_.keep_free(on_image(ball.box));
    canvas_.stroke_circle(center, ball.radius_px * layout_.scale,
                          {.ink = kTextInk.with_alpha(.9), .width = 1.2 * unit_});
  }

  /// On the floor: where it comes in a moment, and its number; a dashed ring where it is remembered only.
  void track(const TrackSeen& track, const MountedCamera& camera) {
    const auto on_image = [&](double time) {
      return camera.project({track.x + time * track.vx, track.y + time * track.vy, 0});
    };
    const auto now = on_image(0), soon = on_image(kArrowTime);
    if (!now || !soon) return;
    const CanvasPoint place = on_canvas(*now, layout_.scale);
    const Ink color = track_ink(track);
    if (track.age > 0)
      canvas_.stroke_circle(place, .5 * layout_.text, {.ink = color, .width = 1.4 * unit_, .dashed = true});
    canvas_.arrow(place, on_canvas(*soon, layout_.scale), {.ink = color, .width = 1.8 * unit_, .cased = true});
    canvas_.text(number_text(track.id), {place.x, place.y + .9 * layout_.text}, TextAnchor::center,
                 {.size = .85 * layout_.text, .ink = color, .weight = TextWeight::bold});
  }

  void label(const PixelBox& pixels, const std::string& words, Ink color) {
    const TextStyle style{.size = layout_.text, .ink = kTextInk, .weight = TextWeight::bold};
    const double dot = .28 * style.size, padding = .4 * style.size;
    const double height = 1.45 * style.size;
    const double width = canvas_.text_width(words, style) + 3 * padding + 2 * dot;
    const Rect place = labels_.place(on_image(pixels), width, height);
    const double middle = place.y + height / 2;
    canvas_.fill_rounded(place, 4 * unit_, kPanelInk.with_alpha(.72));
    canvas_.fill_circle({place.x + padding + dot, middle}, dot, color);
    canvas_.text(words, {place.x + 2 * padding + 2 * dot, middle}, TextAnchor::left, style);
  }

  Canvas& canvas_;
  const Layout& layout_;
  double unit_;  ///< Width of strokes relative to the usual picture. [1]
  LabelLayout labels_;
};

void draw_status(Canvas& canvas, const Layout& layout, const Scene& scene, const StepPicture* step) {
  canvas.clipped(layout.status, [&] {
    canvas.fill_rect(layout.status, kPanelInk);
    const double middle = layout.status.y + layout.status.height / 2, margin = layout.text;
    const TextStyle strong{.size = layout.text, .ink = kTextInk, .weight = TextWeight::bold};
    const TextStyle quiet{.size = layout.text, .ink = kQuietTextInk};
    double x = margin;
    const auto word = [&](const std::string& text, const TextStyle& style) {
      canvas.text(text, {x, middle}, TextAnchor::left, style);
      x += canvas.text_width(text, style) + 1.4 * layout.text;
    };
    word("frame " + std::to_string(scene.frame), strong);
    if (step != nullptr) word(step->title, strong);
    word(fixed(scene.t, 3) + " s", quiet);
    if (!scene.image.empty()) word(scene.image, quiet);
    if (scene.pose) {
      const PoseSeen& pose = *scene.pose;
      const double sigma = std::sqrt(pose.covariance[0] + pose.covariance[4]);
      word("x " + fixed(pose.x, 2) + "  y " + fixed(pose.y, 2) + " m  " + fixed(degrees(pose.theta), 0) + "\u00b0",
           strong);
      word("\u00b1 " + fixed(100 * sigma, 1) + " cm  " + std::string(to_string(pose.kind)) +
               (pose.mirror ? ", or the mirrored place" : ""),
           quiet);
    }
    if (scene.timing.empty()) return;
    canvas.text(fixed(scene.timing.back().ms, 2) + " ms", {layout.status.right() - margin, middle}, TextAnchor::right,
                strong);
  });
}

}  // namespace

void OverlayOptions::check() const {
  if (scale < 0 || scale > kLargestScale)
    throw Error("overlay.scale", "is " + std::to_string(scale) + ", must be 0.." + std::to_string(kLargestScale));
  if (!(bird_range > 0) || !std::isfinite(bird_range))
    throw Error("overlay.bird_range", "is " + std::to_string(bird_range) + ", must be > 0");
}

Picture draw_overlay(const FrameView& frame, ColorRange range, const Scene& scene, const OverlayOptions& options) {
  options.check();
  const auto pixels = static_cast<std::size_t>(frame.width()) * static_cast<std::size_t>(frame.height());
  expects(options.labels.empty() || options.labels.size() == pixels, "draw_overlay: one label per pixel");
  expects(options.surface == nullptr ||
              (options.surface->width == frame.width() && options.surface->height == frame.height()),
          "draw_overlay: the surface is the frame's");
  const Layout layout = make_layout(frame, options);
  Canvas canvas(layout.width, layout.height, kPanelInk);
  canvas.image(picture_from_frame(frame, range), layout.image);
  if (!options.labels.empty()) canvas.label_map(options.labels, frame.width(), layout.image);
  canvas.clipped(layout.image, [&] {
    if (options.step != nullptr)
      draw_step(canvas, layout, *options.step, frame.width(), frame.height());
    else
      ImageDrawing(canvas, layout).draw(frame, scene, options);
  });
  if (layout.bird.width > 0) draw_bird_view(canvas, layout.bird, scene, options.bird_range);
  draw_status(canvas, layout, scene, options.step);
  return canvas.picture();
}

}  // namespace tassilo
