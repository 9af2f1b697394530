#pragma once

#include <memory>

#include "tassilo/base/error.h"
#include "tassilo/image/frame.h"
#include "tassilo/message/ros_messages.h"

namespace tassilo {

/// An image in an encoding that is not among those below: whoever sends one will send no other.
class UnknownEncoding : public Error {
 public:
  using Error::Error;
};

/// What a message does not say of its pixels.
struct ImageRanges {
  ColorRange yuv = ColorRange::limited;  ///< Of YUV encodings, as camera drivers send them.
  ColorRange rgb = ColorRange::limited;  ///< What RGB becomes; normally the color table's range.
};

/// The pixels of a sensor_msgs/Image from anybody.
///
/// uyvy (formerly yuv422), yuyv (formerly yuv422_yuy2) and nv12 stay where they are, in the bytes that `storage` keeps
/// alive; rgb8 and bgr8 become BT.601 yuv422p. Rows may be padded. An odd width has a whole pair of pixels at its end,
/// an odd height of nv12 a last chroma row for one. All values are of 8 bits, whatever is_bigendian says.
/// index, t  left to the caller
/// cost      YUV: none; RGB: O(pixels)
/// Throws UnknownEncoding; Error("image", ...) where size, step and number of bytes are none or do not belong together.
Frame frame_from(const ros::BorrowedImage& image, const ImageRanges& ranges, std::shared_ptr<const void> storage);

}  // namespace tassilo
