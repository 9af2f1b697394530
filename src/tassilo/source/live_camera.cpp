#include "tassilo/source/internal/live_camera.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tassilo {
namespace {

constexpr double kStallSeconds = 1, kStallFrames = 3;  // whichever is longer, for slow cameras
constexpr double kFirstFrameSeconds = 3;               // a camera that was just started may need to warm up
constexpr double kRestartSeconds = 1, kLookSeconds = 0.5;
constexpr int kRestarts = 3;         // then it is closed and opened again
constexpr double kOldestStamp = 10;  // [s] older ones are on some other clock

std::string seconds_text(double seconds) {
  const auto tenths = std::lround(seconds * 10);
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " s";
}

double frame_patience(const AgreedFormat& format) {
  return std::max(kStallSeconds, format.fps > 0 ? kStallFrames / format.fps : 0);
}

/// Asks for exactly what was agreed on before.
CameraOptions like_before(CameraOptions options, const AgreedFormat& format) {
  options.format = format.format;
  options.width = format.width;
  options.height = format.height;
  return options;
}

bool is_same_picture(const AgreedFormat& a, const AgreedFormat& b) {
  return a.format == b.format && a.width == b.width && a.height == b.height && a.range == b.range;
}

}  // namespace

LiveCamera::LiveCamera(SystemCalls& calls, std::string path, const CameraOptions& options)
    : calls_(calls),
      path_(std::move(path)),
      options_(options),
      stream_(V4l2Stream::start(calls_, path_, options_)),
      format_(stream_->format()),
      name_(stream_->name()),
      bus_(stream_->bus()),
      controls_(stream_->controls()),
      epoch_from_monotonic_(calls_.realtime_s() - calls_.monotonic_s()) {
  await_first_frame();
  last_frame_at_ = calls_.monotonic_s();
}

LiveCamera::~LiveCamera() {
  if (stream_) stream_->close();
}

void LiveCamera::await_first_frame() {
  const double now = calls_.monotonic_s();
  overdue_at_ = now + std::max(kFirstFrameSeconds, frame_patience(format_));
  next_try_ = now + kRestartSeconds;
  is_doubtful_ = false;
  last_sequence_.reset();
}

std::optional<GrabbedFrame> LiveCamera::grab(int patience_ms) {
  if (!stream_) {
    look_for_it(patience_ms);
    return std::nullopt;
  }
  const Dequeued dequeued = stream_->dequeue(patience_ms);
  switch (dequeued.outcome) {
    case Dequeued::Outcome::frame:
      return accept(dequeued);
    case Dequeued::Outcome::broken:
      index_of(dequeued.sequence);
      ++counts_.broken;
      nothing_came();  // a camera that sends nothing else must be started again
      break;
    case Dequeued::Outcome::nothing:
      nothing_came();
      break;
    case Dequeued::Outcome::failed:
      failed(dequeued.code);
      break;
  }
  return std::nullopt;
}

std::optional<GrabbedFrame> LiveCamera::accept(const Dequeued& dequeued) {
  GrabbedFrame grabbed;
  Frame& frame = grabbed.frame;
  frame.index = index_of(dequeued.sequence);
  frame.t = time_of(dequeued);
  frame.range = format_.range;
  frame.storage = dequeued.storage;
  if (format_.format == CameraFormat::mjpeg)
    grabbed.jpeg = dequeued.bytes;
  else
    frame.view = view_of(stream_->format(), dequeued.bytes.data());  // the stride may be another one than before
  frame_came();
  return grabbed;
}

std::int64_t LiveCamera::index_of(std::uint32_t sequence) {
  // Unsigned, for a count that overflows; one that stands still or jumps back counts nothing.
  const std::uint32_t step = last_sequence_ ? sequence - *last_sequence_ : 1;
  last_sequence_ = sequence;
  constexpr std::uint32_t kBackwards = 1U << 31;
  const std::int64_t lost = step == 0 || step >= kBackwards ? 0 : step - 1;
  counts_.lost += lost;
  next_index_ += lost;
  return next_index_++;
}

double LiveCamera::time_of(const Dequeued& dequeued) {
  const double now = calls_.monotonic_s();
  const double stamp = dequeued.stamp;
  counts_arrival_ = !dequeued.is_monotonic || stamp > now || stamp < now - kOldestStamp || stamp <= last_stamp_;
  last_stamp_ = counts_arrival_ ? std::max(now, std::nextafter(last_stamp_, now + 1)) : stamp;
  return epoch_from_monotonic_ + last_stamp_;
}

void LiveCamera::frame_came() {
  const double now = calls_.monotonic_s();
  overdue_at_ = now + frame_patience(format_);
  failed_starts_ = 0;
  is_doubtful_ = false;
  const double before = std::exchange(last_frame_at_, now);
  if (state_ == CameraState::streaming) return;
  const std::string after = " after " + seconds_text(now - before);
  enter(CameraState::streaming, state_ == CameraState::unplugged ? "is back" + after : "delivers frames again" + after);
}

void LiveCamera::nothing_came() {
  const double now = calls_.monotonic_s();
  if (now < overdue_at_) return;
  // The program itself may have slept: what came meanwhile is looked at first.
  if (!std::exchange(is_doubtful_, true)) return;
  stall("has sent no whole frame for " + seconds_text(now - last_frame_at_));
}

void LiveCamera::failed(int code) {
  if (is_gone(code)) return unplugged();
  stall("cannot be read: " + reason_of(code));
}

void LiveCamera::stall(const std::string& reason) {
  if (state_ == CameraState::streaming) {
    ++counts_.stalls;
    enter(CameraState::stalled, reason + ", it is started again");
  }
  const double now = calls_.monotonic_s();
  if (now < next_try_) return;
  next_try_ = now + kRestartSeconds;
  overdue_at_ = now + frame_patience(format_);
  is_doubtful_ = false;
  try {
    if (++failed_starts_ > kRestarts) {
      stream_->close();
      stream_ = nullptr;
      return;
    }
    last_sequence_.reset();
    stream_->restart();
  } catch (const DeviceError& refusal) {
    if (is_gone(refusal.code())) return unplugged();
    stream_->close();
    stream_ = nullptr;
  }
}

void LiveCamera::unplugged() {
  // Let go of it at once: held, it would come back as another device.
  if (stream_) stream_->close();
  stream_ = nullptr;
  next_try_ = calls_.monotonic_s() + kLookSeconds;
  if (state_ == CameraState::unplugged) return;
  ++counts_.unplugged;
  enter(CameraState::unplugged, "is unplugged, waiting for it");
}

void LiveCamera::look_for_it(int patience_ms) {
  const double wait = next_try_ - calls_.monotonic_s();
  if (wait > 0) {
    calls_.poll(-1, std::min(patience_ms, static_cast<int>(std::ceil(wait * 1000))));
    return;
  }
  std::shared_ptr<V4l2Stream> back;
  try {
    back = V4l2Stream::start(calls_, path_, like_before(options_, format_));
  } catch (const DeviceError& refusal) {
    // Also when it is there, but not ready yet, or not ours yet (rights are given a moment later).
    next_try_ = calls_.monotonic_s() + kLookSeconds;
    if (is_gone(refusal.code())) unplugged();
    return;
  } catch (const NoCamera&) {
    next_try_ = calls_.monotonic_s() + kLookSeconds;
    return;
  }
  if (!is_same_picture(back->format(), format_)) {
    back->close();
    throw Error(path_, "came back as '" + back->name() + "' with " + to_string(back->format()) + ", must be " +
                           to_string(format_) + " as before; start again");
  }
  stream_ = std::move(back);
  failed_starts_ = 0;
  await_first_frame();
}

void LiveCamera::enter(CameraState state, const std::string& text) {
  state_ = state;
  news_.push_back({state, path_ + " (" + name_ + ") " + text});
}

std::string LiveCamera::description() const {
  std::string text = name_ + ", " + to_string(format_);
  if (format_.width != options_.width || format_.height != options_.height)
    text += " (asked for " + std::to_string(options_.width) + "x" + std::to_string(options_.height) + ")";
  constexpr double kNearly = 0.01;
  if (format_.fps > 0 && std::abs(format_.fps - options_.fps) > kNearly * options_.fps)
    text += " (asked for " + std::to_string(std::lround(options_.fps)) + ")";
  text += "; " + controls_;
  if (counts_arrival_) text += "; times of arrival, the driver tells no monotonic time of capture";
  return text;
}

}  // namespace tassilo
