#pragma once

#include <array>
#include <cmath>
#include <numbers>

namespace tassilo {

/// The centroid of a disc's image: that of a polygon whose second moments relative to its area are the disc's, which is
/// what the centroid depends on up to the fourth order.
///
/// x, y, radius   of the disc on its plane [m]
/// shown          shown(x, y, T* pixel): where a place of the plane shows; false where it does not
/// returns        false where a part of the disc does not show
template <class T, class Shown>
bool disc_centroid(double x, double y, double radius, Shown shown, T* pixel) {
  constexpr std::size_t corners = 8;
  const double turn = 2 * std::numbers::pi / corners;
  const double reach = radius * std::sqrt(3 / (2 + std::cos(turn)));
  std::array<T, corners> c, r;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = static_cast<double>(i) * turn;
    T at[2];
    if (!shown(x + reach * std::cos(angle), y + reach * std::sin(angle), at)) return false;
    c[i] = at[0];
    r[i] = at[1];
  }
  T area(0), moment_c(0), moment_r(0);
  for (std::size_t i = 2; i < corners; ++i) {  // triangles with corner 0
    const T ax = c[i - 1] - c[0], ay = r[i - 1] - r[0], bx = c[i] - c[0], by = r[i] - r[0];
    const T doubled = ax * by - ay * bx;
    area += doubled;
    moment_c += doubled * (ax + bx);
    moment_r += doubled * (ay + by);
  }
  if (!(area > 0.)) return false;
  pixel[0] = c[0] + moment_c / (3. * area);
  pixel[1] = r[0] + moment_r / (3. * area);
  return true;
}

}  // namespace tassilo
