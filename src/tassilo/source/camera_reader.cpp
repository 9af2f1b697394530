#include <atomic>
#include <mutex>
#include <thread>
#include <utility>

#include "tassilo/base/error.h"
#include "tassilo/source/internal/frame_reader.h"
#include "tassilo/source/internal/jpeg_decoder.h"
#include "tassilo/source/internal/live_camera.h"
#include "tassilo/source/newest_slot.h"

namespace tassilo {
namespace {

constexpr int kPatienceMs = 100;  // how long an interruption may be overlooked

std::string device_of(const std::string& location) {
  constexpr std::string_view kScheme = "v4l2:";
  return location.starts_with(kScheme) ? location.substr(kScheme.size()) : location;
}

/// What the grabbing thread has to tell, apart from frames.
class Bulletin {
 public:
  void post(LiveCamera& camera) {
    const std::lock_guard lock(mutex_);
    for (CameraNews& news : camera.news()) news_.push_back(std::move(news));
    counts_ = camera.counts();
    description_ = camera.description();
  }
  void post(const Error& fault) {
    const std::lock_guard lock(mutex_);
    fault_ = fault;
  }
  std::vector<CameraNews> news() {
    const std::lock_guard lock(mutex_);
    return std::exchange(news_, {});
  }
  std::optional<Error> fault() const {
    const std::lock_guard lock(mutex_);
    return fault_;
  }
  CameraCounts counts() const {
    const std::lock_guard lock(mutex_);
    return counts_;
  }
  std::string description() const {
    const std::lock_guard lock(mutex_);
    return description_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<CameraNews> news_;
  CameraCounts counts_;
  std::string description_;
  std::optional<Error> fault_;
};

/// A thread of its own grabs frames as they come and leaves the newest one to the reading thread. A JPEG is decoded by
/// the reader: those that are replaced cost nothing.
class CameraReader final : public FrameReader {
 public:
  CameraReader(const SourceOptions& options, SystemCalls& calls)
      : path_(device_of(options.location)),
        interrupted_(options.interrupted),
        news_(options.camera_news),
        camera_(calls, path_, options.camera) {
    if (camera_.format().format == CameraFormat::mjpeg) decoder_.emplace(path_);
    bulletin_.post(camera_);
    thread_ = std::jthread([this](const std::stop_token& stop) { grab(stop); });
  }

  std::optional<Frame> next() override {
    while (!interrupted_ || !interrupted_()) {
      if (news_)
        for (const CameraNews& news : bulletin_.news()) news_(news);
      if (const auto fault = bulletin_.fault()) throw *fault;
      std::optional<GrabbedFrame> grabbed = slot_.take(std::chrono::milliseconds(kPatienceMs));
      if (!grabbed) continue;
      if (grabbed->jpeg.empty()) return std::move(grabbed->frame);
      if (std::optional<Frame> decoded = decode(*grabbed)) return decoded;
      ++undecodable_;
    }
    return std::nullopt;
  }

  SourceInfo info() const override {
    SourceInfo info;
    info.name = path_;
    info.description = bulletin_.description();
    info.live = true;
    return info;
  }

  std::optional<double> now() const override { return camera_.now(); }

  CameraCounts counts() const override {
    CameraCounts counts = bulletin_.counts();
    counts.broken += undecodable_;
    counts.replaced = slot_.replaced();
    return counts;
  }

 private:
  void grab(const std::stop_token& stop) {
    try {
      while (!stop.stop_requested()) {
        std::optional<GrabbedFrame> grabbed = camera_.grab(kPatienceMs);
        bulletin_.post(camera_);
        if (grabbed) slot_.put(std::move(*grabbed));
      }
    } catch (const Error& fault) {
      bulletin_.post(fault);
    }
  }

  /// Nothing for one that is damaged or of another size.
  std::optional<Frame> decode(const GrabbedFrame& grabbed) {
    std::optional<Frame> frame = decoder_->decode(grabbed.jpeg);
    const AgreedFormat& format = camera_.format();
    if (!frame || frame->view.width() != format.width || frame->view.height() != format.height) return std::nullopt;
    frame->index = grabbed.frame.index;
    frame->t = grabbed.frame.t;
    frame->range = grabbed.frame.range;
    return frame;
  }

  std::string path_;
  std::function<bool()> interrupted_;
  std::function<void(const CameraNews&)> news_;
  NewestSlot<GrabbedFrame> slot_;  ///< Outlived by the camera's memory, which its frame keeps.
  Bulletin bulletin_;
  LiveCamera camera_;  ///< The thread's own, but for what never changes.
  std::optional<JpegDecoder> decoder_;
  std::int64_t undecodable_ = 0;
  std::jthread thread_;  ///< Last: stopped before anything it uses is gone.
};

}  // namespace

std::unique_ptr<FrameReader> make_camera_reader(const SourceOptions& options, SystemCalls& calls) {
  return std::make_unique<CameraReader>(options, calls);
}

}  // namespace tassilo
