#include "tassilo/app/live_view.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "tassilo/app/annotated_picture.h"
#include "tassilo/app/calibration_requests.h"
#include "tassilo/app/field_json.h"
#include "tassilo/app/frame_bytes.h"
#include "tassilo/app/recording_api.h"
#include "tassilo/app/training_requests.h"
#include "tassilo/base/error.h"
#include "tassilo/files/json.h"
#include "tassilo/files/scene_json.h"

namespace tassilo {
namespace {

using nlohmann::json;

constexpr const char* kScene = "scene";
constexpr const char* kPicture = "picture";
constexpr const char* kFrame = "frame";
constexpr std::size_t kLastFrames = 8;  ///< A browser asks for one of them that it has just shown.

std::string stages_json(const Configuration& configuration, const VisionChanges& changes) {
  const VisionOptions& options = configuration.setup.vision.options;
  const auto values = option_values(options);
  const auto options_json = [&](const std::vector<OptionInfo>& infos) {
    json list = json::array();
    for (const OptionInfo& info : infos)
      list.push_back({{"key", info.key},
                      {"unit", info.unit},
                      {"low", info.low},
                      {"high", info.high},
                      {"whole", info.whole},
                      {"meaning", info.meaning},
                      {"default", info.standard},
                      {"value", values.at(info.key)},
                      {"changed", changes.contains(info.key)}});
    return list;
  };
  json stages = json::array();
  for (const StageInfo& stage : stage_infos(configuration.setup.registry)) {
    json alternatives = json::array();
    for (const StageInfo::Alternative& one : stage.alternatives) {
      alternatives.push_back({{"name", one.name},
                              {"meaning", one.meaning},
                              {"default", &one == &stage.alternatives.front()},
                              {"chosen", one.name == chosen_name(stage, options)},
                              {"options", options_json(one.options)}});
    }
    stages.push_back({{"key", stage.key},
                      {"meaning", stage.meaning},
                      {"changed", changes.contains(stage.key)},
                      {"alternatives", std::move(alternatives)},
                      {"options", options_json(stage.options)}});
  }
  return stages.dump();
}

/// Without what says the same as the robot file, or as the default where that says nothing.
VisionChanges really_changed(VisionChanges changes, const RobotSetup& setup) {
  const VisionOptions filed = vision_options(setup.settings, setup.registry);
  const auto values = option_values(filed);
  std::erase_if(changes, [&](const auto& change) {
    const auto& [key, setting] = change;
    if (const auto value = values.find(key); value != values.end()) return setting.number() == value->second;
    bool is_same = false;
    setup.registry.for_each(
        [&](const auto& stage) { is_same |= stage.key == key && setting.text == chosen_name(stage, filed); });
    return is_same;
  });
  return changes;
}

/// The file of a role, as it was named; empty: there is none.
std::string file_of(const Configuration& configuration, const char* role) {
  const auto file = std::ranges::find(configuration.setup.read, std::string(role), &NamedFile::role);
  return file != configuration.setup.read.end() ? file->path : "";
}

}  // namespace

void apply_changes(RobotSetup& setup, const VisionChanges& changes) {
  auto settings = setup.settings;
  std::erase_if(settings, [&](const auto& setting) { return changes.contains(setting.first); });
  settings.insert(settings.end(), changes.begin(), changes.end());
  setup.vision.options = vision_options(settings, setup.registry);
  setup.at_work = std::move(settings);
}

LiveView::LiveView(const WebOptions& options, std::string robot_file, std::filesystem::path samples, Recorder* recorder)
    : robot_file_(std::move(robot_file)),
      samples_(std::move(samples)),
      recorder_(recorder),
      server_(
          [&] {
            WebOptions with_channels = options;
            with_channels.channels = {kScene, kPicture, kFrame};
            return with_channels;
          }(),
          [this](const WebRequest& request) { return answer(request); }),
      painter_([this] { draw_pictures(); }) {}

LiveView::~LiveView() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  wanted_.notify_all();
  shown_.notify_all();
  painter_.join();
}

void LiveView::begin(const std::string& source_name, const std::string& source_description, int every, ColorRange range,
                     std::shared_ptr<const Configuration> now, Load load) {
  const std::lock_guard lock(mutex_);
  seen_.source_name = source_name;
  seen_.source_description = source_description;
  seen_.every = every;
  range_ = range;
  now_ = std::move(now);
  load_ = std::move(load);
}

void LiveView::show(const Frame& frame, const Scene& scene, const VisionWorkspace& workspace,
                    const std::shared_ptr<const Configuration>& configuration) {
  if (server_.listeners(kScene) > 0)
    server_.publish(kScene, std::make_shared<const std::string>(to_json_line(scene)), WebServer::Message::text);
  const bool is_picture_wanted = server_.listeners(kPicture) > 0;
  const bool has_frame_listeners = server_.listeners(kFrame) > 0;
  const std::lock_guard lock(mutex_);
  // The rate of the last second or so.
  constexpr double share = 0.05;
  const auto now = std::chrono::steady_clock::now();
  const double dt = std::chrono::duration<double>(now - seen_.shown_at).count();
  if (seen_.frames > 0 && dt > 0) seen_.rate_hz += (seen_.rate_hz > 0 ? share : 1) * (1 / dt - seen_.rate_hz);
  if (seen_.frames > 0) seen_.dropped += std::max<std::int64_t>(scene.frame - seen_.frame - seen_.every, 0);
  seen_.shown_at = now;
  seen_.frame = scene.frame;
  seen_.t = scene.t;
  ++seen_.frames;
  if (!chosen_) now_ = configuration;  // what was chosen meanwhile counts already
  if (drawing_) return;
  CalibrationSession* const calibration =
      calibration_ != nullptr && calibration_->wants_frame() ? calibration_.get() : nullptr;
  if (!(is_picture_wanted || has_frame_listeners || is_frame_wanted_ || calibration != nullptr)) return;
  snapshot_ = {frame, {}, calibration};
  if (is_picture_wanted) snapshot_->scenery = {scene, workspace.surface, configuration};
  wanted_.notify_one();
}

void LiveView::add_latency(double ms) {
  const std::lock_guard lock(mutex_);
  latency_ms_.add(ms, std::chrono::steady_clock::now());
}

void LiveView::set_mount_drift(const std::string& text) {
  const std::lock_guard lock(mutex_);
  seen_.mount_drift = text;
}

void LiveView::leave() {
  const std::lock_guard loading(loading_);
  const std::lock_guard lock(mutex_);
  load_ = nullptr;
}

std::shared_ptr<const Configuration> LiveView::chosen() {
  const std::lock_guard lock(mutex_);
  auto chosen = std::exchange(chosen_, nullptr);
  if (chosen) {
    ++seen_.taken_over;
    seen_.refusal.clear();
  }
  return chosen;
}

VisionChanges LiveView::changes() const {
  const std::lock_guard lock(mutex_);
  return changes_;
}

std::shared_ptr<const Configuration> LiveView::load_with_changes(const Load& load) {
  const std::lock_guard loading(loading_);
  return load(changes());
}

void LiveView::told(const ConfigurationWatch::News& news) {
  const std::lock_guard lock(mutex_);
  seen_.taken_over += news.configuration != nullptr;
  seen_.refusal = news.refusal;
}

void LiveView::draw_pictures() {
  for (;;) {
    Snapshot snapshot;
    {
      std::unique_lock lock(mutex_);
      drawing_ = false;
      wanted_.wait(lock, [&] { return ending_ || snapshot_.has_value(); });
      if (ending_) return;
      snapshot = std::move(*snapshot_);
      snapshot_.reset();
      drawing_ = true;
    }
    std::string fault;
    try {
      publish(snapshot);
    } catch (const std::exception& error) {  // the vision goes on without a picture
      fault = error.what();
    }
    const std::lock_guard lock(mutex_);
    seen_.picture_fault = std::move(fault);
  }
}

void LiveView::publish(const Snapshot& snapshot) {
  if (snapshot.calibration != nullptr) snapshot.calibration->see(snapshot.frame);
  bool is_frame_wanted = server_.listeners(kFrame) > 0;
  {
    const std::lock_guard lock(mutex_);
    is_frame_wanted |= is_frame_wanted_;
  }
  if (is_frame_wanted) {
    const auto bytes = std::make_shared<const std::string>(frame_bytes(snapshot.frame));
    {
      const std::lock_guard lock(mutex_);
      last_frames_.push_back(bytes);
      if (last_frames_.size() > kLastFrames) last_frames_.pop_front();
      is_frame_wanted_ = false;
    }
    shown_.notify_all();
    server_.publish(kFrame, bytes, WebServer::Message::binary);
  }
  if (snapshot.scenery)
    server_.publish(kPicture,
                    std::make_shared<const std::string>(
                        annotated_jpeg(snapshot.frame, snapshot.scenery->scene, snapshot.scenery->surface,
                                       snapshot.scenery->configuration->vision.optics())),
                    WebServer::Message::binary);
}

/// That was sent a moment ago, or the next one; null when none comes.
std::shared_ptr<const std::string> LiveView::shown_frame(std::optional<std::int64_t> frame) {
  constexpr auto patience = std::chrono::seconds(2);
  std::unique_lock lock(mutex_);
  if (frame)
    for (const auto& bytes : last_frames_)
      if (frame_of_bytes(bytes).index == *frame) return bytes;
  // Nothing comes: others need not wait for that.
  if (std::chrono::steady_clock::now() - seen_.shown_at > patience) return nullptr;
  is_frame_wanted_ = true;
  if (!shown_.wait_for(lock, patience, [&] { return ending_ || !is_frame_wanted_; }) || ending_) {
    is_frame_wanted_ = false;
    return nullptr;
  }
  return last_frames_.back();
}

void LiveView::take_over_files() {
  const std::lock_guard loading(loading_);
  Load load;
  {
    const std::lock_guard lock(mutex_);
    load = load_;
  }
  if (!load) return;
  auto configuration = load(changes());
  const std::lock_guard lock(mutex_);
  now_ = chosen_ = std::move(configuration);
}

WebResponse LiveView::train(const WebRequest& request) {
  std::shared_ptr<const Configuration> now;
  std::optional<ColorRange> range;
  {
    const std::lock_guard lock(mutex_);
    now = now_;
    range = range_;
  }
  if (!now || !range) return refusal(503, "the source is not open yet");
  const TrainingFiles files = training_files(file_of(*now, kColorsRole), samples_);
  if (!training_) training_ = std::make_unique<TrainingSession>(files, *range);
  if (training_->files().colors != files.colors)
    return refusal(409, "the robot file names another color table now, " + files.colors.string() +
                            "; start the server again to train that one");
  return answer_training(
      *training_, request,
      {[this] {
         const std::lock_guard lock(mutex_);
         return now_->setup.vision.colors;
       },
       [this](std::optional<std::int64_t> frame) { return shown_frame(frame); }, [this] { take_over_files(); }});
}

WebResponse LiveView::calibrate(const WebRequest& request) {
  CalibrationSession* session = nullptr;
  std::string camera;
  {
    const std::lock_guard lock(mutex_);
    if (!now_) return refusal(503, "the source is not open yet");
    camera = file_of(*now_, kCameraRole);
    session = calibration_.get();
  }
  if (session != nullptr) {
    session->set_file(camera);
  } else {
    auto first = std::make_unique<CalibrationSession>(camera);  // reads the file: the vision does not wait for that
    session = first.get();
    const std::lock_guard lock(mutex_);
    calibration_ = std::move(first);
  }
  return answer_calibration(*session, request, [this] { take_over_files(); });
}

std::string LiveView::state_json() const {
  const WebCounts counts = server_.counts();
  const json recording = recording_json(recorder_->state());
  const std::lock_guard lock(mutex_);
  json state({{"version", TASSILO_VERSION},
              {"robot", robot_file_},
              {"source", {{"name", seen_.source_name}, {"description", seen_.source_description}}},
              {"frame", seen_.frame},
              {"t", seen_.t},
              {"rate_hz", seen_.rate_hz},
              {"frames", seen_.frames},
              {"dropped", seen_.dropped},
              {"configuration", {{"taken_over", seen_.taken_over}, {"refusal", seen_.refusal}}},
              {"web",
               {{"viewers", server_.listeners(kScene)},
                {"clients", counts.clients},
                {"sent", counts.sent},
                {"dropped", counts.dropped}}},
              {"mount_drift", seen_.mount_drift},
              {"picture_fault", seen_.picture_fault},
              {"recording", recording},
              {"ended", load_ == nullptr && seen_.frames > 0}});
  if (const auto latency = latency_ms_.get(std::chrono::steady_clock::now())) state["latency_ms"] = *latency;
  if (now_ && now_->vision.optics() != nullptr) state["field"] = field_json(now_->setup.vision.field);
  return state.dump(-1, ' ', false, json::error_handler_t::replace);
}

WebResponse LiveView::answer(const WebRequest& request) {
  const bool reads = request.method == "GET" || request.method == "HEAD";
  if (request.path == "/api/state")
    return reads ? WebResponse{200, "application/json", state_json()} : refusal(405, "the state can be read only");
  if (request.path == "/api/recording") return answer_recording(*recorder_, request);
  if (request.path == "/api/stages") {
    if (request.method == "PUT") return change_stages(request.body);
    if (!reads) return refusal(405, "stages are read by GET and changed by PUT");
    const std::lock_guard lock(mutex_);
    if (!now_) return refusal(503, "the source is not open yet");
    return {200, "application/json", stages_json(*now_, changes_)};
  }
  if (request.path == "/api/training" || request.path.starts_with("/api/training/")) return train(request);
  if (request.path == "/api/calibration" || request.path.starts_with("/api/calibration/")) return calibrate(request);
  if (request.path == "/")
    return refusal(404,
                   "the pages are not installed; /api/state, /api/stages, /api/training, /api/calibration, "
                   "/api/recording, /ws/scene, /ws/picture and /ws/frame are here");
  return refusal(404, "there is nothing at " + request.path);
}

WebResponse LiveView::change_stages(const std::string& body) {
  const std::lock_guard loading(loading_);
  VisionChanges changes = this->changes();
  Load load;
  {
    const std::lock_guard lock(mutex_);
    load = load_;
  }
  if (!load) return refusal(503, "the source is not open yet");
  try {
    for (const auto& [key, value] : parse_json(body, "request").any_map().entries()) {
      if (value.is_null())
        changes.erase(key);
      else {
        Setting setting = value.setting();
        setting.name = "vision." + key;
        // A name of an alternative is a text in JSON, and none in the robot file.
        setting.quoted = false;
        changes.insert_or_assign(key, std::move(setting));
      }
    }
    auto configuration = load(changes);
    changes = really_changed(std::move(changes), configuration->setup);
    std::string json = stages_json(*configuration, changes);
    const std::lock_guard lock(mutex_);
    changes_ = std::move(changes);
    now_ = chosen_ = std::move(configuration);
    return {200, "application/json", std::move(json)};
  } catch (const Error& error) {
    return refusal(400, error.what());
  }
}

}  // namespace tassilo
