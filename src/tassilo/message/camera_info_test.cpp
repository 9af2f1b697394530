#include "tassilo/message/camera_info.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

using testing::HasSubstr;

ros::CameraInfo good_info() {
  ros::CameraInfo info;
  info.width = 640;
  info.height = 480;
  info.distortion_model = "plumb_bob";
  info.d = {-0.2, 0.05, 0.001, -0.002, 0};
  info.k = {500, 0, 321, 0, 505, 238, 0, 0, 1};
  info.p = {450, 0, 318, 0, 0, 460, 241, 0, 0, 0, 1, 0};
  return info;
}

CameraModel model_of(const ros::CameraInfo& info, bool is_rectified = false) {
  return lens_from(info, is_rectified).model.value();
}

std::string refusal_of(const ros::CameraInfo& info) {
  try {
    lens_from(info, false);
  } catch (const Error& refusal) {
    return refusal.what();
  }
  return "";
}

TEST(CameraInfo, TopicIsTheSiblingOfTheImages) {
  EXPECT_EQ(camera_info_topic_of("/camera/image_raw"), "/camera/camera_info");
  EXPECT_EQ(camera_info_topic_of("/camera/image_raw/compressed"), "/camera/camera_info");
  EXPECT_EQ(camera_info_topic_of("/image"), "/camera_info");
  EXPECT_EQ(camera_info_topic_of("/image/compressed"), "/camera_info");
  EXPECT_EQ(camera_info_topic_of("/robot3/front/image_rect"), "/robot3/front/camera_info");
  EXPECT_TRUE(is_rectified_topic("/camera/image_rect"));
  EXPECT_TRUE(is_rectified_topic("/camera/image_rect_color/compressed"));
  EXPECT_FALSE(is_rectified_topic("/image_rect/image_raw"));
}

TEST(CameraInfo, GivesTheLens) {
  const ros::CameraInfo info = good_info();
  const CameraModel lens = model_of(info);
  EXPECT_EQ(lens.width, 640);
  EXPECT_EQ(lens.height, 480);
  EXPECT_EQ(lens.fx, 500);
  EXPECT_EQ(lens.fy, 505);
  EXPECT_EQ(lens.cx, 321);
  EXPECT_EQ(lens.cy, 238);
  EXPECT_EQ(lens.distortion, Distortion(PlumbBob{-0.2, 0.05, 0.001, -0.002, 0}));

  ros::CameraInfo other = info;
  other.distortion_model = "rational_polynomial";
  other.d = {.1, .2, .3, .4, .5, .6, .7, .8, 0, 0, 0, 0};
  EXPECT_EQ(model_of(other).distortion, Distortion(RationalPolynomial{.1, .2, .3, .4, .5, .6, .7, .8}));
  other.distortion_model = "equidistant";
  other.d = {.1, .2, .3, .4};
  EXPECT_EQ(model_of(other).distortion, Distortion(Equidistant{.1, .2, .3, .4}));
  other.distortion_model = "";
  other.d = {};
  EXPECT_EQ(model_of(other).distortion, Distortion(PlumbBob{}));
}

TEST(CameraInfo, OfRectifiedImagesIsTheProjection) {
  const CameraModel lens = model_of(good_info(), true);
  EXPECT_EQ(lens.fx, 450);
  EXPECT_EQ(lens.fy, 460);
  EXPECT_EQ(lens.cx, 318);
  EXPECT_EQ(lens.cy, 241);
  EXPECT_EQ(lens.distortion, Distortion(PlumbBob{}));
}

TEST(CameraInfo, OfAPartOfTheImageIsOfThatPart) {
  ros::CameraInfo info = good_info();
  info.binning_x = info.binning_y = 2;
  info.roi = {100, 40, 400, 480, false};
  info.roi.height = 400;
  info.roi.width = 480;
  const ToldLens lens = lens_from(info, false);
  EXPECT_EQ(lens.width, 240);
  EXPECT_EQ(lens.height, 200);
  EXPECT_EQ(lens.model->fx, 250);
  EXPECT_EQ(lens.model->cx, (321. - 100) / 2);
  EXPECT_EQ(lens.model->cy, (238. - 40) / 2);
  info.roi.x_offset = 200;
  EXPECT_THAT(refusal_of(info), HasSubstr("do not belong together"));
}

TEST(CameraInfo, OfAnUncalibratedCameraHasASizeOnly) {
  ros::CameraInfo info;
  info.width = 640;
  info.height = 480;
  const ToldLens lens = lens_from(info, false);
  EXPECT_EQ(lens.width, 640);
  EXPECT_FALSE(lens.model);
}

TEST(CameraInfo, ThatDescribesNoCameraIsRefused) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  ros::CameraInfo bad = good_info();
  bad.width = 0;
  EXPECT_THAT(refusal_of(bad), HasSubstr("do not belong together"));
  bad = good_info();
  bad.binning_x = 641;
  EXPECT_THAT(refusal_of(bad), HasSubstr("do not belong together"));
  for (const double value : {nan, -500., 0., std::numeric_limits<double>::infinity()}) {
    bad = good_info();
    bad.k[0] = value;
    EXPECT_THAT(refusal_of(bad), HasSubstr("describe no camera"));
  }
  bad = good_info();
  bad.d[1] = nan;
  EXPECT_THAT(refusal_of(bad), HasSubstr("describe no camera"));
  bad = good_info();
  bad.d.push_back(.1);
  EXPECT_THAT(refusal_of(bad), HasSubstr("has 6 coefficients of distortion, must have at most 5 that are not 0"));
  bad = good_info();
  bad.distortion_model = "mirror\n";
  EXPECT_THAT(refusal_of(bad), HasSubstr("has distortion model \"mirror?\", must be plumb_bob"));
}

TEST(LensDifference, IsNoneFromALensToItself) {
  EXPECT_LT(difference(model_of(good_info()), model_of(good_info())).px, 1e-6);
}

TEST(LensDifference, IsTheShiftOfThePrincipalPoint) {
  const CameraModel one = model_of(good_info());
  for (const double shift : {-3., 0.3, 2.}) {
    CameraModel other = one;
    other.cx += shift;
    EXPECT_NEAR(difference(one, other).px, std::abs(shift), 1e-6);
  }
}

TEST(LensDifference, OfTheFocalLengthIsLargestAtACorner) {
  ros::CameraInfo info = good_info();
  info.d = {};
  const CameraModel one = model_of(info);
  CameraModel other = one;
  other.fx *= 1.01;
  other.fy *= 1.01;
  const LensDifference most = difference(one, other);
  EXPECT_NEAR(most.px, 0.01 * std::hypot(321., 241.), 1e-6);
  EXPECT_EQ(most.at.x, 0);
  EXPECT_EQ(most.at.y, 479);
}

TEST(LensDifference, DoesNotDependOnTheModel) {
  // A division lens as a rational polynomial: the sixth convergent of its closed form.
  CameraModel division = model_of(good_info());
  const double k = -0.1458;
  division.distortion = Division{k};
  CameraModel rational = division;
  rational.distortion = RationalPolynomial{-5 * k, 6 * k * k, 0, 0, -k * k * k, -6 * k, 10 * k * k, -4 * k * k * k};
  EXPECT_LT(difference(division, rational).px, 1e-3);
  EXPECT_LT(difference(rational, division).px, 1e-3);
}

TEST(LensDifference, IsInfiniteWhereTheOtherCannotShowIt) {
  CameraModel wide = model_of(good_info());
  wide.distortion = Equidistant{};
  wide.fx = wide.fy = 100;
  CameraModel narrow = wide;
  narrow.distortion = PlumbBob{};
  EXPECT_TRUE(std::isinf(difference(wide, narrow).px));
}

TEST(LensDifference, OfAnyNumbersEnds) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-300, 300);
  const CameraModel one = model_of(good_info());
  for (int seed = 0; seed < 300; ++seed) {
    ros::CameraInfo info = good_info();
    for (double& value : info.d) value = (random() % 2 == 0 ? 1 : -1) * std::pow(10, exponent(random));
    info.k[2] = std::pow(10, exponent(random));
    EXPECT_GE(difference(one, model_of(info)).px, 0);
  }
}

}  // namespace
}  // namespace tassilo
