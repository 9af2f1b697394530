#include "tassilo/sim/internal/stage.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tassilo/field/field_curves.h"

namespace tassilo {
namespace {

using Eigen::Vector3f;

constexpr double kWallThickness = 0.04, kHallHeight = 5;

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  /// Evenly in [low, high); the standard library's own distributions differ from one to the other.
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }

 private:
  std::mt19937_64 engine_;
};

Vector3f vector(double x, double y, double z) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

Light rgb(double r, double g, double b) {
  return {static_cast<float>(r), static_cast<float>(g), static_cast<float>(b), 0};
}

class Builder {
 public:
  Stage stage;

  std::uint32_t surface(const Surface& surface) {
    stage.surfaces.push_back(surface);
    return static_cast<std::uint32_t>(stage.surfaces.size() - 1);
  }

  /// In pieces, as light is baked at their corners.
  void quad(const std::array<Vector3f, 4>& corners, std::uint32_t surface) {
    const Vector3f u = corners[1] - corners[0], v = corners[3] - corners[0], normal = u.cross(v).normalized();
    const Surface& of = stage.surfaces[surface];
    const float piece = of.is_floor ? 1e3F : of.is_outside ? 1.F : .4F;
    const auto columns = static_cast<std::uint32_t>(std::max(1.F, std::ceil(u.norm() / piece)));
    const auto rows = static_cast<std::uint32_t>(std::max(1.F, std::ceil(v.norm() / piece)));
    const auto first = static_cast<std::uint32_t>(stage.vertices.size());
    for (std::uint32_t r = 0; r <= rows; ++r)
      for (std::uint32_t c = 0; c <= columns; ++c) {
        stage.vertices.emplace_back(corners[0] + static_cast<float>(c) / static_cast<float>(columns) * u +
                                    static_cast<float>(r) / static_cast<float>(rows) * v);
        stage.normals.push_back(normal);
      }
    for (std::uint32_t r = 0; r < rows; ++r)
      for (std::uint32_t c = 0; c < columns; ++c) {
        const std::uint32_t a = first + r * (columns + 1) + c, b = a + columns + 1;
        stage.triangles.push_back({{a, a + 1, b + 1}, surface});
        stage.triangles.push_back({{a, b + 1, b}, surface});
      }
  }

  /// Level at height z.
  void plate(Interval x, Interval y, double z, std::uint32_t surface) {
    quad({vector(x.low, y.low, z), vector(x.high, y.low, z), vector(x.high, y.high, z), vector(x.low, y.high, z)},
         surface);
  }
  /// Upright from (x0, y0) to (x1, y1).
  void sheet(FieldPoint from, FieldPoint to, Interval z, std::uint32_t surface) {
    quad({vector(from.x, from.y, z.low), vector(to.x, to.y, z.low), vector(to.x, to.y, z.high),
          vector(from.x, from.y, z.high)},
         surface);
  }
  void box(Interval x, Interval y, Interval z, std::uint32_t surface) {
    if (x.high <= x.low || y.high <= y.low || z.high <= z.low) return;
    sheet({x.low, y.low}, {x.high, y.low}, z, surface);
    sheet({x.high, y.low}, {x.high, y.high}, z, surface);
    sheet({x.high, y.high}, {x.low, y.high}, z, surface);
    sheet({x.low, y.high}, {x.low, y.low}, z, surface);
    plate(x, y, z.high, surface);
  }
  /// Upright, round, without bottom and top; `low` and `high` are its radii there.
  void tube(FieldPoint at, double low, double high, Interval z, std::uint32_t surface) {
    constexpr std::uint32_t sides = 20;
    const auto first = static_cast<std::uint32_t>(stage.vertices.size());
    for (std::uint32_t k = 0; k <= sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      const double c = std::cos(angle), s = std::sin(angle);
      stage.vertices.push_back(vector(at.x + low * c, at.y + low * s, z.low));
      stage.vertices.push_back(vector(at.x + high * c, at.y + high * s, z.high));
      stage.normals.insert(stage.normals.end(), 2, vector(c, s, 0));
    }
    for (std::uint32_t k = 0; k < 2 * sides; k += 2) {
      stage.triangles.push_back({{first + k, first + k + 2, first + k + 3}, surface});
      stage.triangles.push_back({{first + k, first + k + 3, first + k + 1}, surface});
    }
  }
  void globe(FieldPoint at, double z, double radius, std::uint32_t surface) {
    constexpr std::uint32_t sides = 14, rings = 8;
    const auto first = static_cast<std::uint32_t>(stage.vertices.size());
    for (std::uint32_t r = 0; r <= rings; ++r)
      for (std::uint32_t k = 0; k <= sides; ++k) {
        const double a = 2 * std::numbers::pi * k / sides, e = std::numbers::pi * (static_cast<double>(r) / rings - .5);
        const Vector3f normal = vector(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
        stage.vertices.push_back(vector(at.x, at.y, z) + static_cast<float>(radius) * normal);
        stage.normals.push_back(normal);
      }
    for (std::uint32_t r = 0; r < rings; ++r)
      for (std::uint32_t k = 0; k < sides; ++k) {
        const std::uint32_t a = first + r * (sides + 1) + k, b = a + sides + 1;
        stage.triangles.push_back({{a, a + 1, b + 1}, surface});
        stage.triangles.push_back({{a, b + 1, b}, surface});
      }
  }
};

std::uint8_t label_of(ColorClass color) { return static_cast<std::uint8_t>(color); }

/// The box from the mouth outwards, for a goal on either side.
Interval outwards(const FieldModel::Goal& goal, double from, double to) {
  return goal.side == GoalSide::plus_x ? Interval{from, to} : Interval{-to, -from};
}

double mouth_x(const FieldModel& field, const FieldModel::Goal& goal) {
  const FieldExtent extent = field_extent(field);
  return goal.side == GoalSide::plus_x ? extent.x.high : -extent.x.low;
}

double post_width(const FieldModel::Goal& goal) { return std::min(0.05, goal.height / 4); }

void add_panels(Builder& builder, const FieldModel& field, int index) {
  const FieldModel::Goal& goal = field.goals[static_cast<std::size_t>(index)];
  const ColorClass color = goal.color == GoalColor::blue ? ColorClass::blue : ColorClass::yellow;
  const std::uint32_t panel = builder.surface({.albedo = paint_of(color), .label = label_of(color), .goal = index});
  const double front = mouth_x(field, goal), sign = goal.side == GoalSide::plus_x ? 1 : -1;
  const double back = sign * (front + goal.depth), x = sign * front, y = goal.width / 2;
  builder.sheet({x, y}, {back, y}, {0, goal.height}, panel);
  builder.sheet({back, y}, {back, -y}, {0, goal.height}, panel);
  builder.sheet({back, -y}, {x, -y}, {0, goal.height}, panel);
}

void add_frame(Builder& builder, const FieldModel& field, const FieldModel::Goal& goal) {
  const std::uint32_t white = builder.surface({.albedo = paint_of(ColorClass::white), .label = 2});
  const double post = post_width(goal), half = goal.width / 2, x = mouth_x(field, goal);
  const Interval depth = outwards(goal, x, x + post);
  // The panel's paint, not the post's, is what the mouth shows at its side.
  constexpr double behind = 2e-4;
  builder.box(depth, {half + behind, half + post}, {0, goal.height + post}, white);
  builder.box(depth, {-half - post, -half - behind}, {0, goal.height + post}, white);
  builder.box(depth, {-half, half}, {goal.height, goal.height + post}, white);
  builder.plate(depth, {-half, half}, goal.height, white);
}

void add_walls(Builder& builder, const FieldModel& field) {
  const FieldModel::Walls& walls = *field.walls;
  const ColorClass color = color_class_from(walls.color).value_or(ColorClass::white);
  const std::uint32_t paint = builder.surface({.albedo = paint_of(color), .label = label_of(color)});
  const Interval z{0, walls.height}, x{walls.x.low - kWallThickness, walls.x.high + kWallThickness};
  builder.box(x, {walls.y.high, walls.y.high + kWallThickness}, z, paint);
  builder.box(x, {walls.y.low - kWallThickness, walls.y.low}, z, paint);
  for (const GoalSide side : {GoalSide::plus_x, GoalSide::minus_x}) {
    const Interval at = side == GoalSide::plus_x ? Interval{walls.x.high, walls.x.high + kWallThickness}
                                                 : Interval{walls.x.low - kWallThickness, walls.x.low};
    double from = walls.y.low;
    for (const FieldModel::Goal& goal : field.goals) {
      if (goal.side != side) continue;
      builder.box(at, {from, -goal.width / 2 - post_width(goal)}, z, paint);
      from = goal.width / 2 + post_width(goal);
    }
    builder.box(at, {from, walls.y.high}, z, paint);
  }
}

/// A place outside the field and its goals, `rim` from it at least.
FieldPoint place_outside(Dice& dice, const Stage& stage, double rim) {
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const FieldPoint at{dice.between(stage.hall_x.low + .4, stage.hall_x.high - .4),
                        dice.between(stage.hall_y.low + .4, stage.hall_y.high - .4)};
    if (at.x < stage.carpet_x.low - rim || at.x > stage.carpet_x.high + rim || at.y < stage.carpet_y.low - rim ||
        at.y > stage.carpet_y.high + rim)
      return at;
  }
  return {stage.hall_x.low, stage.hall_y.low};
}

Surface outside(const Light& albedo) { return {.albedo = albedo, .label = kLabelIgnored, .is_outside = true}; }

const std::array<Light, 10> kCloth{rgb(.25, .08, .32), rgb(.35, .33, .08), rgb(.55, .55, .55), rgb(.18, .09, .04),
                                   rgb(.02, .02, .03), rgb(.35, .04, .04), rgb(.08, .1, .35),  rgb(.03, .2, .3),
                                   rgb(.05, .18, .08), rgb(.3, .12, .04)};

void add_person(Builder& builder, Dice& dice, FieldPoint at, const Light& shirt) {
  const double height = dice.between(1.6, 1.95), girth = dice.between(.17, .24);
  const std::uint32_t cloth = builder.surface(outside(shirt));
  const std::uint32_t trousers = builder.surface(outside(.6F * kCloth[dice.below(kCloth.size())]));
  const std::uint32_t skin = builder.surface(outside(rgb(.5, .27, .18)));
  builder.tube(at, girth * .7, girth * .8, {0, .5 * height}, trousers);
  builder.tube(at, girth, girth * .9, {.48 * height, .83 * height}, cloth);
  builder.plate({at.x - .7 * girth, at.x + .7 * girth}, {at.y - .7 * girth, at.y + .7 * girth}, .83 * height, cloth);
  builder.globe(at, .92 * height, .065 * height, skin);
}

void add_hall(Builder& builder, const FieldModel& field, const StageOptions& options) {
  Stage& stage = builder.stage;
  Dice dice(options.seed * 0x9E3779B97F4A7C15U + 1);
  const std::uint32_t gray = builder.surface({.albedo = rgb(.135, .135, .135), .is_outside = true});
  const std::uint32_t ceiling = builder.surface({.albedo = rgb(.08, .08, .08), .is_outside = true});
  const Interval z{0, kHallHeight};
  const auto& [x, y] = std::pair(stage.hall_x, stage.hall_y);
  builder.sheet({x.low, y.low}, {x.low, y.high}, z, gray);
  builder.sheet({x.high, y.high}, {x.high, y.low}, z, gray);
  builder.sheet({x.low, y.high}, {x.high, y.high}, z, gray);
  builder.sheet({x.high, y.low}, {x.low, y.low}, z, gray);
  builder.quad({vector(x.low, y.low, kHallHeight), vector(x.low, y.high, kHallHeight),
                vector(x.high, y.high, kHallHeight), vector(x.high, y.low, kHallHeight)},
               ceiling);

  const auto count = [](double amount, double all) { return static_cast<int>(std::lround(amount * all)); };
  const double around = 2 * (x.high - x.low + y.high - y.low);
  for (int k = 0; k < count(options.clutter, around / 4); ++k) {  // crates and tables
    const FieldPoint at = place_outside(dice, stage, .5);
    const double w = dice.between(.2, .6), d = dice.between(.2, .4), h = dice.between(.4, 1);
    const std::uint32_t low = builder.surface(outside(.7F * kCloth[dice.below(kCloth.size())]));
    const std::uint32_t high = builder.surface(outside(.7F * kCloth[dice.below(kCloth.size())]));
    builder.box({at.x - w, at.x + w}, {at.y - d, at.y + d}, {0, h * .6}, low);
    builder.box({at.x - w, at.x + w}, {at.y - d, at.y + d}, {h * .6, h}, high);
  }
  for (int k = 0; k < count(options.clutter, around / 5); ++k) {  // posters
    const std::uint32_t poster = builder.surface(outside(.6F * kCloth[dice.below(kCloth.size())]));
    const double w = dice.between(.3, 1.2), low = dice.between(.8, 1.6), high = low + dice.between(.4, .9);
    const bool end = dice.below(2) == 0, far = dice.below(2) == 0;
    if (end) {
      const double at = dice.between(y.low + w, y.high - w), off = .01 + .004 * k,
                   px = far ? x.high - off : x.low + off;
      builder.sheet({px, far ? at + w : at - w}, {px, far ? at - w : at + w}, {low, high}, poster);
    } else {
      const double at = dice.between(x.low + w, x.high - w), off = .01 + .004 * k,
                   py = far ? y.high - off : y.low + off;
      builder.sheet({far ? at - w : at + w, py}, {far ? at + w : at - w, py}, {low, high}, poster);
    }
  }
  const Light ball = paint_of(color_class_from(field.ball.color).value_or(ColorClass::red));
  for (int k = 0; k < count(options.people, around / 1.7); ++k) {
    const FieldPoint at = place_outside(dice, stage, .45);
    const Light& shirt = kCloth[dice.below(kCloth.size())];
    add_person(builder, dice, at, options.ball_colored_people && k % 4 == 0 ? ball : shirt);
  }
}

}  // namespace

Light paint_of(ColorClass color) {
  switch (color) {
    case ColorClass::black:
      return rgb(.032, .032, .033);
    case ColorClass::white:
      return rgb(.87, .87, .85);
    case ColorClass::green:
      return rgb(.057, .207, .084);
    case ColorClass::blue:
      return rgb(.033, .079, .36);
    case ColorClass::cyan:
      return rgb(.05, .295, .378);
    case ColorClass::magenta:
      return rgb(.43, .075, .218);
    case ColorClass::red:
      return rgb(.72, .115, .045);
    case ColorClass::yellow:
      return rgb(.86, .55, .09);
    case ColorClass::no_color:
      break;
  }
  return rgb(.2, .2, .2);
}

Stage make_stage(const FieldModel& field, const StageOptions& options) {
  Builder builder;
  Stage& stage = builder.stage;
  const FieldExtent extent = field_extent(field);
  double behind = 0.02;
  for (const FieldModel::Goal& goal : field.goals) behind = std::max(behind, goal.depth + 0.02);
  const double size = std::max(extent.x.high - extent.x.low, extent.y.high - extent.y.low);
  const double margin = field.walls ? 0.02 : std::clamp(0.1 * size, 0.3, 1.0), hall = std::clamp(.4 * size, 2.5, 4.);
  const double margin_x = std::max(margin, behind);
  stage.carpet_x = {extent.x.low - margin_x, extent.x.high + margin_x};
  stage.carpet_y = {extent.y.low - margin, extent.y.high + margin};
  stage.hall_x = {stage.carpet_x.low - hall, stage.carpet_x.high + 1.2 * hall};
  stage.hall_y = {stage.carpet_y.low - 1.1 * hall, stage.carpet_y.high + hall};

  const std::uint32_t floor =
      builder.surface({.albedo = paint_of(ColorClass::green), .label = label_of(ColorClass::green), .is_floor = true});
  builder.plate(stage.hall_x, stage.hall_y, 0, floor);
  if (field.walls) add_walls(builder, field);
  for (std::size_t k = 0; k < field.goals.size(); ++k) {
    add_panels(builder, field, static_cast<int>(k));
    add_frame(builder, field, field.goals[k]);
  }
  add_hall(builder, field, options);
  return std::move(builder.stage);
}

Stage make_goal(const FieldModel& field, int goal) {
  Builder builder;
  add_panels(builder, field, goal);
  return std::move(builder.stage);
}

}  // namespace tassilo
