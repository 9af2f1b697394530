#include "tassilo/localize/mount_drift.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tassilo/base/option_check.h"
#include "tassilo/base/recycled.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

using Vector3 = Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;  ///< Height, roll, pitch; x, y, theta of the robot in its own frame.
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// What may have happened to a mount that nobody noticed: it sits loosely, or somebody ran into it. [m, rad]
constexpr double kLooseHeight = .03, kLooseAngle = .03;
/// How far the localization may be led astray by that. [m, rad]
constexpr double kLoosePose = .3, kLooseTheta = .08;

constexpr std::size_t kLeastMarks = 16;  ///< In a frame; two lines' worth.
constexpr int kRounds = 3;

Vector3 vector(RobotPoint p) { return {p.x, p.y, p.z}; }

/// A seen line and the field's, with sums over the rays of its marks: all that a straight line is judged by.
struct Pair {
  std::span<const LineMark> marks;
  const FieldLine* line = nullptr;
  const FieldArc* arc = nullptr;
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Vector3 rays = Vector3::Zero();
};

Vector3 ray_of(const LineMark& mark, const Vector3& eye) {
  return (Vector3(mark.at.x, mark.at.y, 0) - eye).normalized();
}

/// Marks with the indulgence that a loose mount needs.
RecycledVector<LineMark> indulgent(const MountEvidence& seen) {
  RecycledVector<LineMark> marks(seen.marks.begin(), seen.marks.end());
  const RobotPoint eye = seen.camera.center();
  for (LineMark& mark : marks) {
    const FloorPoint out{mark.at.x - eye.x, mark.at.y - eye.y};
    const double range = std::max(norm(out), 1e-6);
    const double radial = std::abs(dot(out, mark.across)) / range, sideways = std::abs(cross(out, mark.across)) / range;
    const double by_pitch = radial * (range * range + eye.z * eye.z) / eye.z * kLooseAngle;
    const double by_roll = std::max(radial, sideways) * eye.z * kLooseAngle;
    mark.common_sigma =
        std::hypot(mark.common_sigma, by_pitch, std::hypot(by_roll, radial * range / eye.z * kLooseHeight));
  }
  return marks;
}

/// Calls each(marks of one line).
template <class Each>
void for_lines(std::span<const LineMark> marks, Each each) {
  for (std::size_t begin = 0, end = 0; begin < marks.size(); begin = end) {
    while (end < marks.size() && marks[end].line == marks[begin].line) ++end;
    each(marks.subspan(begin, end - begin));
  }
}
bool is_explained(int line, std::span<const int> line_of) {
  return line >= 0 && static_cast<std::size_t>(line) < line_of.size() && line_of[static_cast<std::size_t>(line)] >= 0;
}

RecycledVector<Pair> pairs_of(const FieldTarget& target, const MountEvidence& seen, std::span<const int> line_of) {
  const Vector3 eye = vector(seen.camera.center());
  RecycledVector<Pair> pairs;
  for_lines(seen.marks, [&](std::span<const LineMark> marks) {
    Pair pair{.marks = marks};
    const int line = marks.front().line;
    if (line == LineMark::kCircle && !target.curves.arcs.empty())
      pair.arc = &target.curves.arcs.front();
    else if (is_explained(line, line_of))
      pair.line = &target.curves.lines[static_cast<std::size_t>(line_of[static_cast<std::size_t>(line)])];
    else
      return;
    for (const LineMark& mark : marks) {
      const Vector3 ray = ray_of(mark, eye);
      pair.squares.noalias() += ray * ray.transpose();
      pair.rays += ray;
    }
    pairs.push_back(pair);
  });
  return pairs;
}

/// Sums of all marks' squares, for pose and mount as they are taken.
struct Normal {
  Matrix6 information = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
  double square = 0;
  int marks = 0;
};

Normal normal_at(const MountEvidence& seen, std::span<const Pair> pairs, const FieldFromRobot& field_from_robot,
                 const Vector3& change, const MountDriftOptions& options) {
  const CameraModel& model = seen.camera.model();
  const double px_per_rad = std::sqrt(model.fx * model.fy);
  const double own = std::pow(options.mark_sigma_px / px_per_rad, 2),
               common = std::pow(options.line_sigma_px / px_per_rad, 2);
  const Vector3 eye_before = vector(seen.camera.center()), eye = eye_before + Vector3(0, 0, change[0]);
  const Vector3 roll_axis = vector(seen.camera.robot_from_optical({0, 0, 1}));
  const double yaw = seen.camera.mount().yaw;
  const Vector3 pitch_axis(-std::sin(yaw), std::cos(yaw), 0), up = Vector3::UnitZ();
  // Rays, turned as the mount was.
  const Vector3 turn = change[1] * roll_axis + change[2] * pitch_axis;
  Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
  if (turn.norm() > 0) turned = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  const auto robot_from_field = inverse(field_from_robot);

  /// A line's plane and how a ray's angle off it changes by the six unknowns: both linear in the ray.
  struct Plane {
    Vector3 normal;
    Eigen::Matrix<double, 6, 3> by;
  };
  const auto plane_at = [&](FieldPoint at, FieldPoint along) {
    const FloorPoint foot = robot_from_field * at, next = robot_from_field * (at + along);
    const Vector3 tangent = Vector3(next.x - foot.x, next.y - foot.y, 0).normalized();
    const Vector3 square = (Vector3(foot.x, foot.y, 0) - eye).cross(tangent);
    const double length = square.norm();
    Plane plane;
    plane.normal = square / length;
    // The normal's own length changes nothing while the ray is near the plane.
    const auto eye_moved = [&](const Vector3& by) -> Vector3 { return -by.cross(tangent) / length; };
    const auto ray_turned = [&](const Vector3& axis) -> Vector3 { return plane.normal.cross(axis); };
    plane.by.row(0) = eye_moved(up);
    plane.by.row(1) = ray_turned(roll_axis);
    plane.by.row(2) = ray_turned(pitch_axis);
    plane.by.row(3) = eye_moved(Vector3::UnitX());
    plane.by.row(4) = eye_moved(Vector3::UnitY());
    plane.by.row(5) = ray_turned(up) + eye_moved(up.cross(eye));
    return plane;
  };

  Normal all;
  for (const Pair& pair : pairs) {
    Matrix6 squares = Matrix6::Zero();
    Vector6 rows = Vector6::Zero(), products = Vector6::Zero();
    double sum = 0, square = 0;
    if (pair.line != nullptr) {
      const Plane plane = plane_at(pair.line->p, pair.line->q - pair.line->p);
      const Eigen::Matrix3d rays = turned * pair.squares * turned.transpose();
      const Vector3 ray = turned * pair.rays;
      squares = plane.by * rays * plane.by.transpose();
      rows = plane.by * ray;
      products = plane.by * (rays * plane.normal);
      sum = plane.normal.dot(ray);
      square = plane.normal.dot(rays * plane.normal);
    } else {
      for (const LineMark& mark : pair.marks) {
        const FieldPoint out = field_from_robot * mark.at - pair.arc->center;
        const FieldPoint unit = (1 / std::max(norm(out), 1e-9)) * out;
        const Plane plane = plane_at(pair.arc->center + pair.arc->radius * unit, {-unit.y, unit.x});
        const Vector3 ray = turned * ray_of(mark, eye_before);
        const Vector6 row = plane.by * ray;
        const double off = plane.normal.dot(ray);
        squares.noalias() += row * row.transpose();
        rows += row;
        products += off * row;
        sum += off;
        square += off * off;
      }
    }
    // The inverse of a covariance that has what marks share.
    const double kappa = common / (own + static_cast<double>(pair.marks.size()) * common);
    const double whitened = (square - kappa * sum * sum) / own;
    constexpr double loss = 9;  // of three sigmas, squared; Cauchy, for a line as a whole
    const auto count = static_cast<double>(pair.marks.size());
    const double weight = 1 / (1 + whitened / count / loss) / own;
    all.information += weight * (squares - kappa * rows * rows.transpose());
    all.gradient += weight * (products - kappa * sum * rows);
    all.square += std::min(whitened, 16 * count);
    all.marks += static_cast<int>(pair.marks.size());
  }
  return all;
}

/// How likely F with 3 and `freedom` degrees of freedom is beyond this by chance.
/// source   E. Paulson, "An approximate normalization of the analysis of variance distribution", 1942
double chance_of(double f, double freedom) {
  const double root = std::cbrt(f), a = 2. / 27, b = 2 / (9 * freedom);
  const double normal = ((1 - b) * root - (1 - a)) / std::sqrt(b * root * root + a);
  return .5 * std::erfc(normal / std::sqrt(2));
}

}  // namespace

void MountDriftOptions::check() const {
  check_above("mount_drift.memory", memory, 0);
  check_at_least("mount_drift.step", step, 0);
  check_above("mount_drift.alike_time", alike_time, 0);
  check_above("mount_drift.mark_sigma_px", mark_sigma_px, 0);
  check_above("mount_drift.line_sigma_px", line_sigma_px, 0);
  check_above("mount_drift.least_shift", least_shift, 0);
  if (!(false_alarm > 0 && false_alarm < 1))
    throw Error("mount_drift.false_alarm", "is " + std::to_string(false_alarm) + ", must be within 0 and 1");
}

MountDrift watched(const MountDrift& before, const FieldTarget& target, const MountEvidence& seen,
                   const MountDriftOptions& options) {
  MountDrift drift = before;
  const bool goes_on = before.begun && before.mount == seen.camera.mount() && seen.t > before.t;
  if (!goes_on) drift = {.mount = seen.camera.mount(), .t = seen.t};
  if (seen.marks.size() < kLeastMarks || (drift.begun && seen.t - drift.t < options.step)) return drift;

  PoseGaussian prior = seen.pose;
  prior.covariance =
      Eigen::Vector3d(kLoosePose * kLoosePose, kLoosePose * kLoosePose, kLooseTheta * kLooseTheta).asDiagonal();
  // As the localization has it, if that explains nearly all; indulgence has its own mistakes.
  PoseFit fit;
  fit.pose = seen.pose;
  fit.line_of.assign(seen.line_of.begin(), seen.line_of.end());
  const auto explained = std::ranges::count_if(seen.marks, [&](const LineMark& mark) {
    return mark.line == LineMark::kCircle || is_explained(mark.line, seen.line_of);
  });
  constexpr double nearly_all = .8;
  if (static_cast<double>(explained) < nearly_all * static_cast<double>(seen.marks.size()))
    fit = fit_pose(target, {indulgent(seen), {}, nullptr}, prior);
  const RecycledVector<Pair> pairs = pairs_of(target, seen, fit.line_of);
  if (pairs.size() < 2) return drift;

  FieldFromRobot pose = fit.pose.field_from_robot();
  Vector3 change = Vector3::Zero();
  Normal normal;
  // So weak that it says nothing beside a line, but leaves nothing open.
  Vector6 loose;
  loose << kLooseHeight, kLooseAngle, kLooseAngle, kLoosePose, kLoosePose, kLooseTheta;
  for (int round = 0;; ++round) {
    normal = normal_at(seen, pairs, pose, change, options);
    if (round == kRounds) break;
    Matrix6 information = normal.information;
    information.diagonal() += loose.cwiseProduct(loose).cwiseInverse();
    Vector6 gradient = normal.gradient;
    gradient.head<3>() += change.cwiseQuotient(loose.head<3>().cwiseProduct(loose.head<3>()));
    const Vector6 step = -information.ldlt().solve(gradient);
    change += step.head<3>();
    pose = pose * make_pose2<RobotFrame, RobotFrame>(step[3], step[4], step[5]);
  }
  constexpr double most_square = 4;  // a mark; worse is not explained
  if (normal.marks < static_cast<int>(kLeastMarks) || normal.square > most_square * normal.marks) return drift;

  // What is left of the mount when any pose will do.
  const Eigen::Matrix3d by_mount = normal.information.topLeftCorner<3, 3>(),
                        mixed = normal.information.topRightCorner<3, 3>();
  Eigen::Matrix3d by_pose = normal.information.bottomRightCorner<3, 3>();
  by_pose.diagonal() += loose.tail<3>().cwiseProduct(loose.tail<3>()).cwiseInverse();
  const Eigen::Matrix3d gain = mixed * by_pose.inverse();
  Eigen::Matrix3d information = by_mount - gain * mixed.transpose();
  Vector3 sum = information * change - (normal.gradient.head<3>() - gain * normal.gradient.tail<3>());
  // Lines that were taken for others would have it anywhere.
  constexpr double most_change = 2, wide = 3;
  const Vector3 limit = most_change * loose.head<3>(), open = wide * loose.head<3>();
  Eigen::Matrix3d held = information;
  held.diagonal() += open.cwiseProduct(open).cwiseInverse();
  const Vector3 alone = held.inverse() * sum;
  if (!(alone.array().abs() <= limit.array()).all()) return drift;
  // A robot that shakes is another one in each frame: (information^-1 + nod)^-1.
  const Vector3 nod(seen.nod.z * seen.nod.z, seen.nod.roll * seen.nod.roll, seen.nod.pitch * seen.nod.pitch);
  const Eigen::Matrix3d damped = (Eigen::Matrix3d::Identity() + information * nod.asDiagonal()).inverse();
  information = damped * information;
  sum = damped * sum;

  const double step = drift.begun ? seen.t - drift.t : options.alike_time;
  const double kept = std::exp(-step / options.memory), weight = std::min(1., step / options.alike_time);
  drift.information = kept * drift.information + weight * .5 * (information + information.transpose());
  drift.sum = kept * drift.sum + weight * sum;
  drift.square = kept * drift.square + weight * alone.dot(sum);
  drift.moments = kept * drift.moments + weight;
  drift.t = seen.t;
  drift.begun = true;
  return drift;
}

std::optional<MountDrifted> drifted(const MountDrift& drift, const MountDriftOptions& options) {
  // Fewer moments do not tell how much they differ.
  constexpr double least_moments = 3;
  if (!drift.begun || drift.moments < least_moments) return std::nullopt;
  // Nothing is known before but that mounts do not fly off: what lines leave open stays as it was told.
  Eigen::Matrix3d information = drift.information;
  const Vector3 loose(kLooseHeight, kLooseAngle, kLooseAngle);
  information.diagonal() += loose.cwiseProduct(loose).cwiseInverse();
  Eigen::Matrix3d covariance = information.inverse();
  const Vector3 change = covariance * drift.sum;
  // What is known of sub-pixel edges before is worth so many measurements of how far off they are.
  constexpr double belief = 20;
  // Moments that contradict each other, by lines taken for others or a robot that nods, say less than each believes.
  const double excess = std::max(1., (drift.square - change.dot(drift.sum)) / (3 * (drift.moments - 1)));
  covariance *= excess;
  const double square = change.dot(information * change) / excess;
  const double chance = chance_of(square / 3, belief + 3 * (drift.moments - 1));
  if (!(chance < options.false_alarm)) return std::nullopt;
  CameraMount now = drift.mount;
  now.z += change[0];
  now.roll += change[1];
  now.pitch += change[2];
  const double shift = floor_shift(drift.mount, now);
  if (!(shift > options.least_shift)) return std::nullopt;
  const Vector3 sigma = covariance.diagonal().cwiseSqrt();
  return MountDrifted{change[0], change[1], change[2], sigma[0], sigma[1], sigma[2], shift};
}

std::string to_text(const MountDrifted& drifted) {
  std::string text;
  const auto tell = [&](const char* name, double value, double sigma, const char* unit, int digits) {
    constexpr double certain = 3;  // sigmas
    if (std::abs(value) < certain * sigma) return;
    char part[96];
    std::snprintf(part, sizeof part, "%s%s %+.*f %s (sigma %.*f)", text.empty() ? "" : ", ", name, digits, value, unit,
                  digits, sigma);
    text += part;
  };
  tell("pitch", degrees(drifted.pitch), degrees(drifted.pitch_sigma), "deg", 2);
  tell("roll", degrees(drifted.roll), degrees(drifted.roll_sigma), "deg", 2);
  tell("height", 1000 * drifted.z, 1000 * drifted.z_sigma, "mm", 0);
  if (text.empty()) text = "height, roll and pitch together";
  char shift[64];
  std::snprintf(shift, sizeof shift, "; places 3 m away are off by %.0f cm", 100 * drifted.shift);
  return text + shift;
}

}  // namespace tassilo
