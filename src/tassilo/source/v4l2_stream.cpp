#include "tassilo/source/internal/v4l2_stream.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>

#include "tassilo/source/internal/v4l2_controls.h"

namespace tassilo {
namespace {

// One in the vision, one in the slot, one just grabbed, and two for the driver to fill, with one to spare.
constexpr __u32 kBuffers = 6;
constexpr std::size_t kFewestBuffers = 2, kDriversBuffers = 2;

v4l2_buffer describe_buffer(std::size_t index) {
  v4l2_buffer buffer{};
  buffer.index = static_cast<__u32>(index);
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  return buffer;
}

}  // namespace

V4l2Stream::V4l2Stream(SystemCalls& calls, const std::string& path) : device_(calls, path) {}

std::shared_ptr<V4l2Stream> V4l2Stream::start(SystemCalls& calls, const std::string& path,
                                              const CameraOptions& options) {
  const std::shared_ptr<V4l2Stream> stream(new V4l2Stream(calls, path));
  stream->format_ = agree_on_format(stream->device_, options);
  stream->controls_ = apply_controls(stream->device_, options);
  stream->map_buffers();
  stream->queue_all_and_start();
  return stream;
}

V4l2Stream::~V4l2Stream() {
  close();
  for (const Buffer& buffer : buffers_) device_.calls().unmap(buffer.memory, buffer.length);
}

void V4l2Stream::map_buffers() {
  v4l2_requestbuffers request{};
  request.count = kBuffers;
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  device_.ask(VIDIOC_REQBUFS, &request, "share its memory");
  if (request.count < kFewestBuffers)
    throw Error(device_.path(), "shares " + std::to_string(request.count) + " buffers, must be at least " +
                                    std::to_string(kFewestBuffers));
  for (std::size_t index = 0; index < request.count; ++index) {
    v4l2_buffer about = describe_buffer(index);
    device_.ask(VIDIOC_QUERYBUF, &about, "describe its memory");
    if (about.length < format_.least_bytes)
      throw Error(device_.path(), "has buffers of " + std::to_string(about.length) + " bytes, must be at least " +
                                      std::to_string(format_.least_bytes) + " for " + to_string(format_));
    void* const memory = device_.calls().map(device_.fd(), about.length, about.m.offset);
    if (memory == nullptr) throw DeviceError(device_.path(), "share its memory", errno);
    buffers_.push_back({static_cast<std::uint8_t*>(memory), about.length});
  }
}

int V4l2Stream::queue(std::size_t index) {
  v4l2_buffer buffer = describe_buffer(index);
  return device_.try_ask(VIDIOC_QBUF, &buffer);
}

void V4l2Stream::queue_all_and_start() {
  for (std::size_t index = 0; index < buffers_.size(); ++index) {
    if (buffers_[index].held) continue;
    if (const int code = queue(index); code != 0) throw DeviceError(device_.path(), "take its memory back", code);
  }
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  device_.ask(VIDIOC_STREAMON, &type, "start");
}

void V4l2Stream::restart() {
  const std::lock_guard lock(mutex_);
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  device_.ask(VIDIOC_STREAMOFF, &type, "stop");  // all buffers are ours now
  queue_all_and_start();
}

void V4l2Stream::close() {
  const std::lock_guard lock(mutex_);
  if (!device_.is_open()) return;
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  device_.try_ask(VIDIOC_STREAMOFF, &type);
  device_.close();
}

void V4l2Stream::release(std::size_t index) noexcept {
  const std::lock_guard lock(mutex_);
  buffers_[index].held = false;
  --held_;
  // What the driver refuses now it refuses the grabbing thread as well, which then starts it again with all buffers.
  if (device_.is_open()) queue(index);
}

Dequeued V4l2Stream::dequeue(int timeout_ms) {
  // Errors and hang-ups (POLLERR, POLLHUP) are told by the call that follows.
  const int events = device_.calls().poll(device_.fd(), timeout_ms);
  if (events == 0) return {};
  if (events < 0 && errno == EINTR) return {};
  if (events < 0) return {.outcome = Dequeued::Outcome::failed, .code = errno};

  v4l2_buffer buffer = describe_buffer(0);
  const int code = device_.try_ask(VIDIOC_DQBUF, &buffer);
  if (code == EAGAIN) {
    // An error without a reason would make us look again at once, for ever.
    constexpr int kPauseMs = 10;
    device_.calls().poll(-1, std::min(kPauseMs, timeout_ms));
    return {};
  }
  if (code != 0) return {.outcome = Dequeued::Outcome::failed, .code = code};
  if (buffer.index >= buffers_.size()) return {.outcome = Dequeued::Outcome::failed, .code = EINVAL};

  Dequeued taken = take(buffer.index, (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0 ? 0 : buffer.bytesused);
  taken.sequence = buffer.sequence;
  taken.stamp = static_cast<double>(buffer.timestamp.tv_sec) + 1e-6 * static_cast<double>(buffer.timestamp.tv_usec);
  taken.is_monotonic = (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  return taken;
}

Dequeued V4l2Stream::take(std::size_t index, std::size_t used) {
  Buffer& buffer = buffers_[index];
  Dequeued taken;
  taken.outcome = Dequeued::Outcome::broken;
  const bool is_whole = used >= format_.least_bytes && used <= buffer.length;
  if (is_whole) taken.outcome = Dequeued::Outcome::frame;
  if (is_whole && hold(index)) {
    taken.storage = std::shared_ptr<const void>(
        buffer.memory, [self = shared_from_this(), index](const void*) { self->release(index); });
    taken.bytes = {buffer.memory, used};
    return taken;
  }
  if (is_whole) {
    auto copy = std::make_shared<std::vector<std::uint8_t>>(buffer.memory, buffer.memory + used);
    taken.bytes = *copy;
    taken.storage = std::move(copy);
  }
  const std::lock_guard lock(mutex_);
  queue(index);
  return taken;
}

bool V4l2Stream::hold(std::size_t index) {
  const std::lock_guard lock(mutex_);
  if (held_ + 1 + kDriversBuffers > buffers_.size()) return false;
  buffers_[index].held = true;
  ++held_;
  return true;
}

}  // namespace tassilo
