#include "tassilo/app/monitor.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "tassilo/app/field_json.h"
#include "tassilo/app/team_json.h"
#include "tassilo/app/unix_clock.h"
#include "tassilo/base/error.h"
#include "tassilo/message/plausible.h"

namespace tassilo {
namespace {

using nlohmann::json;

constexpr const char* kTeamChannel = "team";
constexpr std::size_t kMostEars = 1000;                // a hundred robots; what is more is an attack
constexpr double kForgotten = 10;                      // nobody has published a topic for so long [s]
constexpr std::size_t kMemory = std::size_t{1} << 19;  // of team pictures [B]
constexpr double kKeptStep = 0.095;                    // ten team pictures a second are kept [s]
constexpr int kDepth = 32;                             // messages of one topic between two looks: a burst of a second

std::string picture_channel(int robot) { return "picture" + std::to_string(robot); }

WebOptions with_channels(WebOptions web, bool is_live) {
  web.front = "monitor.html";
  if (!is_live) return web;
  web.channels = {kTeamChannel};
  for (int robot = 0; robot < 256; ++robot) web.channels.push_back(picture_channel(robot));
  return web;
}

std::optional<double> number(const WebRequest& request, const char* key) {
  const auto text = query_value(request.query, key);
  if (!text) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
  if (error != std::errc{} || end != text->data() + text->size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

WebResponse needs(const char* key) { return refusal(400, std::string("the query needs a number: ") + key + "=..."); }

WebResponse ok(std::string body) { return {200, "application/json", std::move(body)}; }

/// The seconds of trails that are asked for; nothing when they are out of range.
std::optional<double> trail_seconds(const WebRequest& request) {
  if (!query_value(request.query, "seconds")) return 5;
  const auto seconds = number(request, "seconds");
  return seconds && *seconds >= 0 && *seconds <= 60 ? seconds : std::nullopt;
}

/// Those that whoever asks does not know yet.
std::vector<TeamNews> news_after(const WebRequest& request, std::vector<TeamNews> news) {
  const auto after = static_cast<std::int64_t>(std::clamp(number(request, "after").value_or(0), 0., 1e15));
  std::erase_if(news, [&](const TeamNews& one) { return one.number <= after; });
  return news;
}

std::string monitor_json(const char* mode, const std::string& name, const std::string& damage, const FieldModel& field,
                         std::optional<double> begin, std::optional<double> end, double step) {
  const json value{{"version", TASSILO_VERSION},
                   {"mode", mode},
                   {"name", name},
                   {"damage", damage},
                   {"field", field_json(field)},
                   {"begin", begin ? json(*begin) : json()},
                   {"end", end ? json(*end) : json()},
                   {"step", step}};
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

WebResponse nothing_at(const WebRequest& request) {
  if (request.path == "/")
    return refusal(404,
                   "the pages are not installed; /api/monitor, /api/monitor/at, /api/monitor/trails, "
                   "/api/monitor/picture, /api/monitor/news, /ws/team and /ws/picture<robot> are here");
  return refusal(404, "there is nothing at " + request.path);
}

/// Robots of this field in full view are so wide.
TeamFusionOptions fusion_on(const FieldModel& field) {
  TeamFusionOptions options;
  if (field.robots.width.middle() > 0) options.robot_width = field.robots.width.middle();
  return options;
}

/// "robot 3's sender": those of one participant are one sender.
std::string sender_of(const BusId& writer) { return to_string(writer).substr(0, 24); }

}  // namespace

void MonitorOptions::check() const {
  if (!(rate >= 1 && rate <= 100)) throw Error("monitor.rate", "is " + std::to_string(rate) + ", must be 1 .. 100");
  if (!(memory_s >= 1 && memory_s <= 3600))
    throw Error("monitor.memory", "is " + std::to_string(memory_s) + ", must be 1 .. 3600");
}

LiveMonitor::LiveMonitor(const MonitorOptions& options)
    : options_(options),
      bus_(options.bus),
      view_(options.view),
      bench_(fusion_on(options.field)),
      history_(options.memory_s, static_cast<std::size_t>(options.memory_s) * kMemory),
      trails_(options.memory_s),
      server_(with_channels(options.web, true), [this](const WebRequest& request) { return answer(request); }) {
  options_.check();
  if (!options_.record.empty()) record_.emplace(options_.record);
  for (int robot = 0; robot < 256; ++robot)
    picture_channels_.at(static_cast<std::size_t>(robot)) = picture_channel(robot);
}

bool LiveMonitor::is_known(int robot) const {
  const std::vector<int>& known = options_.view.known_robots;
  return known.empty() || std::ranges::find(known, robot) != known.end();
}

/// Listens to what is published of robots, and no longer to what nobody publishes.
void LiveMonitor::find_ears(double now) {
  deaf_.clear();
  with_pictures_.clear();
  for (const BusEndpoint& publication : bus_.publications()) {
    const std::string ros_name = ros_topic_name(publication.topic);
    const RobotTopic topic = robot_topic_from(ros_name);
    if (topic.robot < 0 || topic.topic->name == kScanTopic.name) continue;
    if (publication.type != topic.topic->wire_type()) {
      if (deaf_.size() < 20)
        deaf_.push_back(ros_name.substr(0, 100) +
                        " is published with another type: " + publication.type.substr(0, 100));
      continue;
    }
    // Strangers are told of, and not heard: that they are there is known by their state.
    if (!is_known(topic.robot) && topic.topic->name != kTeamStateTopic.name) continue;
    const bool is_picture = topic.topic->name == kImageTopic.name;
    if (is_picture) with_pictures_.push_back(topic.robot);
    if (is_picture && server_.listeners(picture_channels_.at(static_cast<std::size_t>(topic.robot))) == 0) continue;
    const auto known = ears_.find(publication.topic);
    if (known != ears_.end()) {
      known->second.published_at = now;
      continue;
    }
    if (ears_.size() >= kMostEars) {
      deaf_.assign(1, "more topics of robots than can be listened to");
      continue;
    }
    ears_.emplace(
        publication.topic,
        Ear{bus_.reader({publication.topic, publication.type, BusReliability::best_effort, is_picture ? 1 : kDepth}),
            ros_name, is_picture, topic.robot, now});
  }
  std::ranges::sort(with_pictures_);
  const auto [first, last] = std::ranges::unique(with_pictures_);
  with_pictures_.erase(first, last);
  std::erase_if(ears_, [&](const auto& entry) {
    const Ear& ear = entry.second;
    const bool is_unwanted =
        ear.is_picture && server_.listeners(picture_channels_.at(static_cast<std::size_t>(ear.robot))) == 0;
    return is_unwanted || now - ear.published_at > kForgotten;
  });
}

void LiveMonitor::record(const BusSample& sample, const Ear& ear) {
  if (!record_ || !record_trouble_.empty()) return;
  try {
    constexpr std::size_t most = 4000;  // senders that come and go without end have no channels of their own
    const Recorded key{ear.topic, channels_.size() < most ? sender_of(sample.writer) : "others"};
    auto channel = channels_.find(key);
    if (channel == channels_.end()) {
      const RobotTopic topic = robot_topic_from(ear.topic);
      channel =
          channels_
              .emplace(key,
                       record_->add_channel(
                           {ear.topic, topic.topic->ros_type(), topic.topic->definition(), {{"sender", key.sender}}}))
              .first;
    }
    record_->write(channel->second, sample.arrival_ns, std::max<std::int64_t>(sample.source_time_ns, 0), sample.data);
    ++recorded_;
  } catch (const Error& error) {
    record_trouble_ = error.what();
  }
}

void LiveMonitor::listen(double now) {
  struct Came {
    BusSample sample;
    const Ear* ear;
  };
  constexpr double longest_wait = 1;  // between two looks [s]
  const double wall = unix_now();
  std::vector<Came> came;
  for (auto& [topic, ear] : ears_)
    for (BusSample& sample : ear.reader.take()) came.push_back({std::move(sample), &ear});
  std::ranges::stable_sort(came, {}, [](const Came& one) { return one.sample.arrival_ns; });
  for (const Came& one : came) {
    if (one.ear->is_picture) {
      const auto picture = decoded<ros::CompressedImage>(one.sample.data);
      if (picture && implausible(*picture, one.ear->robot).empty())
        server_.publish(picture_channels_.at(static_cast<std::size_t>(one.ear->robot)),
                        std::make_shared<const std::string>(picture->data.begin(), picture->data.end()),
                        WebServer::Message::binary);
      record(one.sample, *one.ear);
      continue;
    }
    {
      const std::lock_guard lock(mutex_);
      // On the even clock: how long ago it came does not change when the machine's clock is set.
      const double ago = wall - 1e-9 * static_cast<double>(one.sample.arrival_ns);
      const double arrival = now - std::clamp(ago, 0., longest_wait);
      const std::string sender = sender_of(one.sample.writer);
      const Heard heard{one.ear->topic, sender, arrival, one.sample.data};
      if (const auto believed = view_.hear(heard)) bench_.hear(heard, *believed);
    }
    record(one.sample, *one.ear);
  }
}

/// To people at the terminal, and for a while to those who look at the page.
void LiveMonitor::tell(double now, const std::string& complaint) {
  fmt::print("bus: {}\n", complaint);
  std::fflush(stdout);
  bus_troubles_.push_back({now, "bus: " + complaint});
}

void LiveMonitor::publish(double now) {
  const bool is_wanted = server_.listeners(kTeamChannel) > 0;
  const std::lock_guard lock(mutex_);
  const bool is_kept = now - kept_at_ >= kKeptStep || now < kept_at_;
  if (!is_wanted && !is_kept) return;
  TeamPicture picture = view_.picture(now);
  picture.troubles.insert(picture.troubles.end(), deaf_.begin(), deaf_.end());
  constexpr double lasts = 60;  // [s]
  std::erase_if(bus_troubles_, [&](const Trouble& trouble) { return now - trouble.t > lasts; });
  for (const Trouble& trouble : bus_troubles_) picture.troubles.push_back(trouble.text);
  if (!record_trouble_.empty()) picture.troubles.push_back("no longer recorded: " + record_trouble_);
  const auto text = std::make_shared<const std::string>(team_picture_json(
      picture, bench_.at(now), view_.news().empty() ? 0 : view_.news().back().number, with_pictures_));
  if (is_kept) {
    kept_at_ = now;
    history_.add(now, text);
    trails_.add(picture);
  }
  if (is_wanted) server_.publish(kTeamChannel, text, WebServer::Message::text);
}

void LiveMonitor::run(const std::function<bool()>& is_over) {
  using Clock = std::chrono::steady_clock;
  constexpr auto look_for_topics = std::chrono::milliseconds(250);
  constexpr auto look = std::chrono::milliseconds(2);  // messages of one image come together, and are heard together
  const auto step = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / options_.rate));
  auto next_ears = Clock::now(), next_picture = Clock::now();
  while (!is_over()) {
    const auto until = std::min(next_ears, next_picture);
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now());
    if (bus_.wait(std::clamp(left, std::chrono::milliseconds(1), std::chrono::milliseconds(100))))
      std::this_thread::sleep_for(look);
    const double now = clock_.now();
    if (Clock::now() >= next_ears) {
      find_ears(now);
      for (const std::string& complaint : complaints_.news(bus_)) tell(now, complaint);
      next_ears = Clock::now() + look_for_topics;
    }
    listen(now);
    if (Clock::now() >= next_picture) {
      publish(now);
      next_picture = std::max(next_picture + step, Clock::now());
    }
  }
  if (record_) {
    try {
      record_->finish();
    } catch (const Error& error) {
      if (record_trouble_.empty()) record_trouble_ = error.what();
    }
  }
  if (!record_trouble_.empty()) throw Error(options_.record, record_trouble_);
}

std::string LiveMonitor::summary() const {
  const std::lock_guard lock(mutex_);
  TeamView view = view_;
  const TeamCounts counts = view.picture(clock_.now()).counts;
  std::string text = fmt::format("{} messages: {} refused, {} late, {} repeated\n", counts.heard, counts.refused,
                                 counts.late, counts.repeated);
  if (record_) text += fmt::format("log: {}, {} messages\n", options_.record, recorded_);
  return text;
}

WebResponse LiveMonitor::answer(const WebRequest& request) {
  if (request.method != "GET" && request.method != "HEAD") return refusal(405, "the monitor can be read only");
  const std::lock_guard lock(mutex_);
  if (request.path == "/api/monitor")
    return ok(monitor_json("live", fmt::format("domain {} on {}", options_.bus.domain, options_.bus.interface), "",
                           options_.field, history_.begin(), history_.end(), 0.1));
  if (request.path == "/api/monitor/at") {
    const auto t = number(request, "t");
    if (!t) return needs("t");
    const auto picture = history_.at(*t);
    if (!picture) return refusal(404, "nothing is known of that time any more, or yet");
    return ok(*picture);
  }
  if (request.path == "/api/monitor/trails") {
    const auto t = number(request, "t"), seconds = trail_seconds(request);
    if (!t) return needs("t");
    if (!seconds) return refusal(400, "seconds must be 0..60");
    return ok(team_trails_json(trails_.before(*t, *seconds)));
  }
  if (request.path == "/api/monitor/picture")
    return refusal(404, "live pictures come on /ws/picture<robot>; those of before are not kept");
  if (request.path == "/api/monitor/news") {
    return ok(team_news_json(news_after(request, {view_.news().begin(), view_.news().end()})));
  }
  return nothing_at(request);
}

LogMonitor::LogMonitor(const MonitorOptions& options, const std::string& log)
    : options_(options),
      name_(log),
      log_(log, options.view, fusion_on(options.field)),
      server_(with_channels(options.web, false), [this](const WebRequest& request) { return answer(request); }) {}

void LogMonitor::run(const std::function<bool()>& is_over) {
  while (!is_over()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

WebResponse LogMonitor::answer(const WebRequest& request) {
  if (request.method != "GET" && request.method != "HEAD") return refusal(405, "the monitor can be read only");
  if (request.path == "/api/monitor")
    return ok(monitor_json("log", name_, log_.damage(), options_.field, log_.begin(), log_.end(), 1. / 30));
  const auto t = number(request, "t");
  if (request.path == "/api/monitor/at") {
    if (!t) return needs("t");
    const TeamPicture picture = log_.at(*t);
    const std::vector<TeamNews> news = log_.news();
    return ok(team_picture_json(picture, log_.world(), news.empty() ? 0 : news.back().number, log_.with_pictures()));
  }
  if (request.path == "/api/monitor/trails") {
    const auto seconds = trail_seconds(request);
    if (!t) return needs("t");
    if (!seconds) return refusal(400, "seconds must be 0..60");
    return ok(team_trails_json(log_.trails(*t, *seconds)));
  }
  if (request.path == "/api/monitor/picture") {
    const auto robot = number(request, "robot");
    if (!t) return needs("t");
    if (!robot || *robot < 0 || *robot > 255 || *robot != std::floor(*robot))
      return refusal(400, "robot must be a whole number, 0..255");
    auto picture = log_.picture(static_cast<int>(*robot), *t);
    if (!picture) return refusal(404, "the log has no picture of this robot and time");
    return {200, "image/jpeg", std::move(*picture)};
  }
  if (request.path == "/api/monitor/news") {
    return ok(team_news_json(news_after(request, log_.news())));
  }
  return nothing_at(request);
}

}  // namespace tassilo
