#pragma once

#include <linux/videodev2.h>

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "tassilo/source/internal/system_calls.h"

namespace tassilo {

/// What a camera of the tests does next.
struct CameraStep {
  enum class Kind {
    frame,          ///< A whole one.
    lost,           ///< `number` frames that only the driver's count knows of.
    marked_broken,  ///< One with the driver's error flag.
    wrong_size,     ///< One of `number` bytes.
    again,          ///< Readable, but then it says EAGAIN.
    signal,         ///< A signal interrupts the call: EINTR.
    fails,          ///< Reading fails with errno `number`.
    silence,        ///< Nothing for `seconds`.
    asleep,         ///< The program sleeps for `seconds`, frames come meanwhile.
    until_restart,  ///< Nothing until it is started again.
    unplug,         ///< Gone for `seconds`, then `number` is what opening fails with once more (0: nothing).
  };
  Kind kind = Kind::frame;
  int number = 0;
  double seconds = 0;
};

/// A driver without a camera, on a clock that waiting moves. What a driver may be asked is checked: a buffer that is
/// not queued is never written to, and its memory ends when it is unmapped. Any thread.
class FakeCamera final : public SystemCalls {
 public:
  struct Control {
    int least, most, value;
    bool refuses = false;  ///< EBUSY
  };
  struct Format {
    __u32 fourcc;
    std::vector<std::pair<int, int>> sizes;  ///< The nearest is answered.
    int fps;
  };

  std::string path = "/dev/video3";
  std::vector<Format> formats{{V4L2_PIX_FMT_YUYV, {{32, 24}, {64, 48}}, 20}};
  std::vector<Format> formats_when_back;  ///< Empty: the same.
  std::map<__u32, Control> controls;
  __u32 capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  __u32 quantization = V4L2_QUANTIZATION_DEFAULT, colorspace = V4L2_COLORSPACE_SRGB;
  __u32 encoding = V4L2_YCBCR_ENC_DEFAULT;
  __u32 padding = 0;  ///< After each row. [bytes]
  __u32 most_buffers = 32;
  __u32 stamp_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  double stamp_offset = 0;  ///< Added to the clock. [s]
  std::string jpeg;         ///< What frames are when the format is one of JPEG.
  std::deque<CameraStep> steps;
  std::map<unsigned long, int> refusals;  ///< Request -> errno.

  // What happened.
  int dequeued = 0, requeued = 0, opened = 0, closed = 0, mapped = 0, unmapped = 0, starts = 0, faults = 0;
  double now = 100;  ///< [s]

  void plan(CameraStep::Kind kind, int number = 0, double seconds = 0) { steps.push_back({kind, number, seconds}); }
  void plan_frames(int count) {
    for (int k = 0; k < count; ++k) plan(CameraStep::Kind::frame);
  }
  std::size_t queued() const { return queue_.size(); }

  int open(const std::string& wanted) override;
  void close(int fd) override;
  int ioctl(int fd, unsigned long request, void* argument) override;
  void* map(int fd, std::size_t length, std::int64_t offset) override;
  void unmap(void* memory, std::size_t length) override;
  int poll(int fd, int timeout_ms) override;
  double monotonic_s() override;
  double realtime_s() override { return monotonic_s() + kEpoch; }
  static constexpr double kEpoch = 1'000'000;

 private:
  int answer(unsigned long request, void* argument);
  int enumerate_format(v4l2_fmtdesc& about) const;
  int enumerate_interval(v4l2_frmivalenum& about) const;
  int enumerate_size(v4l2_frmsizeenum& about) const;
  int agree(v4l2_pix_format& pix) const;
  int control(unsigned long request, v4l2_control& wanted);
  int dequeue(v4l2_buffer& buffer);
  void start();

  mutable std::mutex mutex_;
  v4l2_pix_format pix_{};
  bool present_ = true, streaming_ = false;
  double back_at_ = 0, next_frame_at_ = 0, silent_until_ = 0;
  int refuse_opening_ = 0;
  std::uint32_t sequence_ = 0;
  std::uint8_t fill_ = 0;
  int fd_ = -1, next_fd_ = 1000;
  std::vector<std::uint8_t*> buffers_;  ///< By index, nullptr: not mapped.
  std::deque<__u32> queue_;
};

}  // namespace tassilo
