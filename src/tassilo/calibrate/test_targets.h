#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "tassilo/calibrate/april_grid.h"
#include "tassilo/calibrate/checkerboard.h"
#include "tassilo/calibrate/intrinsics.h"
#include "tassilo/camera/camera_model.h"

// Targets as cameras of known parameters see them, for tests.

namespace tassilo {

inline const Target kDots{TargetKind::dots, 7, 7, .04, .01};
inline const Target kTags{TargetKind::april_grid, 12, 12, .04, 0, .3};
inline const Target kChecker{TargetKind::checkerboard, 9, 6, .04, 0};

struct TestImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
  ByteView view() const { return {pixels.data(), width, height, width}; }
};

inline std::optional<PixelPoint> project_at(const CameraModel& camera, const TargetPose& pose, double x, double y) {
  const Eigen::Vector3d p = pose.rotation * Eigen::Vector3d(x, y, 0) + pose.translation;
  return project(camera, {p.x(), p.y(), p.z()});
}

/// Looking at the target's middle so that it shows near the ray through (column, row), from `distance`, the target
/// turned about x, then y, then z. [px, m, rad]
inline TargetPose pose_at(const CameraModel& camera, const Target& target, PixelPoint place, double distance,
                          Eigen::Vector3d turns) {
  const auto ray = unproject(camera, place).value();
  TargetPose pose;
  pose.rotation =
      (Eigen::AngleAxisd(turns.z(), Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(turns.y(), Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(turns.x(), Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  const TargetPoint last = target.at(target.columns - 1, target.rows - 1);
  const Eigen::Vector3d middle(last.x / 2, last.y / 2, 0);
  pose.translation = distance * Eigen::Vector3d(ray.x, ray.y, ray.z) - pose.rotation * middle;
  return pose;
}

/// Brightness of a target at a place on its plane; nothing beside the paper. [m]
inline std::optional<double> brightness(const Target& target, double x, double y) {
  constexpr double paper = 190, ink = 50;
  if (target.kind == TargetKind::april_grid) {
    const double gap = target.spacing * target.pitch, step = target.pitch + gap;
    const int columns = target.columns / 2, rows = target.rows / 2;
    if (x < -1.5 * gap || y < -1.5 * gap || x > columns * step + .5 * gap || y > rows * step + .5 * gap)
      return std::nullopt;
    const double c = std::floor(x / step), r = std::floor(y / step), u = x - c * step, v = y - r * step;
    if (u > target.pitch && v > target.pitch) return u < step && v < step && x >= -gap && y >= -gap ? ink : paper;
    if (u > target.pitch || v > target.pitch || c < 0 || r < 0 || c >= columns || r >= rows) return paper;
    static const auto tags = [] {
      std::vector<std::vector<bool>> out;
      for (int id = 0; id < 60; ++id) out.push_back(tag_cells(id));
      return out;
    }();
    const auto id = static_cast<std::size_t>(columns * (rows - 1 - static_cast<int>(r)) + static_cast<int>(c));
    const auto cell = [&](double w) {
      return static_cast<std::size_t>(std::min(kTagCells - 1, static_cast<int>(w / target.pitch * kTagCells)));
    };
    return tags[id][cell(v) * kTagCells + cell(u)] ? ink : paper;
  }
  const double q = target.pitch, u = x / q, v = y / q;
  const double right = target.columns - 1, bottom = target.rows - 1;
  const double margin = target.kind == TargetKind::dots ? 1.6 : 1.5;
  if (u < -margin || v < -margin || u > right + margin || v > bottom + margin) return std::nullopt;
  if (target.kind == TargetKind::checkerboard) {
    if (u < -1 || v < -1 || u > right + 1 || v > bottom + 1) return paper;
    return (static_cast<int>(std::floor(u + 1)) + static_cast<int>(std::floor(v + 1))) % 2 == 0 ? ink : paper;
  }
  const double c = std::round(u), r = std::round(v);
  if (c >= 0 && r >= 0 && c <= right && r <= bottom && std::hypot(u - c, v - r) * q < target.radius) return ink;
  const double out = std::max({-u, -v, u - right, v - bottom});
  if (out > 1 && out < 1.25) return ink;
  return out <= 1 && (u + 1) + (v + 1) < .5 ? ink : paper;
}

/// The image with rays jittered over pixels of twice the width, and noise. [gray levels]
inline TestImage render(const CameraModel& camera, const Target& target, const TargetPose& pose, unsigned seed,
                        double noise = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(0, 1);
  std::normal_distribution<double> gauss(0, noise);
  constexpr int grid = 6;
  TestImage image{camera.width, camera.height, {}};
  const Eigen::Vector3d normal = pose.rotation.col(2);
  const double offset = normal.dot(pose.translation);
  // Where the rays of whole pixels, from (-1, -1) on, meet the target's plane; bilinear between them. [m]
  const double nowhere = std::numeric_limits<double>::quiet_NaN();
  std::vector<Eigen::Vector2d> met;
  for (int r = -1; r <= image.height + 1; ++r)
    for (int c = -1; c <= image.width + 1; ++c) {
      Eigen::Vector2d at(nowhere, nowhere);
      if (const auto ray = unproject(camera, {static_cast<double>(c), static_cast<double>(r)})) {
        const Eigen::Vector3d direction(ray->x, ray->y, ray->z);
        const double along = offset / normal.dot(direction);
        if (along > 0) at = (pose.rotation.transpose() * (along * direction - pose.translation)).head<2>();
      }
      met.push_back(at);
    }
  const auto met_at = [&](int c, int r) { return met[static_cast<std::size_t>((r + 1) * (image.width + 3) + c + 1)]; };
  for (int r = 0; r < image.height; ++r)
    for (int c = 0; c < image.width; ++c) {
      double sum = 0;
      for (int i = 0; i < grid * grid; ++i) {
        const double x = c + 2 * (i % grid + jitter(random)) / grid - 1,
                     y = r + 2 * (i / grid + jitter(random)) / grid - 1;
        const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
        const double u = x - left, v = y - top;
        const Eigen::Vector2d at = (1 - v) * ((1 - u) * met_at(left, top) + u * met_at(left + 1, top)) +
                                   v * ((1 - u) * met_at(left, top + 1) + u * met_at(left + 1, top + 1));
        const double value = at.allFinite() ? brightness(target, at.x(), at.y()).value_or(90) : 90;
        sum += value;
      }
      const double y = sum / (grid * grid) + gauss(random);
      image.pixels.push_back(static_cast<std::uint8_t>(std::clamp(std::lround(y), 0L, 255L)));
    }
  return image;
}

/// Where the centroid of a dot's image is, or a corner.
inline std::optional<PixelPoint> seen_at(const CameraModel& camera, const TargetPose& pose, const Target& target,
                                         int column, int row) {
  const auto [x, y] = target.at(column, row);
  if (target.kind != TargetKind::dots) return project_at(camera, pose, x, y);
  constexpr int corners = 180;
  std::vector<PixelPoint> rim;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    const auto at = project_at(camera, pose, x + target.radius * std::cos(angle), y + target.radius * std::sin(angle));
    if (!at) return std::nullopt;
    rim.push_back(*at);
  }
  double area = 0;
  PixelPoint moment{};
  for (int i = 1; i + 1 < corners; ++i) {
    const PixelPoint a = rim[static_cast<std::size_t>(i)] - rim[0], b = rim[static_cast<std::size_t>(i + 1)] - rim[0];
    area += cross(a, b);
    moment = moment + cross(a, b) * (a + b);
  }
  return rim[0] + 1 / (3 * area) * moment;
}

/// Places on the frame of a dot target whose sides' middles are `distance` pitches from the outer dots, as a perfect
/// detector with Gaussian errors across the sides would give them. [px]
inline std::vector<FramePlace> frame_of(const CameraModel& camera, const Target& target, const TargetPose& pose,
                                        std::mt19937& random, double sigma, double distance = 1.125) {
  std::normal_distribution<double> gauss(0, sigma);
  std::vector<FramePlace> out;
  for (const FrameSide side : {FrameSide::top, FrameSide::bottom, FrameSide::left, FrameSide::right}) {
    const bool is_row = side == FrameSide::top || side == FrameSide::bottom;
    const bool is_first = side == FrameSide::top || side == FrameSide::left;
    const double across = is_first ? -distance : (is_row ? target.rows : target.columns) - 1 + distance;
    const auto at = [&](double along) {
      return is_row ? project_at(camera, pose, along * target.pitch, across * target.pitch)
                    : project_at(camera, pose, across * target.pitch, along * target.pitch);
    };
    for (double along = is_first ? 0 : -.6; along < (is_row ? target.columns : target.rows) - .4; along += .25) {
      const auto here = at(along), next = at(along + .01);
      if (!here || !next || here->x < 0 || here->y < 0 || here->x > camera.width - 1 || here->y > camera.height - 1)
        continue;
      const PixelPoint tangent = 1 / norm(*next - *here) * (*next - *here), normal{-tangent.y, tangent.x};
      out.push_back({side, along, *here + gauss(random) * normal, normal});
    }
  }
  return out;
}

/// How far directions show from where they do by the true camera, at most and as a root mean square, over a grid of
/// pixels up to the corners; infinite where one cannot be shown. [px]
struct MappedError {
  double worst = 0, rms = 0;
};
inline MappedError mapped_error(const CameraModel& truth, const CameraModel& found) {
  constexpr int columns = 17, rows = 13;
  MappedError out;
  for (int i = 0; i < columns * rows; ++i) {
    const PixelPoint pixel{(truth.width - 1.) * (i % columns) / (columns - 1),
                           (truth.height - 1.) * (i / columns) / (rows - 1)};
    const auto ray = unproject(truth, pixel);
    const auto shown = ray ? project(found, *ray) : std::nullopt;
    const double off = shown ? distance(pixel, *shown) : std::numeric_limits<double>::infinity();
    out.worst = std::max(out.worst, off);
    out.rms += off * off / (columns * rows);
  }
  out.rms = std::sqrt(out.rms);
  return out;
}

/// A view as a perfect detector with Gaussian errors would give it: the points that are in the image. [px]
inline TargetView view_of(const CameraModel& camera, const Target& target, const TargetPose& pose, std::mt19937& random,
                          double sigma) {
  std::normal_distribution<double> gauss(0, 1);
  TargetView view{target, {}};
  for (int r = 0; r < target.rows; ++r)
    for (int c = 0; c < target.columns; ++c) {
      const auto at = seen_at(camera, pose, target, c, r);
      if (!at || at->x < 0 || at->y < 0 || at->x > camera.width - 1 || at->y > camera.height - 1) continue;
      view.points.push_back({c, r, {at->x + sigma * gauss(random), at->y + sigma * gauss(random)}});
    }
  return view;
}

}  // namespace tassilo
