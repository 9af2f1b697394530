#include "tassilo/sim/internal/lighting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tassilo {
namespace {

constexpr double kWhite = 4300;  ///< What the camera's white balance is for. [K]

/// Color of a black body, linear, by the fit of T. Helland (2012) for displays.
Light black_body(double temperature) {
  const double t = temperature / 100;
  const double r = t <= 66 ? 255 : 329.698727446 * std::pow(t - 60, -0.1332047592);
  const double g =
      t <= 66 ? 99.4708025861 * std::log(t) - 161.1195681661 : 288.1221695283 * std::pow(t - 60, -0.0755148492);
  const double b = t >= 66 ? 255 : t <= 19 ? 0 : 138.5177312231 * std::log(t - 10) - 305.0447927307;
  const auto linear = [](double v) { return static_cast<float>(std::pow(std::clamp(v, 1., 255.) / 255, 2.2)); };
  return {linear(r), linear(g), linear(b), 0};
}

/// As bright as white light.
Light lamp_color(double temperature) {
  Light color = black_body(temperature);
  const Light white = black_body(kWhite);
  for (int k = 0; k < 3; ++k) color[k] /= white[k];
  return color / (.299F * color[0] + .587F * color[1] + .114F * color[2]);
}

std::vector<SimLamp> usual_lamps(const Stage& stage) {
  std::vector<SimLamp> lamps;
  const double length = stage.carpet_x.high - stage.carpet_x.low, width = stage.carpet_y.high - stage.carpet_y.low;
  for (const double column : {-1., 0., 1.})
    for (const double row : {-1., 1.})
      lamps.push_back({.x = stage.carpet_x.middle() + column * .36 * length,
                       .y = stage.carpet_y.middle() + row * .36 * width,
                       .z = std::clamp(.45 * length, 3.2, 8.),
                       .radius = .3});
  return lamps;
}

}  // namespace

const std::vector<std::array<float, 2>>& disc_points() {
  static const std::vector<std::array<float, 2>> points = [] {
    std::vector<std::array<float, 2>> made;
    for (int k = 0; k < 256; ++k) {
      // The R2 sequence of M. Roberts, "The unreasonable effectiveness of quasirandom sequences" (2018).
      const double u = std::fmod(.5 + k * .7548776662466927, 1), v = std::fmod(.5 + k * .5698402909980532, 1);
      const double r = std::sqrt(u), angle = 2 * std::numbers::pi * v;
      made.push_back({static_cast<float>(r * std::cos(angle)), static_cast<float>(r * std::sin(angle))});
    }
    return made;
  }();
  return points;
}

Lighting::Lighting(const Stage& stage, const RayWorld& world, const RenderOptions& options) {
  const std::vector<SimLamp> lamps = options.lamps.empty() ? usual_lamps(stage) : options.lamps;
  const Eigen::Vector3f up(0, 0, 1);
  // Intensity 1 everywhere is the light that exposure is for.
  double mean = 0;
  constexpr int grid = 9;
  for (int k = 0; k < grid * grid; ++k) {
    const auto part = [](const Interval& i, int n) {
      return static_cast<float>(i.low + (i.high - i.low) * (n + .5) / grid);
    };
    const Eigen::Vector3f at(part(stage.carpet_x, k % grid), part(stage.carpet_y, k / grid), 0);
    for (const SimLamp& lamp : lamps)
      mean +=
          share({static_cast<float>(lamp.x), static_cast<float>(lamp.y), static_cast<float>(lamp.z), 0, {}}, at, up) /
          (grid * grid);
  }
  const auto ambient = static_cast<float>(options.ambient);
  const double scale = mean > 0 ? (1 - ambient) / mean : 0;
  for (const SimLamp& lamp : lamps)
    lamps_.push_back({static_cast<float>(lamp.x), static_cast<float>(lamp.y), static_cast<float>(lamp.z),
                      static_cast<float>(lamp.radius),
                      static_cast<float>(lamp.intensity * scale) * lamp_color(lamp.temperature)});
  above_ = Light(ambient, ambient, ambient, 0);
  // The floor gives back some of its green, the walls and the hall some white.
  below_ = .95F * above_ + Light(.14F, .17F, .14F, 0);

  const auto unshaded = [&](const Eigen::Vector3f& at, const Eigen::Vector3f& normal) {
    Light sum = this->ambient(normal);
    for (const Lamp& lamp : lamps_) sum += share(lamp, at, normal) * lamp.color;
    return sum;
  };
  for (std::size_t k = 0; k < stage.vertices.size(); ++k) {
    fronts_.push_back(unshaded(stage.vertices[k], stage.normals[k]));
    backs_.push_back(unshaded(stage.vertices[k], -stage.normals[k]));
  }

  const double length = stage.hall_x.high - stage.hall_x.low, width = stage.hall_y.high - stage.hall_y.low;
  const double cell = std::max(.1, std::sqrt(length * width) / 120);
  x0_ = static_cast<float>(stage.hall_x.low);
  y0_ = static_cast<float>(stage.hall_y.low);
  per_cell_ = static_cast<float>(1 / cell);
  columns_ = static_cast<int>(std::ceil(length / cell)) + 2;
  rows_ = static_cast<int>(std::ceil(width / cell)) + 2;
  columns_limit_ = static_cast<float>(columns_ - 2) + .999F;
  rows_limit_ = static_cast<float>(rows_ - 2) + .999F;
  floor_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  const auto& disc = disc_points();
  constexpr LaneMask valid{{-1, -1, -1, -1, -1, -1, -1, -1}};
  for (int r = 0; r < rows_; ++r)
    for (int c = 0; c < columns_; ++c) {
      const Eigen::Vector3f at(x0_ + static_cast<float>(c * cell), y0_ + static_cast<float>(r * cell), 0);
      Light sum = above_;
      const bool shaded = at.x() > stage.carpet_x.low - .2 && at.x() < stage.carpet_x.high + .2 &&
                          at.y() > stage.carpet_y.low - .2 && at.y() < stage.carpet_y.high + .2;
      for (const Lamp& lamp : lamps_) {
        if (!shaded) {
          sum += share(lamp, at, up) * lamp.color;
          continue;
        }
        RTCRay8 rays{};
        for (int k = 0; k < 8; ++k) {
          rays.org_x[k] = at.x();
          rays.org_y[k] = at.y();
          rays.org_z[k] = .001F;
          const auto& [dx, dy] = disc[static_cast<std::size_t>((8 * c + 40 * r + k) & 255)];
          rays.dir_x[k] = lamp.x + lamp.radius * dx - at.x();
          rays.dir_y[k] = lamp.y + lamp.radius * dy - at.y();
          rays.dir_z[k] = lamp.z;
          rays.tfar[k] = .98F;
          rays.mask[k] = ~0U;
        }
        world.occluded(valid, rays, true, false);
        const auto clear = std::count_if(rays.tfar, rays.tfar + 8, [](float far) { return far > 0; });
        sum += static_cast<float>(clear) / 8 * share(lamp, at, up) * lamp.color;
      }
      floor_[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(c)] = sum;
    }
}

}  // namespace tassilo
