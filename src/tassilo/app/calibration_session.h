#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tassilo/calibrate/intrinsics.h"
#include "tassilo/calibrate/target.h"
#include "tassilo/files/png.h"
#include "tassilo/image/frame.h"

namespace tassilo {

/// A calibration of the camera while somebody holds targets into its view: views, what they make, the camera file.
///
/// A view is captured by itself when a target is found that is at rest and shows otherwise than in every view before.
/// At rest: no point moved by more than .25 % of the image's diagonal since the look before. Looks are at least 100 ms
/// apart and a camera exposes for some 10 ms, so that motion blur, which displaces the points it smears, stays below a
/// few tenths of a pixel. A single image (a file, or one of a folder) counts as at rest, since nothing is known of how
/// it moved. Otherwise: the middle of the points is 5 % of the diagonal away, the target is 15 % larger or smaller or
/// turned by 9 degrees, or tilted so that its points lie 6 % differently, some 20 degrees.
///
/// What cannot be done throws Error with the reason, and changes nothing.
///
/// threads  any. Targets are looked for, and the camera is worked out, in two threads of its own; `wants_frame` waits
///          for neither. The destructor waits for both, some seconds at worst.
class CalibrationSession {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMostViews = 60, kMostTargets = 4;

  /// camera_file   that `save` replaces; its lens model is the first choice. Empty: there is none.
  explicit CalibrationSession(std::filesystem::path camera_file);
  ~CalibrationSession();
  CalibrationSession(const CalibrationSession&) = delete;
  CalibrationSession& operator=(const CalibrationSession&) = delete;

  /// The robot file names another camera file, or none (empty), from now on.
  void set_file(const std::filesystem::path& camera_file);

  /// Fields that are there are changed.
  struct Change {
    std::optional<bool> is_on = {}, is_automatic = {};
    std::optional<std::vector<Target>> targets = {};  ///< 1..4; the first that is found in a frame counts.
    std::optional<LensModel> model = {};
  };
  /// Views are kept; another target or model drops the result. Throws Error for no, too many or bad targets.
  void change(const Change& change);

  /// A frame that was looked at.
  struct Look {
    std::int64_t frame = 0;
    std::optional<TargetView> view;
    std::string verdict;  ///< In words: captured, or why it was not. Lower-case, no full stop.
    bool is_captured = false;
  };
  struct View {
    std::string id;  ///< Never given twice.
    std::int64_t frame = 0;
    TargetView view;
  };
  struct State {
    bool is_on = false, is_automatic = true, is_solving = false;
    std::vector<Target> targets;
    LensModel model = LensModel::plumb_bob;
    ImageSize size;           ///< Of the frames; that of the camera file before the first, 0 without one. [px]
    std::optional<Look> now;  ///< The last; nothing before the first.
    std::vector<View> views;  ///< In the order in which they were captured.
    Coverage coverage;        ///< Of all views; without cells while the size is not known.
    std::shared_ptr<const Intrinsics> result;  ///< Of these views, by this model; null: none.
    std::string failure;                       ///< Why the last try failed; empty when it did not.
    std::filesystem::path file;
    std::string refusal;    ///< Why nothing can be saved; empty when it can.
    bool is_saved = false;  ///< The file has this result.
  };
  /// Reads the camera file, which takes some tenths of a millisecond.
  State state() const;

  /// Somebody looks on: for three seconds more frames are looked at, also when no views are captured by themselves.
  void watched();
  /// Does it look for targets now, and has it time for one more frame? Does not wait.
  bool wants_frame() const;
  /// Takes a frame to look at, in place of one that still waits. Copies its brightness: the frame is not kept.
  void see(const Frame& frame);

  /// Captures the next frame if it shows a target, however it moves and whatever views there are. Waits for it. Throws
  /// Error when it is not on, there are 60 views, no frame comes, or the frame shows no target.
  void capture_next(std::chrono::milliseconds patience = std::chrono::seconds(2));
  /// False when there is no such view.
  bool forget(const std::string& id);
  void forget_all();

  /// Begins to work the camera out: some seconds. Throws Error when that goes on already or there are too few views.
  void solve();
  /// The picture of the residuals; nothing without a result. Some ms.
  std::optional<RgbImage> residuals() const;

  /// Writes the result with name and mount of the file that is there, which is kept in the folder STEM_history beside
  /// it, and has `take_over` use it; when that throws, the former file is written back. Throws Error when there is no
  /// result, no file that can be read, one for another size of images, or it cannot be written.
  void save(const std::function<void()>& take_over);

 private:
  struct Waiting {
    GrayImage image;
    std::int64_t frame = 0;
    bool is_single = false;  ///< It is no part of a video.
  };

  void look_on();
  void judge(Look& look, bool is_single, bool is_asked, ImageSize size);
  void capture(Look& look);
  std::string why_not(const TargetView& view, bool is_single) const;
  void drop_result();
  void work();

  std::filesystem::path file_;  ///< Of who answers requests.
  std::mutex saving_;           ///< Held while the file is replaced; before the other one.
  mutable std::mutex mutex_;    ///< Guards all below, and is held shortly only.
  std::condition_variable waiting_changed_, looked_, to_solve_;
  bool is_on_ = false, is_automatic_ = true;
  std::vector<Target> targets_;
  LensModel model_ = LensModel::plumb_bob;
  std::int64_t settings_ = 0;  ///< Counts what a look at work was not begun with.
  ImageSize size_;
  std::optional<Waiting> waiting_;
  bool is_looking_ = false, is_capture_asked_ = false;
  std::int64_t asked_number_ = 0;  ///< Of the last capture that was asked for.
  Clock::time_point watched_at_, looked_at_;
  std::optional<Look> now_;
  std::string asked_fault_;  ///< Why what was asked for last was not captured; empty when it was.
  std::vector<View> views_;
  std::int64_t next_id_ = 1;
  std::int64_t version_ = 0;  ///< Of what a result is made of.
  bool is_solving_ = false;
  std::shared_ptr<const Intrinsics> result_;
  std::string failure_;
  bool ending_ = false;
  std::thread looker_, solver_;  ///< Last: they use all of the above.
};

}  // namespace tassilo
