#include "tassilo/localize/mount_drift.h"

#include <Eigen/Dense>
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

/// A seen line and the field's: marks in a row.
struct Pair {
  std::span<const LineMark> marks;
  const FieldLine* line = nullptr;
  const FieldArc* arc = nullptr;
};

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

RecycledVector<Pair> pairs_of(const FieldTarget& target, std::span<const LineMark> marks, const PoseFit& fit) {
  RecycledVector<Pair> pairs;
  for (std::size_t begin = 0, end = 0; begin < marks.size(); begin = end) {
    while (end < marks.size() && marks[end].line == marks[begin].line) ++end;
    Pair pair{marks.subspan(begin, end - begin), nullptr, nullptr};
    const int line = marks[begin].line;
    if (line == LineMark::kCircle) {
      if (!target.curves.arcs.empty()) pair.arc = &target.curves.arcs.front();
    } else if (line >= 0 && static_cast<std::size_t>(line) < fit.line_of.size()) {
      const int of = fit.line_of[static_cast<std::size_t>(line)];
      if (of >= 0) pair.line = &target.curves.lines[static_cast<std::size_t>(of)];
    }
    if (pair.line != nullptr || pair.arc != nullptr) pairs.push_back(pair);
  }
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
  const RobotPoint eye_before = seen.camera.center();
  const Vector3 eye(eye_before.x, eye_before.y, eye_before.z + change[0]);
  const Vector3 roll_axis = vector(seen.camera.robot_from_optical({0, 0, 1}));
  const double yaw = seen.camera.mount().yaw;
  const Vector3 pitch_axis(-std::sin(yaw), std::cos(yaw), 0), up = Vector3::UnitZ();
  const auto robot_from_field = inverse(field_from_robot);
  Normal all;
  for (const Pair& pair : pairs) {
    Matrix6 squares = Matrix6::Zero();
    Vector6 rows = Vector6::Zero(), products = Vector6::Zero();
    double sum = 0, square = 0;
    for (const LineMark& mark : pair.marks) {
      // The mark's ray, turned as the mount was.
      const Vector3 seen_ray = (Vector3(mark.at.x, mark.at.y, 0) - vector(eye_before)).normalized();
      const Vector3 turn = change[1] * roll_axis + change[2] * pitch_axis;
      const Vector3 ray = (seen_ray + turn.cross(seen_ray) + .5 * turn.cross(turn.cross(seen_ray))).normalized();
      FieldPoint at, along;
      if (pair.line != nullptr) {
        at = pair.line->p;
        along = pair.line->q - pair.line->p;
      } else {
        const FieldPoint out = field_from_robot * mark.at - pair.arc->center;
        const FieldPoint unit = (1 / std::max(norm(out), 1e-9)) * out;
        at = pair.arc->center + pair.arc->radius * unit;
        along = {-unit.y, unit.x};
      }
      const FloorPoint foot = robot_from_field * at, next = robot_from_field * (at + along);
      const Vector3 tangent = Vector3(next.x - foot.x, next.y - foot.y, 0).normalized();
      const Vector3 to_line = Vector3(foot.x, foot.y, 0) - eye, normal = to_line.cross(tangent);
      const double length = normal.norm();
      const double off = normal.dot(ray) / length;
      // The normal's own length changes nothing while the ray is near the plane.
      const auto eye_moved = [&](const Vector3& by) { return -by.cross(tangent).dot(ray) / length; };
      const auto ray_turned = [&](const Vector3& axis) { return normal.dot(axis.cross(ray)) / length; };
      Vector6 row;
      row << eye_moved(up), ray_turned(roll_axis), ray_turned(pitch_axis), eye_moved(Vector3::UnitX()),
          eye_moved(Vector3::UnitY()), ray_turned(up) + eye_moved(up.cross(eye));
      squares.noalias() += row * row.transpose();
      rows += row;
      products += off * row;
      sum += off;
      square += off * off;
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
  if (seen.marks.size() < kLeastMarks) return drift;

  PoseGaussian prior = seen.pose;
  prior.covariance =
      Eigen::Vector3d(kLoosePose * kLoosePose, kLoosePose * kLoosePose, kLooseTheta * kLooseTheta).asDiagonal();
  // As the mount was told, if that explains nearly all; indulgence has its own mistakes.
  PoseFit fit = fit_pose(target, {seen.marks, {}, nullptr}, prior);
  constexpr int some = 4, of = 5;
  if (of * fit.marks_explained < some * fit.marks_seen) fit = fit_pose(target, {indulgent(seen), {}, nullptr}, prior);
  const RecycledVector<Pair> pairs = pairs_of(target, seen.marks, fit);
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
