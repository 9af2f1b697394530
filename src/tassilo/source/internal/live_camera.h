#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tassilo/source/camera.h"
#include "tassilo/source/internal/v4l2_stream.h"

namespace tassilo {

/// A frame as it was grabbed: either pixels, or the bytes of a JPEG that `frame.storage` keeps alive.
struct GrabbedFrame {
  Frame frame;
  std::span<const std::uint8_t> jpeg;
};

/// A camera that may stall, be pulled out and come back, over all of it one source with one count and one clock.
///
/// Index: the driver's sequence numbers, so that lost and broken frames leave gaps; goes on without a gap after a stall
/// or an absence. Time: the driver's monotonic stamp, moved to the UNIX epoch by an offset taken once, so that a clock
/// that is set moves nothing; always rising. The time of arrival where a stamp is not monotonic or cannot be true.
///
/// threads  one at a time; frames may be let go of by any
class LiveCamera {
 public:
  /// Opens and starts. Throws Error when there is none or none that fits, as V4l2Stream::start.
  LiveCamera(SystemCalls& calls, std::string path, const CameraOptions& options);
  ~LiveCamera();

  /// The next frame, or nothing within about `patience_ms`. Meanwhile all that can be done about a camera that stalls
  /// or is away is done: started again each second, looked for each half second.
  /// Throws Error when a camera came back that sends something else.
  std::optional<GrabbedFrame> grab(int patience_ms);

  CameraState state() const { return state_; }
  /// Changes of state since the last call, in order.
  std::vector<CameraNews> news() { return std::exchange(news_, {}); }
  /// `replaced` is not ours to know: 0.
  CameraCounts counts() const { return counts_; }
  std::string description() const;
  const AgreedFormat& format() const { return format_; }
  /// On the clock of the frames. Any thread. [s]
  double now() const { return epoch_from_monotonic_ + calls_.monotonic_s(); }

 private:
  void look_for_it(int patience_ms);
  std::optional<GrabbedFrame> accept(const Dequeued& dequeued);
  void frame_came();
  void nothing_came();
  void failed(int code);
  void stall(const std::string& reason);
  void unplugged();
  void enter(CameraState state, const std::string& text);
  std::int64_t index_of(std::uint32_t sequence);
  double time_of(const Dequeued& dequeued);
  void await_first_frame();

  SystemCalls& calls_;
  std::string path_;
  CameraOptions options_;
  std::shared_ptr<V4l2Stream> stream_;  ///< None while there is nothing to be read from.
  AgreedFormat format_;
  std::string name_, bus_, controls_;
  CameraState state_ = CameraState::streaming;
  std::vector<CameraNews> news_;
  CameraCounts counts_;
  double epoch_from_monotonic_ = 0;  ///< [s]
  // On the monotonic clock. [s]
  double overdue_at_ = 0;     ///< When a frame must have come.
  double next_try_ = 0;       ///< Not earlier to start it again or to look for it.
  double last_frame_at_ = 0;  ///< Or of opening.
  int failed_starts_ = 0;
  bool is_doubtful_ = false;                    ///< A frame is overdue, and it was looked for once.
  bool counts_arrival_ = false;                 ///< The last frame's time was that of its arrival.
  std::optional<std::uint32_t> last_sequence_;  ///< Of this stream.
  std::int64_t next_index_ = 0;
  double last_stamp_ = 0;
};

}  // namespace tassilo
