#include "tassilo/localize/pose_fit.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "tassilo/geometry/angle.h"
#include "tassilo/localize/internal/regression_line.h"

namespace tassilo {
namespace {

constexpr double kPi = std::numbers::pi;

/// Marks of one seen line.
struct SeenLine {
  std::span<const LineMark> marks;
  bool is_circle = false;
  bool is_wall = false;
  double angle = 0;  ///< Of the line, modulo pi. [rad]
  FloorPoint middle;
  FloorPoint first, last;
};

RecycledVector<SeenLine> seen_lines(std::span<const LineMark> marks) {
  RecycledVector<SeenLine> lines;
  for (std::size_t begin = 0; begin < marks.size();) {
    std::size_t end = begin;
    while (end < marks.size() && marks[end].line == marks[begin].line) ++end;
    SeenLine line;
    line.marks = marks.subspan(begin, end - begin);
    line.is_circle = marks[begin].line == LineMark::kCircle;
    line.is_wall = marks[begin].kind == LineKind::boundary;
    line.first = marks[begin].at;
    line.last = marks[end - 1].at;
    const auto regression = regression_line<RobotFrame>(
        line.marks, &LineMark::at, [](const LineMark& mark) { return 1 / (mark.sigma * mark.sigma); });
    line.middle = regression.middle;
    line.angle = regression.angle;
    constexpr std::size_t least = 4;
    if (line.marks.size() >= least) lines.push_back(line);
    begin = end;
  }
  return lines;
}

/// Where seen floor ends.
struct FloorEnd {
  FloorPoint at;
  double range = 0;  ///< [m]
};
RecycledVector<FloorEnd> floor_ends(const FreeSpace* space) {
  RecycledVector<FloorEnd> ends;
  for (std::size_t k = 0; space != nullptr && k < space->ranges.size(); ++k) {
    if (space->states[k] == SectorState::unseen) continue;
    const double angle = space->angle_min + static_cast<double>(k) * space->angle_increment;
    ends.push_back({space->origin + space->ranges[k] * FloorPoint{std::cos(angle), std::sin(angle)}, space->ranges[k]});
  }
  return ends;
}

/// How far a robot that drives is from standing level: its front down, its right side down. [rad]
struct Tilt {
  double pitch = 0, roll = 0;
};
/// Where a place of the floor is if the robot that saw it was tilted.
FloorPoint tilted(FloorPoint p, const Point3<RobotFrame>& eye, const Tilt& tilt) {
  const Eigen::Vector3d ray =
      Eigen::AngleAxisd(tilt.pitch, Eigen::Vector3d::UnitY()) *
      (Eigen::AngleAxisd(tilt.roll, Eigen::Vector3d::UnitX()) * Eigen::Vector3d(p.x - eye.x, p.y - eye.y, -eye.z));
  constexpr double least_down = 0.01;  // [m] at the horizon and above it no floor is seen
  const double scale = eye.z / std::max(-ray.z(), least_down);
  return {eye.x + scale * ray.x(), eye.y + scale * ray.y()};
}

double angle_of(const FieldLine& line) { return std::atan2(line.q.y - line.p.y, line.q.x - line.p.x); }

/// Distance of a point from a line's stretch. [m]
double distance_from(const FieldLine& line, FieldPoint p) {
  const FieldPoint along = line.q - line.p, out = p - line.p;
  const double share = std::clamp(dot(out, along) / dot(along, along), 0., 1.);
  return distance(p, line.p + share * along);
}

constexpr double kCap = 9;             // squared residuals beyond three sigmas say no more
constexpr double kUnexplained = 8;     // log likelihood that a seen line is none of the field's costs
constexpr double kMostEvidence = 6;    // independent places of a line: they share blur and mount
constexpr double kTiltSigma = 0.0175;  // [rad] a robot that drives nods and rolls by up to two degrees
// Where the prior's share counts, a line that is none of the field's costs this more. One in twenty is none (3); one
// that is lies within centimeters and degrees of its place instead of anywhere on the floor (10, of which 8 are above).
constexpr double kStray = 5;
constexpr double kGoalCap = 25;
constexpr double kPostSigma = 0.015;  // [rad] a pixel or two, and the width of a post's rim
constexpr double kGoalSigma = 0.04;   // [rad] of a visible part that may lie anywhere in the mouth

/// Where a goal's mouth is.
double goal_x(const FieldTarget& target, const FieldModel::Goal& goal) {
  return goal.side == GoalSide::plus_x ? target.extent.x.high : target.extent.x.low;
}
/// The left post as seen from the field; the right one is at minus that: looking at the +x goal, +y is to the left.
double y_of_left_post(const FieldModel::Goal& goal) {
  return goal.side == GoalSide::plus_x ? goal.width / 2 : -goal.width / 2;
}

class Fitter {
 public:
  Fitter(const FieldTarget& target, const PoseObservation& seen)
      : target_(target),
        seen_(seen),
        lines_(seen_lines(seen.marks)),
        floor_ends_(floor_ends(seen.free_space)),
        of_(lines_.size(), -1) {}

  const RecycledVector<SeenLine>& lines() const { return lines_; }

  /// Is it known where the marks were seen from?
  bool knows_eye() const { return !seen_.marks.empty() && seen_.marks.front().eye.z > 0; }
  /// Sees everything as a robot does that is tilted; only where the eye is known.
  void tilt(const Tilt& tilt) {
    tilted_.assign(seen_.marks.begin(), seen_.marks.end());
    for (LineMark& mark : tilted_) mark.at = tilted(mark.at, mark.eye, tilt);
    lines_ = seen_lines(tilted_);
    floor_ends_ = floor_ends(seen_.free_space);
    for (FloorEnd& end : floor_ends_) end.at = tilted(end.at, tilted_.front().eye, tilt);
  }

  /// How well a pose explains what is seen; `slack` is how far off the pose may be at the marks. [m]
  double associate(const PoseGaussian& pose, double slack, double turn_slack) {
    double total = 0;
    const FieldFromRobot field_from_robot = pose.field_from_robot();
    for (std::size_t k = 0; k < lines_.size(); ++k) {
      const SeenLine& line = lines_[k];
      of_[k] = -1;
      double best = kCap;
      if (line.is_circle) {
        for (std::size_t a = 0; a < target_.curves.arcs.size(); ++a) {
          const double cost = mean_cost(line, slack, [&](FloorPoint p) {
            return std::abs(distance(field_from_robot * p, target_.curves.arcs[a].center) -
                            target_.curves.arcs[a].radius);
          });
          if (cost < best) best = cost, of_[k] = static_cast<int>(a);
        }
      } else {
        const double angle = line.angle + pose.theta;
        for (std::size_t m = 0; m < target_.curves.lines.size(); ++m) {
          const FieldLine& model = target_.curves.lines[m];
          if (model.is_wall != line.is_wall) continue;
          constexpr double most_turn = 0.1;  // [rad] a line seen at all has a direction
          if (std::abs(wrap_half_turn(angle - angle_of(model))) > most_turn + turn_slack) continue;
          // The ends of a stretch need not be seen to the centimetre.
          const double cost =
              mean_cost(line, slack, [&](FloorPoint p) { return distance_from(model, field_from_robot * p); });
          if (cost < best) best = cost, of_[k] = static_cast<int>(m);
        }
      }
      const double evidence = std::min(kMostEvidence, static_cast<double>(line.marks.size()));
      total -= of_[k] < 0 ? kUnexplained : std::min(kUnexplained, 0.5 * evidence * best);
    }
    return total + goals(pose) + free_floor(field_from_robot);
  }

  /// One step of Gauss-Newton from `pose`; the information of all measurements but the prior.
  /// Unknowns: x, y, theta; with five of them pitch and roll as well.
  template <int unknowns>
  void add_measurements(const PoseGaussian& pose, Eigen::Matrix<double, unknowns, unknowns>& information,
                        Eigen::Matrix<double, unknowns, 1>& gradient) const {
    using Row = Eigen::Matrix<double, unknowns, 1>;
    const double c = std::cos(pose.theta), s = std::sin(pose.theta);
    const auto add = [&](const Row& by_pose, double residual, double sigma, double scale) {
      const double normed = residual / scale, robust = 1 / (1 + normed * normed / 4);  // Cauchy, two sigmas
      const double weight = robust / (sigma * sigma);
      information += weight * by_pose * by_pose.transpose();
      gradient += weight * residual * by_pose;
    };
    for (std::size_t k = 0; k < lines_.size(); ++k) {
      if (of_[k] < 0) continue;
      const auto n = static_cast<double>(lines_[k].marks.size());
      for (const LineMark& mark : lines_[k].marks) {
        const double turned_x = c * mark.at.x - s * mark.at.y, turned_y = s * mark.at.x + c * mark.at.y;
        const double x = turned_x + pose.x, y = turned_y + pose.y;
        double nx = 0, ny = 0, residual = 0;
        if (lines_[k].is_circle) {
          const FieldArc& arc = target_.curves.arcs[static_cast<std::size_t>(of_[k])];
          const double dx = x - arc.center.x, dy = y - arc.center.y, out = std::max(std::hypot(dx, dy), 1e-9);
          nx = dx / out;
          ny = dy / out;
          residual = out - arc.radius;
        } else {
          const FieldLine& line = target_.curves.lines[static_cast<std::size_t>(of_[k])];
          const FieldPoint along = line.q - line.p;
          const double length = norm(along);
          nx = -along.y / length;
          ny = along.x / length;
          residual = nx * (x - line.p.x) + ny * (y - line.p.y);
        }
        // What all marks of a line share does not average out.
        const double own = mark.sigma * mark.sigma, common = mark.common_sigma * mark.common_sigma;
        Row row = Row::Zero();
        row.template head<3>() << nx, ny, -nx * turned_y + ny * turned_x;
        if constexpr (unknowns == 5) {
          // Out from the eye, over its height: one radian moves a place by so much.
          const double ox = mark.at.x - mark.eye.x, oy = mark.at.y - mark.eye.y, h = mark.eye.z;
          const double mx = c * nx + s * ny, my = -s * nx + c * ny;  // the normal as the robot sees it
          row[3] = -mx * (h + ox * ox / h) - my * ox * oy / h;
          row[4] = mx * ox * oy / h + my * (h + oy * oy / h);
        }
        add(row, residual, std::sqrt(own + n * common), std::sqrt(own + common));
      }
    }
    for_goals(pose, [&](FieldPoint at, double bearing_seen, double sigma) {
      const double dx = at.x - pose.x, dy = at.y - pose.y, square = std::max(dx * dx + dy * dy, 0.04);
      const double residual = wrap_angle(std::atan2(dy, dx) - pose.theta - bearing_seen);
      Row row = Row::Zero();
      row.template head<3>() << dy / square, -dx / square, -1;
      add(row, residual, sigma, sigma);
    });
  }

  /// Nothing that is seen is of the field.
  PoseFit nothing(const PoseGaussian& pose) {
    std::ranges::fill(of_, -1);
    return result(
        pose, -kUnexplained * static_cast<double>(lines_.size()) + goals(pose) + free_floor(pose.field_from_robot()));
  }

  PoseFit result(const PoseGaussian& pose, double log_likelihood) const {
    PoseFit fit;
    fit.pose = pose;
    fit.log_likelihood = log_likelihood;
    for (std::size_t k = 0; k < lines_.size(); ++k) {
      const SeenLine& line = lines_[k];
      const bool explained = of_[k] >= 0;
      ++fit.lines_seen;
      fit.lines_explained += explained;
      fit.marks_seen += static_cast<int>(line.marks.size());
      fit.marks_explained += explained ? static_cast<int>(line.marks.size()) : 0;
      if (line.is_circle) continue;
      const auto number = static_cast<std::size_t>(line.marks.front().line);
      if (fit.line_of.size() <= number) fit.line_of.resize(number + 1, -1);
      fit.line_of[number] = of_[k];
    }
    return fit;
  }

 private:
  template <class Distance>
  static double mean_cost(const SeenLine& line, double slack, Distance distance_of) {
    double sum = 0;
    for (const LineMark& mark : line.marks) {
      const double off = distance_of(mark.at);
      sum += std::min(off * off / (mark.sigma * mark.sigma + mark.common_sigma * mark.common_sigma + slack * slack),
                      2 * kCap);
    }
    return sum / static_cast<double>(line.marks.size());
  }

  /// Calls each(field point, bearing seen, sigma) for what is known of the goals.
  template <class Each>
  void for_goals(const PoseGaussian& pose, Each each) const {
    for (const Goal& seen : seen_.goals) {
      const FieldModel::Goal* model = goal_of(target_, seen.color);
      if (model == nullptr) continue;
      const double x = goal_x(target_, *model), half = model->width / 2, left = y_of_left_post(*model);
      for (const GoalPost& post : seen.posts)
        each(FieldPoint{x, post.side == PostSide::left ? left : -left}, bearing(post.position), kPostSigma);
      if (!seen.posts.empty() || !seen.bearing) continue;
      // Somewhere in the mouth: where it comes nearest to what is seen.
      const double sideways =
          std::tan(std::clamp(pose.theta + *seen.bearing - (model->side == GoalSide::plus_x ? 0 : kPi), -1.4, 1.4));
      const double y = pose.y + (x - pose.x) * sideways;
      each(FieldPoint{x, std::clamp(y, -half, half)}, *seen.bearing, kGoalSigma);
    }
  }
  double goals(const PoseGaussian& pose) const {
    double total = 0;
    for_goals(pose, [&](FieldPoint at, double seen, double sigma) {
      const double off = wrap_angle(std::atan2(at.y - pose.y, at.x - pose.x) - pose.theta - seen) / sigma;
      total -= 0.5 * std::min(off * off, kGoalCap);
    });
    return total;
  }
  /// Floor that is seen does not lie behind a wall.
  double free_floor(const FieldFromRobot& field_from_robot) const {
    if (!target_.field.walls) return 0;
    constexpr double margin = 0.2, most = 8;  // [m]; log likelihood
    double total = 0;
    for (const FloorEnd& end : floor_ends_) {
      const FieldPoint p = field_from_robot * end.at;
      const Interval &x = target_.field.walls->x, &y = target_.field.walls->y;
      const double slack = margin + 0.05 * end.range;
      // Goals have floor, too.
      double depth = 0;
      for (const FieldModel::Goal& goal : target_.field.goals)
        if (std::abs(p.y) < goal.width / 2 + slack) depth = std::max(depth, goal.depth);
      const bool outside =
          p.x < x.low - depth - slack || p.x > x.high + depth + slack || p.y < y.low - slack || p.y > y.high + slack;
      total -= outside;
    }
    return std::max(total, -most);
  }

  const FieldTarget& target_;
  const PoseObservation& seen_;
  RecycledVector<LineMark> tilted_;  ///< Empty where it was not asked for.
  RecycledVector<SeenLine> lines_;
  RecycledVector<FloorEnd> floor_ends_;
  RecycledVector<int> of_;  ///< Model line (or arc) of each seen line, -1: none.
};

struct Fitted {
  PoseFit fit;
  double log_share = 0;  ///< Of the prior's belief that is at this place: how likely it was, how much of it fits in.
};

/// From `start`, whose covariance says how far off the lines may be there. Unknowns: x, y, theta; with five of them the
/// robot's pitch and roll, too, beginning at `tilt`. Explained is what lies within `most_slack` in the end. [m]
template <int unknowns>
Fitted fit_with(Fitter& fitter, const PoseGaussian& prior, const PoseGaussian& start, double most_slack = 0.3,
                Tilt tilt = {}) {
  using Matrix = Eigen::Matrix<double, unknowns, unknowns>;
  using Vector = Eigen::Matrix<double, unknowns, 1>;
  Matrix prior_information = Matrix::Zero();
  prior_information.template topLeftCorner<3, 3>() = prior.covariance.inverse();
  for (int k = 3; k < unknowns; ++k) prior_information(k, k) = 1 / (kTiltSigma * kTiltSigma);
  PoseGaussian pose = start;
  Matrix covariance = Matrix::Zero();
  covariance.template topLeftCorner<3, 3>() = start.covariance;
  const auto from_prior = [&] {
    Vector off = Vector::Zero();
    off.template head<3>() << pose.x - prior.x, pose.y - prior.y, wrap_angle(pose.theta - prior.theta);
    if constexpr (unknowns == 5) off.template tail<2>() << tilt.pitch, tilt.roll;
    return off;
  };
  constexpr int iterations = 8;
  for (int i = 0; i < iterations; ++i) {
    // Lines are told apart by where they are once it is known where we are.
    const double slack = std::min(2 * std::sqrt(covariance(0, 0) + covariance(1, 1)), 0.6);
    const double turn = std::min(2 * std::sqrt(covariance(2, 2)), 0.35);
    if constexpr (unknowns == 5) fitter.tilt(tilt);
    fitter.associate(pose, slack, turn);
    Matrix information = prior_information;
    Vector gradient = prior_information * from_prior();
    fitter.add_measurements<unknowns>(pose, information, gradient);
    const Eigen::LDLT<Matrix> solver(information);
    const Vector step = -solver.solve(gradient);
    if (!step.allFinite()) break;
    pose.x += step[0];
    pose.y += step[1];
    pose.theta = wrap_angle(pose.theta + step[2]);
    if constexpr (unknowns == 5) {
      constexpr double most = 3 * kTiltSigma;
      tilt = {std::clamp(tilt.pitch + step[3], -most, most), std::clamp(tilt.roll + step[4], -most, most)};
    }
    covariance = solver.solve(Matrix::Identity());
    if (i > 1 && std::hypot(step[0], step[1]) < 1e-4 && std::abs(step[2]) < 1e-4) break;
  }
  const Eigen::Matrix3d of_pose = covariance.template topLeftCorner<3, 3>();
  pose.covariance = 0.5 * (of_pose + of_pose.transpose());
  const double slack = std::min(std::sqrt(covariance(0, 0) + covariance(1, 1)), most_slack);
  if constexpr (unknowns == 5) fitter.tilt(tilt);
  const double log_likelihood = fitter.associate(pose, slack, 0.05);
  const Vector off = from_prior();
  const double likely = -0.5 * off.dot(prior_information * off),
               fits_in = 0.5 * std::log(covariance.determinant() * prior_information.determinant());
  return {fitter.result(pose, log_likelihood), likely + fits_in};
}

/// A place worth a fit, and how well it explains what is seen as it is.
struct Candidate {
  PoseGaussian pose;
  double score = 0;
};

/// Where the normals of a circle's marks meet; their middle where they all point the same way.
FloorPoint center_of(const SeenLine& circle) {
  FloorPoint sum;
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d vector = Eigen::Vector2d::Zero();
  for (const LineMark& mark : circle.marks) {
    sum = sum + mark.at;
    const Eigen::Vector2d n(mark.across.x, mark.across.y);
    const Eigen::Matrix2d off = Eigen::Matrix2d::Identity() - n * n.transpose();
    information += off;
    vector += off * Eigen::Vector2d(mark.at.x, mark.at.y);
  }
  if (information.determinant() <= 1e-6) return (1 / static_cast<double>(circle.marks.size())) * sum;
  const Eigen::Vector2d center = information.inverse() * vector;
  return {center[0], center[1]};
}

/// Collects poses at which a few of the things that are seen lie where the field has them.
class Search {
 public:
  /// `prior`: null where nothing is known.
  Search(const FieldTarget& target, const PoseObservation& seen, Fitter& fitter, const PoseGaussian* prior = nullptr)
      : target_(target), seen_(seen), fitter_(fitter), prior_(prior) {
    if (prior != nullptr) information_ = prior->covariance.inverse();
  }

  /// On the field, or just off it; within what is known before.
  bool may_stand(const PoseGaussian& pose) const {
    constexpr double gate = 16;  // of a Gaussian in three dimensions all but a thousandth lies within
    if (prior_ != nullptr && from_prior(pose) > gate) return false;
    constexpr double margin = 0.5;  // [m]
    return std::abs(pose.x) <= target_.field.length / 2 + margin &&
           std::abs(pose.y) <= target_.field.width / 2 + margin;
  }

  /// Squared distance from the prior in its standard deviations.
  double from_prior(const PoseGaussian& pose) const {
    if (prior_ == nullptr) return 0;
    const Eigen::Vector3d off(pose.x - prior_->x, pose.y - prior_->y, wrap_angle(pose.theta - prior_->theta));
    return off.dot(information_ * off);
  }

  /// Best first.
  RecycledVector<Candidate> candidates() {
    RecycledVector<const SeenLine*> straight;
    std::optional<FloorPoint> center;
    for (const SeenLine& line : fitter_.lines()) {
      if (line.is_circle)
        center = center_of(line);
      else
        straight.push_back(&line);
    }
    std::ranges::sort(straight, std::greater<>{},
                      [](const SeenLine* line) { return distance(line->first, line->last); });
    constexpr std::size_t most_straight = 4;
    if (straight.size() > most_straight) straight.resize(most_straight);
    for (std::size_t i = 0; i < straight.size(); ++i)
      for (const double theta : turns(*straight[i])) {
        if (prior_ != nullptr) by_line(*straight[i], theta);
        for (std::size_t j = i + 1; j < straight.size(); ++j) by_two_lines(*straight[i], *straight[j], theta);
        if (center && !target_.curves.arcs.empty()) by_point(*center, target_.curves.arcs.front().center, theta);
        for (const Goal& goal : seen_.goals)
          if (const FieldModel::Goal* model = goal_of(target_, goal.color); model != nullptr && goal.position)
            by_point(*goal.position, {goal_x(target_, *model), 0}, theta);
      }
    for (const Goal& goal : seen_.goals) by_posts(goal);
    std::ranges::sort(found_, std::greater<>{}, &Candidate::score);
    return std::exchange(found_, {});
  }

 private:
  /// With a covariance for the fit that says little: a metre, 18 degrees.
  void offer(double x, double y, double theta) {
    const PoseGaussian pose{x, y, wrap_angle(theta), Eigen::Vector3d(1, 1, 0.1).asDiagonal()};
    if (may_stand(pose)) found_.push_back({pose, fitter_.associate(pose, 0.15, 0.15) - 0.5 * from_prior(pose)});
  }
  /// Orientations that bring a seen line along one of the field's.
  RecycledVector<double> turns(const SeenLine& line) const {
    RecycledVector<double> turns;
    for (const FieldLine& model : target_.curves.lines) {
      if (model.is_wall != line.is_wall) continue;
      for (const double half : {0., kPi}) {
        const double theta = wrap_angle(angle_of(model) - line.angle + half);
        if (std::ranges::none_of(turns, [&](double other) { return std::abs(wrap_angle(other - theta)) < 0.05; }))
          turns.push_back(theta);
      }
    }
    return turns;
  }
  /// May a seen line be one of the field's, at an orientation of the robot?
  static bool may_be(const SeenLine& line, const FieldLine& model, double theta, double tolerance) {
    return model.is_wall == line.is_wall && std::abs(wrap_half_turn(angle_of(model) - line.angle - theta)) <= tolerance;
  }
  static FieldPoint turned(FloorPoint p, double theta) {
    const double c = std::cos(theta), s = std::sin(theta);
    return {c * p.x - s * p.y, s * p.x + c * p.y};
  }
  /// A line is one of the field's; along it the robot is where the prior has it.
  void by_line(const SeenLine& line, double theta) {
    const FieldPoint middle = FieldPoint{prior_->x, prior_->y} + turned(line.middle, theta);
    for (const FieldLine& model : target_.curves.lines) {
      if (!may_be(line, model, theta, 0.1)) continue;
      const FieldPoint along = model.q - model.p;
      const double off = cross(along, middle - model.p) / dot(along, along);
      offer(prior_->x + off * along.y, prior_->y - off * along.x, theta);
    }
  }
  /// Two lines that cross are two of the field's.
  void by_two_lines(const SeenLine& a, const SeenLine& b, double theta) {
    if (std::abs(wrap_half_turn(a.angle - b.angle)) < 0.5) return;
    const FieldPoint pa = turned(a.middle, theta), pb = turned(b.middle, theta);
    for (const FieldLine& of_a : target_.curves.lines) {
      if (!may_be(a, of_a, theta, 0.1)) continue;
      for (const FieldLine& of_b : target_.curves.lines) {
        if (!may_be(b, of_b, theta, 0.15)) continue;
        // The place t moves both onto their lines: cross(da, t) = ra, cross(db, t) = rb.
        const FieldPoint da = of_a.q - of_a.p, db = of_b.q - of_b.p;
        const double det = cross(da, db), ra = cross(da, of_a.p - pa), rb = cross(db, of_b.p - pb);
        offer((db.x * ra - da.x * rb) / det, (db.y * ra - da.y * rb) / det, theta);
      }
    }
  }
  /// A place of the floor is one of the field.
  void by_point(FloorPoint seen, FieldPoint at, double theta) {
    const FieldPoint from = turned(seen, theta);
    offer(at.x - from.x, at.y - from.y, theta);
  }
  /// Both posts of a goal tell the orientation, too.
  void by_posts(const Goal& goal) {
    const FieldModel::Goal* model = goal_of(target_, goal.color);
    if (model == nullptr || goal.posts.size() != 2) return;
    const bool first_is_left = goal.posts[0].side == PostSide::left;
    const FloorPoint left = goal.posts[first_is_left ? 0 : 1].position,
                     right = goal.posts[first_is_left ? 1 : 0].position;
    const double theta = std::atan2(2 * y_of_left_post(*model), 0) - bearing(left - right);
    by_point(0.5 * (left + right), {goal_x(target_, *model), 0}, theta);
  }

  const FieldTarget& target_;
  const PoseObservation& seen_;
  Fitter& fitter_;
  const PoseGaussian* prior_;
  Eigen::Matrix3d information_ = Eigen::Matrix3d::Zero();  ///< Of the prior.
  RecycledVector<Candidate> found_;
};

/// Do x, y and theta follow from what was seen, or from the prior alone?
bool is_tied_down(const PoseGaussian& pose) {
  constexpr double most_sigma = 0.5, most_turn_sigma = 0.2;  // [m], [rad]
  return pose.covariance(0, 0) <= most_sigma * most_sigma && pose.covariance(1, 1) <= most_sigma * most_sigma &&
         pose.covariance(2, 2) <= most_turn_sigma * most_turn_sigma;
}

}  // namespace

const FieldModel::Goal* goal_of(const FieldTarget& target, GoalColor color) {
  const auto goal = std::ranges::find(target.field.goals, color, &FieldModel::Goal::color);
  return goal == target.field.goals.end() ? nullptr : &*goal;
}

PoseFit fit_pose(const FieldTarget& target, const PoseObservation& seen, const PoseGaussian& prior) {
  Fitter fitter(target, seen);
  return fit_with<3>(fitter, prior, prior).fit;
}

RecycledVector<PoseFit> fit_poses(const FieldTarget& target, const PoseObservation& seen, const PoseGaussian& prior,
                                  bool may_tilt) {
  Fitter fitter(target, seen);
  RecycledVector<Fitted> found;
  const auto weight = [](const Fitted& one) {
    return one.fit.log_likelihood + one.log_share - kStray * (one.fit.lines_seen - one.fit.lines_explained);
  };
  const auto add = [&](Fitted one) {
    const auto same = std::ranges::find_if(found, [&](const Fitted& other) {
      return are_near(other.fit.pose, one.fit.pose, 0.2, 0.15) &&
             (other.fit.lines_explained > 0) == (one.fit.lines_explained > 0);
    });
    if (same == found.end())
      found.push_back(std::move(one));
    else if (weight(*same) < weight(one))
      *same = std::move(one);
  };
  may_tilt = may_tilt && fitter.knows_eye();
  const auto fit_from = [&](const PoseGaussian& start, const Tilt& tilt) {
    // A line that is one of the field's has drawn the pose to itself. One that lies further off has not, and if it
    // counted as explained, a loose pose would explain all.
    constexpr double slack = 0.05;
    add(may_tilt ? fit_with<5>(fitter, prior, start, slack, tilt) : fit_with<3>(fitter, prior, start, slack));
  };
  // Poses from lines are close to the right ones only if the robot's pitch is; a start for each degree.
  for (const double pitch : {0., -kTiltSigma, kTiltSigma, -2 * kTiltSigma, 2 * kTiltSigma}) {
    if (pitch != 0 && !may_tilt) break;
    const Tilt tilt{pitch, 0};
    if (may_tilt) fitter.tilt(tilt);
    Search search(target, seen, fitter, &prior);
    constexpr std::size_t most_fits = 12;  // each pitch
    RecycledVector<PoseGaussian> tried;
    for (auto& [pose, score] : search.candidates()) {
      if (tried.size() == most_fits) break;
      if (std::ranges::any_of(tried,
                              [&pose = pose](const PoseGaussian& other) { return are_near(other, pose, 0.15, 0.1); }))
        continue;
      tried.push_back(pose);
      pose.covariance = Eigen::Vector3d(0.01, 0.01, 0.01).asDiagonal();  // its lines lie where the field's are
      fit_from(pose, tilt);
    }
  }
  fit_from(prior, {});
  // Or nothing that is seen is of the field.
  if (may_tilt) fitter.tilt({});
  add({fitter.nothing(prior)});
  std::ranges::sort(found, std::greater<>{}, weight);
  constexpr std::size_t most_found = 12;
  if (found.size() > most_found) found.resize(most_found);
  RecycledVector<PoseFit> fits;
  for (Fitted& one : found) {
    one.fit.log_likelihood = weight(one) - found.front().log_share;
    fits.push_back(std::move(one.fit));
  }
  return fits;
}

RecycledVector<PoseFit> search_poses(const FieldTarget& target, const PoseObservation& seen) {
  Fitter fitter(target, seen);
  Search search(target, seen, fitter);
  constexpr std::size_t most_fits = 40, most_found = 12;
  RecycledVector<PoseFit> found;
  RecycledVector<PoseGaussian> tried;
  for (const auto& [pose, score] : search.candidates()) {
    if (tried.size() == most_fits) break;
    // Near one that was tried it would end there.
    if (std::ranges::any_of(tried,
                            [&pose = pose](const PoseGaussian& other) { return are_near(other, pose, 0.15, 0.1); }))
      continue;
    tried.push_back(pose);
    PoseFit fit = fit_with<3>(fitter, pose, pose).fit;
    if (!is_tied_down(fit.pose) || !search.may_stand(fit.pose)) continue;
    const auto is_it = [&](const PoseFit& other) { return are_near(other.pose, fit.pose, 0.2, 0.15); };
    if (std::ranges::none_of(found, is_it)) found.push_back(std::move(fit));
  }
  std::ranges::sort(found, std::greater<>{}, &PoseFit::log_likelihood);
  if (found.size() > most_found) found.resize(most_found);
  return found;
}

}  // namespace tassilo
