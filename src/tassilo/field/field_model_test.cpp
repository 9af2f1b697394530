#include "tassilo/field/field_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

FieldModel full_field() {
  FieldModel field;
  field.length = 8.22;
  field.width = 4.575;
  field.line_width = 0.035;
  field.circle_radius = 1;
  field.areas = {{1.0, 2.6}};
  field.segments = {{3, -1, 3, 1}};
  field.arcs = {{0, 0, 0.5, 0, 1.5}};
  field.goals = {{GoalSide::plus_x, GoalColor::blue, 1.5, 0.9, 0.5},
                 {GoalSide::minus_x, GoalColor::yellow, 1.5, 0.9, 0.5}};
  field.walls = FieldModel::Walls{"white", 0.5, {-4.11, 4.11}, {-2.2875, 2.2875}};
  return field;
}

TEST(FieldModel, AcceptsFullAndMinimalFields) {
  EXPECT_NO_THROW(full_field().check());
  FieldModel bare;
  bare.length = 9;
  bare.width = 6;
  EXPECT_NO_THROW(bare.check());
}

TEST(FieldModel, NamesTheFirstValueOutOfRange) {
  struct Case {
    std::function<void(FieldModel&)> spoil;
    std::string message;
  };
  const Case cases[] = {
      {[](FieldModel& f) { f.length = 0; }, "field.length: is 0, must be > 0 and <= 200 [m]"},
      {[](FieldModel& f) { f.length = 8220; }, "field.length: is 8220, must be > 0 and <= 200 [m]"},
      {[](FieldModel& f) { f.width = kNan; }, "field.width: is nan, must be > 0 and <= 200 [m]"},
      {[](FieldModel& f) { f.line_width = -1; }, "field.line_width: is -1, must be >= 0 and <= 200 [m]"},
      {[](FieldModel& f) { f.line_width = 3; }, "field.line_width: is 3, must be below half the field's size [m]"},
      {[](FieldModel& f) { f.circle_radius = 3; },
       "field.circle_radius: is 3, must be <= half the field's size, 2.2875 [m]"},
      {[](FieldModel& f) { f.areas[0].depth = 5; }, "field.areas[0].depth: is 5, must be <= half the length, 4.11 [m]"},
      {[](FieldModel& f) { f.areas[0].width = 5; }, "field.areas[0].width: is 5, must be <= the width, 4.575 [m]"},
      {[](FieldModel& f) { f.segments[0].x1 = kInfinity; }, "field.segments[0]: is inf, must be within +-200 [m]"},
      {[](FieldModel& f) {
         f.segments[0] = {1, 1, 1, 1};
       },
       "field.segments[0]: is a point, must have two different ends"},
      {[](FieldModel& f) { f.arcs[0].radius = 0; }, "field.arcs[0].radius: is 0, must be > 0 and <= 200 [m]"},
      {[](FieldModel& f) { f.arcs[0].cx = kNan; }, "field.arcs[0].center: is nan, must be within +-200 [m]"},
      {[](FieldModel& f) { f.arcs[0].to = 90; }, "field.arcs[0].angle: is 90, must be within +-10 [rad]"},
      {[](FieldModel& f) { f.arcs[0].to = -1; }, "field.arcs[0].from: is 0, must be < to, -1 [rad]"},
      {[](FieldModel& f) { f.goals[1].side = GoalSide::plus_x; },
       "field.goals[1].side: is the side of goals[0], each side has one goal at most"},
      {[](FieldModel& f) { f.goals[0].depth = -1; }, "field.goals[0].depth: is -1, must be >= 0 and <= 200 [m]"},
      {[](FieldModel& f) { f.goals[0].width = 5; },
       "field.goals[0].width: is 5, must be <= the field's width, 4.575 [m]"},
      {[](FieldModel& f) { f.walls->height = 0; }, "field.walls.height: is 0, must be > 0 and <= 200 [m]"},
      {[](FieldModel& f) {
         f.walls->x = {4, -4};
       },
       "field.walls.x: is [4, -4], must be [low, high] with low < high"},
      {[](FieldModel& f) {
         f.ball.radius = {0.2, 0.1};
       },
       "field.ball.radius: is [0.2, 0.1], must be [low, high]"},
      {[](FieldModel& f) { f.robots.width.low = 0; }, "field.robots.width[0]: is 0, must be > 0 and <= 200 [m]"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.message);
    FieldModel field = full_field();
    c.spoil(field);
    EXPECT_THAT([&] { field.check(); }, testing::ThrowsMessage<Error>(c.message));
  }
}

}  // namespace
}  // namespace tassilo
