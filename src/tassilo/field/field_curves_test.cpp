#include "tassilo/field/field_curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tassilo {
namespace {

FieldModel walled() {
  FieldModel field;
  field.length = 10;
  field.width = 6;
  field.line_width = 0.05;
  field.halfway_line = true;
  field.circle_radius = 1;
  field.areas = {{1, 3}};
  field.walls = FieldModel::Walls{.color = "white", .height = 0.5, .x = {-5, 5}, .y = {-3, 3}};
  field.goals = {{GoalSide::plus_x, GoalColor::blue, 2, 0.9, 0.5}, {GoalSide::minus_x, GoalColor::yellow, 2, 0.9, 0.5}};
  return field;
}

double length_of(const FieldCurves& curves, const std::string& name, bool is_wall) {
  double sum = 0;
  for (const FieldLine& line : curves.lines)
    if (line.name == name && line.is_wall == is_wall) sum += distance(line.p, line.q);
  return sum;
}

TEST(FieldCurves, WallsAreOpenWhereGoalsAre) {
  const FieldCurves curves = field_curves(walled());
  EXPECT_DOUBLE_EQ(length_of(curves, "x_plus", true), 6 - 2);
  EXPECT_DOUBLE_EQ(length_of(curves, "x_minus", true), 6 - 2);
  EXPECT_DOUBLE_EQ(length_of(curves, "y_plus", true), 10);
}

TEST(FieldCurves, LinesAreKnownByTheirMiddles) {
  FieldModel field = walled();
  field.walls.reset();
  field.touchlines = true;
  const FieldCurves curves = field_curves(field);
  for (const FieldLine& line : curves.lines) {
    EXPECT_FALSE(line.is_wall);
    if (line.name == "x_plus") {
      EXPECT_DOUBLE_EQ(line.p.x, 5 - 0.025);
    }
    if (line.name == "y_minus") {
      EXPECT_DOUBLE_EQ(line.p.y, -3 + 0.025);
    }
    if (line.name == "area_1_front") {
      EXPECT_DOUBLE_EQ(std::abs(line.p.x), 5 - 1 + 0.025);
    }
  }
  ASSERT_EQ(curves.arcs.size(), 1u);
  EXPECT_EQ(curves.arcs[0].name, "circle");
}

TEST(FieldCurves, OfASymmetricFieldAreTheirOwnPointMirror) {
  const FieldCurves curves = field_curves(walled());
  for (const FieldLine& line : curves.lines)
    EXPECT_TRUE(std::ranges::any_of(curves.lines, [&](const FieldLine& other) {
      const FieldPoint p = -1.0 * other.p, q = -1.0 * other.q;
      return other.is_wall == line.is_wall &&
             std::min(distance(line.p, p) + distance(line.q, q), distance(line.p, q) + distance(line.q, p)) < 1e-12;
    })) << line.name;
}

TEST(FieldCurves, OfAnEmptyFieldAreNone) {
  FieldModel field;
  field.length = 4;
  field.width = 3;
  EXPECT_TRUE(field_curves(field).lines.empty());
  EXPECT_TRUE(field_curves(field).arcs.empty());
}

}  // namespace
}  // namespace tassilo
