#include "tassilo/source/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <random>

#include "tassilo/base/error.h"
#include "tassilo/source/internal/camera_list.h"
#include "tassilo/source/internal/live_camera.h"
#include "tassilo/source/test_camera.h"

namespace tassilo {
namespace {

using testing::HasSubstr;
using Kind = CameraStep::Kind;

CameraOptions small() {
  CameraOptions options;
  options.width = 32;
  options.height = 24;
  options.fps = 20;
  return options;
}

/// What opening throws; "": nothing.
std::string refusal(FakeCamera& fake, const CameraOptions& options = small()) {
  try {
    const LiveCamera camera(fake, fake.path, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string description(FakeCamera& fake, const CameraOptions& options = small()) {
  return LiveCamera(fake, fake.path, options).description();
}

TEST(CameraFormat, AnswersAreTakenAndTold) {
  FakeCamera fake;
  CameraOptions options = small();
  EXPECT_THAT(description(fake, options), HasSubstr("Fake Cam, yuyv 32x24 px, limited range, 20 frames/s;"));
  options.width = 40;
  options.fps = 60;
  EXPECT_THAT(description(fake, options), HasSubstr("20 frames/s (asked for 40x24) (asked for 60)"));
  EXPECT_EQ(fake.mapped, fake.unmapped);
  EXPECT_EQ(fake.opened, fake.closed);
  EXPECT_EQ(fake.faults, 0);
}

TEST(CameraFormat, SizeCountsFirstThenRateThenTheLayout) {
  FakeCamera fake;
  fake.formats = {{V4L2_PIX_FMT_MJPEG, {{32, 24}, {64, 48}}, 20},
                  {V4L2_PIX_FMT_NV12, {{32, 24}, {64, 48}}, 5},
                  {V4L2_PIX_FMT_YUYV, {{32, 24}}, 20}};
  EXPECT_THAT(description(fake), HasSubstr("yuyv 32x24"));
  CameraOptions large = small();
  large.width = 64;
  large.height = 48;
  EXPECT_THAT(description(fake, large), HasSubstr("mjpeg 64x48 px, full range"));
  large.fps = 5;
  EXPECT_THAT(description(fake, large), HasSubstr("nv12 64x48 px, limited"));
  large.format = CameraFormat::yuyv;
  EXPECT_THAT(description(fake, large), HasSubstr("yuyv 32x24"));
  large.format = CameraFormat::uyvy;
  EXPECT_THAT(refusal(fake, large), HasSubstr("offers mjpeg, nv12, yuyv, must be uyvy"));
}

TEST(CameraFormat, RangeAndColorsAreWhatTheDriverSays) {
  FakeCamera fake;
  fake.quantization = V4L2_QUANTIZATION_FULL_RANGE;
  EXPECT_THAT(description(fake), HasSubstr("full range"));
  fake.quantization = V4L2_QUANTIZATION_DEFAULT;
  fake.colorspace = V4L2_COLORSPACE_JPEG;
  EXPECT_THAT(description(fake), HasSubstr("full range"));
  fake.quantization = V4L2_QUANTIZATION_LIM_RANGE;
  EXPECT_THAT(description(fake), HasSubstr("limited range"));
  CameraOptions corrected = small();
  corrected.range = ColorRange::full;
  EXPECT_THAT(description(fake, corrected), HasSubstr("full range"));
  fake.encoding = V4L2_YCBCR_ENC_709;
  EXPECT_THAT(refusal(fake), testing::AllOf(HasSubstr("BT.709"), HasSubstr("must be BT.601"), HasSubstr("mjpeg")));
  fake.encoding = V4L2_YCBCR_ENC_DEFAULT;
  fake.colorspace = V4L2_COLORSPACE_REC709;
  EXPECT_THAT(refusal(fake), HasSubstr("BT.709"));
  fake.formats.push_back({V4L2_PIX_FMT_MJPEG, {{32, 24}}, 20});
  EXPECT_THAT(description(fake), HasSubstr("mjpeg 32x24 px, full range"));
}

TEST(CameraFormat, PixelsAreTheDriversBufferInEachLayout) {
  for (const auto& [fourcc, format] :
       {std::pair{V4L2_PIX_FMT_YUYV, PixelFormat::yuyv422}, std::pair{V4L2_PIX_FMT_UYVY, PixelFormat::uyvy422},
        std::pair{V4L2_PIX_FMT_NV12, PixelFormat::nv12}}) {
    SCOPED_TRACE(std::string(to_string(format)));
    FakeCamera fake;
    fake.formats.front().fourcc = fourcc;
    fake.padding = 16;
    fake.plan_frames(1);
    LiveCamera camera(fake, fake.path, small());
    const auto grabbed = camera.grab(1000);
    ASSERT_TRUE(grabbed);
    const FrameView& view = grabbed->frame.view;
    EXPECT_EQ(view.format(), format);
    EXPECT_EQ(view.width(), 32);
    EXPECT_EQ(view.height(), 24);
    const std::ptrdiff_t stride = (format == PixelFormat::nv12 ? 32 : 64) + 16;
    EXPECT_EQ(view.row(1).y - view.row(0).y, stride);
    if (format == PixelFormat::nv12) {
      EXPECT_EQ(view.row(0).u - view.row(0).y, 24 * stride);
    }
    EXPECT_EQ(grabbed->frame.storage.get(), view.row(0).y - (format == PixelFormat::uyvy422 ? 1 : 0)) << "a copy";
  }
}

TEST(CameraFormat, WhatIsNoUsableCameraSaysSo) {
  FakeCamera fake;
  EXPECT_THAT(refusal(fake), "");
  fake.formats = {{v4l2_fourcc('B', 'G', 'G', 'R'), {{32, 24}}, 20}};
  EXPECT_THAT(refusal(fake), HasSubstr("offers BGGR, must be yuyv, uyvy, nv12 or mjpeg"));
  fake.capabilities = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  EXPECT_THAT(refusal(fake), HasSubstr("captures no video"));
  fake.capabilities = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING;
  EXPECT_THAT(refusal(fake), HasSubstr("planes apart"));
  fake.capabilities = V4L2_CAP_VIDEO_CAPTURE;
  EXPECT_THAT(refusal(fake), HasSubstr("does not share its memory"));
  fake.refusals[VIDIOC_QUERYCAP] = ENOTTY;
  EXPECT_THAT(refusal(fake), HasSubstr("is no video device"));
  fake.path = "/dev/video4";
  EXPECT_THROW(LiveCamera(fake, "/dev/video3", small()), DeviceError);
  EXPECT_EQ(fake.opened, fake.closed);
  EXPECT_EQ(fake.mapped, fake.unmapped);
}

TEST(CameraFormat, RefusedStepsOfOpeningAreNamed) {
  for (const unsigned long request : {VIDIOC_S_FMT, VIDIOC_REQBUFS, VIDIOC_QUERYBUF, VIDIOC_QBUF, VIDIOC_STREAMON}) {
    FakeCamera fake;
    fake.refusals[request] = EBUSY;
    EXPECT_THAT(refusal(fake), HasSubstr("evice or resource busy"));
    EXPECT_EQ(fake.opened, fake.closed);
    EXPECT_EQ(fake.mapped, fake.unmapped);
  }
  FakeCamera fake;
  fake.most_buffers = 1;
  EXPECT_THAT(refusal(fake), HasSubstr("shares 1 buffers, must be at least 2"));
}

TEST(CameraControls, AutomaticIsOffUnlessAskedFor) {
  FakeCamera fake;
  fake.controls = {{V4L2_CID_EXPOSURE_AUTO, {0, 3, 3}},
                   {V4L2_CID_EXPOSURE_ABSOLUTE, {1, 5000, 156}},
                   {V4L2_CID_AUTO_WHITE_BALANCE, {0, 1, 1}},
                   {V4L2_CID_WHITE_BALANCE_TEMPERATURE, {2800, 6500, 4600}},
                   {V4L2_CID_GAIN, {0, 100, 32}},
                   {V4L2_CID_EXPOSURE_AUTO_PRIORITY, {0, 1, 1}}};
  EXPECT_THAT(description(fake), HasSubstr("exposure 156 fixed, gain 32 fixed, white balance 4600 K fixed"));
  EXPECT_EQ(fake.controls.at(V4L2_CID_EXPOSURE_AUTO).value, V4L2_EXPOSURE_MANUAL);
  EXPECT_EQ(fake.controls.at(V4L2_CID_AUTO_WHITE_BALANCE).value, 0);

  CameraOptions options = small();
  options.exposure = {.automatic = true};
  options.gain = {.value = 500};
  options.white_balance = {.value = 3000};
  EXPECT_THAT(description(fake, options),
              HasSubstr("exposure 156 automatic, gain 100 fixed (asked for 500, must be 0..100), white balance 3000 K "
                        "fixed"));
  EXPECT_EQ(fake.controls.at(V4L2_CID_EXPOSURE_AUTO_PRIORITY).value, 0) << "the dark would lower the rate";
}

TEST(CameraControls, WhatACameraLacksIsTold) {
  FakeCamera fake;
  EXPECT_THAT(description(fake), HasSubstr("no exposure, no gain, no white balance"));
  CameraOptions options = small();
  options.gain = {.value = 5};
  EXPECT_THAT(refusal(fake, options), HasSubstr("has no gain that can be set; leave it out"));
  options.gain = {.automatic = true};
  EXPECT_THAT(refusal(fake, options), HasSubstr("has no automatic gain"));
  fake.controls = {{V4L2_CID_GAIN, {0, 100, 32, true}}, {V4L2_CID_AUTOGAIN, {0, 1, 1, true}}};
  options.gain = {.value = 5};
  EXPECT_THAT(description(fake, options),
              testing::AllOf(HasSubstr("gain 32 automatic"), HasSubstr("cannot be set"), HasSubstr("asked for 5")));
}

TEST(CameraOptions, OneOfAutomaticAndAValue) {
  CameraOptions options;
  options.check();
  options.gain = {.automatic = true, .value = 3};
  EXPECT_THROW(options.check(), Error);
  EXPECT_THROW(CameraOptions{.width = 0}.check(), Error);
  EXPECT_THROW(CameraOptions{.fps = 0}.check(), Error);
}

TEST(CameraList, NamesFormatsAndProblems) {
  FakeCamera fake;
  fake.formats.push_back({v4l2_fourcc('B', 'G', 'G', 'R'), {{8, 8}}, 7});
  const std::vector<CameraInfo> cameras = list_cameras(fake);
  ASSERT_EQ(cameras.size(), 1U);
  EXPECT_EQ(cameras[0].path, "/dev/video3");
  EXPECT_EQ(cameras[0].name, "Fake Cam");
  EXPECT_EQ(cameras[0].bus, "usb-0");
  ASSERT_EQ(cameras[0].modes.size(), 3U);
  EXPECT_EQ(cameras[0].modes[1].format, "yuyv");
  EXPECT_EQ(cameras[0].modes[1].width, 64);
  EXPECT_EQ(cameras[0].modes[1].fps, 20);
  EXPECT_TRUE(cameras[0].modes[1].usable);
  EXPECT_EQ(cameras[0].modes[2].format, "BGGR");
  EXPECT_FALSE(cameras[0].modes[2].usable);
  fake.refusals[VIDIOC_QUERYCAP] = EACCES;
  EXPECT_THAT(list_cameras(fake).at(0).problem, HasSubstr("ermission denied"));
  fake.refusals[VIDIOC_QUERYCAP] = ENOTTY;
  EXPECT_TRUE(list_cameras(fake).empty());
  EXPECT_EQ(fake.opened, fake.closed);
}

TEST(CameraLocation, DevicesAndTheScheme) {
  EXPECT_TRUE(is_camera("/dev/video0"));
  EXPECT_TRUE(is_camera("/dev/v4l/by-id/usb-cam"));
  EXPECT_TRUE(is_camera("v4l2:/dev/front"));
  EXPECT_FALSE(is_camera("video.mkv"));
  EXPECT_FALSE(is_camera("/dev/stdin"));
}

}  // namespace
}  // namespace tassilo
