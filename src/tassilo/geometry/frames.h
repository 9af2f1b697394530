#pragma once

// Coordinate frames as types: a point of one frame does not fit where another is asked for.
// docs/conventions.md has them in one picture.

namespace tassilo {

struct ImageFrame;    ///< Pixels: x = column, y = row; the centre of the top-left pixel is (0, 0). [px]
struct OpticalFrame;  ///< Origin: optical centre. X right, Y down, Z forward. [m]
struct RobotFrame;    ///< Origin: floor under the robot's centre. x forward, y left, z up (REP-103). [m]
struct FieldFrame;    ///< Origin: field centre on the floor. x to the +x goal (blue), y left, z up. [m]

}  // namespace tassilo
