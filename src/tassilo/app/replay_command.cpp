#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "tassilo/app/bus_arguments.h"
#include "tassilo/app/commands.h"
#include "tassilo/app/signals.h"
#include "tassilo/app/unix_clock.h"
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

/// What a message's stamp becomes; nothing where that is no time: others are to judge what it was.
std::optional<ros::Time> moved(const ros::Time& stamp, double by) {
  constexpr double end_of_time = 2147483647;  // that a stamp can say: 2038 [s]
  const double t = seconds_of(stamp) + by;
  if (!(t >= 0 && t < end_of_time)) return std::nullopt;
  return ros_time(t);
}

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
            bus_.writer({wire_topic_name(channel.topic), topic.topic->wire_type(), BusReliability::best_effort, 1}));
      writers_.emplace(number, Out{topic.topic, writer->second});
    }
    if (writers_.empty()) throw Error(arguments.log, "has no topics of a robot, /robot<id>/...");
  }

  void operator()() {
    const double length = seconds(reader_.end_ns() - reader_.begin_ns());
    if (arguments_.from > length)
      throw Error("--from", fmt::format("is {} s, but the log is over after {:.1f} s", arguments_.from, length));
    if (!arguments_.quiet) {
      fmt::print("{}: {} messages, {:.1f} s{}\n", arguments_.log, reader_.message_count(), length,
                 reader_.is_complete() ? "" : "; " + reader_.damage());
      if (left_out_ > 0) fmt::print("{} channels that are no robot's are left out\n", left_out_);
      std::fflush(stdout);
    }
    const std::int64_t begin = reader_.begin_ns() + nanoseconds(arguments_.from);
    const std::int64_t end =
        arguments_.duration ? std::min(reader_.end_ns(), begin + nanoseconds(*arguments_.duration)) : reader_.end_ns();
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

  static double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }
  static std::int64_t nanoseconds(double s) { return static_cast<std::int64_t>(s * 1e9); }

  static void wait_until(Clock::time_point then) {
    constexpr auto patience = std::chrono::milliseconds(50);  // until a signal is noticed
    while (!is_interrupted() && Clock::now() < then)
      std::this_thread::sleep_for(std::min<Clock::duration>(patience, then - Clock::now()));
  }

  void once(std::int64_t begin, std::int64_t end) {
    reader_.seek(begin);
    const auto started = Clock::now();
    const double started_unix = unix_now();
    const auto when = [&](std::int64_t log_time) { return seconds(log_time - begin) / arguments_.speed; };
    const auto due = [&](double s) {
      return started + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
    };
    while (const auto message = reader_.next()) {
      if (message->log_time_ns > end) break;
      wait_until(due(when(message->log_time_ns)));
      if (is_interrupted()) return;
      const auto out = writers_.find(message->channel);
      if (out == writers_.end()) continue;
      // As much before it is sent as it was before it was written down, however fast: clocks keep their differences.
      const double later = started_unix + when(message->log_time_ns) - seconds(message->log_time_ns);
      out->second.writer->write(arguments_.keep_stamps
                                    ? std::vector<std::byte>(message->data.begin(), message->data.end())
                                    : stamped(*out->second.topic, message->data, later));
      ++sent_;
    }
    constexpr double shortest = 0.1;  // a pass takes time, whatever is in it [s]
    wait_until(due(std::max(shortest, when(end))));
  }

  /// The same message with stamps so many seconds later.
  static std::vector<std::byte> stamped(const Topic& topic, std::span<const std::byte> data, double later) {
    std::vector<std::byte> bytes(data.begin(), data.end());
    if (topic.name == kTransformsTopic.name) {
      auto message = decoded<ros::TFMessage>(data);
      if (!message) return bytes;
      for (ros::TransformStamped& transform : message->transforms)
        transform.header.stamp = moved(transform.header.stamp, later).value_or(transform.header.stamp);
      return encoded(*message);
    }
    // All others begin with their stamp; what is no message stays as it is, for whoever hears it to refuse.
    constexpr std::size_t stamp_at = 4;
    if (bytes.size() < stamp_at + 8 || bytes[0] != std::byte{0} || bytes[1] > std::byte{1}) return bytes;
    const bool is_big_endian = bytes[1] == std::byte{0};
    const auto numbers = std::span(bytes).subspan(stamp_at, 8);
    const auto swap = [&] {
      if (!is_big_endian) return;
      std::reverse(numbers.begin(), numbers.begin() + 4);
      std::reverse(numbers.begin() + 4, numbers.end());
    };
    swap();
    ros::Time stamp;
    std::memcpy(&stamp.sec, numbers.data(), 4);
    std::memcpy(&stamp.nanosec, numbers.data() + 4, 4);
    stamp = moved(stamp, later).value_or(stamp);
    std::memcpy(numbers.data(), &stamp.sec, 4);
    std::memcpy(numbers.data() + 4, &stamp.nanosec, 4);
    swap();
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
