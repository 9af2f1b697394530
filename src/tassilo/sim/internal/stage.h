#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "tassilo/color/color_class.h"
#include "tassilo/field/field_model.h"

namespace tassilo {

/// Linear red, green, blue; 1 is what saturates at exposure 1. The fourth is unused.
using Light = Eigen::Array4f;

inline constexpr std::uint8_t kLabelIgnored = 255;  ///< Of label maps: any answer is right.

/// How a surface looks and what it is.
struct Surface {
  Light albedo = Light::Zero();
  std::uint8_t label = 0;
  bool is_floor = false;    ///< Carpet and marks, by place.
  bool is_outside = false;  ///< The hall and all in it beyond the field: takes no part in shadows.
  int goal = -1;            ///< Panel of this goal of the field.
};

/// All that does not move, as triangles of the field frame.
struct Stage {
  struct Triangle {
    std::array<std::uint32_t, 3> corners;
    std::uint32_t surface;
  };
  std::vector<Eigen::Vector3f> vertices, normals;  ///< One normal a vertex.
  std::vector<Triangle> triangles;
  std::vector<Surface> surfaces;
  Interval carpet_x, carpet_y;  ///< The floor beyond is the hall's.
  Interval hall_x, hall_y;
};

/// What stands around the field.
struct StageOptions {
  double clutter = 0, people = 0;    ///< 0..1
  bool ball_colored_people = false;  ///< Some people wear shirts of the ball's color.
  std::uint64_t seed = 1;
};

/// The mean color of a class as paint, so that a scene lit as in the recordings has their colors.
Light paint_of(ColorClass color);

Stage make_stage(const FieldModel& field, const StageOptions& options);
/// The colored panels of one goal alone.
Stage make_goal(const FieldModel& field, int goal);

}  // namespace tassilo
