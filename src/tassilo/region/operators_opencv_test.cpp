// Agreement of the further operators with OpenCV; built only where OpenCV is installed.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <set>
#include <vector>

#include "tassilo/region/algebra.h"
#include "tassilo/region/distance.h"
#include "tassilo/region/elements.h"
#include "tassilo/region/enclosing.h"
#include "tassilo/region/gray.h"
#include "tassilo/region/hit_or_miss.h"
#include "tassilo/region/internal/test_opencv.h"
#include "tassilo/region/internal/test_regions.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/outline.h"
#include "tassilo/region/residue.h"
#include "tassilo/region/transform.h"

namespace tassilo {
namespace {

TEST(OpenCv, SameMirrorAndZoom) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    const auto [moved, where] = random_case(seed);
    const Region region = translated(moved, {-where.x0, -where.y0});
    const PixelBox box{0, 0, where.width(), where.height()};
    cv::Mat flipped;
    cv::flip(mat_of(region, box), flipped, 1);
    EXPECT_EQ(mirrored_left_right(region, (box.width() - 1) / 2.), region_of(flipped, box));
    cv::flip(mat_of(region, box), flipped, 0);
    EXPECT_EQ(mirrored_top_bottom(region, (box.height() - 1) / 2.), region_of(flipped, box));
    for (const auto& [width, height] : {std::pair{17, 40}, {box.width(), 3}, {90, 9}}) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", to " << width << " x " << height);
      cv::Mat resized;
      cv::resize(mat_of(region, box), resized, {width, height}, 0, 0, cv::INTER_NEAREST_EXACT);
      // Where a centre falls on an edge between pixels, rounding decides; such sizes are left out.
      const auto has_tie = [](int to, int from) {
        for (int k = 0; k < to; ++k)
          if (2 * (2 * k + 1) * from % (4 * to) == 0) return true;
        return false;
      };
      if (has_tie(width, box.width()) || has_tie(height, box.height())) continue;
      const Region ours = zoomed(region, {double(width) / box.width(), double(height) / box.height()});
      EXPECT_EQ(ours, region_of(resized, box));
    }
  }
}

TEST(OpenCv, SameHitOrMissAndHats) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [region, box] = random_case(seed);
    const PixelBox window = wider(box, 8);
    const Region hit = Region::from_runs({{0, 0, 2}, {1, 0, 1}}), miss = Region::from_runs({{-1, -1, 1}, {0, -1, 0}});
    cv::Mat kernel = cv::Mat::zeros(3, 3, CV_32S);
    for (const PixelRun& run : hit.runs())
      for (int c = run.begin; c < run.end; ++c) kernel.at<int>(run.row + 1, c + 1) = 1;
    for (const PixelRun& run : miss.runs())
      for (int c = run.begin; c < run.end; ++c) kernel.at<int>(run.row + 1, c + 1) = -1;
    cv::Mat found;
    cv::morphologyEx(mat_of(region, window), found, cv::MORPH_HITMISS, kernel);
    EXPECT_EQ(hit_or_miss(region, hit, miss), region_of(found, window));

    const Region element = octagon(2);
    const cv::Mat octagon_kernel = mat_of(element, {-2, -2, 3, 3});
    cv::morphologyEx(mat_of(region, window), found, cv::MORPH_TOPHAT, octagon_kernel);
    EXPECT_EQ(top_hat(region, element), region_of(found, window));
    cv::morphologyEx(mat_of(region, window), found, cv::MORPH_BLACKHAT, octagon_kernel);
    EXPECT_EQ(bottom_hat(region, element), region_of(found, window));
  }
}

TEST(OpenCv, SameDistances) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [region, box] = random_case(seed);
    const PixelBox window = wider(box, 1);
    const std::pair<DistanceMetric, int> metrics[] = {{DistanceMetric::euclidean_squared, cv::DIST_L2},
                                                      {DistanceMetric::chessboard, cv::DIST_C},
                                                      {DistanceMetric::city_block, cv::DIST_L1}};
    for (const auto& [metric, type] : metrics) {
      cv::Mat theirs;
      cv::distanceTransform(mat_of(region, window), theirs, type,
                            type == cv::DIST_L2 ? cv::DIST_MASK_PRECISE : cv::DIST_MASK_3, CV_32F);
      const DistanceImage ours = distance_inside(region, window, metric);
      for (int r = 0; r < window.height(); ++r)
        for (int c = 0; c < window.width(); ++c) {
          const double value = ours.at(c + window.x0, r + window.y0);
          ASSERT_NEAR(metric == DistanceMetric::euclidean_squared ? std::sqrt(value) : value, theirs.at<float>(r, c),
                      1e-3);
        }
    }
  }
}

TEST(OpenCv, SameRectangleAndCircleAround) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [region, box] = random_case(seed);
    if (region.empty()) continue;
    std::vector<cv::Point> points;
    cv::findNonZero(mat_of(region, box), points);
    const cv::RotatedRect theirs = cv::minAreaRect(points);
    const RotatedRectangle ours = smallest_rectangle(region);
    EXPECT_NEAR(4 * ours.half_length * ours.half_width, theirs.size.area(), 1e-2 * (1 + theirs.size.area()));
    cv::Point2f center;
    float radius = 0;
    cv::minEnclosingCircle(points, center, radius);
    const Circle circle = smallest_circle(region);
    EXPECT_NEAR(circle.radius, radius, .01);  // OpenCV adds 1e-4
    EXPECT_NEAR(circle.center.x - box.x0, center.x, .05);
    EXPECT_NEAR(circle.center.y - box.y0, center.y, .05);
  }
}

TEST(OpenCv, SameCenterOutlines) {
  using Corners = std::multiset<std::pair<int, int>>;
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [region, box] = random_case(seed);
    const PixelBox window = wider(box, 1);
    std::vector<std::vector<cv::Point>> contours;
    std::vector<cv::Vec4i> hierarchy;
    cv::findContours(mat_of(region, window), contours, hierarchy, cv::RETR_CCOMP, cv::CHAIN_APPROX_SIMPLE);
    std::multiset<std::pair<bool, Corners>> theirs, ours;
    for (std::size_t k = 0; k < contours.size(); ++k) {
      Corners corners;
      for (const cv::Point& p : contours[k]) corners.insert({p.x + window.x0, p.y + window.y0});
      theirs.insert({hierarchy[k][3] >= 0, corners});
    }
    for (const Outline& outline : center_outlines(region)) {
      Corners corners;
      for (const PixelPoint& p : outline.corners) corners.insert({static_cast<int>(p.x), static_cast<int>(p.y)});
      ours.insert({outline.is_hole, corners});
    }
    EXPECT_EQ(ours, theirs);
  }
}

TEST(OpenCv, SameGrayFeatures) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [moved, where] = random_case(seed);
    const Region region = translated(moved, {-where.x0, -where.y0});
    const PixelBox box{0, 0, where.width(), where.height()};
    if (region.empty()) continue;
    cv::Mat image(box.height(), box.width(), CV_8U);
    cv::RNG(seed).fill(image, cv::RNG::UNIFORM, 0, 256);
    const cv::Mat mask = mat_of(region, box);
    const GrayFeatures features =
        gray_features(region, ByteView{image.data, image.cols, image.rows, static_cast<std::ptrdiff_t>(image.step[0])});
    cv::Scalar mean, deviation;
    cv::meanStdDev(image, mean, deviation, mask);
    EXPECT_NEAR(features.mean, mean[0], 1e-9);
    EXPECT_NEAR(features.deviation, deviation[0], 1e-6);
    double least = 0, most = 0;
    cv::minMaxLoc(image, &least, &most, nullptr, nullptr, mask);
    EXPECT_EQ(features.min, least);
    EXPECT_EQ(features.max, most);
  }
}

}  // namespace
}  // namespace tassilo
