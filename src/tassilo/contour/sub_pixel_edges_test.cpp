#include "tassilo/contour/sub_pixel_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/contour/internal/edge_points.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

constexpr int kSize = 64;

struct Scene {
  double dark = 90, contrast = 60, noise = 0;
  unsigned seed = 0;
};

/// A frame that is bright where depth(column, row) > 0; pixels see their square, blurred a little as by a lens. [px]
Frame drawn(PixelFormat format, const Scene& scene, const std::function<double(double, double)>& depth) {
  FrameBuffer buffer = make_frame_buffer(format, kSize, kSize, ColorRange::full);
  std::mt19937 random(scene.seed);
  std::normal_distribution<double> noise;  // of sigma 1
  const YuvRow first = buffer.frame.view.row(0);
  for (int r = 0; r < kSize; ++r)
    for (int c = 0; c < kSize; ++c) {
      // Far from the edge a pixel sees one side only.
      double light = depth(c, r) > 4 ? 1 : 0;
      constexpr int kFine = 5;
      for (int i = 0; i < kFine && std::abs(depth(c, r)) <= 4; ++i)
        for (int j = 0; j < kFine; ++j) {
          const double d = depth(c + (j + .5) / kFine - .5, r + (i + .5) / kFine - .5);
          light += .5 * std::erfc(-d / (.4 * std::numbers::sqrt2)) / (kFine * kFine);
        }
      const double value = scene.dark + scene.contrast * light + scene.noise * noise(random);
      const auto offset = first.y - buffer.planes[0];
      buffer.planes[0][offset + r * buffer.strides[0] + c * first.y_step] =
          static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
    }
  return buffer.frame;
}

/// How far a point lies on the bright side of a straight edge. [px]
struct StraightEdge {
  double angle, phase;  ///< Of the direction in which it gets brighter. [rad], [px]
  double operator()(double c, double r) const {
    return (c - kSize / 2.) * std::cos(angle) + (r - kSize / 2.) * std::sin(angle) - phase;
  }
};

const Region kAll = Region::from_box({0, 0, kSize, kSize});
const Region kInner = Region::from_box({10, 10, kSize - 10, kSize - 10});

/// Errors of the points of all edges in kInner. [px]
std::vector<double> errors(const StraightEdge& edge, const Scene& scene, const EdgeOptions& options) {
  const Frame frame = drawn(PixelFormat::yuv422p, scene, edge);
  std::vector<double> errors;
  for (const Contour& contour : sub_pixel_edges(frame.view, kInner, options))
    for (const PixelPoint point : contour.points) errors.push_back(edge(point.x, point.y));
  return errors;
}
double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value / static_cast<double>(values.size());
  return sum;
}
double mean_size(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += std::abs(value) / static_cast<double>(values.size());
  return sum;
}

TEST(SubPixelEdges, LieOnStraightEdgesOfAllDirectionsAndPhases) {
  for (const int size : {3, 5, 7})
    for (int angle_deg = 0; angle_deg < 360; angle_deg += 18)
      for (double phase = 0; phase < 1; phase += .25) {
        SCOPED_TRACE(std::to_string(size) + ", " + std::to_string(angle_deg) + " deg, phase " + std::to_string(phase));
        const auto found = errors({angle_deg * std::numbers::pi / 180, phase}, {}, {.filter_size_px = size});
        EXPECT_GE(found.size(), 40u);
        EXPECT_LT(mean_size(found), size == 3 ? .035 : .015);
      }
}

TEST(SubPixelEdges, StayCloseInNoiseWithoutBiasOverThePhase) {
  for (const int size : {5, 7})
    for (int angle_deg = 0; angle_deg < 360; angle_deg += 30)
      for (double phase = 0; phase < 1; phase += .25) {
        SCOPED_TRACE(std::to_string(size) + ", " + std::to_string(angle_deg) + " deg, phase " + std::to_string(phase));
        std::vector<double> all;
        for (unsigned seed = 0; seed < 4; ++seed) {
          const Scene scene{.noise = 5, .seed = seed};
          const auto found = errors({angle_deg * std::numbers::pi / 180, phase}, scene, {.filter_size_px = size});
          all.insert(all.end(), found.begin(), found.end());
        }
        EXPECT_GE(all.size(), 160u);
        EXPECT_LT(mean_size(all), .1);
        // The mean of so many points, which do not all see other noise, is known to about .01.
        EXPECT_LT(std::abs(mean(all)), .04);
      }
}

TEST(SubPixelEdges, OfADiscAreOneClosedContourWithTheBrightSideToTheRight) {
  for (const bool bright : {false, true}) {
    const auto depth = [&](double c, double r) { return (bright ? 1 : -1) * (18.3 - std::hypot(c - 31.4, r - 30.8)); };
    const Frame frame = drawn(PixelFormat::yuv422p, {.noise = 2}, depth);
    const auto edges = sub_pixel_edges(frame.view, kAll);
    ASSERT_EQ(edges.size(), 1u);
    EXPECT_TRUE(edges[0].closed);
    EXPECT_NEAR(length(edges[0]), 2 * std::numbers::pi * 18.3, 2);
    double twice_area = 0;
    const auto& points = edges[0].points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(depth(points[i].x, points[i].y), 0, .25);
      twice_area += cross(points[i], points[(i + 1) % points.size()]);
    }
    EXPECT_EQ(twice_area > 0, bright) << "clockwise around bright discs, counter-clockwise around dark ones";
  }
}

TEST(SubPixelEdges, OfAStraightEdgeAreOneContour) {
  for (int angle_deg = 0; angle_deg < 360; angle_deg += 7) {
    SCOPED_TRACE(angle_deg);
    const Frame frame = drawn(PixelFormat::yuv422p, {.noise = 4}, StraightEdge{angle_deg * std::numbers::pi / 180, .3});
    const auto edges = sub_pixel_edges(frame.view, kInner);
    ASSERT_EQ(edges.size(), 1u);
    EXPECT_FALSE(edges[0].closed);
    EXPECT_GE(length(edges[0]), 42);
  }
}

TEST(SubPixelEdges, AreTheSameInAllPixelFormatsAndWithAllKernels) {
  const StraightEdge edge{.7, .2};
  const auto expected = sub_pixel_edges(drawn(PixelFormat::yuv422p, {.noise = 5}, edge).view, kAll);
  ASSERT_FALSE(expected.empty());
  for (const PixelFormat format :
       {PixelFormat::yuyv422, PixelFormat::uyvy422, PixelFormat::yuv422p, PixelFormat::yuv420p, PixelFormat::nv12}) {
    SCOPED_TRACE(to_string(format));
    const Frame frame = drawn(format, {.noise = 5}, edge);
    for (const GradientKernel& kernel : gradient_kernels()) {
      if (!is_supported(kernel.kernel)) continue;
      const auto edges = sub_pixel_edges_by(kernel, frame.view, kAll, {});
      ASSERT_EQ(edges.size(), expected.size());
      for (std::size_t i = 0; i < edges.size(); ++i) EXPECT_EQ(edges[i].points, expected[i].points);
    }
  }
}

bool same(const RecycledVector<EdgePoint>& a, const RecycledVector<EdgePoint>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const EdgePoint& p, const EdgePoint& q) {
    return p.x == q.x && p.y == q.y && p.slope_x == q.slope_x && p.slope_y == q.slope_y && p.squared == q.squared;
  });
}

/// Gradients and maxima pixel by pixel, from their definitions.
RecycledVector<EdgePoint> plain_points(const FrameView& frame, const Region& region, const EdgeOptions& options) {
  const int reach = options.filter_size_px / 2;
  std::vector<int> smooth{1};
  const auto longer = [](const std::vector<int>& mask, int last) {
    std::vector<int> product(mask.size() + 1);
    for (std::size_t i = 0; i < mask.size(); ++i) {
      product[i] += mask[i];
      product[i + 1] += last * mask[i];
    }
    return product;
  };
  for (int k = 0; k < 2 * reach - 2; ++k) smooth = longer(smooth, 1);
  const std::vector<int> slope = longer(longer(smooth, -1), 1);
  smooth = longer(longer(smooth, 1), 1);
  const auto filtered = [&](int c, int r, const std::vector<int>& across, const std::vector<int>& down) {
    int sum = 0;
    for (int i = -reach; i <= reach; ++i)
      for (int j = -reach; j <= reach; ++j)
        sum += down[std::size_t(i + reach)] * across[std::size_t(j + reach)] *
               frame.y(std::clamp(c + j, 0, frame.width() - 1), std::clamp(r + i, 0, frame.height() - 1));
    return -sum >> (reach == 3 ? 3 : 0);  // the mask begins with 1 on the left, where the derivative has -1
  };
  RecycledVector<EdgePoint> points;
  const double least = options.low * gradient_unit(reach);
  for (const PixelRun& run : region.runs())
    for (int c = run.begin; c < run.end; ++c) {
      const int r = run.row;
      if (c < 1 || r < 1 || c >= frame.width() - 1 || r >= frame.height() - 1) continue;
      const auto squared = [&](int column, int row) {
        const int x = filtered(column, row, slope, smooth), y = filtered(column, row, smooth, slope);
        return x * x + y * y;
      };
      const int x = filtered(c, r, slope, smooth), y = filtered(c, r, smooth, slope), here = x * x + y * y;
      const bool down = std::abs(y) > std::abs(x);
      const int before = down ? squared(c, r - 1) : squared(c - 1, r),
                after = down ? squared(c, r + 1) : squared(c + 1, r);
      if (here < least * least || here <= before || here < after) continue;
      const auto log2_of = [](int value) { return std::log2(std::max(value, 1)); };
      const double offset =
          (log2_of(after) - log2_of(before)) / (2 * (2 * log2_of(here) - log2_of(before) - log2_of(after)));
      points.push_back({static_cast<float>(c + (down ? 0 : offset)), static_cast<float>(r + (down ? offset : 0)),
                        static_cast<std::int16_t>(c), static_cast<std::int16_t>(r), static_cast<std::int16_t>(x),
                        static_cast<std::int16_t>(y), here});
    }
  return points;
}

TEST(EdgePoints, AreTheMaximaOfTheGradientInFramesOfAllWidths) {
  for (int width = 1; width <= 140; width += width < 72 ? 1 : 17) {
    const int height = 1 + width % 9;
    const PixelFormat format = width % 2 == 0 ? PixelFormat::yuyv422 : PixelFormat::yuv420p;
    const FrameBuffer buffer = make_frame_buffer(format, width, height, ColorRange::full);
    const FrameView& view = buffer.frame.view;
    std::mt19937 random(static_cast<unsigned>(width));
    for (int r = 0; r < height; ++r)
      for (int c = 0; c < width; ++c) {
        const YuvRow row = view.row(r);
        // Black and white alone drive the sums to their limits.
        const auto value = static_cast<std::uint8_t>(width % 3 == 0 ? 255 * (random() % 2) : random());
        buffer.planes[0][row.y + c * row.y_step - buffer.planes[0]] = value;
      }
    const Region all = Region::from_box({-3, -3, width + 3, height + 3});
    for (const int size : {3, 5, 7}) {
      SCOPED_TRACE(std::to_string(width) + ", filter " + std::to_string(size));
      const EdgeOptions options{.filter_size_px = size};
      const auto plain = edge_points(gradient_kernels()[0], view, all, options),
                 expected = plain_points(view, all, options);
      ASSERT_EQ(plain.size(), expected.size());
      for (std::size_t i = 0; i < plain.size(); ++i) {
        EXPECT_EQ(plain[i].slope_x, expected[i].slope_x);
        EXPECT_EQ(plain[i].slope_y, expected[i].slope_y);
        EXPECT_EQ(plain[i].squared, expected[i].squared);
        EXPECT_NEAR(plain[i].x, expected[i].x, 1e-3);
        EXPECT_NEAR(plain[i].y, expected[i].y, 1e-3);
      }
      for (const GradientKernel& kernel : gradient_kernels())
        if (is_supported(kernel.kernel)) {
          EXPECT_TRUE(same(edge_points(kernel, view, all, options), plain)) << to_string(kernel.kernel);
        }
    }
  }
}

TEST(EdgePoints, OfARegionAreThoseOfTheFrameWithinIt) {
  const Frame frame = drawn(PixelFormat::yuyv422, {.noise = 20}, StraightEdge{.4, 0});
  const EdgeOptions options{.low = 1, .high = 1};
  const GradientKernel& kernel = gradient_kernels().front();
  const auto all = edge_points(kernel, frame.view, kAll, options);
  std::mt19937 random(5);
  for (int k = 0; k < 40; ++k) {
    RunVector runs;
    for (int i = 0; i < 1 + k; ++i) {
      const auto row = static_cast<std::int16_t>(random() % 80), begin = static_cast<std::int16_t>(random() % 90 - 10);
      runs.push_back({static_cast<std::int16_t>(row - 8), begin, static_cast<std::int16_t>(begin + random() % 40)});
    }
    const Region region = Region::from_runs(std::move(runs));
    RecycledVector<EdgePoint> within = all;
    std::erase_if(within, [&](const EdgePoint& point) { return !contains(region, point.column, point.row); });
    EXPECT_TRUE(same(edge_points(kernel, frame.view, region, options), within));
  }
}

// A ramp of 31 gray levels a pixel: gradients so nearly equal that their logarithms are.
TEST(SubPixelEdges, OnARampAreFiniteAndWithinTheirPixel) {
  std::mt19937 random(3);
  std::size_t found = 0;
  for (int trial = 0; trial < 200; ++trial) {
    FrameBuffer buffer = make_frame_buffer(PixelFormat::yuv422p, kSize, kSize, ColorRange::full);
    for (int r = 0; r < kSize; ++r)
      for (int c = 0; c < kSize; ++c)
        buffer.planes[0][r * buffer.strides[0] + c] =
            static_cast<std::uint8_t>(std::clamp(31 * (c - 28) + static_cast<int>(random() % 60 == 0), 0, 255));
    for (const int size : {3, 5, 7})
      for (const EdgePoint& point :
           edge_points(gradient_kernels()[0], buffer.frame.view, kAll, {.filter_size_px = size, .min_points = 1})) {
        ++found;
        ASSERT_LE(std::abs(point.x - static_cast<float>(point.column)), .5F);
        ASSERT_LE(std::abs(point.y - static_cast<float>(point.row)), .5F);
      }
  }
  EXPECT_GT(found, 1000u);
}

TEST(SubPixelEdges, NeedSomewhereTheHighThreshold) {
  const Frame frame = drawn(PixelFormat::nv12, {.contrast = 30}, StraightEdge{0, 0});  // about 11 gray levels / px
  EXPECT_EQ(sub_pixel_edges(frame.view, kAll, {.low = 3, .high = 8}).size(), 1u);
  EXPECT_TRUE(sub_pixel_edges(frame.view, kAll, {.low = 3, .high = 16}).empty());
  EXPECT_TRUE(sub_pixel_edges(frame.view, kAll, {.min_points = 100}).empty());
  EXPECT_TRUE(sub_pixel_edges(frame.view, kAll, {.low = 1e30, .high = 1e30}).empty());
}

TEST(SubPixelEdges, OfNothingAreNone) {
  const Frame frame = drawn(PixelFormat::nv12, {}, StraightEdge{0, 0});
  EXPECT_TRUE(sub_pixel_edges(frame.view, {}).empty());
  EXPECT_TRUE(sub_pixel_edges(frame.view, Region::from_box({200, 0, 300, 10})).empty());
  EXPECT_TRUE(sub_pixel_edges(FrameView{}, kAll).empty());
}

TEST(EdgeOptions, NameWhatIsOutOfRange) {
  for (const EdgeOptions& options : {EdgeOptions{.filter_size_px = 4}, EdgeOptions{.low = 0}, EdgeOptions{.low = 9},
                                     EdgeOptions{.min_points = 0}, EdgeOptions{.high = std::nan("")}})
    EXPECT_THROW(options.check(), Error);
  EXPECT_NO_THROW(EdgeOptions{}.check());
}

}  // namespace
}  // namespace tassilo
