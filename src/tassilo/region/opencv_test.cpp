// Agreement with OpenCV; built only where OpenCV is installed.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "tassilo/region/algebra.h"
#include "tassilo/region/features.h"
#include "tassilo/region/internal/test_opencv.h"
#include "tassilo/region/internal/test_regions.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

TEST(OpenCv, SameComponentsWithAreaCenterAndBox) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [region, box] = random_case(seed);
    for (const auto& [connectivity, number] : {std::pair{Connectivity::four, 4}, std::pair{Connectivity::eight, 8}}) {
      cv::Mat labels, stats, centers;
      const int count = cv::connectedComponentsWithStats(mat_of(region, box), labels, stats, centers, number, CV_32S);
      const RecycledVector<Region> parts = components(region, connectivity);
      ASSERT_EQ(std::ssize(parts), count - 1);
      for (const Region& part : parts) {
        const PixelRun first = part.runs().front();
        const int label = labels.at<int>(first.row - box.y0, first.begin - box.x0);
        const ShapeFeatures features = shape_features(part);
        EXPECT_EQ(features.area, stats.at<int>(label, cv::CC_STAT_AREA));
        EXPECT_EQ(features.box.x0 - box.x0, stats.at<int>(label, cv::CC_STAT_LEFT));
        EXPECT_EQ(features.box.y0 - box.y0, stats.at<int>(label, cv::CC_STAT_TOP));
        EXPECT_EQ(features.box.width(), stats.at<int>(label, cv::CC_STAT_WIDTH));
        EXPECT_EQ(features.box.height(), stats.at<int>(label, cv::CC_STAT_HEIGHT));
        EXPECT_NEAR(features.center.x - box.x0, centers.at<double>(label, 0), 1e-9);
        EXPECT_NEAR(features.center.y - box.y0, centers.at<double>(label, 1), 1e-9);
        EXPECT_EQ(part, region_of(labels == label, box));
      }
    }
  }
}

TEST(OpenCv, SameMorphologyWithBackgroundOutside) {
  const Region odd = Region::from_runs({{-1, -2, 0}, {-1, 1, 2}, {0, 0, 1}, {2, -1, 3}});
  const PixelBox kernel_box{-7, -7, 8, 8};
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [region, box] = random_case(seed);
    const PixelBox window = wider(box, 8);
    for (const Region& element : {rectangle(3, 3), rectangle(4, 2), disc(3.5), disc(7), odd}) {
      const cv::Point middle(-1, -1);
      cv::Mat dilated, eroded;
      cv::dilate(mat_of(region, window), dilated, mat_of(reflected(element), kernel_box), middle, 1,
                 cv::BORDER_CONSTANT, cv::Scalar(0));
      // Without a margin: the border rule itself is compared.
      cv::erode(mat_of(region, box), eroded, mat_of(element, kernel_box), middle, 1, cv::BORDER_CONSTANT,
                cv::Scalar(0));
      EXPECT_EQ(dilation(region, element), region_of(dilated, window));
      EXPECT_EQ(clipped(erosion(region, element), box), region_of(eroded, box));
    }
  }
}

TEST(OpenCv, RectangleHasTheSameOriginAsItsKernels) {
  const PixelBox box{0, 0, 30, 20};
  const Region region = random_region(4, {box, .9, 0});
  for (int width = 1; width < 6; ++width)
    for (int height = 1; height < 6; ++height) {
      cv::Mat eroded;
      cv::erode(mat_of(region, box), eroded, cv::getStructuringElement(cv::MORPH_RECT, {width, height}), {-1, -1}, 1,
                cv::BORDER_CONSTANT, cv::Scalar(0));
      EXPECT_EQ(clipped(erosion(region, rectangle(width, height)), box), region_of(eroded, box));
    }
}

TEST(OpenCv, SameMomentsContourLengthAndHull) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [region, box] = random_case(seed);
    if (region.empty()) continue;
    const ShapeFeatures features = shape_features(region);
    const cv::Moments moments = cv::moments(mat_of(region, box), true);
    EXPECT_NEAR(features.moments.cc, moments.mu20 / moments.m00, 1e-6);
    EXPECT_NEAR(features.moments.rc, moments.mu11 / moments.m00, 1e-6);
    EXPECT_NEAR(features.moments.rr, moments.mu02 / moments.m00, 1e-6);

    std::vector<std::vector<cv::Point>> contours;
    std::vector<cv::Vec4i> hierarchy;
    const PixelBox window = wider(box, 1);
    cv::findContours(mat_of(region, window), contours, hierarchy, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
    double length = 0;
    int holes = 0;
    std::vector<cv::Point> all;
    for (std::size_t k = 0; k < contours.size(); ++k) {
      const bool is_hole = hierarchy[k][3] >= 0;
      holes += is_hole;
      if (!is_hole) length += cv::arcLength(contours[k], true);
      all.insert(all.end(), contours[k].begin(), contours[k].end());
    }
    EXPECT_NEAR(contour_length(region), length, 1e-4 * (1 + length));
    EXPECT_EQ(hole_count(region), holes);

    std::vector<cv::Point> hull;
    cv::convexHull(all, hull);
    const RecycledVector<PixelPoint> ours = convex_hull(region);
    ASSERT_EQ(ours.size(), hull.size());
    double twice_area = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) twice_area += cross(ours[i], ours[(i + 1) % ours.size()]);
    EXPECT_NEAR(twice_area / 2, cv::contourArea(hull), 1e-6);
    for (const PixelPoint& p : ours)
      EXPECT_TRUE(
          std::ranges::count(hull, cv::Point(static_cast<int>(p.x) - window.x0, static_cast<int>(p.y) - window.y0)));
  }
}

}  // namespace
}  // namespace tassilo
