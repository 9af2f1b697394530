#include "tassilo/app/recorder.h"

#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <utility>

#include "tassilo/app/recorded_configuration.h"
#include "tassilo/base/error.h"
#include "tassilo/files/kept_copies.h"
#include "tassilo/files/scene_json.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

/// What comes further from a frame than that says nothing of it: twice the longest gap that odometry bridges. [s]
constexpr double kReach = 2 * Odometry::kMaxGap;
constexpr auto kFlushPause = std::chrono::seconds(2);

std::int64_t pixel_bytes(const FrameView& view) {
  const std::int64_t pixels = std::int64_t{view.width()} * view.height();
  const bool is_420 = view.format() == PixelFormat::yuv420p || view.format() == PixelFormat::nv12;
  return is_420 ? pixels * 3 / 2 : pixels * 2;
}

/// Makes a folder that was not there. Throws Error when it cannot be made; false when there is one of that name.
bool made(const fs::path& folder) {
  std::error_code problem;
  const bool is_new = fs::create_directory(folder, problem);
  if (problem) throw Error(folder.string(), "cannot be made a folder: " + problem.message());
  return is_new;
}

/// What else runs on the robot needs a disk, too.
void check_room(const fs::path& folder) {
  std::error_code problem;
  const fs::space_info space = fs::space(folder, problem);
  constexpr std::uintmax_t mega = 1 << 20;
  if (!problem && space.available < Recorder::kLeastFree)
    throw Error(folder.string(), "has " + std::to_string(space.available / mega) + " MiB left on its disk, must have " +
                                     std::to_string(Recorder::kLeastFree / mega) + " for other things");
}

void make_writable(const fs::path& folder) {
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (problem) throw Error(folder.string(), "cannot be made a folder for recordings: " + problem.message());
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw Error(folder.string(), "is no folder for recordings that can be written into");
  check_room(folder);
}

}  // namespace

Recorder::Recorder(fs::path folder, bool waits)
    : folder_(fs::absolute(folder).lexically_normal()), waits_(waits), thread_([this] { write_all(); }) {
  const std::lock_guard lock(mutex_);
  state_.folder = folder_.string();
}

Recorder::~Recorder() {
  stop();
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  there_is_work_.notify_all();
  thread_.join();
}

void Recorder::start() {
  // Before the mutex: the vision waits for it, and must not wait for a disk.
  make_writable(folder_);
  const std::lock_guard lock(mutex_);
  if (state_.on) return;
  if (over_) throw Error("recording", "cannot begin: no more frames come");
  ++recording_;
  state_ = {};
  state_.on = true;
  state_.folder = folder_.string();
  started_ = Clock::now();
  start_name_ = time_for_names();
  why_next_ = "as it was started";
  catches_up_ = is_left_out_ = false;
}

void Recorder::stop() {
  const std::lock_guard lock(mutex_);
  if (!state_.on) return;
  state_.on = false;
  state_.seconds = std::chrono::duration<double>(Clock::now() - started_).count();
  end_part("");
  there_is_room_.notify_all();
}

RecordingState Recorder::state() const {
  const std::lock_guard lock(mutex_);
  RecordingState state = state_;
  state.finishing = !state.on && (busy_ || !queue_.empty());
  if (state.on) state.seconds = std::chrono::duration<double>(Clock::now() - started_).count();
  return state;
}

std::vector<std::string> Recorder::news() {
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, {});
}

void Recorder::before(const Frame& frame, const std::shared_ptr<const Configuration>& configuration,
                      const VisionHistory& history, const OdometryInput& odometry) {
  const std::lock_guard lock(mutex_);
  is_left_out_ = false;
  if (!state_.on) return;
  if (is_part_open_ && configuration != configuration_)
    end_part("the configuration was changed");
  else if (is_part_open_ && frame.t <= last_t_)
    end_part("the source began again");
  if (is_part_open_) return;
  is_left_out_ = catches_up_ && waiting_ > kMaxWaiting / 2;
  if (!is_left_out_) begin_part(frame, configuration, history, odometry);
}

void Recorder::begin_part(const Frame& frame, const std::shared_ptr<const Configuration>& configuration,
                          const VisionHistory& history, const OdometryInput& odometry) {
  // As the vision asks for it: what is not earlier than the frame is of another drive.
  const auto* const belief = history.beliefs.before(frame.t);
  const auto* const tracks = history.tracks.before(frame.t);
  const bool goes_on = belief != nullptr && belief == history.beliefs.latest() && tracks != nullptr;
  catches_up_ = false;
  is_part_open_ = true;
  configuration_ = configuration;
  begin_.emplace(Begin{configuration, std::nullopt, odometry.get() != nullptr, std::exchange(why_next_, "")});
  if (goes_on) begin_->state = {belief->t, belief->value, tracks->value};
  // What was known before the first frame, as far back as its motion may depend on it.
  const double from = (goes_on ? belief->t : frame.t) - kReach;
  begin_odometry_.clear();
  next_sample_ = 0;
  if (const Odometry* const samples = odometry.get())
    for (std::size_t i = 0; i < samples->size(); ++i) {
      const OdometrySample sample = (*samples)[i];
      if (sample.t < from)
        next_sample_ = i + 1;
      else if (odometry.is_whole())
        break;
      else
        begin_odometry_.push_back({sample, std::nullopt});
    }
}

/// The next frame that is recorded begins a part, because of `why`.
void Recorder::end_part(std::string why) {
  why_next_ = std::move(why);
  // A part without frames is none.
  if (is_part_open_ && !begin_) push(Item(recording_));
  begin_.reset();
  is_part_open_ = false;
  configuration_ = nullptr;
}

void Recorder::push(Item item) {
  waiting_ += item.bytes;
  queue_.push_back(std::move(item));
  there_is_work_.notify_one();
}

void Recorder::after(const Frame& frame, const Scene& scene, const OdometryInput& odometry) {
  std::unique_lock lock(mutex_);
  if (is_left_out_ && state_.on) ++state_.dropped;
  if (!is_part_open_) return;

  Item item(recording_);
  item.frame = frame;
  item.scene = scene;
  if (begin_) item.odometry = std::move(begin_odometry_);
  if (odometry.is_whole()) {
    const Odometry* const samples = odometry.get();
    for (; samples != nullptr && next_sample_ < samples->size() && (*samples)[next_sample_].t <= frame.t + kReach;
         ++next_sample_)
      item.odometry.push_back({(*samples)[next_sample_], std::nullopt});
  } else if (!begin_) {
    for (const OdometrySample& sample : odometry.arrived()) item.odometry.push_back({sample, frame.index});
  }
  constexpr std::int64_t of_a_scene = 16 << 10;
  item.bytes =
      pixel_bytes(frame.view) + of_a_scene + static_cast<std::int64_t>(item.odometry.size() * sizeof(OdometryLine));
  const auto fits = [&] { return waiting_ == 0 || waiting_ + item.bytes <= kMaxWaiting; };
  if (waits_) {
    there_is_room_.wait(lock, [&] { return fits() || !is_part_open_; });
    if (!is_part_open_) return;
  } else if (!fits()) {
    ++state_.dropped;
    end_part("frames before it were not recorded, the disk was too slow");
    catches_up_ = true;
    return;
  }
  item.begin = std::exchange(begin_, std::nullopt);
  last_t_ = frame.t;
  push(std::move(item));
}

void Recorder::finish() {
  stop();
  std::unique_lock lock(mutex_);
  over_ = true;
  there_is_room_.wait(lock, [&] { return queue_.empty() && !busy_; });
}

void Recorder::write_all() {
  std::unique_lock lock(mutex_);
  for (;;) {
    there_is_work_.wait(lock, [&] { return ending_ || !queue_.empty(); });
    if (queue_.empty()) return;
    const std::int64_t bytes = queue_.front().bytes;
    {
      Item item = std::move(queue_.front());
      queue_.pop_front();
      busy_ = true;
      lock.unlock();
      try {
        write(item);
      } catch (const std::exception& error) {  // whatever it is, the vision goes on
        fail(item.recording, error.what());
      }
    }
    lock.lock();
    busy_ = false;
    waiting_ -= bytes;
    there_is_room_.notify_all();
  }
}

void Recorder::write(Item& item) {
  if (item.recording == failed_) return;
  if (!item.frame) return close_part();
  if (item.begin) open_part(item.recording, *item.begin);
  for (const OdometryLine& line : item.odometry) part_->write(line);
  part_->write(*item.frame);
  // What was done to the configuration meanwhile is not seen again: a part has one from its beginning.
  std::erase_if(item.scene.why, [](const auto& why) { return why.first == "configuration"; });
  part_->write_scene(to_json_line(item.scene));
  if (const auto now = Clock::now(); now - flushed_at_ > kFlushPause) {
    part_->flush_to_disk();
    flushed_at_ = now;
    check_room(folder_);
  }
  const std::lock_guard lock(mutex_);
  if (item.recording != recording_) return;
  ++state_.frames;
  state_.bytes = bytes_before_ + part_->bytes();
}

void Recorder::open_part(int recording, const Begin& begin) {
  std::string start_name;
  {
    const std::lock_guard lock(mutex_);
    start_name = start_name_;
  }
  if (recording != part_recording_) {
    part_recording_ = recording;
    part_number_ = 0;
    bytes_before_ = 0;
    base_name_ = start_name;
    for (int k = 2; !made(folder_ / base_name_); ++k) base_name_ = start_name + "-" + std::to_string(k);
  }
  std::string name = base_name_;
  if (++part_number_ > 1) {
    name += ".part" + std::to_string(part_number_);
    if (!made(folder_ / name)) throw Error((folder_ / name).string(), "exists already");
  }
  const std::string remarks =
      "# Recording " + base_name_ + ", part " + std::to_string(part_number_) + ", " + begin.why +
      "; tassilo " TASSILO_VERSION "\n# The same scenes again: tassilo run --robot robot.yaml --source video.mkv" +
      (begin.has_odometry ? " --odometry odometry.jsonl" : "") + " --output again.jsonl\n";
  write_configuration(folder_ / name, *begin.configuration, begin.state, remarks);
  part_.emplace(folder_ / name, begin.has_odometry);
  flushed_at_ = Clock::now();
  const std::lock_guard lock(mutex_);
  news_.push_back("recording into " + (folder_ / name).string() + ", " + begin.why);
  if (recording != recording_) return;
  state_.name = name;
  state_.parts = part_number_;
}

void Recorder::close_part() {
  if (!part_) return;
  part_->finish();
  part_->flush_to_disk();
  bytes_before_ += part_->bytes();
  part_.reset();
  const std::lock_guard lock(mutex_);
  if (part_recording_ == recording_) state_.bytes = bytes_before_;
}

void Recorder::fail(int recording, const std::string& why) {
  part_.reset();
  failed_ = recording;
  const std::lock_guard lock(mutex_);
  news_.push_back("recording ended: " + why);
  if (recording != recording_) return;
  if (state_.on) state_.seconds = std::chrono::duration<double>(Clock::now() - started_).count();
  state_.on = false;
  state_.trouble = why;
  begin_.reset();
  is_part_open_ = false;
  configuration_ = nullptr;
}

}  // namespace tassilo
