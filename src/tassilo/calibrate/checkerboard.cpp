#include "tassilo/calibrate/checkerboard.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "tassilo/base/contract.h"
#include "tassilo/calibrate/internal/grid_walk.h"
#include "tassilo/calibrate/internal/image_filters.h"
#include "tassilo/calibrate/internal/saddle_fit.h"

namespace tassilo {
namespace {

constexpr double kLeastContrast = 12;       ///< Around a corner, from mean to extreme. [gray levels]
constexpr double kLeastResponse = .02;      ///< Of the strongest saddle in the image.
constexpr double kBendSigma = 4e-4;         ///< Of a line's bend from the points on it. [1/px]
constexpr std::size_t kMostSaddles = 1500;  ///< The strongest ones.

/// Where brightness has a saddle, to the pixel or a little better.
struct Saddle {
  PixelPoint at;
  double response = 0;  ///< - determinant of the Hessian matrix.
};

double response_at(const GrayPlane& image, int c, int r) {
  const double xx = image.at(c - 1, r) - 2 * image.at(c, r) + image.at(c + 1, r);
  const double yy = image.at(c, r - 1) - 2 * image.at(c, r) + image.at(c, r + 1);
  const double xy =
      (image.at(c + 1, r + 1) - image.at(c - 1, r + 1) - image.at(c + 1, r - 1) + image.at(c - 1, r - 1)) / 4;
  return xy * xy - xx * yy;
}

/// Whether brightness around a point goes up and down exactly twice, and is alike on opposite sides.
bool alternates(const GrayPlane& image, PixelPoint at, double radius) {
  constexpr int count = 32;
  std::array<double, count> ring;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / count;
    ring[i] = image.sample(at.x + radius * std::cos(angle), at.y + radius * std::sin(angle));
    low = std::min(low, ring[i]);
    high = std::max(high, ring[i]);
  }
  if (high - low < 2 * kLeastContrast) return false;
  const double middle = (low + high) / 2;
  int changes = 0, alike = 0;
  for (std::size_t i = 0; i < count; ++i) {
    changes += (ring[i] > middle) != (ring[(i + 1) % count] > middle);
    alike += (ring[i] > middle) == (ring[(i + count / 2) % count] > middle);
  }
  return changes == 4 && alike >= count * 3 / 4;
}

std::vector<Saddle> find_saddles(const GrayPlane& image, double sigma) {
  GrayPlane response = image;
  double strongest = 0;
  const auto place = [&](int c, int r) {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(c);
  };
  for (int r = 0; r < image.height; ++r)
    for (int c = 0; c < image.width; ++c) {
      const double here = response_at(image, c, r);
      response.values[place(c, r)] = static_cast<float>(here);
      strongest = std::max(strongest, here);
    }
  const double radius = 2 + sigma;
  const int border = static_cast<int>(std::ceil(radius)) + 1;
  std::vector<Saddle> saddles;
  for (int r = border; r < image.height - border; ++r)
    for (int c = border; c < image.width - border; ++c) {
      const float here = response.at(c, r);
      if (!(here > kLeastResponse * strongest)) continue;
      bool is_peak = true;
      for (int dr = -2; dr <= 2 && is_peak; ++dr)
        for (int dc = -2; dc <= 2 && is_peak; ++dc) {
          const float other = response.at(c + dc, r + dr);
          is_peak = here > other || (here == other && (dr > 0 || (dr == 0 && dc >= 0)));
        }
      const PixelPoint at{static_cast<double>(c), static_cast<double>(r)};
      if (is_peak && alternates(image, at, radius)) saddles.push_back({at, here});
    }
  std::ranges::stable_sort(saddles, std::ranges::greater{}, &Saddle::response);
  if (saddles.size() > kMostSaddles) saddles.resize(kMostSaddles);
  return saddles;
}

/// The step from a cell of the lattice to its neighbor at (dc, dr), or from the one opposite; nothing without either.
std::optional<PixelPoint> step_from(const Lattice& lattice, std::span<const PixelPoint> places, std::array<int, 2> cell,
                                    std::array<int, 2> way) {
  const auto place = [&](int times) -> std::optional<PixelPoint> {
    const int column = cell[0] + times * way[0], row = cell[1] + times * way[1];
    if (column < 0 || row < 0 || column >= lattice.columns || row >= lattice.rows) return std::nullopt;
    const int point = lattice.at(column, row);
    return point >= 0 ? std::optional(places[static_cast<std::size_t>(point)]) : std::nullopt;
  };
  const auto here = place(0), next = place(1), last = place(-1);
  // The shorter one: what is farther away may belong to the next corner already.
  if (next && last && distance(*here, *last) < distance(*next, *here)) return *here - *last;
  if (next) return *next - *here;
  if (last) return *here - *last;
  return std::nullopt;
}

/// +1 where the squares before and behind a corner along the diagonal (both coordinates rise) are black, -1 where they
/// are white; 0 when it has no neighbors to tell the diagonal by.
int polarity(const GrayPlane& image, const Lattice& lattice, std::span<const PixelPoint> places, int c, int r) {
  const PixelPoint here = places[static_cast<std::size_t>(lattice.at(c, r))];
  const auto along = step_from(lattice, places, {c, r}, {1, 0}), down = step_from(lattice, places, {c, r}, {0, 1});
  if (!along || !down) return 0;
  const auto sample = [&](double u, double v) {
    const PixelPoint at = here + u * *along + v * *down;
    return image.sample(at.x, at.y);
  };
  constexpr double far = .3;
  const double diagonal = sample(far, far) + sample(-far, -far), across = sample(far, -far) + sample(-far, far);
  return diagonal < across ? 1 : -1;
}

/// How many more corners agree with a black square before corner (0, 0) than with a white one, and how many were asked.
std::array<int, 2> votes_for_black(const GrayPlane& image, const Lattice& lattice, std::span<const PixelPoint> places) {
  std::array<int, 2> votes{};
  for (int r = 0; r < lattice.rows; ++r)
    for (int c = 0; c < lattice.columns; ++c) {
      if (lattice.at(c, r) < 0) continue;
      const int sign = polarity(image, lattice, places, c, r);
      votes[0] += (c + r) % 2 == 0 ? sign : -sign;
      votes[1] += sign != 0;
    }
  return votes;
}

/// How the lattice's line through a cell is bent there, see RoughCorner: a parabola through up to 7 points. 0 with too
/// few.
double line_bend(const Lattice& lattice, std::span<const PixelPoint> places, std::array<int, 2> cell,
                 std::array<int, 2> way) {
  constexpr int reach = 3;
  const auto step = step_from(lattice, places, cell, way);
  const PixelPoint here = places[static_cast<std::size_t>(lattice.at(cell[0], cell[1]))];
  if (!step) return 0;
  const PixelPoint tangent = 1 / norm(*step) * *step, normal{-tangent.y, tangent.x};
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  int count = 0;
  for (int k = -reach; k <= reach; ++k) {
    const int column = cell[0] + k * way[0], row = cell[1] + k * way[1];
    if (column < 0 || row < 0 || column >= lattice.columns || row >= lattice.rows) continue;
    const int point = lattice.at(column, row);
    if (point < 0) continue;
    const PixelPoint away = places[static_cast<std::size_t>(point)] - here;
    const double s = dot(away, tangent);
    const Eigen::Vector3d powers(1, s, s * s);
    squares += powers * powers.transpose();
    right += dot(away, normal) * powers;
    ++count;
  }
  return count >= 5 ? -squares.ldlt().solve(right)[2] : 0;
}

/// The places of a lattice's corners between the pixels; where that fails the lattice loses the corner.
std::vector<PixelPoint> place_corners(ByteView image, Lattice& lattice, const std::vector<PixelPoint>& places,
                                      bool bends_known) {
  std::vector<PixelPoint> placed = places;
  std::vector<int> kept = lattice.index;
  for (int r = 0; r < lattice.rows; ++r)
    for (int c = 0; c < lattice.columns; ++c) {
      const int point = lattice.at(c, r);
      if (point < 0) continue;
      const auto along = step_from(lattice, places, {c, r}, {1, 0}), down = step_from(lattice, places, {c, r}, {0, 1});
      std::optional<PixelPoint> at;
      if (along && down) {
        RoughCorner corner{.at = places[static_cast<std::size_t>(point)], .along = *along, .down = *down};
        if (bends_known) {
          corner.along_bend = line_bend(lattice, places, {c, r}, {1, 0});
          corner.down_bend = line_bend(lattice, places, {c, r}, {0, 1});
          corner.bend_sigma = kBendSigma;
        }
        at = fitted_corner(image, corner);
      }
      if (at)
        placed[static_cast<std::size_t>(point)] = *at;
      else
        kept[static_cast<std::size_t>(r * lattice.columns + c)] = -1;
    }
  lattice.index = kept;
  return placed;
}

}  // namespace

TargetSearch find_checkerboard(ByteView image, const Target& target) {
  expects(target.kind == TargetKind::checkerboard, "find_checkerboard: a checkerboard");
  target.check();
  TargetSearch nearest{{}, "the image is too small"};
  if (image.width < 16 || image.height < 16) return nearest;
  for (const double sigma : {1., 2., 4.}) {
    const GrayPlane smooth = blurred(image, sigma);
    const std::vector<Saddle> saddles = find_saddles(smooth, sigma);
    std::vector<PixelPoint> places;
    for (const Saddle& saddle : saddles) places.push_back(saddle.at);
    const LatticeSearch found = walk_grid(places, target.columns, target.rows, [](int, int) { return true; });
    if (!found.lattice) {
      if (sigma == 1) nearest.reason = found.reason;
      continue;
    }
    Lattice lattice = *found.lattice;
    const auto [votes, asked] = votes_for_black(smooth, lattice, places);
    if (std::abs(votes) < .8 * asked) {
      nearest.reason = "squares between the grid's points do not alternate";
      continue;
    }
    if (votes < 0) lattice = quarter_turn(quarter_turn(lattice));
    // The second time with the lines' bends as the first has found them.
    std::vector<PixelPoint> placed = place_corners(image, lattice, places, false);
    placed = place_corners(image, lattice, placed, true);
    TargetView view{target, {}};
    for (int r = 0; r < lattice.rows; ++r)
      for (int c = 0; c < lattice.columns; ++c)
        if (const int point = lattice.at(c, r); point >= 0)
          view.points.push_back({c, r, placed[static_cast<std::size_t>(point)]});
    if (static_cast<double>(view.points.size()) < .8 * target.size()) {
      nearest.reason = "corners cannot be placed between the pixels";
      continue;
    }
    return {std::move(view), {}};
  }
  return nearest;
}

}  // namespace tassilo
