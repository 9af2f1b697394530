#include "tassilo/calibrate/internal/saddle_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace tassilo {
namespace {

constexpr double kShare = .7;      ///< Of the steps to the next corners, whose edges must stay out of view.
constexpr double kMostReach = 14;  ///< [px]
constexpr int kMostSteps = 30;

/// Brightness a + b erf(d0 / s) erf(d1 / s): d the distances from two edges through (x, y), edge i in direction
/// angle[i], bent by bend[i].
enum Parameter { kX, kY, kAngle0, kAngle1, kBend0, kBend1, kSpread, kMean, kContrast, kCount };
using Vector = Eigen::Matrix<double, kCount, 1>;
using Matrix = Eigen::Matrix<double, kCount, kCount>;

struct Pixel {
  double column, row, brightness;
};

/// Value and slope of the model at a pixel.
double model_at(const Vector& p, const Pixel& pixel, Vector& slope) {
  const Eigen::Vector2d away(pixel.column - p[kX], pixel.row - p[kY]);
  double step[2], rise[2], off[2];
  Eigen::Vector2d by_place[2];
  double by_angle[2], by_bend[2];
  for (int i = 0; i < 2; ++i) {
    const double angle = p[kAngle0 + i], bend = p[kBend0 + i];
    const Eigen::Vector2d tangent(std::cos(angle), std::sin(angle)), normal(-tangent.y(), tangent.x());
    const double along = tangent.dot(away), across = normal.dot(away);
    off[i] = (across + bend * along * along) / p[kSpread];
    step[i] = std::erf(off[i]);
    rise[i] = 2 / std::sqrt(std::numbers::pi) * std::exp(-off[i] * off[i]) / p[kSpread];
    by_place[i] = -normal - 2 * bend * along * tangent;
    by_angle[i] = -along + 2 * bend * along * across;
    by_bend[i] = along * along;
  }
  const double b = p[kContrast];
  const double slope0 = b * rise[0] * step[1], slope1 = b * rise[1] * step[0];
  slope.segment<2>(kX) = slope0 * by_place[0] + slope1 * by_place[1];
  slope[kAngle0] = slope0 * by_angle[0];
  slope[kAngle1] = slope1 * by_angle[1];
  slope[kBend0] = slope0 * by_bend[0];
  slope[kBend1] = slope1 * by_bend[1];
  slope[kSpread] = -(slope0 * off[0] + slope1 * off[1]);
  slope[kMean] = 1;
  slope[kContrast] = step[0] * step[1];
  return p[kMean] + b * step[0] * step[1];
}

struct Normal {
  Matrix matrix = Matrix::Zero();
  Vector right = Vector::Zero();
  double cost = 0;
};

Normal normal_of(const Vector& p, const std::vector<Pixel>& pixels, const RoughCorner& corner) {
  Normal out;
  Vector slope;
  for (const Pixel& pixel : pixels) {
    const double off = pixel.brightness - model_at(p, pixel, slope);
    out.matrix.noalias() += slope * slope.transpose();
    out.right += off * slope;
    out.cost += off * off;
  }
  // Freely bent edges would follow the noise. [gray levels^2]
  for (const int which : {0, 1}) {
    constexpr double noise = 2;
    const double weight = noise * noise / (corner.bend_sigma * corner.bend_sigma);
    const double off = (which == 0 ? corner.along_bend : corner.down_bend) - p[kBend0 + which];
    out.matrix(kBend0 + which, kBend0 + which) += weight;
    out.right[kBend0 + which] += weight * off;
    out.cost += weight * off * off;
  }
  return out;
}

}  // namespace

std::optional<PixelPoint> fitted_corner(ByteView image, const RoughCorner& corner) {
  Eigen::Matrix2d steps;
  steps << corner.along.x, corner.down.x, corner.along.y, corner.down.y;
  const auto shorter = [](PixelPoint step) { return std::min(1., kMostReach / (kShare * norm(step))); };
  steps.col(0) *= shorter(corner.along);
  steps.col(1) *= shorter(corner.down);
  if (!(std::abs(steps.determinant()) > 1)) return std::nullopt;
  const Eigen::Matrix2d to_steps = steps.inverse();
  const Eigen::Vector2d reach = kShare * (steps.col(0).cwiseAbs() + steps.col(1).cwiseAbs());
  const Eigen::Vector2d middle(corner.at.x, corner.at.y);
  std::vector<Pixel> pixels;
  double dark = 255, bright = 0, sign = 0;
  for (int r = static_cast<int>(std::ceil(middle.y() - reach.y())); r <= middle.y() + reach.y(); ++r)
    for (int c = static_cast<int>(std::ceil(middle.x() - reach.x())); c <= middle.x() + reach.x(); ++c) {
      const Eigen::Vector2d place = to_steps * (Eigen::Vector2d(c, r) - middle);
      if (place.cwiseAbs().maxCoeff() > kShare) continue;
      if (c < 0 || r < 0 || c >= image.width || r >= image.height) return std::nullopt;
      const double y = image.row(r)[static_cast<std::size_t>(c)];
      pixels.push_back({static_cast<double>(c), static_cast<double>(r), y});
      dark = std::min(dark, y);
      bright = std::max(bright, y);
      sign += (y - 128) * (place.x() * place.y() > 0 ? 1 : -1);
    }
  if (pixels.size() < 2 * kCount) return std::nullopt;
  Vector p;
  // The distance from the line along the columns rises with the rows, that from the other falls with the columns.
  p << corner.at.x, corner.at.y, std::atan2(corner.along.y, corner.along.x), std::atan2(corner.down.y, corner.down.x),
      corner.along_bend, corner.down_bend, 1.2, (dark + bright) / 2, (sign > 0 ? -1 : 1) * (bright - dark) / 2;
  Normal normal = normal_of(p, pixels, corner);
  double damping = 1e-3;
  for (int step = 0; step < kMostSteps; ++step) {
    Matrix damped = normal.matrix;
    damped.diagonal() *= 1 + damping;
    const Vector move = damped.ldlt().solve(normal.right);
    const Vector next = p + move;
    if (!next.allFinite()) return std::nullopt;
    const bool is_sound = next[kSpread] > .2 && next[kSpread] < 8;
    const Normal there = is_sound ? normal_of(next, pixels, corner) : Normal{};
    if (!is_sound || there.cost > normal.cost) {
      damping *= 10;
      if (damping > 1e8) break;
      continue;
    }
    p = next;
    normal = there;
    damping = std::max(damping / 10, 1e-9);
    if (move.head<2>().norm() < 1e-5) break;
  }
  const PixelPoint at{p[kX], p[kY]};
  if (!(distance(at, corner.at) < std::max(1.5, .2 * reach.minCoeff()))) return std::nullopt;
  return at;
}

}  // namespace tassilo
