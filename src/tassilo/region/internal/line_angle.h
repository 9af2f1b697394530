#pragma once

#include <cmath>
#include <numbers>

#include "tassilo/geometry/point.h"

namespace tassilo {

/// Direction of a line, as seen on the screen counter-clockwise from "right", in (-pi/2, pi/2]. [rad]
inline double line_angle(PixelPoint direction) {
  constexpr double kPi = std::numbers::pi;
  const double phi = std::atan2(0 - direction.y, direction.x);  // from 0: -0 would make the angle -0, too
  if (phi > kPi / 2) return phi - kPi;
  return phi <= -kPi / 2 ? phi + kPi : phi;
}

}  // namespace tassilo
