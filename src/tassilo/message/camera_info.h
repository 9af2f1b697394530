#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "tassilo/camera/camera_model.h"
#include "tassilo/message/ros_messages.h"

// What a camera driver of ROS says of its lens, beside what the camera file says.

namespace tassilo {

/// The topic of the CameraInfo that belongs to an image topic, by the rule of image_transport: "/camera/camera_info"
/// for
/// "/camera/image_raw" and for "/camera/image_raw/compressed".
std::string camera_info_topic_of(std::string_view image_topic);
/// Are the images of this topic free of distortion, as image_proc makes them ("image_rect", "image_rect_color")? Then
/// P speaks of them, not K and D.
bool is_rectified_topic(std::string_view image_topic);

/// The lens of the images as they are sent: after binning and cutting out the region of interest.
struct ToldLens {
  int width = 0, height = 0;         ///< [px]
  std::optional<CameraModel> model;  ///< Nothing: the driver does not know (K or P are all 0).
};
/// Throws Error("camera info", ...) for another model than plumb_bob, rational_polynomial and equidistant, and for
/// numbers that describe no camera.
ToldLens lens_from(const ros::CameraInfo& info, bool is_rectified);

/// Where two lenses differ most.
struct LensDifference {
  double px =
      0;  ///< Between the places where both show what `first` shows at `at`; infinite where `second` cannot show it.
  PixelPoint at;
};
/// Over 17 x 13 places from border to border of `first`: models are smooth, and differ most at borders and corners.
/// Names, sizes and kinds of models are not compared: lenses that show the same are the same.
///
/// cost  some 0.2 ms
LensDifference difference(const CameraModel& first, const CameraModel& second);

/// Lenses that differ by more than this somewhere are not of one calibration. The same calibration in other digits, or
/// in another model, differs by some hundredths; two good calibrations of one camera by about half a pixel at the
/// corners. One pixel is about what an edge is found to in an image that was not made for measuring: less would not be
/// seen in any scene; more moves what is 4 m away by some percent. [px]
inline constexpr double kMostLensDifference = 1;

}  // namespace tassilo
