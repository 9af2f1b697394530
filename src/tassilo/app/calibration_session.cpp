#include "tassilo/app/calibration_session.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <system_error>
#include <utility>

#include "tassilo/app/residual_picture.h"
#include "tassilo/app/target_look.h"
#include "tassilo/base/error.h"
#include "tassilo/files/atomic_file.h"
#include "tassilo/files/camera_file.h"
#include "tassilo/files/colors_history.h"
#include "tassilo/files/kept_copies.h"
#include "tassilo/files/text.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

constexpr auto kLookOn = std::chrono::seconds(3);        ///< After somebody asked.
constexpr auto kLongestLook = std::chrono::seconds(20);  ///< On a slow machine, with all kinds of targets.
constexpr auto kCaptureOn = std::chrono::seconds(60);    ///< The same, for views that are captured by themselves.
constexpr auto kBetweenLooks = std::chrono::milliseconds(100);  ///< Motion shows, and the vision keeps its cores.
constexpr double kRest = .0025, kOtherPlace = .05;              ///< Of the image's diagonal.
constexpr double kOtherSize = .15;                              ///< Relative; a turn of 9 degrees is as much.
constexpr double kOtherTilt = .06;               ///< Of points besides, relative to their distance from their middle.
constexpr std::size_t kLeastCommon = 4;          ///< Points by which views are compared.
constexpr std::size_t kMostFileBytes = 1 << 20;  // as of every YAML file

double diagonal(ImageSize size) { return std::hypot(size.width, size.height); }

/// The points that both views have.
std::vector<std::pair<PixelPoint, PixelPoint>> common_points(const TargetView& a, const TargetView& b) {
  std::vector<std::pair<PixelPoint, PixelPoint>> common;
  const auto place = [](const SeenPoint& point) { return std::pair(point.row, point.column); };
  for (auto i = a.points.begin(), k = b.points.begin(); i != a.points.end() && k != b.points.end();) {
    if (place(*i) == place(*k))
      common.emplace_back(i++->pixel, k++->pixel);
    else if (place(*i) < place(*k))
      ++i;
    else
      ++k;
  }
  return common;
}

double distance(PixelPoint a, PixelPoint b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// How far a target went between two views: its farthest point; nothing when that cannot be told. [px]
std::optional<double> motion(const TargetView& from, const TargetView& to) {
  if (from.target != to.target) return std::nullopt;
  const auto common = common_points(from, to);
  if (common.size() < kLeastCommon) return std::nullopt;
  double farthest = 0;
  for (const auto& [a, b] : common) farthest = std::max(farthest, distance(a, b));
  return farthest;
}

bool are_alike(const TargetView& a, const TargetView& b, ImageSize size) {
  if (a.target != b.target) return false;
  const auto common = common_points(a, b);
  if (common.size() < kLeastCommon) return false;
  const auto n = static_cast<double>(common.size());
  PixelPoint middle_a{}, middle_b{};
  for (const auto& [p, q] : common) {
    middle_a = middle_a + 1 / n * p;
    middle_b = middle_b + 1 / n * q;
  }
  if (distance(middle_a, middle_b) > kOtherPlace * diagonal(size)) return false;
  // What turns and scales a into b, as a factor of complex numbers; the rest is perspective, that is tilt.
  std::complex<double> product = 0;
  double square = 0, rest = 0;
  const auto from = [](PixelPoint point, PixelPoint middle) {
    return std::complex<double>(point.x - middle.x, point.y - middle.y);
  };
  for (const auto& [p, q] : common) {
    product += std::conj(from(p, middle_a)) * from(q, middle_b);
    square += std::norm(from(p, middle_a));
  }
  const std::complex<double> factor = product / square;
  for (const auto& [p, q] : common) rest += std::norm(from(q, middle_b) - factor * from(p, middle_a));
  return std::abs(factor - 1.) <= kOtherSize && std::sqrt(rest / square) <= kOtherTilt;
}

LensModel model_of(const CameraModel& camera) {
  if (std::holds_alternative<Division>(camera.distortion)) return LensModel::division;
  return std::holds_alternative<Equidistant>(camera.distortion) ? LensModel::equidistant : LensModel::plumb_bob;
}

/// A camera file as text and as what it says.
struct ReadCamera {
  std::string text;
  CameraFile camera;
};
ReadCamera read_whole(const fs::path& file) {
  if (file.empty()) throw Error("camera file", "there is none: the robot file names no `camera:`");
  ReadCamera read{read_text(file, kMostFileBytes), {}};
  read.camera = camera_from_yaml(read.text, file.string());
  return read;
}

/// Puts what a file says into the folder STEM_history beside it, once.
void keep_in_history(const fs::path& file, const std::string& text) {
  const fs::path folder = history_folder(file);
  std::error_code error;
  for (auto at = fs::directory_iterator(folder, error); !error && at != fs::directory_iterator(); at.increment(error)) {
    std::error_code unreadable;
    if (at->is_regular_file(unreadable) && at->file_size(unreadable) == text.size() && !unreadable &&
        read_text(at->path(), kMostFileBytes) == text)
      return;
  }
  write_atomically(unused_file(folder, time_for_names(), ".yaml"), text);
}

}  // namespace

CalibrationSession::CalibrationSession(fs::path camera_file) : file_(std::move(camera_file)), targets_{Target{}} {
  try {
    const CameraModel camera = read_whole(file_).camera.model;
    model_ = model_of(camera);
    size_ = {camera.width, camera.height};
  } catch (const Error&) {  // `state` tells
  }
  looker_ = std::thread([this] { look_on(); });
  solver_ = std::thread([this] { work(); });
}

CalibrationSession::~CalibrationSession() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  waiting_changed_.notify_all();
  looked_.notify_all();
  to_solve_.notify_all();
  looker_.join();
  solver_.join();
}

void CalibrationSession::change(const Change& change) {
  if (change.targets) {
    if (change.targets->empty() || change.targets->size() > kMostTargets)
      throw Error("targets", fmt::format("are {}, must be 1 to {}", change.targets->size(), kMostTargets));
    for (const Target& target : *change.targets) target.check();
  }
  {
    const std::lock_guard lock(mutex_);
    is_automatic_ = change.is_automatic.value_or(is_automatic_);
    if (change.targets && *change.targets != targets_) {
      targets_ = *change.targets;
      ++settings_;
      waiting_.reset();
      drop_result();
    }
    if (change.model && *change.model != model_) {
      model_ = *change.model;
      drop_result();
    }
    if (change.is_on && *change.is_on != is_on_) {
      is_on_ = *change.is_on;
      ++settings_;
      waiting_.reset();
      now_.reset();
    }
  }
  looked_.notify_all();
}

CalibrationSession::State CalibrationSession::state() const {
  State state;
  {
    const std::lock_guard lock(mutex_);
    state.is_on = is_on_;
    state.is_automatic = is_automatic_;
    state.is_solving = is_solving_;
    state.targets = targets_;
    state.model = model_;
    state.size = size_;
    state.now = now_;
    state.views = views_;
    state.result = result_;
    state.failure = failure_;
  }
  if (state.size.width > 0 && state.size.height > 0) {
    std::vector<TargetView> views;
    for (const View& view : state.views) views.push_back(view.view);
    state.coverage = coverage_of(state.size, views);
  }
  state.file = file_;
  try {
    const CameraModel in_file = read_whole(file_).camera.model;
    if (state.result) {
      CameraModel mine = state.result->camera;
      mine.name = in_file.name;
      state.is_saved = mine == in_file;
    }
  } catch (const Error& error) {
    state.refusal = error.what();
  }
  return state;
}

void CalibrationSession::set_file(const fs::path& camera_file) {
  const std::scoped_lock lock(saving_, mutex_);
  file_ = camera_file;
}

void CalibrationSession::watched() {
  const std::lock_guard lock(mutex_);
  watched_at_ = Clock::now();
}

bool CalibrationSession::wants_frame() const {
  const std::lock_guard lock(mutex_);
  if (!is_on_ || is_looking_ || waiting_) return false;
  const auto now = Clock::now();
  const bool is_wanted =
      is_capture_asked_ || now - watched_at_ < (is_automatic_ && views_.size() < kMostViews ? kCaptureOn : kLookOn);
  return is_wanted && now - looked_at_ >= kBetweenLooks;
}

void CalibrationSession::see(const Frame& frame) {
  {
    const std::lock_guard lock(mutex_);
    if (!is_on_) return;
  }
  Waiting waiting{gray_of(frame.view), frame.index, !frame.image.empty()};
  {
    const std::lock_guard lock(mutex_);
    if (!is_on_) return;
    waiting_ = std::move(waiting);
  }
  waiting_changed_.notify_one();
}

void CalibrationSession::look_on() {
  std::unique_lock lock(mutex_);
  for (;;) {
    waiting_changed_.wait(lock, [&] { return ending_ || waiting_.has_value(); });
    if (ending_) return;
    const Waiting waiting = std::move(*waiting_);
    waiting_.reset();
    is_looking_ = true;
    looked_at_ = Clock::now();
    const std::int64_t asked = is_capture_asked_ ? asked_number_ : 0;
    const std::int64_t settings = settings_;
    const std::vector<Target> targets = targets_;
    lock.unlock();
    Look look;
    look.frame = waiting.frame;
    try {
      TargetSearch search = find_any_target(waiting.image, targets);
      look.view = std::move(search.view);
      if (!look.view) look.verdict = "no target found: " + search.reason;
    } catch (const std::exception& error) {
      look.verdict = fmt::format("no target found: {}", error.what());
    }
    lock.lock();
    is_looking_ = false;
    if (settings != settings_) continue;                                // it was looked for something else
    const bool is_asked = is_capture_asked_ && asked == asked_number_;  // and not given up meanwhile
    judge(look, waiting.is_single, is_asked, {waiting.image.width, waiting.image.height});
    if (is_asked) {
      is_capture_asked_ = false;
      asked_fault_ = look.is_captured ? "" : look.verdict;
    }
    now_ = std::move(look);
    looked_.notify_all();
  }
}

void CalibrationSession::judge(Look& look, bool is_single, bool is_asked, ImageSize size) {
  if (views_.empty()) size_ = size;
  if (!look.view) return;
  if (size.width != size_.width || size.height != size_.height) {
    look.verdict = fmt::format("the frame has {} x {} pixels, those of the views have {} x {}: forget the views first",
                               size.width, size.height, size_.width, size_.height);
  } else if (views_.size() >= kMostViews) {
    look.verdict = fmt::format("there are {} views, the most that are kept", kMostViews);
  } else if (is_asked) {
    capture(look);
  } else if (std::string why = why_not(*look.view, is_single); !why.empty()) {
    look.verdict = std::move(why);
  } else if (is_automatic_) {
    capture(look);
  } else {
    look.verdict = "new: at rest, and like no other view";
  }
}

void CalibrationSession::capture(Look& look) {
  drop_result();
  views_.push_back({std::to_string(next_id_++), look.frame, *look.view});
  look.is_captured = true;
  look.verdict = "captured as view " + views_.back().id;
}

std::string CalibrationSession::why_not(const TargetView& view, bool is_single) const {
  if (!is_single) {
    const auto moved = now_ && now_->view ? motion(*now_->view, view) : std::nullopt;
    if (!moved) return "moves: it was not seen in the last look";
    if (*moved > kRest * diagonal(size_))
      return fmt::format("moves: {:.{}f} px since the last look", *moved, *moved < 10 ? 1 : 0);
  }
  for (const View& former : views_)
    if (are_alike(former.view, view, size_)) return "like view " + former.id;
  return "";
}

void CalibrationSession::capture_next(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  if (!is_on_) throw Error("calibration", "is not on");
  if (views_.size() >= kMostViews)
    throw Error("views", fmt::format("are {}, must be at most {}; forget some", views_.size(), kMostViews));
  waiting_.reset();  // it is from before
  is_capture_asked_ = true;
  ++asked_number_;
  const auto is_answered = [&] { return ending_ || !is_on_ || !is_capture_asked_; };
  bool came = looked_.wait_for(lock, patience, is_answered);
  // A frame is there; looking for targets may take longer than waiting for one.
  if (!came && (is_looking_ || waiting_)) came = looked_.wait_for(lock, kLongestLook, is_answered);
  if (is_capture_asked_) {
    is_capture_asked_ = false;
    throw Error("view", came          ? "was not captured: calibration has ended"
                        : is_looking_ ? "was not captured: looking for the targets takes too long"
                                      : "was not captured: no frame comes");
  }
  if (!asked_fault_.empty()) throw Error("view", "was not captured: " + asked_fault_);
}

bool CalibrationSession::forget(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(views_, id, &View::id);
  if (found == views_.end()) return false;
  views_.erase(found);
  drop_result();
  return true;
}

void CalibrationSession::forget_all() {
  const std::lock_guard lock(mutex_);
  views_.clear();
  drop_result();
}

void CalibrationSession::drop_result() {
  ++version_;
  result_ = nullptr;
  failure_.clear();
}

void CalibrationSession::solve() {
  {
    const std::lock_guard lock(mutex_);
    if (is_solving_) throw Error("camera", "is being worked out already");
    if (views_.size() < static_cast<std::size_t>(kLeastViews))
      throw Error("views", fmt::format("are {}, must be at least {}", views_.size(), kLeastViews));
    drop_result();
    is_solving_ = true;
    is_automatic_ = false;  // another view would drop the result
  }
  to_solve_.notify_all();
}

void CalibrationSession::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    to_solve_.wait(lock, [&] { return ending_ || is_solving_; });
    if (ending_) return;
    const std::int64_t version = version_;
    const ImageSize size = size_;
    const LensModel model = model_;
    std::vector<TargetView> views;
    for (const View& view : views_) views.push_back(view.view);
    lock.unlock();
    std::shared_ptr<const Intrinsics> result;
    std::string failure;
    try {
      result = std::make_shared<const Intrinsics>(calibrate_intrinsics(size, views, {.model = model}));
    } catch (const std::exception& error) {
      failure = error.what();
    }
    lock.lock();
    is_solving_ = false;
    if (version == version_) {
      result_ = std::move(result);
      failure_ = std::move(failure);
    } else {
      failure_ = "views or model were changed while the camera was worked out; try again";
    }
  }
}

std::optional<RgbImage> CalibrationSession::residuals() const {
  std::shared_ptr<const Intrinsics> result;
  {
    const std::lock_guard lock(mutex_);
    result = result_;
  }
  if (!result) return std::nullopt;
  return residual_picture(*result);
}

void CalibrationSession::save(const std::function<void()>& take_over) {
  const std::lock_guard saving(saving_);
  std::shared_ptr<const Intrinsics> result;
  {
    const std::lock_guard lock(mutex_);
    result = result_;
  }
  if (!result) throw Error("camera", "is not worked out from these views yet");
  const ReadCamera former = read_whole(file_);
  CameraFile camera{result->camera, former.camera.mount};
  camera.model.name = former.camera.model.name;
  if (camera.model.width != former.camera.model.width || camera.model.height != former.camera.model.height)
    throw Error(file_.string(),
                fmt::format("is for images of {} x {}, the result is for {} x {}", former.camera.model.width,
                            former.camera.model.height, camera.model.width, camera.model.height));
  keep_in_history(file_, former.text);
  write_camera(file_, camera);
  try {
    take_over();
  } catch (const std::exception& error) {  // a plug-in may throw anything
    write_atomically(file_, former.text);
    throw Error(file_.string(), fmt::format("is as it was, the run refuses the new one: {}", error.what()));
  }
}

}  // namespace tassilo
