#include "tassilo/calibrate/internal/frame_places.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

namespace tassilo {
namespace {

// Lengths without unit are in pitches.
constexpr double kStep = .25;      ///< Between places along a side, and the length that each is measured over.
constexpr double kBeyond = .625;   ///< How far beyond the outer dots there are places: clear of the other sides. Beside
                                   ///< the triangle: not at all.
constexpr double kReach = .36;     ///< Of a profile across: the bar, then white up to short of the paper's end.
constexpr double kWhite = .24;     ///< What is farther from the middle is white for sure.
constexpr double kLeastBar = 2;    ///< Narrower bars have no white beside them that blur leaves alone. [px]
constexpr double kContrast = 24;   ///< Of bar and paper. [gray levels]
constexpr double kMostShift = .2;  ///< From where the dots let expect the bar.

/// From target to image by a polynomial through the dots: good enough to look for the frame, a pitch beyond them.
class SmoothMap {
 public:
  explicit SmoothMap(const TargetView& dots)
      : middle_((dots.target.columns - 1) / 2., (dots.target.rows - 1) / 2.),
        degree_(std::min(dots.target.columns, dots.target.rows) >= 5 ? 3 : 2) {
    const auto terms = terms_at(0, 0).size();
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(terms, terms);
    coefficients_ = Eigen::MatrixXd::Zero(terms, 2);
    for (const SeenPoint& dot : dots.points) {
      const Eigen::VectorXd row = terms_at(dot.column, dot.row);
      normal += row * row.transpose();
      coefficients_ += row * Eigen::RowVector2d(dot.pixel.x, dot.pixel.y);
    }
    coefficients_ = normal.ldlt().solve(coefficients_).eval();
  }

  Eigen::Vector2d at(double column, double row) const { return coefficients_.transpose() * terms_at(column, row); }

 private:
  Eigen::VectorXd terms_at(double column, double row) const {
    const double u = (column - middle_.x()) / middle_.x(), v = (row - middle_.y()) / middle_.y();
    Eigen::VectorXd out(degree_ == 3 ? 10 : 6);
    if (degree_ == 3)
      out << 1, u, v, u * u, u * v, v * v, u * u * u, u * u * v, u * v * v, v * v * v;
    else
      out << 1, u, v, u * u, u * v, v * v;
    return out;
  }

  Eigen::Vector2d middle_;
  int degree_;
  Eigen::MatrixXd coefficients_;
};

double sample(ByteView image, double x, double y) {
  const int c = static_cast<int>(x), r = static_cast<int>(y);
  const double u = x - c, v = y - r;
  const auto upper = image.row(r), lower = image.row(r + 1);
  const auto at = static_cast<std::size_t>(c);
  return (1 - v) * ((1 - u) * upper[at] + u * upper[at + 1]) + v * ((1 - u) * lower[at] + u * lower[at + 1]);
}

/// Where the middle of a dark bar is, from `place` along `across` [px / pitch]; nothing without one. [pitch]
std::optional<double> bar_middle(ByteView image, const Eigen::Vector2d& place, const Eigen::Vector2d& along,
                                 const Eigen::Vector2d& across) {
  const int columns = static_cast<int>(std::ceil(2 * kStep * along.norm()));
  const int rows = 2 * static_cast<int>(std::ceil(2 * kReach * across.norm())) + 1;
  Eigen::VectorXd profile = Eigen::VectorXd::Zero(rows), distance(rows);
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (int k = 0; k < rows; ++k) {
    const double d = distance[k] = kReach * (2. * k / (rows - 1) - 1);
    for (int i = 0; i < columns; ++i) {
      const Eigen::Vector2d at = place + d * across + kStep * ((i + .5) / columns - .5) * along;
      if (!(at.x() >= 0 && at.y() >= 0 && at.x() < image.width - 1 && at.y() < image.height - 1)) return std::nullopt;
      profile[k] += sample(image, at.x(), at.y()) / columns;
    }
    if (std::abs(d) < kWhite) continue;
    normal += Eigen::Vector2d(1, d) * Eigen::RowVector2d(1, d);
    right += profile[k] * Eigen::Vector2d(1, d);
  }
  const Eigen::Vector2d paper = normal.ldlt().solve(right);
  double mass = 0, moment = 0, darkest = 0;
  for (int k = 0; k < rows; ++k) {
    const double dark = paper[0] + paper[1] * distance[k] - profile[k];
    mass += dark;
    moment += dark * distance[k];
    darkest = std::max(darkest, dark);
  }
  if (!(darkest > kContrast && mass > 0)) return std::nullopt;
  return moment / mass;
}

/// Measured twice: what is not in the middle of its profile is drawn to the middle.
std::optional<FramePlace> measured(ByteView image, const TargetView& dots, const SmoothMap& map, FramePlace place) {
  const bool is_row = place.side == FrameSide::top || place.side == FrameSide::bottom;
  const double last = (is_row ? dots.target.rows : dots.target.columns) - 1;
  const bool is_first = place.side == FrameSide::top || place.side == FrameSide::left;
  const double off = is_first ? -kFrameDistance : last + kFrameDistance;
  const auto at = [&](double shift_along, double shift_across) {
    return is_row ? map.at(place.along + shift_along, off + shift_across)
                  : map.at(off + shift_across, place.along + shift_along);
  };
  constexpr double h = .05;
  const Eigen::Vector2d along = (at(h, 0) - at(-h, 0)) / (2 * h), across = (at(0, h) - at(0, -h)) / (2 * h);
  if (!(along.allFinite() && across.allFinite())) return std::nullopt;
  // The farthest step that a sane image has: beyond it the map through the dots is none.
  const double longest = std::max(image.width, image.height);
  if (!(along.norm() < longest && across.norm() < longest)) return std::nullopt;
  const Eigen::Vector2d tangent = along.normalized(), normal(-tangent.y(), tangent.x());
  if (!(.25 * std::abs(normal.dot(across)) >= kLeastBar)) return std::nullopt;
  double middle = 0;
  for (int round = 0; round < 3; ++round) {
    const auto shift = bar_middle(image, at(0, 0) + middle * across, along, across);
    if (!shift) return std::nullopt;
    middle += *shift;
    if (!(std::abs(middle) < kMostShift)) return std::nullopt;
  }
  const Eigen::Vector2d pixel = at(0, 0) + middle * across;
  place.pixel = {pixel.x(), pixel.y()};
  place.normal = {normal.x(), normal.y()};
  return place;
}

}  // namespace

std::vector<FramePlace> frame_places(ByteView image, const TargetView& dots) {
  const SmoothMap map(dots);
  std::vector<FramePlace> out;
  for (const FrameSide side : {FrameSide::top, FrameSide::bottom, FrameSide::left, FrameSide::right}) {
    const bool is_row = side == FrameSide::top || side == FrameSide::bottom;
    const bool has_mark = side == FrameSide::top || side == FrameSide::left;
    const double last = (is_row ? dots.target.columns : dots.target.rows) - 1;
    for (double along = has_mark ? 0 : -kBeyond; along <= last + kBeyond + 1e-9; along += kStep)
      if (const auto place = measured(image, dots, map, {side, along, {}, {}})) out.push_back(*place);
  }
  return out;
}

}  // namespace tassilo
