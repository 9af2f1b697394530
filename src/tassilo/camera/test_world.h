#pragma once

// A little world for tests: carpet, one wall, spheres and upright cylinders, seen by any camera. Flat light, exact
// edges.

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tassilo/camera/mount.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/image/frame.h"

namespace tassilo::test {

struct Paint {
  double y = 0, u = 128, v = 128;
};
inline constexpr Paint kCarpet{110, 115, 105}, kRed{115, 98, 180}, kWhite{205, 127, 128}, kBlack{45, 128, 128},
    kCyan{110, 147, 92}, kMagenta{100, 134, 162}, kYellow{175, 75, 153}, kHall{95, 128, 128};

struct Sphere {
  RobotPoint center;
  double radius = 0.1;
  Paint paint = kRed;
};
/// Stands on the floor; black below, its marker band from `band` up.
struct Cylinder {
  FloorPoint foot;
  double radius = 0.2, height = 0.5, band = 0.25;
  Paint marker = kCyan;
};
/// White stripe on the floor from a to b.
struct Stripe {
  FloorPoint a, b;
  double width = 0.05;
};

struct World {
  std::vector<Sphere> spheres;
  std::vector<Cylinder> robots;
  std::vector<Stripe> lines;
  double wall_x = 5;         ///< A wall across, facing the robot; beyond it is the hall. [m]
  double wall_height = 0.5;  ///< [m]
  std::vector<std::pair<double, double>>
      goal;  ///< At most one: from..to along y, an opening in the wall, yellow behind it.
};

inline double distance_to_stripe(FloorPoint p, const Stripe& stripe) {
  const FloorPoint along = stripe.b - stripe.a;
  const double at = std::clamp(dot(p - stripe.a, along) / dot(along, along), 0.0, 1.0);
  return distance(p, stripe.a + at * along);
}

/// What the ray from `eye` shows.
inline Paint look(const World& world, RobotPoint eye, RobotPoint ray) {
  double nearest = std::numeric_limits<double>::infinity();
  Paint paint = kHall;
  const auto hit = [&](double along, Paint what) {
    if (along > 1e-6 && along < nearest) {
      nearest = along;
      paint = what;
    }
  };
  if (ray.z < 0) {
    const double along = -eye.z / ray.z;
    const FloorPoint p{eye.x + along * ray.x, eye.y + along * ray.y};
    const bool line = std::any_of(world.lines.begin(), world.lines.end(), [&](const Stripe& stripe) {
      return distance_to_stripe(p, stripe) <= stripe.width / 2;
    });
    hit(along, line ? kWhite : kCarpet);
  }
  if (ray.x > 0) {
    const double along = (world.wall_x - eye.x) / ray.x;
    const double y = eye.y + along * ray.y, z = eye.z + along * ray.z;
    const bool opening = std::any_of(world.goal.begin(), world.goal.end(),
                                     [&](const auto& goal) { return y > goal.first && y < goal.second && z < 0.9; });
    if (opening)
      hit(along, kYellow);
    else if (z < world.wall_height)
      hit(along, kWhite);
    else
      hit(along, kHall);
  }
  for (const Sphere& sphere : world.spheres) {
    const RobotPoint to = sphere.center - eye;
    const double along = dot(to, ray), off = dot(to, to) - along * along;
    if (along > 0 && off < sphere.radius * sphere.radius)
      hit(along - std::sqrt(sphere.radius * sphere.radius - off), sphere.paint);
  }
  for (const Cylinder& robot : world.robots) {
    const double dx = robot.foot.x - eye.x, dy = robot.foot.y - eye.y, flat = ray.x * ray.x + ray.y * ray.y;
    const double along = (dx * ray.x + dy * ray.y) / flat;
    const double off = dx * dx + dy * dy - along * along * flat;
    if (along <= 0 || off >= robot.radius * robot.radius) continue;
    const double front = along - std::sqrt((robot.radius * robot.radius - off) / flat);
    const double z = eye.z + front * ray.z;
    if (z >= 0 && z <= robot.height) hit(front, z > robot.band && z < robot.height - 0.04 ? robot.marker : kBlack);
  }
  return paint;
}

/// The world as the camera shows it, 2x2 rays a pixel.
inline Frame render(const MountedCamera& camera, const World& world, ColorRange range = ColorRange::limited) {
  const int width = camera.model().width, height = camera.model().height;
  const FrameBuffer buffer = make_frame_buffer(PixelFormat::yuv422p, width, height, range);
  std::vector<Paint> row(static_cast<std::size_t>(width));
  for (int r = 0; r < height; ++r) {
    for (int c = 0; c < width; ++c) {
      Paint sum{0, 0, 0};
      for (const double dc : {-0.25, 0.25})
        for (const double dr : {-0.25, 0.25}) {
          const auto ray = camera.ray({c + dc, r + dr});
          const Paint p = ray ? look(world, camera.center(), *ray) : kHall;
          sum = {sum.y + p.y / 4, sum.u + p.u / 4, sum.v + p.v / 4};
        }
      row[static_cast<std::size_t>(c)] = sum;
      buffer.planes[0][r * buffer.strides[0] + c] = static_cast<std::uint8_t>(std::lround(sum.y));
    }
    for (int c = 0; c < width; c += 2) {
      const Paint &a = row[static_cast<std::size_t>(c)], &b = row[static_cast<std::size_t>(std::min(c + 1, width - 1))];
      buffer.planes[1][r * buffer.strides[1] + c / 2] = static_cast<std::uint8_t>(std::lround((a.u + b.u) / 2));
      buffer.planes[2][r * buffer.strides[2] + c / 2] = static_cast<std::uint8_t>(std::lround((a.v + b.v) / 2));
    }
  }
  return buffer.frame;
}

/// Cameras with each lens model, as they sit on robots.
inline std::vector<MountedCamera> cameras() {
  CameraModel wide;
  wide.width = 384;
  wide.height = 172;
  wide.fx = 216;
  wide.fy = 178;
  wide.cx = 187;
  wide.cy = 89;
  wide.distortion = Division{-0.146};
  CameraModel plumb;
  plumb.width = 400;
  plumb.height = 300;
  plumb.fx = 245;
  plumb.fy = 244;
  plumb.cx = 198;
  plumb.cy = 154;
  plumb.distortion = PlumbBob{-0.262, 0.078, 0.0006, -0.0009, -0.008};
  CameraModel fish = plumb;
  fish.fx = fish.fy = 190;
  fish.distortion = Equidistant{-0.02, 0.003, 0, 0};
  const CameraMount high{.x = 0.06, .y = 0.015, .z = 0.52, .roll = 0.007, .pitch = 0.244, .yaw = -0.014};
  const CameraMount middle{.x = 0.1, .y = 0, .z = 0.45, .roll = -0.005, .pitch = 0.314, .yaw = 0.009};
  const CameraMount low{.x = 0.05, .y = -0.02, .z = 0.3, .roll = 0.01, .pitch = 0.35, .yaw = 0.3};
  return {MountedCamera(wide, high), MountedCamera(plumb, middle), MountedCamera(fish, low)};
}

/// The camera after the robot frame turned by `angle` about its origin: it shows the same image, and everything it
/// tells must turn along. [rad]
inline MountedCamera turned(const MountedCamera& camera, double angle) {
  CameraMount mount = camera.mount();
  const double x = mount.x, y = mount.y;
  mount.x = std::cos(angle) * x - std::sin(angle) * y;
  mount.y = std::sin(angle) * x + std::cos(angle) * y;
  mount.yaw = wrap_angle(mount.yaw + angle);
  return MountedCamera(camera.model(), mount);
}

}  // namespace tassilo::test
