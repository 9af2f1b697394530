#include "tassilo/app/team_sender.h"

#include <fmt/core.h>

#include <utility>

#include "tassilo/app/annotated_picture.h"
#include "tassilo/app/unix_clock.h"
#include "tassilo/base/error.h"

namespace tassilo {
namespace {

constexpr std::size_t kMostWaiting = 8;  // a quarter of a second of frames
constexpr double kEpoch = 1e9;           // later times are taken for those since the UNIX epoch: 2001 [s]

std::int64_t nanoseconds(double t) { return static_cast<std::int64_t>(t * 1e9); }

MessageContext context_of(int robot, const RobotSetup& setup) {
  MessageContext context;
  context.robot = robot;
  context.team = setup.robot.team;
  context.ball_radius = setup.vision.field.ball.radius.middle();
  context.free_space_range = setup.vision.options.free_space.max_range;
  return context;
}

std::vector<Spoken> messages_of(const Scene& scene, ros::Time stamp, const MessageContext& context,
                                const Odometry* odometry, bool has_floor) {
  std::vector<Spoken> messages;
  const auto add = [&](const Topic& topic, const auto& message) { messages.push_back({&topic, encoded(message)}); };
  // First what others play by: when bytes are short, the rest is withheld.
  if (scene.pose) add(kPoseTopic, pose_message(*scene.pose, stamp));
  if (has_floor) {
    add(kBallsTopic, balls_message(scene, stamp, context));
    add(kRobotsTopic, robots_message(scene, stamp, context));
    add(kTracksTopic, tracks_message(scene, stamp, context));
  }
  if (odometry != nullptr)
    if (const auto message = odometry_message(*odometry, scene.t, stamp, context)) add(kOdometryTopic, *message);
  const ros::TFMessage transforms =
      transforms_message(scene, odometry != nullptr ? odometry->at(scene.t) : std::nullopt, stamp, context);
  if (!transforms.transforms.empty()) add(kTransformsTopic, transforms);
  if (scene.free_space) {
    add(kFreeSpaceTopic, free_space_message(*scene.free_space, stamp, context));
    add(kScanTopic, scan_message(*scene.free_space, stamp, context));
  }
  if (has_floor) {
    add(kGoalsTopic, goals_message(scene, stamp, context));
    add(kLinesTopic, lines_message(scene, stamp, context));
  }
  return messages;
}

}  // namespace

TeamSender::TeamSender(const TeamSenderOptions& options) : options_(options) {
  options_.budget.check();
  // The log last: a bus that cannot be entered leaves none behind.
  if (options_.bus) {
    bus_.emplace(*options_.bus);
    voice_.emplace(*bus_, options_.robot, options_.budget,
                   options_.reliable ? BusReliability::reliable : BusReliability::best_effort);
  }
  if (!options_.log.empty()) {
    log_.emplace(options_.log);
    for (const Topic& topic : kTopics)
      channels_.emplace(
          topic.name,
          log_->add_channel({ros_topic_name(topic, options_.robot), topic.ros_type(), topic.definition(), {}}));
  }
  thread_ = std::thread([this] { send_all(); });
}

TeamSender::~TeamSender() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  there_is_work_.notify_all();
  thread_.join();
}

void TeamSender::begin(double first_t, bool is_live) {
  const bool is_since_epoch = first_t > kEpoch;
  offset_ = is_live || (is_since_epoch && !bus_) ? 0 : unix_now() - first_t;
}

void TeamSender::say(const Frame& frame, const Scene& scene, const VisionWorkspace& workspace,
                     const std::shared_ptr<const Configuration>& configuration, const Odometry* odometry,
                     std::optional<double> latency_s, const TeamRole& role) {
  MessageContext context = context_of(options_.robot, configuration->setup);
  context.has_odometry = odometry != nullptr;
  Item item;
  item.t = scene.t + offset_;
  constexpr double end_of_time = 2147483647;  // that a stamp can say: 2038 [s]
  if (!(item.t >= 0 && item.t < end_of_time)) return lose(fmt::format("{} s is no time that can be told", item.t));
  const ros::Time stamp = ros_time(item.t);
  item.messages = messages_of(scene, stamp, context, odometry, configuration->vision.optics() != nullptr);
  item.state = team_state_message(scene, stamp, context);
  item.state.role = role.role;
  item.state.action = role.action;
  item.state.planning_state = role.planning_state;
  frames_.add(item.t, 1);
  item.state.frames = ++seen_;
  item.state.frame_rate = frames_.per_second(item.t);
  item.state.latency = latency_s.value_or(0);
  // What a file's frames were logged at is when they were seen in the recorded world.
  item.log_time_ns = nanoseconds(latency_s ? item.t + *latency_s : item.t);

  const double picture_period = options_.budget.picture_rate > 0 ? 1 / options_.budget.picture_rate : 0;
  if (log_ && picture_period > 0 && item.t >= next_logged_picture_) {
    item.is_drawing_logged = true;
    next_logged_picture_ = std::max(next_logged_picture_, item.t - picture_period) + picture_period;
  }
  if (item.is_drawing_logged || is_picture_wanted_) item.drawing = {frame, scene, workspace.surface, configuration};

  std::unique_lock lock(mutex_);
  if (options_.waits) there_is_room_.wait(lock, [&] { return queue_.size() < kMostWaiting; });
  if (queue_.size() >= kMostWaiting) {
    queue_.pop_front();
    ++dropped_;
  }
  queue_.push_back(std::move(item));
  there_is_work_.notify_one();
}

void TeamSender::send_all() {
  for (;;) {
    std::optional<Item> item;
    {
      std::unique_lock lock(mutex_);
      busy_ = false;
      there_is_room_.notify_all();
      there_is_work_.wait(lock, [&] { return ending_ || !queue_.empty() || picture_; });
      if (queue_.empty() && !picture_) return;
      busy_ = true;
      if (!queue_.empty()) {
        item = std::move(queue_.front());
        queue_.pop_front();
      }
    }
    try {
      if (item)
        send(*item);
      else
        show(*std::exchange(picture_, std::nullopt));
    } catch (const std::exception& error) {  // the vision goes on
      lose(error.what());
    }
    tell_complaints();
  }
}

/// Something was not told; the first time it is said why.
void TeamSender::lose(const std::string& why) {
  const std::lock_guard lock(mutex_);
  if (lost_++ == 0) news_.push_back("not told to others: " + why);
}

/// What the middleware has to say goes to people, once each.
void TeamSender::tell_complaints() {
  if (!bus_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now < next_complaints_) return;
  next_complaints_ = now + std::chrono::seconds(1);
  const std::lock_guard lock(mutex_);
  for (const std::string& complaint : complaints_.news(*bus_)) news_.push_back("bus: " + complaint);
}

std::vector<std::string> TeamSender::news() {
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, {});
}

/// What goes wrong with the log ends the log, and nothing else.
void TeamSender::log(const Topic& topic, const Item& item, std::span<const std::byte> data) {
  if (!log_ || has_log_failed_) return;
  try {
    log_->write(channels_.at(topic.name), item.log_time_ns, nanoseconds(item.t), data);
    const std::lock_guard lock(mutex_);
    ++logged_;
  } catch (const Error& error) {
    has_log_failed_ = true;
    const std::lock_guard lock(mutex_);
    log_trouble_ = error.what();
    news_.push_back("the log ends here: " + log_trouble_);
  }
}

void TeamSender::send(Item& item) {
  if (voice_) {
    item.state = voice_->say(item.messages, item.state, item.t);
    is_picture_wanted_ = voice_->is_picture_wanted(item.t);
    const std::lock_guard lock(mutex_);
    sent_ = voice_->messages();
    withheld_ = voice_->withheld();
    bytes_ = voice_->bytes_per_second(item.t);
  }
  for (const Spoken& message : item.messages) log(*message.topic, item, message.data);
  log(kTeamStateTopic, item, encoded(item.state));
  if (!item.drawing) return;
  // Drawn when there is nothing else to do: messages do not wait for pictures, but newer pictures replace older ones.
  if (picture_ && options_.waits) show(*std::exchange(picture_, std::nullopt));
  picture_ = std::move(item);
}

void TeamSender::show(const Item& item) {
  const Drawing& drawing = *item.drawing;
  const std::string jpeg =
      annotated_jpeg(drawing.frame, drawing.scene, drawing.surface, drawing.configuration->vision.optics());
  const ros::CompressedImage picture{{ros_time(item.t), robot_frame_id(options_.robot, "camera")},
                                     "jpeg",
                                     std::vector<std::uint8_t>(jpeg.begin(), jpeg.end())};
  if (item.is_drawing_logged) log(kImageTopic, item, encoded(picture));
  if (voice_ && voice_->is_picture_wanted(item.t)) voice_->show(picture, item.t);
}

void TeamSender::finish() {
  std::unique_lock lock(mutex_);
  there_is_room_.wait(lock, [&] { return queue_.empty() && !busy_ && !picture_; });
  if (!log_trouble_.empty()) throw Error("log", log_trouble_);
  if (log_) log_->finish();
}

std::string TeamSender::summary() const {
  const std::lock_guard lock(mutex_);
  std::string text;
  if (bus_) {
    text += fmt::format("bus: {} messages as robot {}", sent_, options_.robot);
    if (withheld_ > 0) text += fmt::format(", {} withheld for rates and budget", withheld_);
    text += fmt::format("; {:.1f} kB/s\n", bytes_ / 1000);
  }
  if (log_)
    text += fmt::format("log: {}, {} messages, {:.1f} MB\n", options_.log, logged_,
                        1e-6 * static_cast<double>(log_->bytes()));
  if (lost_ > 0) text += fmt::format("{} times something could not be told\n", lost_);
  if (dropped_ > 0) text += fmt::format("{} frames were not told: sending was too slow\n", dropped_);
  return text;
}

}  // namespace tassilo
