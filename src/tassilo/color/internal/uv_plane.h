#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "tassilo/region/region.h"

// The 256x256 chroma plane as an image: column = U, row = V.

namespace tassilo {

inline constexpr PixelBox kUvBox{0, 0, 256, 256};

template <class T>
struct UvPlane {
  std::vector<T> cells = std::vector<T>(256 * 256);

  T& operator()(int u, int v) { return cells[static_cast<std::size_t>(v * 256 + u)]; }
  const T& operator()(int u, int v) const { return cells[static_cast<std::size_t>(v * 256 + u)]; }
};

template <class T, class Predicate>
Region region_where(const UvPlane<T>& plane, Predicate holds) {
  RunVector runs;
  for (int v = 0; v < 256; ++v)
    for (int u = 0; u < 256; ++u) {
      if (!holds(plane(u, v))) continue;
      if (!runs.empty() && runs.back().row == v && runs.back().end == u)
        ++runs.back().end;
      else
        runs.push_back({static_cast<std::int16_t>(v), static_cast<std::int16_t>(u), static_cast<std::int16_t>(u + 1)});
    }
  return Region::from_sorted(std::move(runs));
}

/// Separable binomial filter 1 4 6 4 1, standard deviation 1; outside the plane is nothing.
inline UvPlane<double> binomial_blur(const UvPlane<double>& plane) {
  constexpr std::array<double, 5> kernel{1 / 16., 4 / 16., 6 / 16., 4 / 16., 1 / 16.};
  const auto pass = [&](const UvPlane<double>& in, int du, int dv) {
    UvPlane<double> out;
    for (int v = 0; v < 256; ++v)
      for (int u = 0; u < 256; ++u)
        for (int k = -2; k <= 2; ++k) {
          const int nu = u + k * du, nv = v + k * dv;
          if (nu >= 0 && nu < 256 && nv >= 0 && nv < 256)
            out(u, v) += kernel[static_cast<std::size_t>(k + 2)] * in(nu, nv);
        }
    return out;
  };
  return pass(pass(plane, 1, 0), 0, 1);
}

/// Euclidean distance of every cell to the nearest cell of the region; infinite when it is empty.
/// Two passes over columns and rows, O(256^2) for the first, parabola envelope for the second.
/// source: Felzenszwalb, Huttenlocher, "Distance transforms of sampled functions", Theory of Computing 8, 2012.
inline UvPlane<double> distance_to(const Region& region) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  UvPlane<double> squared;
  std::fill(squared.cells.begin(), squared.cells.end(), infinite);
  for (const PixelRun& run : region.runs())
    for (int u = run.begin; u < run.end; ++u) squared(u, run.row) = 0;
  for (int u = 0; u < 256; ++u) {
    double along = infinite;
    const auto step = [&](int v) {
      along = squared(u, v) == 0 ? 0 : along + 1;
      squared(u, v) = std::min(squared(u, v), along * along);
    };
    for (int v = 0; v < 256; ++v) step(v);
    along = infinite;
    for (int v = 255; v >= 0; --v) step(v);
  }
  UvPlane<double> distance;
  for (int v = 0; v < 256; ++v) {
    std::array<int, 256> apex{};
    std::array<double, 257> from{};
    int count = 0;
    for (int u = 0; u < 256; ++u) {
      const double height = squared(u, v);
      if (height == infinite) continue;
      double start = -infinite;
      while (count > 0) {
        const int p = apex[static_cast<std::size_t>(count - 1)];
        start = ((height + double(u) * u) - (squared(p, v) + double(p) * p)) / (2.0 * (u - p));
        if (start > from[static_cast<std::size_t>(count - 1)]) break;
        --count;
        start = -infinite;
      }
      apex[static_cast<std::size_t>(count)] = u;
      from[static_cast<std::size_t>(count)] = start;
      ++count;
    }
    for (int u = 0, k = 0; u < 256; ++u) {
      if (count == 0) {
        distance(u, v) = infinite;
        continue;
      }
      while (k + 1 < count && from[static_cast<std::size_t>(k + 1)] < u) ++k;
      const int p = apex[static_cast<std::size_t>(k)];
      distance(u, v) = std::sqrt(squared(p, v) + double(u - p) * (u - p));
    }
  }
  return distance;
}

}  // namespace tassilo
