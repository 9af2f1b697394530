#include "tassilo/region/gray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tassilo/region/algebra.h"
#include "tassilo/region/internal/test_regions.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

/// Noise, or few values; a stride wider than the image.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> bytes;

  explicit Picture(unsigned seed)
      : width(1 + static_cast<int>(seed * 7 % 40)), height(1 + static_cast<int>(seed % 13)) {
    std::mt19937 random(seed);
    bytes.resize(static_cast<std::size_t>(stride() * height));
    for (std::uint8_t& byte : bytes)
      byte = static_cast<std::uint8_t>(seed % 3 == 0 ? random() % 256 : 10 + random() % (1 + seed % 4));
  }
  int stride() const { return width + 3; }
  ByteView view() const { return {bytes.data(), width, height, stride()}; }
  std::uint8_t at(int c, int r) const { return bytes[static_cast<std::size_t>(r * stride() + c)]; }
};

TEST(Gray, FeaturesEqualThoseOfTheListOfValues) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Picture picture(seed);
    const Region region = translated(random_case(seed).region, {20, 3});  // partly outside
    std::vector<int> values;
    double volume = 0;
    PixelPoint center;
    for (int r = 0; r < picture.height; ++r)
      for (int c = 0; c < picture.width; ++c)
        if (contains(region, c, r)) {
          values.push_back(picture.at(c, r));
          volume += picture.at(c, r);
          center = center + double(picture.at(c, r)) * PixelPoint{double(c), double(r)};
        }
    std::ranges::sort(values);
    const GrayFeatures features = gray_features(region, picture.view());
    const GrayHistogram histogram = gray_histogram(region, picture.view());
    const GrayMoments moments = gray_moments(region, picture.view());
    ASSERT_EQ(features.count, std::ssize(values));
    EXPECT_EQ(moments.volume, volume);
    if (values.empty()) {
      EXPECT_EQ(features.mean, 0);
      EXPECT_EQ(features.entropy, 0);
      EXPECT_EQ(gray_quantile(histogram, .5), 0);
      continue;
    }
    const double n = static_cast<double>(values.size());
    double mean = 0, variance = 0, entropy = 0;
    for (const int v : values) mean += v / n;
    for (const int v : values) variance += (v - mean) * (v - mean) / n;
    for (int v = 0; v < 256; ++v) {
      const auto count = std::ranges::count(values, v);
      EXPECT_EQ(histogram.count[static_cast<std::size_t>(v)], count);
      const double share = static_cast<double>(count) / n;
      if (count > 0) entropy -= share * std::log2(share);
    }
    EXPECT_NEAR(features.mean, mean, 1e-9);
    EXPECT_NEAR(features.deviation, std::sqrt(variance), 1e-6);
    EXPECT_NEAR(features.entropy, entropy, 1e-9);
    EXPECT_EQ(features.min, values.front());
    EXPECT_EQ(features.max, values.back());
    EXPECT_EQ(features.median, values[(values.size() - 1) / 2]);
    for (const double share : {0., .1, .25, .5, .9, 1.}) {
      const int quantile = gray_quantile(histogram, share);
      const auto up_to = std::ranges::count_if(values, [&](int v) { return v <= quantile; });
      const auto below = std::ranges::count_if(values, [&](int v) { return v < quantile; });
      EXPECT_GE(static_cast<double>(up_to), share * n);
      EXPECT_TRUE(below == 0 || static_cast<double>(below) < share * n);
    }
    if (volume == 0) continue;
    center = (1 / volume) * center;
    double rr = 0, rc = 0, cc = 0;
    for (int r = 0; r < picture.height; ++r)
      for (int c = 0; c < picture.width; ++c)
        if (contains(region, c, r)) {
          const double w = picture.at(c, r) / volume;
          rr += w * (r - center.y) * (r - center.y);
          rc += w * (r - center.y) * (c - center.x);
          cc += w * (c - center.x) * (c - center.x);
        }
    EXPECT_NEAR(moments.center.x, center.x, 1e-9);
    EXPECT_NEAR(moments.center.y, center.y, 1e-9);
    EXPECT_NEAR(moments.moments.rr, rr, 1e-9);
    EXPECT_NEAR(moments.moments.rc, rc, 1e-9);
    EXPECT_NEAR(moments.moments.cc, cc, 1e-9);
  }
}

TEST(Gray, EqualWeightsGiveTheRegionsOwnMoments) {
  const std::vector<std::uint8_t> bytes(100 * 60, 7);
  const ByteView view{bytes.data(), 100, 60, 100};
  const Region region = translated(disc(12.5), {70, 20});
  const ShapeFeatures shape = shape_features(region);
  const GrayMoments gray = gray_moments(region, view);
  EXPECT_EQ(gray.volume, 7. * static_cast<double>(shape.area));
  EXPECT_NEAR(gray.center.x, shape.center.x, 1e-9);
  EXPECT_NEAR(gray.moments.rr, shape.moments.rr, 1e-9);
  EXPECT_NEAR(gray.ellipse.ra, shape.ellipse.ra, 1e-9);
  EXPECT_EQ(gray_features(region, view).deviation, 0);
  EXPECT_EQ(gray_features(region, view).entropy, 0);
}

TEST(Gray, ReadsTheBrightnessOfEveryFrameFormat) {
  for (const PixelFormat format :
       {PixelFormat::yuyv422, PixelFormat::uyvy422, PixelFormat::yuv422p, PixelFormat::yuv420p, PixelFormat::nv12})
    for (const int height : {1, 5}) {
      SCOPED_TRACE(std::string(to_string(format)));
      const FrameBuffer buffer = make_frame_buffer(format, 9, height, ColorRange::full);
      const FrameView& view = buffer.frame.view;
      std::vector<std::uint8_t> expected(static_cast<std::size_t>(9 * height));
      for (int r = 0; r < height; ++r)
        for (int c = 0; c < 9; ++c) {
          const YuvRow row = view.row(r);
          const auto value = static_cast<std::uint8_t>(20 * r + c);
          buffer.planes[0][(row.y - buffer.planes[0]) + c * row.y_step] = value;
          expected[static_cast<std::size_t>(9 * r + c)] = value;
        }
      const Region all = Region::from_box({-3, -3, 40, 40});
      EXPECT_EQ(gray_histogram(all, view).count, gray_histogram(all, ByteView{expected.data(), 9, height, 9}).count);
    }
  EXPECT_EQ(gray_features(rectangle(3, 3), FrameView{}).count, 0);
  EXPECT_DEATH(gray_quantile({}, 1.5), "0 to 1");
}

}  // namespace
}  // namespace tassilo
