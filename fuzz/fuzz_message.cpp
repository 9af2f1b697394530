// Any bytes are a message or refused, whatever type they are read as; one that was read is written and read back; what
// is plausible becomes a scene, an image a frame, a CameraInfo a lens, each within the memory that the bytes justify.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/message/camera_info.h"
#include "tassilo/message/codec.h"
#include "tassilo/message/image_frame.h"
#include "tassilo/message/odometry_sample.h"
#include "tassilo/message/plausible.h"
#include "tassilo/message/to_scene.h"

namespace tassilo {
namespace {

using Bytes = std::span<const std::byte>;

template <Message M>
std::optional<M> read(Bytes bytes) {
  auto message = decoded<M>(bytes);
  if (message) {
    const std::vector<std::byte> once = encoded(*message);
    const auto again = decoded<M>(once);
    expects(again.has_value() && encoded(*again) == once, "a message that is written reads back equal");
  }
  return message;
}

/// Reads and judges; then `use` of what is plausible.
template <Message M, class Use>
void look(Bytes bytes, Use use) {
  const auto message = read<M>(bytes);
  if (message && implausible(*message, 3).empty()) use(*message);
}

void look_at_image(Bytes bytes) {
  const auto message = decoded<ros::BorrowedImage>(bytes);
  if (!message) return;
  try {
    const Frame frame = frame_from(*message, {}, nullptr);
    std::int64_t sum = 0;
    for (int r = 0; r < frame.view.height(); ++r)
      for (int c = 0; c < frame.view.width(); ++c) sum += frame.view.y(c, r) + frame.view.u(c, r) + frame.view.v(c, r);
    expects(sum >= 0, "all pixels can be read");
  } catch (const Error&) {
  }
}

void look_at_lens(Bytes bytes) {
  const auto message = read<ros::CameraInfo>(bytes);
  if (!message) return;
  CameraModel own;
  own.width = 384;
  own.height = 172;
  own.fx = own.fy = 200;
  own.cx = 190;
  own.cy = 85;
  for (const bool is_rectified : {false, true}) {
    try {
      const ToldLens lens = lens_from(*message, is_rectified);
      if (lens.model) expects(difference(own, *lens.model).px >= 0, "a difference is a number");
    } catch (const Error&) {
    }
  }
}

void look_at_odometry(Bytes bytes) {
  look<ros::Odometry>(bytes, [](const auto&) {});
  const auto message = decoded<ros::Odometry>(bytes);
  if (!message || !unusable(*message).empty()) return;
  const OdometrySample sample = odometry_sample_from(*message);
  expects(std::isfinite(sample.t) && std::isfinite(sample.x) && std::isfinite(sample.y) && std::isfinite(sample.theta),
          "odometry that is usable is finite");
}

void look_at(int type, Bytes bytes) {
  switch (type) {
    case 0:
      return look_at_image(bytes);
    case 1:
      return look_at_lens(bytes);
    case 2:
      return look_at_odometry(bytes);
    case 3:
      return look<ros::CompressedImage>(bytes, [](const auto&) {});
    case 4:
      return look<ros::PoseWithCovarianceStamped>(bytes, [](const auto& message) { pose_from(message); });
    case 5:
      return look<msgs::FreeSpace>(bytes, [](const auto& message) { free_space_from(message); });
    case 6:
      return look<msgs::BallArray>(bytes, [](const auto& message) { balls_from(message); });
    case 7:
      return look<msgs::RobotArray>(bytes, [](const auto& message) { robots_from(message); });
    case 8:
      return look<msgs::GoalArray>(bytes, [](const auto& message) { goals_from(message); });
    case 9:
      return look<msgs::LineArray>(bytes, [](const auto& message) {
        lines_from(message);
        circles_from(message);
      });
    case 10:
      return look<msgs::TrackArray>(bytes, [](const auto& message) { tracks_from(message); });
    case 11:
      return look<msgs::TeamState>(bytes, [](const auto&) {});
    case 12:
      read<ros::TFMessage>(bytes);
      return;
    case 13:
      read<ros::LaserScan>(bytes);
      return;
    case 14:
      read<ros::Image>(bytes);
      return;
    default:
      return;
  }
}

}  // namespace
}  // namespace tassilo

/// The first byte chooses the type.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1 || size > 1 << 16) return 0;
  constexpr int types = 15;
  tassilo::look_at(data[0] % types, std::as_bytes(std::span(data + 1, size - 1)));
  return 0;
}
