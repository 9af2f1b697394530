#include "tassilo/source/test_camera.h"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <utility>

namespace tassilo {
namespace {

using Kind = CameraStep::Kind;

int refuse(int code) {
  errno = code;
  return -1;
}

}  // namespace

double FakeCamera::monotonic_s() {
  const std::lock_guard lock(mutex_);
  return now;
}

int FakeCamera::open(const std::string& wanted) {
  const std::lock_guard lock(mutex_);
  if (!present_ && now >= back_at_) {
    present_ = true;
    if (!formats_when_back.empty()) formats = formats_when_back;
  }
  if (wanted != path || !present_) return refuse(ENOENT);
  if (refuse_opening_ != 0) return refuse(std::exchange(refuse_opening_, 0));
  ++opened;
  streaming_ = false;
  buffers_.clear();
  queue_.clear();
  return fd_ = next_fd_++;
}

void FakeCamera::close(int fd) {
  const std::lock_guard lock(mutex_);
  ++closed;
  faults += fd != fd_;
  fd_ = -1;
}

void* FakeCamera::map(int fd, std::size_t length, std::int64_t offset) {
  const std::lock_guard lock(mutex_);
  faults += fd != fd_ || static_cast<std::size_t>(offset) >= buffers_.size() || length != pix_.sizeimage;
  ++mapped;
  return buffers_[static_cast<std::size_t>(offset)] = new std::uint8_t[length]();
}

void FakeCamera::unmap(void* memory, std::size_t) {
  const std::lock_guard lock(mutex_);
  ++unmapped;
  std::ranges::replace(buffers_, static_cast<std::uint8_t*>(memory), nullptr);
  delete[] static_cast<std::uint8_t*>(memory);
}

int FakeCamera::poll(int fd, int timeout_ms) {
  std::this_thread::sleep_for(std::chrono::microseconds(50));  // lets other threads have the machine
  const std::lock_guard lock(mutex_);
  const double until = now + timeout_ms / 1000.;
  const auto nothing = [&] {
    now = until;
    return 0;
  };
  if (fd < 0) return nothing();
  if (fd != fd_) return refuse(EBADF);
  if (!steps.empty() && steps.front().kind == Kind::unplug) {
    present_ = streaming_ = false;
    back_at_ = now + steps.front().seconds;
    refuse_opening_ = steps.front().number;
    steps.pop_front();
  }
  if (!present_ || !streaming_) return POLLERR;
  if (!steps.empty() && steps.front().kind == Kind::asleep) {
    now += steps.front().seconds;
    steps.pop_front();
    return 0;
  }
  if (!steps.empty() && steps.front().kind == Kind::silence) {
    if (silent_until_ == 0) silent_until_ = now + steps.front().seconds;
    if (until < silent_until_) return nothing();
    now = std::max(now, std::exchange(silent_until_, 0));
    steps.pop_front();
    return 0;
  }
  if (steps.empty() || steps.front().kind == Kind::until_restart || queue_.empty()) return nothing();
  if (next_frame_at_ > until) return nothing();
  now = std::max(now, next_frame_at_);
  return POLLIN;
}

int FakeCamera::ioctl(int fd, unsigned long request, void* argument) {
  const std::lock_guard lock(mutex_);
  if (fd != fd_) {
    ++faults;
    return refuse(EBADF);
  }
  if (!present_) return refuse(ENODEV);
  if (const auto refusal = refusals.find(request); refusal != refusals.end()) return refuse(refusal->second);
  const int code = answer(request, argument);
  return code == 0 ? 0 : refuse(code);
}

int FakeCamera::answer(unsigned long request, void* argument) {
  auto& buffer = *static_cast<v4l2_buffer*>(argument);  // if it is one
  switch (request) {
    case VIDIOC_QUERYCAP: {
      auto& about = *static_cast<v4l2_capability*>(argument);
      std::strcpy(reinterpret_cast<char*>(about.card), "Fake Cam");
      std::strcpy(reinterpret_cast<char*>(about.bus_info), "usb-0");
      about.capabilities = V4L2_CAP_DEVICE_CAPS;
      about.device_caps = capabilities;
      return 0;
    }
    case VIDIOC_ENUM_FMT:
      return enumerate_format(*static_cast<v4l2_fmtdesc*>(argument));
    case VIDIOC_ENUM_FRAMEINTERVALS:
      return enumerate_interval(*static_cast<v4l2_frmivalenum*>(argument));
    case VIDIOC_ENUM_FRAMESIZES:
      return enumerate_size(*static_cast<v4l2_frmsizeenum*>(argument));
    case VIDIOC_TRY_FMT:
      return agree(static_cast<v4l2_format*>(argument)->fmt.pix);
    case VIDIOC_S_FMT: {
      const int code = agree(static_cast<v4l2_format*>(argument)->fmt.pix);
      if (code == 0) pix_ = static_cast<v4l2_format*>(argument)->fmt.pix;
      return code;
    }
    case VIDIOC_G_PARM:
    case VIDIOC_S_PARM: {
      auto& capture = static_cast<v4l2_streamparm*>(argument)->parm.capture;
      capture.capability = V4L2_CAP_TIMEPERFRAME;
      capture.timeperframe = {1, static_cast<__u32>(formats.front().fps)};
      return 0;
    }
    case VIDIOC_QUERYCTRL: {
      auto& about = *static_cast<v4l2_queryctrl*>(argument);
      const auto it = controls.find(about.id);
      if (it == controls.end()) return EINVAL;
      about.minimum = it->second.least;
      about.maximum = it->second.most;
      about.step = 1;
      return 0;
    }
    case VIDIOC_G_CTRL:
    case VIDIOC_S_CTRL:
      return control(request, *static_cast<v4l2_control*>(argument));
    case VIDIOC_REQBUFS: {
      auto& wanted = *static_cast<v4l2_requestbuffers*>(argument);
      wanted.count = std::min(wanted.count, most_buffers);
      buffers_.assign(wanted.count, nullptr);
      return 0;
    }
    case VIDIOC_QUERYBUF:
      buffer.length = pix_.sizeimage;
      buffer.m.offset = buffer.index;
      return 0;
    case VIDIOC_QBUF:
      if (std::ranges::find(queue_, buffer.index) != queue_.end()) {
        ++faults;
        return EINVAL;
      }
      queue_.push_back(buffer.index);
      requeued += streaming_;
      return 0;
    case VIDIOC_DQBUF:
      return dequeue(buffer);
    case VIDIOC_STREAMON:
      start();
      return 0;
    case VIDIOC_STREAMOFF:
      streaming_ = false;
      queue_.clear();
      return 0;
    default:
      return ENOTTY;
  }
}

void FakeCamera::start() {
  ++starts;
  streaming_ = true;
  sequence_ = 0;
  next_frame_at_ = now + 1. / formats.front().fps;
  if (!steps.empty() && steps.front().kind == Kind::until_restart && starts > 1) steps.pop_front();
}

int FakeCamera::enumerate_format(v4l2_fmtdesc& about) const {
  if (about.index >= formats.size()) return EINVAL;
  about.pixelformat = formats[about.index].fourcc;
  return 0;
}

int FakeCamera::enumerate_interval(v4l2_frmivalenum& about) const {
  const auto it = std::ranges::find(formats, about.pixel_format, &Format::fourcc);
  if (about.index > 0 || it == formats.end()) return EINVAL;
  about.type = V4L2_FRMIVAL_TYPE_DISCRETE;
  about.discrete = {1, static_cast<__u32>(it->fps)};
  return 0;
}

int FakeCamera::enumerate_size(v4l2_frmsizeenum& about) const {
  const auto it = std::ranges::find(formats, about.pixel_format, &Format::fourcc);
  if (it == formats.end() || about.index >= it->sizes.size()) return EINVAL;
  about.type = V4L2_FRMSIZE_TYPE_DISCRETE;
  const auto [width, height] = it->sizes[about.index];
  about.discrete = {static_cast<__u32>(width), static_cast<__u32>(height)};
  return 0;
}

int FakeCamera::agree(v4l2_pix_format& pix) const {
  auto it = std::ranges::find(formats, pix.pixelformat, &Format::fourcc);
  if (it == formats.end()) it = formats.begin();
  const int wide = static_cast<int>(pix.width), high = static_cast<int>(pix.height);
  const auto miss = [&](std::pair<int, int> size) {
    return std::abs(size.first - wide) + std::abs(size.second - high);
  };
  const auto [width, height] = *std::ranges::min_element(it->sizes, {}, miss);
  pix.width = static_cast<__u32>(width);
  pix.height = static_cast<__u32>(height);
  pix.pixelformat = it->fourcc;
  const bool is_nv12 = it->fourcc == V4L2_PIX_FMT_NV12, is_jpeg = it->fourcc == V4L2_PIX_FMT_MJPEG;
  pix.bytesperline = is_jpeg ? 0 : pix.width * (is_nv12 ? 1 : 2) + padding;
  pix.sizeimage = is_jpeg ? std::max<__u32>(4096, static_cast<__u32>(jpeg.size()))
                          : pix.bytesperline * (is_nv12 ? pix.height * 3 / 2 : pix.height);
  pix.quantization = quantization;
  pix.colorspace = colorspace;
  pix.ycbcr_enc = encoding;
  return 0;
}

int FakeCamera::control(unsigned long request, v4l2_control& wanted) {
  const auto it = controls.find(wanted.id);
  if (it == controls.end()) return EINVAL;
  Control& own = it->second;
  if (request == VIDIOC_S_CTRL) {
    if (own.refuses) return EBUSY;
    if (wanted.value < own.least || wanted.value > own.most) return ERANGE;
    own.value = wanted.value;
  }
  wanted.value = own.value;
  return 0;
}

int FakeCamera::dequeue(v4l2_buffer& buffer) {
  while (!steps.empty() && steps.front().kind == Kind::lost) {
    sequence_ += static_cast<std::uint32_t>(steps.front().number);
    steps.pop_front();
  }
  if (steps.empty() || queue_.empty() || now < next_frame_at_) return EAGAIN;
  const CameraStep step = steps.front();
  if (step.kind == Kind::silence || step.kind == Kind::asleep || step.kind == Kind::until_restart ||
      step.kind == Kind::unplug)
    return EAGAIN;
  steps.pop_front();
  if (step.kind == Kind::again) return EAGAIN;
  if (step.kind == Kind::signal) return EINTR;
  if (step.kind == Kind::fails) return step.number;

  const double stamp = now + stamp_offset;
  next_frame_at_ = now + 1. / formats.front().fps;
  buffer.index = queue_.front();
  queue_.pop_front();
  ++dequeued;
  std::uint8_t* const memory = buffers_[buffer.index];
  const bool is_jpeg = !jpeg.empty();
  if (is_jpeg)
    std::memcpy(memory, jpeg.data(), jpeg.size());
  else
    std::memset(memory, fill_++, pix_.sizeimage);
  buffer.bytesused = is_jpeg ? static_cast<__u32>(jpeg.size()) : pix_.sizeimage;
  if (step.kind == Kind::wrong_size) buffer.bytesused = static_cast<__u32>(step.number);
  buffer.flags = stamp_flags | (step.kind == Kind::marked_broken ? V4L2_BUF_FLAG_ERROR : 0U);
  buffer.sequence = sequence_++;
  buffer.timestamp.tv_sec = static_cast<long>(std::floor(stamp));
  buffer.timestamp.tv_usec = static_cast<long>((stamp - std::floor(stamp)) * 1e6);
  return 0;
}

}  // namespace tassilo
