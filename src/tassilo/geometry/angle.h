#pragma once

#include <cmath>
#include <numbers>

namespace tassilo {

constexpr double degrees(double radians) { return radians * (180.0 / std::numbers::pi); }
constexpr double radians(double degrees) { return degrees * (std::numbers::pi / 180.0); }

/// The same direction in [-pi, pi). [rad]
inline double wrap_angle(double angle) {
  const double turn = 2 * std::numbers::pi;
  const double wrapped = std::fmod(angle + std::numbers::pi, turn);
  return (wrapped < 0 ? wrapped + turn : wrapped) - std::numbers::pi;
}

/// The same direction of a line that has no sense along it, in [-pi/2, pi/2). [rad]
inline double wrap_half_turn(double angle) { return 0.5 * wrap_angle(2 * angle); }

}  // namespace tassilo
