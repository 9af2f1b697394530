// A camera without hardware, for the real program: preloaded, this library answers for one device what the kernel
// would, and passes everything else on. The device is a file in memory, so that mapping it needs no help.
//
// What it does stands in the environment variable TASSILO_FAKE_CAMERA, words `key=value`:
//   path=/dev/video42   the device, the first word; others are as they are
//   frames=FILE         raw frames in the format below, or Motion JPEG
//   format=yuyv|uyvy|nv12|mjpeg, width=, height=, fps=
//   once=1              after the last frame nothing comes any more; else they come again
//   lockstep=1          a frame comes only when the program has given back all buffers
//   lost=AT:COUNT       COUNT numbers are left out before frame AT (0-based, of all that were sent)
//   error=AT            frame AT is marked as broken;  short=AT  is too small;  again=AT  is not there when asked for
//   fails=AT            reading frame AT fails: EIO
//   stall=AT            no frame AT before it is started again
//   unplug=AT:SECONDS   gone for that long before frame AT
#include <dlfcn.h>
#include <fcntl.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <deque>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <sstream>
#include <string>
#include <vector>

namespace {

double now_s() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class Function>
Function* next_function(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

int refuse(int code) {
  errno = code;
  return -1;
}

class Camera {
 public:
  Camera() {
    const char* const script = std::getenv("TASSILO_FAKE_CAMERA");
    std::istringstream words(script != nullptr ? script : "");
    for (std::string word; words >> word;) {
      const auto equals = word.find('=');
      if (equals != std::string::npos) script_[word.substr(0, equals)] = word.substr(equals + 1);
    }
    load();
  }

  bool is_fd(int fd) const { return fd >= 0 && fd == fd_; }

  int open() {
    const std::lock_guard lock(mutex_);
    if (now_s() < back_at_) return refuse(ENOENT);
    back_at_ = 0;
    streaming_ = false;
    queue_.clear();
    fd_ = memfd_create("camera", MFD_CLOEXEC);
    return fd_;
  }
  void close() {
    const std::lock_guard lock(mutex_);
    fd_ = -1;
  }

  int poll(pollfd& watched, int timeout_ms) {
    const double end = now_s() + timeout_ms / 1000.;
    do {
      watched.revents = static_cast<short>(events());
      if (watched.revents != 0) return 1;
      usleep(500);
    } while (now_s() < end);
    return 0;
  }

  int ioctl(unsigned long request, void* argument) {
    const std::lock_guard lock(mutex_);
    if (back_at_ > 0) return refuse(ENODEV);
    const int code = answer(request, argument);
    return code == 0 ? 0 : refuse(code);
  }

 private:
  int number(const std::string& key) const {
    const auto it = script_.find(key);
    return it == script_.end() ? 0 : std::atoi(it->second.c_str());
  }
  /// Whether it is time for `key`: once.
  bool is_due(const std::string& key) {
    const auto it = script_.find(key);
    if (it == script_.end() || std::atoi(it->second.c_str()) != sent_) return false;
    value_ = std::atof(it->second.c_str() + std::min(it->second.find(':') + 1, it->second.size()));
    script_.erase(it);
    return true;
  }

  void load() {
    width_ = number("width");
    height_ = number("height");
    interval_ = 1. / number("fps");
    const std::string format = script_.at("format");
    fourcc_ = format == "yuyv"   ? V4L2_PIX_FMT_YUYV
              : format == "uyvy" ? V4L2_PIX_FMT_UYVY
              : format == "nv12" ? V4L2_PIX_FMT_NV12
                                 : V4L2_PIX_FMT_MJPEG;
    std::ifstream file(script_.at("frames"), std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), {});
    if (fourcc_ == V4L2_PIX_FMT_MJPEG) {
      for (std::size_t begin = 0; begin < bytes.size();) {
        const auto end = bytes.find("\xff\xd9\xff\xd8", begin);
        const std::size_t next = end == std::string::npos ? bytes.size() : end + 2;
        frames_.push_back(bytes.substr(begin, next - begin));
        begin = next;
      }
    } else {
      const auto size = static_cast<std::size_t>(width_ * height_) * (fourcc_ == V4L2_PIX_FMT_NV12 ? 3 : 4) / 2;
      for (std::size_t begin = 0; begin + size <= bytes.size(); begin += size)
        frames_.push_back(bytes.substr(begin, size));
    }
    for (const std::string& frame : frames_) length_ = std::max(length_, frame.size());
    length_ = (length_ + 4095) / 4096 * 4096;
  }

  int events() {
    const std::lock_guard lock(mutex_);
    if (is_due("unplug")) back_at_ = now_s() + value_;
    if (back_at_ > 0 || !streaming_) return POLLERR;
    if (is_due("stall")) stalled_ = true;
    return is_frame_due() ? POLLIN : 0;
  }

  bool is_frame_due() const {
    const bool over = number("once") != 0 && sent_ >= static_cast<int>(frames_.size());
    const bool is_waiting = number("lockstep") != 0 && queue_.size() < buffers_;
    return !over && !stalled_ && !is_waiting && !queue_.empty() && now_s() >= due_at_;
  }

  int answer(unsigned long request, void* argument) {
    auto& buffer = *static_cast<v4l2_buffer*>(argument);  // if it is one
    switch (request) {
      case VIDIOC_QUERYCAP: {
        auto& about = *static_cast<v4l2_capability*>(argument);
        std::strcpy(reinterpret_cast<char*>(about.card), "Preloaded Camera");
        std::strcpy(reinterpret_cast<char*>(about.bus_info), "nowhere-1.2");
        about.capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
        return 0;
      }
      case VIDIOC_ENUM_FMT:
        static_cast<v4l2_fmtdesc*>(argument)->pixelformat = fourcc_;
        return static_cast<v4l2_fmtdesc*>(argument)->index == 0 ? 0 : EINVAL;
      case VIDIOC_ENUM_FRAMESIZES: {
        auto& size = *static_cast<v4l2_frmsizeenum*>(argument);
        size.type = V4L2_FRMSIZE_TYPE_DISCRETE;
        size.discrete = {static_cast<__u32>(width_), static_cast<__u32>(height_)};
        return size.index == 0 ? 0 : EINVAL;
      }
      case VIDIOC_ENUM_FRAMEINTERVALS: {
        auto& interval = *static_cast<v4l2_frmivalenum*>(argument);
        interval.type = V4L2_FRMIVAL_TYPE_DISCRETE;
        interval.discrete = {1, static_cast<__u32>(number("fps"))};
        return interval.index == 0 ? 0 : EINVAL;
      }
      case VIDIOC_TRY_FMT:
      case VIDIOC_S_FMT: {
        auto& pix = static_cast<v4l2_format*>(argument)->fmt.pix;
        pix.width = static_cast<__u32>(width_);
        pix.height = static_cast<__u32>(height_);
        pix.pixelformat = fourcc_;
        pix.bytesperline = fourcc_ == V4L2_PIX_FMT_MJPEG ? 0 : pix.width * (fourcc_ == V4L2_PIX_FMT_NV12 ? 1 : 2);
        pix.sizeimage = static_cast<__u32>(length_);
        pix.colorspace = V4L2_COLORSPACE_SRGB;
        pix.quantization = V4L2_QUANTIZATION_DEFAULT;
        pix.ycbcr_enc = V4L2_YCBCR_ENC_DEFAULT;
        return 0;
      }
      case VIDIOC_G_PARM:
      case VIDIOC_S_PARM:
        static_cast<v4l2_streamparm*>(argument)->parm.capture.capability = V4L2_CAP_TIMEPERFRAME;
        static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe = {1, static_cast<__u32>(number("fps"))};
        return 0;
      case VIDIOC_QUERYCTRL: {
        auto& about = *static_cast<v4l2_queryctrl*>(argument);
        if (!controls_.contains(about.id)) return EINVAL;
        about.maximum = 1000;
        return 0;
      }
      case VIDIOC_S_CTRL:
      case VIDIOC_G_CTRL: {
        auto& control = *static_cast<v4l2_control*>(argument);
        if (!controls_.contains(control.id)) return EINVAL;
        if (request == VIDIOC_S_CTRL) controls_[control.id] = control.value;
        control.value = controls_[control.id];
        return 0;
      }
      case VIDIOC_REQBUFS:
        buffers_ = static_cast<v4l2_requestbuffers*>(argument)->count;
        return ftruncate(fd_, static_cast<off_t>(buffers_ * length_)) == 0 ? 0 : errno;
      case VIDIOC_QUERYBUF:
        buffer.length = static_cast<__u32>(length_);
        buffer.m.offset = static_cast<__u32>(buffer.index * length_);
        return 0;
      case VIDIOC_QBUF:
        queue_.push_back(buffer.index);
        return 0;
      case VIDIOC_DQBUF:
        return dequeue(buffer);
      case VIDIOC_STREAMON:
        streaming_ = true;
        stalled_ = false;
        sequence_ = 0;
        due_at_ = std::max(now_s(), due_at_);
        return 0;
      case VIDIOC_STREAMOFF:
        streaming_ = false;
        queue_.clear();
        return 0;
      default:
        return ENOTTY;
    }
  }

  int dequeue(v4l2_buffer& buffer) {
    if (!is_frame_due() || is_due("again")) return EAGAIN;
    if (is_due("fails")) return EIO;
    if (is_due("lost")) sequence_ += static_cast<__u32>(value_);
    const std::string& frame = frames_[static_cast<std::size_t>(sent_) % frames_.size()];
    buffer.index = queue_.front();
    queue_.pop_front();
    if (pwrite(fd_, frame.data(), frame.size(), static_cast<off_t>(buffer.index * length_)) < 0) return errno;
    buffer.bytesused = static_cast<__u32>(frame.size());
    buffer.flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
    if (is_due("error")) buffer.flags |= V4L2_BUF_FLAG_ERROR;
    if (is_due("short")) buffer.bytesused /= 2;
    // Evenly spaced, also when the program was late to ask.
    const double stamp = due_at_;
    due_at_ += interval_;
    buffer.timestamp.tv_sec = static_cast<long>(stamp);
    buffer.timestamp.tv_usec = static_cast<long>((stamp - static_cast<double>(buffer.timestamp.tv_sec)) * 1e6);
    buffer.sequence = sequence_++;
    ++sent_;
    return 0;
  }

  std::map<std::string, std::string> script_;
  std::vector<std::string> frames_;
  std::map<__u32, int> controls_{{V4L2_CID_GAIN, 32}, {V4L2_CID_AUTOGAIN, 1}};
  int width_ = 0, height_ = 0;
  double interval_ = 1;
  __u32 fourcc_ = 0;
  std::size_t length_ = 0, buffers_ = 0;

  std::mutex mutex_;
  int fd_ = -1;
  bool streaming_ = false, stalled_ = false;
  double back_at_ = 0, due_at_ = 0, value_ = 0;
  int sent_ = 0;
  __u32 sequence_ = 0;
  std::deque<__u32> queue_;
};

// Made when it is opened first, as what makes it opens files itself; never destroyed: the program may close it last.
Camera* camera = nullptr;

bool is_camera(const char* path) {
  const char* const script = std::getenv("TASSILO_FAKE_CAMERA");
  return path != nullptr && script != nullptr && std::string(script).starts_with("path=" + std::string(path) + " ");
}

int open_file(const char* name, const char* path, int flags, int mode) {
  if (!is_camera(path)) return next_function<int(const char*, int, ...)>(name)(path, flags, mode);
  if (camera == nullptr) camera = new Camera;
  return camera->open();
}

bool is_camera(int fd) { return camera != nullptr && camera->is_fd(fd); }

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const int mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, int) : 0;
  va_end(more);
  return open_file("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const int mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, int) : 0;
  va_end(more);
  return open_file("open64", path, flags, mode);
}

int close(int fd) {
  if (is_camera(fd)) camera->close();
  return next_function<int(int)>("close")(fd);
}

int ioctl(int fd, unsigned long request, ...) {
  va_list more;
  va_start(more, request);
  void* const argument = va_arg(more, void*);
  va_end(more);
  if (is_camera(fd)) return camera->ioctl(request, argument);
  return next_function<int(int, unsigned long, ...)>("ioctl")(fd, request, argument);
}

int poll(pollfd* watched, nfds_t count, int timeout_ms) {
  if (count == 1 && is_camera(watched->fd)) return camera->poll(*watched, timeout_ms);
  return next_function<int(pollfd*, nfds_t, int)>("poll")(watched, count, timeout_ms);
}

}  // extern "C"
