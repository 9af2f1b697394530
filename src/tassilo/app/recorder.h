#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tassilo/app/configuration_watch.h"
#include "tassilo/app/odometry_input.h"
#include "tassilo/files/start_state_file.h"
#include "tassilo/record/recording_part.h"

namespace tassilo {

/// How it stands with recording; of the last recording where none is going on.
struct RecordingState {
  bool on = false;
  bool finishing = false;  ///< No frames are added any more, but the last ones are not yet on the disk.
  std::string folder;      ///< Below which recordings are made.
  std::string name;        ///< Of the folder of the newest part, in there; empty: none yet.
  double seconds = 0;      ///< Since it was started, or how long it took.
  int parts = 0;
  std::int64_t frames = 0;   ///< On the disk.
  std::int64_t dropped = 0;  ///< Seen, but not recorded: the disk was too slow.
  std::int64_t bytes = 0;    ///< On the disk.
  std::string trouble;       ///< Why it ended by itself; empty: it did not.
};

/// Records a run so that the same can be seen again: what comes in, what is known before it, and the configuration it
/// is seen with.
///
/// A recording is a folder named by the time, UTC, that did not exist before: NAME, and NAME.part2, NAME.part3, ... for
/// what cannot be seen again in one go: the configuration was changed, the source began again, or frames are missing
/// since the disk was too slow. Each part has its own configuration and state to begin with, so a run of its video,
/// odometry and robot.yaml gives its scenes to the last digit.
///
/// A thread of its own encodes and writes, from a queue of at most kMaxWaiting bytes. The vision does not wait for it:
/// frames that do not fit are not recorded, are counted, and end the part. With `waits`, for sources that lose nothing,
/// it does. When the disk takes no more, or hardly any more, the recording ends and says why; the vision goes on.
///
/// threads  `before`, `after`, `finish` and `news` from the run's thread, the rest from any; only `finish`, and `after`
///          with `waits`, wait for the disk
class Recorder {
 public:
  static constexpr std::int64_t kMaxWaiting = 64 << 20;    ///< Of pixels and what belongs to them. [B]
  static constexpr std::uintmax_t kLeastFree = 100 << 20;  ///< A recording ends before a disk has less. [B]

  /// folder   below which recordings are made; made itself with the first one
  Recorder(std::filesystem::path folder, bool waits);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// From the next frame on. Nothing when it is on already. Throws Error when the folder cannot be written into, or no
  /// more frames come.
  void start();
  /// The last frame that was seen is the last one. Nothing when it is off.
  void stop();
  RecordingState state() const;

  /// Before a frame is seen, with what is known then.
  void before(const Frame& frame, const std::shared_ptr<const Configuration>& configuration,
              const VisionHistory& history, const OdometryInput& odometry);
  /// After that.
  void after(const Frame& frame, const Scene& scene, const OdometryInput& odometry);
  /// What happened since the last call, for people, in lines without their ends.
  std::vector<std::string> news();
  /// No more frames come: all is on the disk when it returns.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  struct Begin {
    std::shared_ptr<const Configuration> configuration;
    std::optional<StartState> state;
    bool has_odometry = false;
    std::string why;
  };
  struct Item {
    explicit Item(int of_recording) : recording(of_recording) {}
    int recording;
    std::optional<Begin> begin;  ///< Of a part; goes with its first frame.
    std::vector<OdometryLine> odometry;
    std::optional<Frame> frame;  ///< Nothing: the part ends.
    Scene scene;
    std::int64_t bytes = 0;
  };

  // With the mutex held.
  void begin_part(const Frame& frame, const std::shared_ptr<const Configuration>& configuration,
                  const VisionHistory& history, const OdometryInput& odometry);
  void end_part(std::string why);
  void push(Item item);
  // On the thread.
  void write_all();
  void write(Item& item);
  void open_part(int recording, const Begin& begin);
  void close_part();
  void fail(int recording, const std::string& why);

  const std::filesystem::path folder_;
  const bool waits_;
  mutable std::mutex mutex_;  ///< Guards all down to the thread's own.
  std::condition_variable there_is_work_, there_is_room_;
  std::deque<Item> queue_;
  std::int64_t waiting_ = 0;  ///< Bytes in the queue and at work.
  bool busy_ = false, ending_ = false, over_ = false;
  int recording_ = 0;  ///< Counts them.
  RecordingState state_;
  Clock::time_point started_;
  std::vector<std::string> news_;
  std::string start_name_;     ///< By the time of the start.
  bool is_part_open_ = false;  ///< Frames go into a part.
  bool catches_up_ = false;    ///< No new part before the queue is half empty.
  bool is_left_out_ = false;   ///< The frame being seen, for that reason.
  std::string why_next_;       ///< Why the next part begins.
  std::optional<Begin> begin_;
  std::vector<OdometryLine> begin_odometry_;
  std::shared_ptr<const Configuration> configuration_;
  double last_t_ = 0;
  std::size_t next_sample_ = 0;  ///< Of an odometry that is whole.

  // The thread's own.
  std::optional<RecordingPart> part_;
  int part_recording_ = 0, part_number_ = 0;
  std::string base_name_;          ///< Of the first part.
  std::int64_t bytes_before_ = 0;  ///< Of the parts before.
  int failed_ = 0;                 ///< The recording that failed; the rest of it is thrown away.
  Clock::time_point flushed_at_;
  std::thread thread_;
};

}  // namespace tassilo
