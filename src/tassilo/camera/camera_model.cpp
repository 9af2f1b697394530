#include "tassilo/camera/camera_model.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

template <int n>
using Vector = Eigen::Matrix<double, n, 1>;
/// Coefficients of 1, t, t^2, ...
template <std::size_t n>
using Polynomial = std::array<double, n>;

template <std::size_t n>
double value_at(const Polynomial<n>& p, double t) {
  double sum = p[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) sum = sum * t + p[i];
  return sum;
}

/// Whether a polynomial in Bernstein form stays above zero on its whole interval; false where this cannot be told.
/// It does when all coefficients are positive, and does not when an end is not; else each half is asked (de Casteljau).
template <std::size_t n>
bool all_positive(Polynomial<n> bernstein, int halvings = 24) {
  if (!(bernstein.front() > 0 && bernstein.back() > 0)) return false;
  if (std::ranges::all_of(bernstein, [](double b) { return b > 0; })) return true;
  if (halvings == 0) return false;
  Polynomial<n> first;
  for (std::size_t i = 0; i < n; ++i) {
    first[i] = bernstein[0];
    for (std::size_t k = 0; k + i + 1 < n; ++k) bernstein[k] = (bernstein[k] + bernstein[k + 1]) / 2;
  }
  return all_positive(first, halvings - 1) && all_positive(bernstein, halvings - 1);
}

/// Row j, column i: C(j, i) / C(n - 1, i), what the power i on [0, 1] adds to the Bernstein coefficient j.
template <std::size_t n>
constexpr std::array<Polynomial<n>, n> bernstein_from_powers() {
  std::array<Polynomial<n>, n> out{};
  for (std::size_t j = 0; j < n; ++j) {
    out[j][0] = 1;
    for (std::size_t i = 1; i <= j; ++i)
      out[j][i] = out[j][i - 1] * static_cast<double>(j + 1 - i) / static_cast<double>(n - i);
  }
  return out;
}

/// Whether p > 0 on the whole of [0, end].
template <std::size_t n>
bool positive_up_to(Polynomial<n> p, double end) {
  static constexpr auto weights = bernstein_from_powers<n>();
  double scale = 1;
  for (double& coefficient : p) {
    coefficient *= scale;
    scale *= end;
  }
  Polynomial<n> bernstein;
  for (std::size_t j = 0; j < n; ++j) {
    bernstein[j] = p[0];
    for (std::size_t i = 1; i <= j; ++i) bernstein[j] += weights[j][i] * p[i];
  }
  return all_positive(bernstein);
}

template <int n>
struct Linearized {
  Vector<n> value;
  Eigen::Matrix<double, n, n> slope;
};

/// x with map(x) = target on the branch that holds the origin, by Newton's method with halved steps. `map` gives
/// nothing outside that branch, so that no step can leave it. Nothing when the branch does not reach the target.
template <int n, class Map>
std::optional<Vector<n>> invert(const Map& map, const Vector<n>& target) {
  constexpr int most_steps = 50, most_halvings = 60;
  const double size = 1 + target.norm();
  Vector<n> x = target;
  std::optional<Linearized<n>> at = map(x);
  // Starts within the branch, and not far up the steep end of a polynomial, where Newton's steps are small.
  for (int i = 0; !(at && at->value.norm() < 2 * size) && i < most_halvings; ++i) at = map(x *= .5);
  if (!at) return std::nullopt;
  double error = (at->value - target).norm();
  for (int step = 0; step < most_steps && error > 4e-16 * size; ++step) {
    Vector<n> move = at->slope.inverse() * (target - at->value);
    std::optional<Linearized<n>> next;
    double next_error = error;
    for (int i = 0; i < most_halvings && !(next && next_error < error); ++i, move *= .5) {
      // Below the last digit of the value no halving helps: this is as near as doubles get.
      if (move.squaredNorm() < 1e-34 * (1 + x.squaredNorm())) break;
      next = map(x + move);
      if (next) next_error = (next->value - target).norm();
      if (next && next_error < error) x += move;
    }
    if (!(next && next_error < error)) break;
    at = next;
    error = next_error;
  }
  return error <= 1e-12 * size ? std::optional(x) : std::nullopt;
}

OpticalPoint forward(const Vector<2>& undistorted) {
  return normalized(OpticalPoint{undistorted.x(), undistorted.y(), 1});
}

/// The two Brown-Conrady models: with q = x^2 + y^2 and the radial factor g(q) = numerator / denominator,
/// xd = x g + 2 p1 x y + p2 (q + 2 x^2), yd = y g + p1 (q + 2 y^2) + 2 p2 x y.
/// `rises` has the sign of d(r g(r^2))/dr at q = r^2; where it first gets down to zero the image folds.
template <std::size_t fraction, std::size_t degree>
struct Brown {
  Polynomial<4> numerator;
  Polynomial<fraction> denominator;
  Polynomial<degree> rises;
  double p1, p2;

  std::optional<Linearized<2>> operator()(const Vector<2>& p) const {
    const double x = p.x(), y = p.y(), q = p.squaredNorm();
    if (!positive_up_to(rises, q)) return std::nullopt;
    if constexpr (fraction > 1) {
      if (!positive_up_to(denominator, q)) return std::nullopt;
    }
    const double d = value_at(denominator, q);
    const double g = value_at(numerator, q) / d;
    const double radial = value_at(rises, q) / (d * d);    // d(r g)/dr
    const double g_slope = q > 0 ? (radial - g) / q : 0.;  // dg/dr / r
    const double cross = x * y * g_slope + 2 * p1 * x + 2 * p2 * y;
    Linearized<2> out;
    out.value = {x * g + 2 * p1 * x * y + p2 * (q + 2 * x * x), y * g + p1 * (q + 2 * y * y) + 2 * p2 * x * y};
    out.slope << g + x * x * g_slope + 2 * p1 * y + 6 * p2 * x, cross,  //
        cross, g + y * y * g_slope + 6 * p1 * y + 2 * p2 * x;
    const bool right = out.slope.determinant() > 0 && out.value.allFinite();
    return right ? std::optional(out) : std::nullopt;
  }
};

Brown<1, 4> lens(const PlumbBob& m) {
  return {{1, m.k1, m.k2, m.k3}, {1}, {1, 3 * m.k1, 5 * m.k2, 7 * m.k3}, m.p1, m.p2};
}

Brown<4, 7> lens(const RationalPolynomial& m) {
  Brown<4, 7> out{{1, m.k1, m.k2, m.k3}, {1, m.k4, m.k5, m.k6}, {}, m.p1, m.p2};
  // N D + 2 q (N' D - N D'), term by term
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      out.rises[i + j] +=
          (1 + 2 * (static_cast<double>(i) - static_cast<double>(j))) * out.numerator[i] * out.denominator[j];
  return out;
}

/// theta -> theta_d (1 + k1 theta^2 + ...), while it rises and theta < pi.
struct KannalaBrandt {
  Polynomial<5> factor, rises;

  explicit KannalaBrandt(const Equidistant& m)
      : factor{1, m.k1, m.k2, m.k3, m.k4}, rises{1, 3 * m.k1, 5 * m.k2, 7 * m.k3, 9 * m.k4} {}
  std::optional<Linearized<1>> operator()(const Vector<1>& theta) const {
    const double angle = theta.value(), square = angle * angle;
    if (!(std::abs(angle) < std::numbers::pi) || !positive_up_to(rises, square)) return std::nullopt;
    return Linearized<1>{Vector<1>(angle * value_at(factor, square)),
                         Eigen::Matrix<double, 1, 1>(value_at(rises, square))};
  }
};

// For each model: `distort`, a point in space -> distorted normalized coordinates, and `undistort`, back to the unit
// direction. Nothing where the one or the other does not exist.

template <class Model>
std::optional<Vector<2>> distort(const Model& model, OpticalPoint p) {
  if (!(p.z > 0)) return std::nullopt;
  const auto shown = lens(model)(Vector<2>(p.x / p.z, p.y / p.z));
  return shown ? std::optional(shown->value) : std::nullopt;
}
template <class Model>
std::optional<OpticalPoint> undistort(const Model& model, const Vector<2>& distorted) {
  const auto straight = invert(lens(model), distorted);
  return straight ? std::optional(forward(*straight)) : std::nullopt;
}

std::optional<Vector<2>> distort(const Equidistant& model, OpticalPoint p) {
  const double across = std::hypot(p.x, p.y);
  if (across == 0) return p.z > 0 ? std::optional(Vector<2>(0, 0)) : std::nullopt;
  const auto angle = KannalaBrandt(model)(Vector<1>(std::atan2(across, p.z)));
  return angle ? std::optional<Vector<2>>(angle->value.value() / across * Vector<2>(p.x, p.y)) : std::nullopt;
}
std::optional<OpticalPoint> undistort(const Equidistant& model, const Vector<2>& distorted) {
  const double radius = distorted.norm();
  if (radius == 0) return OpticalPoint{0, 0, 1};
  const auto angle = invert(KannalaBrandt(model), Vector<1>(radius));
  if (!angle) return std::nullopt;
  const double scale = std::sin(angle->value()) / radius;
  return OpticalPoint{scale * distorted.x(), scale * distorted.y(), std::cos(angle->value())};
}

// Both in homogeneous coordinates, so that directions near 90 degrees from the axis do not overflow. With k > 0 the
// largest image radius is 1 / sqrt(k), where x = xd / (1 + k rd^2) stops to increase; with k < 0 it is 1 / sqrt(-k),
// where the direction is 90 degrees from the axis.
std::optional<Vector<2>> distort(const Division& model, OpticalPoint p) {
  const double root = p.z * p.z - 4 * model.k * (p.x * p.x + p.y * p.y);
  if (!(p.z > 0) || !(root > 0)) return std::nullopt;
  const double scale = 2 / (p.z + std::sqrt(root));
  return Vector<2>(scale * p.x, scale * p.y);
}
std::optional<OpticalPoint> undistort(const Division& model, const Vector<2>& distorted) {
  const double bend = model.k * distorted.squaredNorm();
  if (!(std::abs(bend) < 1)) return std::nullopt;
  return normalized(OpticalPoint{distorted.x(), distorted.y(), 1 + bend});
}

std::string shown(double value) {
  std::string text = std::to_string(value);
  return text.find('.') == std::string::npos
             ? text
             : text.substr(0, std::max(text.find_last_not_of('0'), text.find('.') + 1) + 1);
}

bool finite(const PlumbBob& m) { return std::isfinite(m.k1 + m.k2 + m.p1 + m.p2 + m.k3); }
bool finite(const RationalPolynomial& m) {
  return std::isfinite(m.k1 + m.k2 + m.p1 + m.p2 + m.k3 + m.k4 + m.k5 + m.k6);
}
bool finite(const Equidistant& m) { return std::isfinite(m.k1 + m.k2 + m.k3 + m.k4); }
bool finite(const Division& m) { return std::isfinite(m.k); }

std::string_view name_of(const PlumbBob&) { return "plumb_bob"; }
std::string_view name_of(const RationalPolynomial&) { return "rational_polynomial"; }
std::string_view name_of(const Equidistant&) { return "equidistant"; }
std::string_view name_of(const Division&) { return "division"; }

void check_focal_length(const char* field, double value) {
  if (!(std::isfinite(value) && value > 0)) throw Error(field, "is " + shown(value) + ", must be > 0");
}
void check_principal_point(const char* field, double value, int size) {
  if (!(value >= -size && value <= 2. * size))
    throw Error(field, "is " + shown(value) + ", must be within " + std::to_string(-size) + " and " +
                           std::to_string(2 * std::int64_t{size}) + ", one image size from the image");
}

}  // namespace

std::string_view distortion_name(const Distortion& distortion) {
  return std::visit([](const auto& model) { return name_of(model); }, distortion);
}

void CameraModel::check() const {
  if (width <= 0) throw Error("image_width", "is " + std::to_string(width) + ", must be > 0");
  if (height <= 0) throw Error("image_height", "is " + std::to_string(height) + ", must be > 0");
  check_focal_length("fx", fx);
  check_focal_length("fy", fy);
  check_principal_point("cx", cx, width);
  check_principal_point("cy", cy, height);
  if (!std::visit([](const auto& model) { return finite(model); }, distortion))
    throw Error("distortion_coefficients", "hold a value that is not finite, all must be");
  for (const double column : {-.5, width - .5})
    for (const double row : {-.5, height - .5})
      if (!unproject(*this, {column, row}))
        throw Error("distortion_coefficients", std::string(distortion_name(distortion)) +
                                                   " folds before the image corner (" + shown(column) + ", " +
                                                   shown(row) + "), must be invertible up to there");
}

std::optional<PixelPoint> project(const CameraModel& camera, OpticalPoint point) {
  const auto seen = std::visit([&](const auto& model) { return distort(model, point); }, camera.distortion);
  if (!seen) return std::nullopt;
  return PixelPoint{camera.fx * seen->x() + camera.cx, camera.fy * seen->y() + camera.cy};
}

std::optional<OpticalPoint> unproject(const CameraModel& camera, PixelPoint pixel) {
  const Vector<2> distorted((pixel.x - camera.cx) / camera.fx, (pixel.y - camera.cy) / camera.fy);
  return std::visit([&](const auto& model) { return undistort(model, distorted); }, camera.distortion);
}

CameraModel from_halcon(const HalconDivision& parameters) {
  return {.name = {},
          .width = parameters.width,
          .height = parameters.height,
          .fx = parameters.f / parameters.sx,
          .fy = parameters.f / parameters.sy,
          .cx = parameters.cx,
          .cy = parameters.cy,
          .distortion = Division{parameters.kappa * parameters.f * parameters.f}};
}

HalconDivision to_halcon(const CameraModel& camera, double sx) {
  const auto* division = std::get_if<Division>(&camera.distortion);
  if (!division)
    throw Error("distortion_model",
                "is " + std::string(distortion_name(camera.distortion)) + ", must be division for HALCON");
  if (!(std::isfinite(sx) && sx > 0)) throw Error("sx", "is " + shown(sx) + ", must be > 0");
  const double f = camera.fx * sx;
  return {.f = f,
          .kappa = division->k / (f * f),
          .sx = sx,
          .sy = f / camera.fy,
          .cx = camera.cx,
          .cy = camera.cy,
          .width = camera.width,
          .height = camera.height};
}

}  // namespace tassilo
