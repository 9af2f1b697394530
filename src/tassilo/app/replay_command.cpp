#include <fmt/core.h>

#include <chrono>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tassilo/app/bus_arguments.h"
#include "tassilo/app/commands.h"
#include "tassilo/app/progress.h"
#include "tassilo/app/signals.h"
#include "tassilo/base/error.h"
#include "tassilo/message/from_scene.h"
#include "tassilo/record/mcap_reader.h"

namespace tassilo {
namespace {

struct ReplayArguments {
  std::string log;
  BusArguments bus;
  double speed = 1, from = 0;
  std::optional<double> duration;
  bool loop = false, keep_stamps = false, quiet = false;
};

using Clock = std::chrono::steady_clock;

double unix_now() { return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count(); }

class Replay {
 public:
  explicit Replay(const ReplayArguments& arguments)
      : arguments_(arguments), reader_(arguments.log), bus_(arguments.bus.options()) {
    for (const auto& [number, channel] : reader_.channels()) {
      const RobotTopic topic = robot_topic_from(channel.topic);
      if (topic.topic == nullptr || channel.message_encoding != "cdr") {
        ++left_out_;
        continue;
      }
      // Several senders of one topic were one topic on the bus.
      const auto [writer, is_new] = names_.try_emplace(channel.topic, nullptr);
      if (is_new)
        writer->second = std::make_shared<BusWriter>(
            bus_.writer({"rt" + channel.topic, topic.topic->wire_type(), BusReliability::best_effort, 1}));
      writers_.emplace(number, Out{topic.topic, writer->second});
    }
    if (writers_.empty()) throw Error(arguments.log, "has no topics of a robot, /robot<id>/...");
  }

  void operator()() {
    const double begin = 1e-9 * static_cast<double>(reader_.begin_ns()) + arguments_.from;
    const double end =
        arguments_.duration ? begin + *arguments_.duration : 1e-9 * static_cast<double>(reader_.end_ns());
    if (begin > 1e-9 * static_cast<double>(reader_.end_ns()))
      throw Error("--from", fmt::format("is {} s, but the log is over after {:.1f} s", arguments_.from,
                                        1e-9 * static_cast<double>(reader_.end_ns() - reader_.begin_ns())));
    if (!arguments_.quiet) {
      fmt::print("{}: {} messages, {:.1f} s{}\n", arguments_.log, reader_.message_count(),
                 1e-9 * static_cast<double>(reader_.end_ns() - reader_.begin_ns()),
                 reader_.is_complete() ? "" : "; " + reader_.damage());
      if (left_out_ > 0) fmt::print("{} channels that are no robot's are left out\n", left_out_);
      std::fflush(stdout);
    }
    do {
      once(begin, end);
    } while (arguments_.loop && !is_interrupted());
    if (!arguments_.quiet) fmt::print("{} messages sent\n", sent_);
  }

 private:
  struct Out {
    const Topic* topic;
    std::shared_ptr<BusWriter> writer;
  };

  void once(double begin, double end) {
    reader_.seek(static_cast<std::int64_t>(begin * 1e9));
    const auto started = Clock::now();
    const double started_unix = unix_now();
    const auto restamped = [&](const ros::Time& stamp) {
      return ros_time(std::max(0., started_unix + (seconds_of(stamp) - begin) / arguments_.speed));
    };
    while (const auto message = reader_.next()) {
      const double t = 1e-9 * static_cast<double>(message->log_time_ns);
      if (t > end) return;
      const auto due = started + std::chrono::duration_cast<Clock::duration>(
                                     std::chrono::duration<double>((t - begin) / arguments_.speed));
      constexpr auto patience = std::chrono::milliseconds(50);  // until a signal is noticed
      while (!is_interrupted() && Clock::now() < due)
        std::this_thread::sleep_for(std::min<Clock::duration>(patience, due - Clock::now()));
      if (is_interrupted()) return;
      const auto out = writers_.find(message->channel);
      if (out == writers_.end()) continue;
      out->second.writer->write(arguments_.keep_stamps
                                    ? std::vector<std::byte>(message->data.begin(), message->data.end())
                                    : stamped(*out->second.topic, message->data, restamped));
      ++sent_;
    }
  }

  /// The same message with another stamp.
  static std::vector<std::byte> stamped(const Topic& topic, std::span<const std::byte> data, const auto& restamped) {
    if (topic.name == kTransformsTopic.name) {
      auto message = decoded<ros::TFMessage>(data);
      if (!message) return {data.begin(), data.end()};
      for (ros::TransformStamped& transform : message->transforms)
        transform.header.stamp = restamped(transform.header.stamp);
      return encoded(*message);
    }
    // All others begin with their header; what is no message stays as it is, for whoever hears it to refuse.
    std::vector<std::byte> bytes(data.begin(), data.end());
    constexpr std::size_t stamp_at = 4, stamp_size = 8;
    if (bytes.size() < stamp_at + stamp_size || bytes[1] != std::byte{1}) return bytes;
    ros::Time stamp;
    std::memcpy(&stamp.sec, bytes.data() + stamp_at, sizeof(stamp.sec));
    std::memcpy(&stamp.nanosec, bytes.data() + stamp_at + 4, sizeof(stamp.nanosec));
    stamp = restamped(stamp);
    std::memcpy(bytes.data() + stamp_at, &stamp.sec, sizeof(stamp.sec));
    std::memcpy(bytes.data() + stamp_at + 4, &stamp.nanosec, sizeof(stamp.nanosec));
    return bytes;
  }

  const ReplayArguments& arguments_;
  McapReader reader_;
  Bus bus_;
  std::map<std::string, std::shared_ptr<BusWriter>> names_;
  std::map<std::uint16_t, Out> writers_;
  std::int64_t sent_ = 0, left_out_ = 0;
};

int replay(const ReplayArguments& arguments) {
  end_cleanly_on_signals();
  Replay one(arguments);
  one();
  return 0;
}

}  // namespace

Command add_replay(CLI::App& program) {
  auto* command = program.add_subcommand(
      "replay", "send a log's messages over the bus again, as they came: to the monitor, to ROS 2, to robots");
  auto arguments = std::make_shared<ReplayArguments>();
  command->add_option("log", arguments->log, "NAME.mcap, as run --record and monitor --record write it")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("--speed", arguments->speed, "so many times as fast as it was")
      ->check(CLI::Range(0.01, 100.))
      ->capture_default_str();
  command->add_option("--from", arguments->from, "begin so many seconds after the log's beginning")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--duration", arguments->duration, "end after so many seconds of the log")
      ->check(CLI::PositiveNumber);
  command->add_flag("--loop", arguments->loop, "again and again, until Ctrl-C");
  command->add_flag("--keep-stamps", arguments->keep_stamps,
                    "leave the times of the messages as they are, instead of as if it happened now");
  command->add_flag("-q,--quiet", arguments->quiet, "print nothing but errors");
  arguments->bus.add_to(*command);
  return [arguments] { return replay(*arguments); };
}

}  // namespace tassilo
