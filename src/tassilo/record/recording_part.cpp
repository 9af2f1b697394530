#include "tassilo/record/recording_part.h"

#include <fcntl.h>
#include <unistd.h>

#include "tassilo/base/contract.h"
#include "tassilo/files/frames_file.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVideo = "video.mkv";
constexpr const char* kScenes = "scenes.jsonl";
constexpr const char* kOdometry = "odometry.jsonl";

std::int64_t size_of(std::string_view line) { return static_cast<std::int64_t>(line.size()) + 1; }

}  // namespace

RecordingPart::RecordingPart(const fs::path& folder, bool has_odometry)
    : folder_(folder), video_((folder / kVideo).string()), scenes_((folder / kScenes).string()) {
  if (has_odometry) odometry_.emplace((folder / kOdometry).string());
}

void RecordingPart::write(const OdometryLine& odometry) {
  expects(odometry_.has_value(), "RecordingPart: a part without odometry gets none");
  const std::string line = odometry_line(odometry);
  odometry_->write(line);
  line_bytes_ += size_of(line);
}

void RecordingPart::write(const Frame& frame) { video_.write(frame); }

void RecordingPart::write_scene(std::string_view line) {
  scenes_.write(line);
  line_bytes_ += size_of(line);
}

void RecordingPart::finish() { video_.finish(); }

void RecordingPart::flush_to_disk() const {
  for (const fs::path& name : {fs::path(kVideo), stamps_file_of(kVideo), fs::path(kScenes), fs::path(kOdometry)}) {
    const int descriptor = ::open((folder_ / name).c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) continue;
    ::fdatasync(descriptor);  // what cannot be written is told by the next write
    ::close(descriptor);
  }
}

}  // namespace tassilo
