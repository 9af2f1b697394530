#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "tassilo/source/camera.h"
#include "tassilo/source/internal/v4l2_device.h"
#include "tassilo/source/internal/v4l2_format.h"

namespace tassilo {

/// What came of looking for a frame.
struct Dequeued {
  enum class Outcome { frame, nothing, broken, failed };
  Outcome outcome = Outcome::nothing;
  int code = 0;                              ///< Why it failed: errno.
  std::uint32_t sequence = 0;                ///< The driver's count, of frame and broken.
  double stamp = 0;                          ///< When it was captured. [s]
  bool is_monotonic = false;                 ///< Whether `stamp` is on the monotonic clock.
  std::span<const std::uint8_t> bytes = {};  ///< Of a frame, at least as many as agreed on.
  std::shared_ptr<const void> storage = {};  ///< Keeps `bytes` alive, and the driver away from them.
};

/// A camera that streams into memory shared with its driver.
///
/// A frame is the driver's own buffer, without a copy, and goes back to the driver when the last holder lets go of it.
/// Two buffers always stay with the driver: when holders keep more, frames are copied, so that keeping frames does not
/// stop the camera. Buffers stay readable as long as they are held, also after the stream was closed.
///
/// Invariant: a buffer is either queued (the driver's) or held (ours), and is queued again once for each time it was
/// dequeued, unless the stream was closed meanwhile.
///
/// threads  one for all calls; frames may be let go of by any
class V4l2Stream : public std::enable_shared_from_this<V4l2Stream> {
 public:
  /// Opens, agrees on a format, sets the controls, starts. Throws Error, DeviceError as agree_on_format,
  /// apply_controls, and DeviceError when the system refuses anything else.
  static std::shared_ptr<V4l2Stream> start(SystemCalls& calls, const std::string& path, const CameraOptions& options);
  ~V4l2Stream();

  /// Looks for a frame, waits for it at most this long. [ms]
  Dequeued dequeue(int timeout_ms);
  /// Stops and starts again. Throws DeviceError.
  void restart();
  /// Lets go of the device: nothing comes any more.
  void close();

  const AgreedFormat& format() const { return format_; }
  const std::string& controls() const { return controls_; }  ///< See apply_controls.
  const std::string& name() const { return device_.name(); }
  const std::string& bus() const { return device_.bus(); }

 private:
  struct Buffer {
    std::uint8_t* memory = nullptr;
    std::size_t length = 0;
    bool held = false;
  };

  V4l2Stream(SystemCalls& calls, const std::string& path);
  void map_buffers();
  int queue(std::size_t index);  ///< 0 or the errno. `mutex_` is held, or nobody else knows us.
  void queue_all_and_start();    ///< As `queue`.
  bool hold(std::size_t index);  ///< False: the driver needs it.
  void release(std::size_t index) noexcept;
  Dequeued take(std::size_t index, std::size_t used);

  V4l2Device device_;
  AgreedFormat format_;
  std::string controls_;
  std::mutex mutex_;  ///< Of `device_` and `held`: frames are let go of by other threads.
  std::vector<Buffer> buffers_;
  std::size_t held_ = 0;
};

}  // namespace tassilo
