// OpenCV's projections as a second opinion on the models both know.
#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>
#include <random>
#include <vector>

#include "tassilo/camera/camera_model.h"

namespace tassilo {
namespace {

const CameraModel kCamera{"", 640, 480, 392.0, 390.5, 316.8, 246.2, PlumbBob{}};
const cv::Matx33d kMatrix(392.0, 0, 316.8, 0, 390.5, 246.2, 0, 0, 1);

std::vector<cv::Point3d> points_in_front(int seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  std::uniform_real_distribution<double> across(-.7, .7), ahead(.4, 6);
  std::vector<cv::Point3d> out;
  for (int i = 0; i < 300; ++i) {
    const double z = ahead(random);
    out.emplace_back(across(random) * z, across(random) * z, z);
  }
  return out;
}

/// Compares project and unproject with OpenCV's pixels for the same points.
void expect_same(const Distortion& distortion, const std::vector<cv::Point3d>& points,
                 const std::vector<cv::Point2d>& pixels) {
  CameraModel camera = kCamera;
  camera.distortion = distortion;
  ASSERT_EQ(points.size(), pixels.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const OpticalPoint point{points[i].x, points[i].y, points[i].z};
    const PixelPoint expected{pixels[i].x, pixels[i].y};
    const auto pixel = project(camera, point);
    ASSERT_TRUE(pixel);
    EXPECT_LT(distance(*pixel, expected), 1e-9);
    const auto ray = unproject(camera, expected);
    ASSERT_TRUE(ray);
    EXPECT_LT(norm(*ray - normalized(point)), 1e-11);
  }
}

TEST(OpenCv, ProjectsLikePlumbBob) {
  const auto points = points_in_front(1);
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), kMatrix, std::vector<double>{-.262, .078, .0006, -.0009, -.008},
                    pixels);
  expect_same(PlumbBob{-.262, .078, .0006, -.0009, -.008}, points, pixels);
}

TEST(OpenCv, ProjectsLikeRationalPolynomial) {
  const auto points = points_in_front(2);
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), kMatrix,
                    std::vector<double>{4.1, 1.9, .0002, -.0003, .07, 4.45, 3.2, .45}, pixels);
  expect_same(RationalPolynomial{4.1, 1.9, .0002, -.0003, .07, 4.45, 3.2, .45}, points, pixels);
}

TEST(OpenCv, ProjectsLikeEquidistant) {
  const auto points = points_in_front(3);
  std::vector<cv::Point2d> pixels;
  cv::fisheye::projectPoints(points, pixels, cv::Vec3d(), cv::Vec3d(), kMatrix, cv::Vec4d(-.012, .004, -.0011, .0001));
  expect_same(Equidistant{-.012, .004, -.0011, .0001}, points, pixels);
}

TEST(OpenCv, UndistortsLikePlumbBob) {
  CameraModel camera = kCamera;
  camera.distortion = PlumbBob{-.262, .078, .0006, -.0009, -.008};
  std::vector<cv::Point2d> pixels, straight;
  for (int column = 0; column <= 640; column += 40)
    for (int row = 0; row <= 480; row += 40) pixels.emplace_back(column, row);
  cv::undistortPoints(pixels, straight, kMatrix, std::vector<double>{-.262, .078, .0006, -.0009, -.008}, cv::noArray(),
                      cv::noArray(), cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 500, 1e-13));
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto ray = unproject(camera, {pixels[i].x, pixels[i].y});
    ASSERT_TRUE(ray);
    EXPECT_NEAR(ray->x / ray->z, straight[i].x, 1e-9);
    EXPECT_NEAR(ray->y / ray->z, straight[i].y, 1e-9);
  }
}

}  // namespace
}  // namespace tassilo
