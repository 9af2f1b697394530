#include "tassilo/calibrate/internal/start.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "tassilo/calibrate/internal/lens.h"
#include "tassilo/calibrate/internal/plane_map.h"

namespace tassilo {
namespace {

using Points = std::vector<Eigen::Vector2d>;

Points on_target(const TargetView& view) {
  Points out;
  for (const SeenPoint& p : view.points) {
    const TargetPoint at = view.target.at(p.column, p.row);
    out.emplace_back(at.x, at.y);
  }
  return out;
}

/// What the search goes over. `bend`: division coefficient for distances in units of half the image diagonal.
struct Guess {
  double bend = 0, aspect = 1;  ///< aspect: fx / fy.
  double error = 0;             ///< Mean square of how far homographies miss. [px^2], in undistorted pixels
  std::vector<Eigen::Matrix3d> maps;
};

/// Points relative to the middle of the image, rows stretched to square pixels, undistorted; in half diagonals.
std::optional<Points> undistorted(ImageSize size, const TargetView& view, const Guess& guess) {
  const double half = std::hypot(size.width, size.height * guess.aspect) / 2;
  Points out;
  for (const SeenPoint& p : view.points) {
    const Eigen::Vector2d at =
        Eigen::Vector2d(p.pixel.x - (size.width - 1) / 2., guess.aspect * (p.pixel.y - (size.height - 1) / 2.)) / half;
    const double scale = 1 + guess.bend * at.squaredNorm();
    if (!(scale > .05)) return std::nullopt;
    out.push_back(at / scale);
  }
  return out;
}

/// Fits homographies; the error is counted where the points were measured, so that bends compare.
std::optional<Guess> judged(ImageSize size, std::span<const TargetView> views, Guess guess) {
  double sum = 0, count = 0;
  for (const TargetView& view : views) {
    const auto image = undistorted(size, view, guess);
    const Points target = on_target(view);
    const auto map = image ? plane_map(target, *image) : std::nullopt;
    if (!map) return std::nullopt;
    guess.maps.push_back(*map);
    for (std::size_t i = 0; i < target.size(); ++i) {
      const Eigen::Vector2d u = (*map * target[i].homogeneous()).hnormalized(), v = (*image)[i];
      // d(distorted) / d(undistorted) is at most the square of the scale across, times (1 - bend r^2)^-1 along.
      const double shrink = 2 / (1 + std::sqrt(std::max(0., 1 - 4 * guess.bend * v.squaredNorm())));
      sum += (u - v).squaredNorm() * shrink * shrink;
      ++count;
    }
  }
  guess.error = sum / count;
  return std::isfinite(guess.error) ? std::optional(std::move(guess)) : std::nullopt;
}

/// Focal length in half diagonals, from the orthonormality of the target's axes; nothing where that gives none.
std::optional<double> focal_length(std::span<const Eigen::Matrix3d> maps) {
  double weighted = 0, weights = 0;  // of 1 / f^2: a u + b = 0
  for (const Eigen::Matrix3d& map : maps) {
    const Eigen::Vector3d h1 = map.col(0), h2 = map.col(1);
    const double pairs[2][2] = {
        {h1.x() * h2.x() + h1.y() * h2.y(), h1.z() * h2.z()},
        {h1.head<2>().squaredNorm() - h2.head<2>().squaredNorm(), h1.z() * h1.z() - h2.z() * h2.z()}};
    const double scale = 1 / std::max(h1.squaredNorm() * h2.squaredNorm(), 1e-300);
    for (const auto& [a, b] : pairs) {
      weighted -= a * b * scale;
      weights += a * a * scale;
    }
  }
  const double inverse_square = weighted / weights;
  if (!(inverse_square > 1e-3 && inverse_square < 1e3)) return std::nullopt;
  return 1 / std::sqrt(inverse_square);
}

/// The pose of a plane whose points (x, y) are mapped to rays map * (x, y, 1).
std::optional<PoseVector> pose_of(const Eigen::Matrix3d& map) {
  Eigen::Matrix3d scaled = map * (2 / (map.col(0).norm() + map.col(1).norm()));
  if (scaled(2, 2) < 0) scaled = -scaled;
  if (!scaled.allFinite()) return std::nullopt;
  Eigen::Matrix3d rotation;
  rotation << scaled.col(0), scaled.col(1), scaled.col(0).cross(scaled.col(1));
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(Eigen::MatrixXd(rotation), Eigen::ComputeFullU | Eigen::ComputeFullV);
  rotation = svd.matrixU() * svd.matrixV().transpose();
  if (!(rotation.determinant() > 0)) return std::nullopt;
  const Eigen::AngleAxisd turn(rotation);
  const Eigen::Vector3d vector = turn.angle() * turn.axis();
  return PoseVector{vector.x(), vector.y(), vector.z(), scaled(0, 2), scaled(1, 2), scaled(2, 2)};
}

/// Camera and poses of a guess with focal length `f`, in half diagonals.
Start state_of(ImageSize size, const Guess& guess, double f) {
  const double half = std::hypot(size.width, size.height * guess.aspect) / 2;
  Start out;
  out.state.camera = {f * half, f * half / guess.aspect, (size.width - 1) / 2., (size.height - 1) / 2.,
                      guess.bend * f * f};
  const Eigen::Vector3d to_rays(1 / f, 1 / f, 1);
  for (const Eigen::Matrix3d& map : guess.maps) {
    const auto pose = pose_of(to_rays.asDiagonal() * map);
    out.state.poses.push_back(pose.value_or(PoseVector{}));
    out.placed.push_back(pose.has_value());
  }
  return out;
}

/// The camera of a start adjusted to the views that it places, then to all that this camera can place; the cost counts
/// each point of the others as far off.
std::optional<std::pair<Start, double>> adjusted(ImageSize size, std::span<const TargetView> views, Bundle& bundle,
                                                 Start start) {
  constexpr double loss = 2, lost_point = 20;  // the cost of one 11 px off
  const Sigmas sigmas(views.size(), 1);
  const auto use_placed = [&] {
    std::ptrdiff_t count = 0;
    for (std::size_t v = 0; v < views.size(); ++v) {
      bundle.use_view(v, true);
      start.placed[v] = start.placed[v] && start.state.poses[v][5] > 0 && bundle.shows(start.state, v);
      bundle.use_view(v, start.placed[v]);
      count += start.placed[v];
    }
    return count >= kLeastViews;
  };
  double cost = 0;
  for (int round = 0; round < 2; ++round) {
    if (!use_placed()) return std::nullopt;
    BundleFit fit = bundle.fit(start.state, {}, sigmas, loss);
    if (!fit.converged || !(fit.state.camera[0] > 0 && fit.state.camera[1] > 0)) return std::nullopt;
    start.state = std::move(fit.state);
    cost = fit.cost;
    const bool all_placed = std::ranges::find(start.placed, false) == start.placed.end();
    if (all_placed || round == 1) break;
    const CameraModel camera = camera_from(size, LensModel::division, start.state.camera);
    for (std::size_t v = 0; v < views.size(); ++v)
      if (!start.placed[v])
        if (const auto pose = start_pose(camera, views[v])) {
          start.state.poses[v] = *pose;
          start.placed[v] = true;
        }
  }
  for (std::size_t v = 0; v < views.size(); ++v) {
    start.placed[v] = start.placed[v] && start.state.poses[v][5] > 0;
    if (!start.placed[v]) cost += lost_point * static_cast<double>(views[v].points.size());
  }
  return std::pair{std::move(start), cost};
}

}  // namespace

std::optional<Start> start_from_homographies(ImageSize size, std::span<const TargetView> views) {
  std::vector<Guess> guesses;
  for (const double aspect : {1., 1.1, .9, 1.2, .83, 1.35, .74, 1.6, .62, 2., .5})
    for (double bend = .2; bend > -1.2; bend -= .1)
      if (auto guess = judged(size, views, {.bend = bend, .aspect = aspect, .maps = {}}))
        guesses.push_back(std::move(*guess));
  std::ranges::stable_sort(guesses, std::ranges::less{}, &Guess::error);
  constexpr std::size_t most_guesses = 3;
  if (guesses.size() > most_guesses) guesses.resize(most_guesses);
  Bundle bundle(LensModel::division, views);
  std::optional<std::pair<Start, double>> best;
  for (const Guess& guess : guesses) {
    std::vector<double> focal_lengths{.5, 1., 2.};
    if (const auto f = focal_length(guess.maps)) focal_lengths.insert(focal_lengths.begin(), *f);
    for (const double f : focal_lengths) {
      auto fit = adjusted(size, views, bundle, state_of(size, guess, f));
      if (fit && (!best || fit->second < best->second)) best = std::move(fit);
    }
  }
  return best ? std::optional(std::move(best->first)) : std::nullopt;
}

std::optional<BundleState> convert_start(const BundleState& division, ImageSize size, LensModel model,
                                         std::span<const int> fixed) {
  const CameraModel camera = camera_from(size, LensModel::division, division.camera);
  BundleState out = division;
  out.division = division.camera[kPinholeCount];
  if (model == LensModel::division) return out;
  out.camera.resize(static_cast<std::size_t>(parameter_count(model)), 0);
  std::fill(out.camera.begin() + kPinholeCount, out.camera.end(), 0);
  // Radial coefficients by their power of the squared argument.
  std::vector<int> free;
  const std::vector<int> radial = model == LensModel::plumb_bob ? std::vector{4, 5, 8} : std::vector{4, 5, 6, 7};
  for (const int index : radial)
    if (std::ranges::find(fixed, index) == fixed.end()) free.push_back(index);
  const double farthest = std::max(camera.cx, size.width - camera.cx) / camera.fx;
  const double lowest = std::max(camera.cy, size.height - camera.cy) / camera.fy;
  constexpr int count = 40;
  std::vector<Eigen::VectorXd> rows;
  std::vector<double> rights;
  for (int i = 1; i <= count; ++i) {
    const double shown = std::hypot(farthest, lowest) * i / count;
    const auto ray = unproject(camera, {camera.cx + shown * camera.fx, camera.cy});
    if (!ray) break;
    const double tangent = std::hypot(ray->x, ray->y) / ray->z;
    if (model == LensModel::plumb_bob && tangent > 2.5) break;  // no polynomial follows a lens up to 90 degrees
    const double argument = model == LensModel::plumb_bob ? tangent : std::atan(tangent);
    Eigen::VectorXd row(static_cast<Eigen::Index>(free.size()));
    for (std::size_t k = 0; k < free.size(); ++k) {
      const auto power = std::ranges::find(radial, free[k]) - radial.begin() + 1;
      row(static_cast<Eigen::Index>(k)) = std::pow(argument, 1 + 2. * static_cast<double>(power));
    }
    rows.push_back(row);
    rights.push_back(shown - argument);
  }
  if (rows.size() < free.size()) return std::nullopt;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(rows[0].size(), rows[0].size());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(rows[0].size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    normal += rows[i] * rows[i].transpose();
    right += rights[i] * rows[i];
  }
  const Eigen::VectorXd solved = normal.ldlt().solve(right);
  if (!solved.allFinite()) return std::nullopt;
  for (std::size_t k = 0; k < free.size(); ++k)
    out.camera[static_cast<std::size_t>(free[k])] = solved(static_cast<Eigen::Index>(k));
  return out;
}

std::optional<PoseVector> start_pose(const CameraModel& camera, const TargetView& view) {
  Points target;
  std::vector<Eigen::Vector3d> rays;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const SeenPoint& p : view.points) {
    const auto ray = unproject(camera, p.pixel);
    if (!ray) continue;
    const TargetPoint at = view.target.at(p.column, p.row);
    target.emplace_back(at.x, at.y);
    rays.emplace_back(ray->x, ray->y, ray->z);
    sum += rays.back();
  }
  if (!(sum.norm() > 0)) return std::nullopt;
  // Through a plane across the target's direction, not across the axis: there is none for rays far from the axis.
  const Eigen::Quaterniond turned = Eigen::Quaterniond::FromTwoVectors(sum, Eigen::Vector3d::UnitZ());
  Points image;
  for (const Eigen::Vector3d& ray : rays) {
    const Eigen::Vector3d at = turned * ray;
    if (!(at.z() > .1)) return std::nullopt;
    image.push_back(at.hnormalized());
  }
  const auto map = plane_map(target, image);
  const auto pose = map ? pose_of(*map) : std::nullopt;
  if (!pose) return std::nullopt;
  const Eigen::Vector3d vector((*pose)[0], (*pose)[1], (*pose)[2]), place((*pose)[3], (*pose)[4], (*pose)[5]);
  const Eigen::Matrix3d rotation =
      (turned.inverse() * Eigen::AngleAxisd(vector.norm(), vector.stableNormalized())).toRotationMatrix();
  const Eigen::AngleAxisd turn(rotation);
  const Eigen::Vector3d turn_vector = turn.angle() * turn.axis(), back = turned.inverse() * place;
  return PoseVector{turn_vector.x(), turn_vector.y(), turn_vector.z(), back.x(), back.y(), back.z()};
}

}  // namespace tassilo
