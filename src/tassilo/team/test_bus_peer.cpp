// A process with a bus of its own, for tests: does what the lines of its standard input say and answers each with one
// line.
//   reader TOPIC TYPE best_effort|reliable DEPTH      -> ok
//   writer TOPIC TYPE best_effort|reliable DEPTH      -> ok
//   readers TOPIC N | writers TOPIC N                 -> ok when so many are matched, or "late" after 20 s
//   send TOPIC HEX                                    -> sent | given up
//   pattern TOPIC SIZE SEED                           -> sent | given up: bytes of pattern() in bus_pattern.h
//   take TOPIC N [MS]                                 -> the hexadecimal bytes of N messages, blanks between, or "late"
//   taken TOPIC                                       -> number of all messages that came since the last line
//   lost TOPIC | refused TOPIC                        -> number
//   stream TOPIC SIZE MS                              -> ok; from now on writes a pattern each MS, seeds counting from
//   0 publications                                      -> TOPIC TYPE ID, blanks between rss -> memory in use [kB]
// usage: bus_peer DOMAIN [INTERFACE [multicast] [PEER...]]
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <thread>

#include "tassilo/base/error.h"
#include "tassilo/team/bus.h"
#include "tassilo/team/test_bus_pattern.h"

namespace tassilo {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kPatience_ms = 20'000;

std::string hex(std::span<const std::byte> data) {
  std::string text;
  for (const std::byte byte : data) {
    text += "0123456789abcdef"[std::to_integer<int>(byte >> 4)];
    text += "0123456789abcdef"[std::to_integer<int>(byte & std::byte{15})];
  }
  return text;
}
std::vector<std::byte> unhex(const std::string& text) {
  std::vector<std::byte> data;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
    data.push_back(static_cast<std::byte>(std::stoi(text.substr(i, 2), nullptr, 16)));
  return data;
}

class Peer {
 public:
  explicit Peer(const BusOptions& options) : bus_(options) {}

  std::string answer(const std::string& line) {
    std::istringstream words(line);
    std::string verb, topic;
    words >> verb >> topic;
    if (verb == "reader" || verb == "writer") {
      BusTopic options;
      options.name = topic;
      std::string reliability;
      words >> options.type >> reliability >> options.depth;
      options.reliability = reliability == "reliable" ? BusReliability::reliable : BusReliability::best_effort;
      if (verb == "reader")
        readers_.emplace(topic, bus_.reader(options));
      else
        writers_.emplace(topic, bus_.writer(options));
      return "ok";
    }
    if (verb == "readers" || verb == "writers") {
      int count = 0;
      words >> count;
      return until(kPatience_ms,
                   [&] {
                     return (verb == "readers" ? writers_.at(topic).readers() : readers_.at(topic).writers()) == count;
                   })
                 ? "ok"
                 : "late";
    }
    if (verb == "send") {
      std::string bytes;
      words >> bytes;
      return writers_.at(topic).write(unhex(bytes)) ? "sent" : "given up";
    }
    if (verb == "pattern") {
      std::size_t size = 0;
      int seed = 0;
      words >> size >> seed;
      return writers_.at(topic).write(bus_pattern(size, seed)) ? "sent" : "given up";
    }
    if (verb == "take") {
      std::size_t count = 0, found = 0;
      int patience_ms = 0;
      words >> count;
      if (!(words >> patience_ms)) patience_ms = kPatience_ms;
      std::string bytes;
      const bool in_time = until(patience_ms, [&] {
        for (const BusSample& sample : readers_.at(topic).take()) {
          if (!bytes.empty()) bytes += ' ';
          bytes += hex(sample.data);
          ++found;
        }
        return found >= count;
      });
      return in_time ? bytes : "late";
    }
    if (verb == "taken") return std::to_string(readers_.at(topic).take().size());
    if (verb == "lost") return std::to_string(readers_.at(topic).lost());
    if (verb == "refused") return std::to_string(readers_.at(topic).refused());
    if (verb == "complaints") {
      std::string text;
      for (const std::string& complaint : Bus::complaints()) text += complaint + "; ";
      return text;
    }
    if (verb == "stream") {
      std::size_t size = 0;
      int ms = 0;
      words >> size >> ms;
      streams_.emplace_back([this, topic, size, ms](const std::stop_token& stop) {
        for (int seed = 0; !stop.stop_requested(); ++seed) {
          writers_.at(topic).write(bus_pattern(size, seed));
          std::this_thread::sleep_for(std::chrono::milliseconds(ms));
        }
      });
      return "ok";
    }
    if (verb == "publications") {
      std::string text;
      for (const BusEndpoint& writer : bus_.publications())
        text += writer.topic + " " + writer.type + " " + to_string(writer.id) + " ";
      return text;
    }
    if (verb == "rss") {
      std::ifstream status("/proc/self/status");
      for (std::string word; status >> word;)
        if (word == "VmRSS:" && status >> word) return word;
    }
    return "unknown: " + line;
  }

 private:
  template <class Condition>
  bool until(int patience_ms, const Condition& holds) {
    const auto end = Clock::now() + std::chrono::milliseconds(patience_ms);
    while (!holds()) {
      if (Clock::now() > end) return false;
      bus_.wait(std::chrono::milliseconds(20));
    }
    return true;
  }

  Bus bus_;
  std::map<std::string, BusReader> readers_;
  std::map<std::string, BusWriter> writers_;
  std::vector<std::jthread> streams_;
};

}  // namespace
}  // namespace tassilo

int main(int count, char** arguments) {
  try {
    tassilo::BusOptions options;
    if (count > 1) options.domain = std::stoi(arguments[1]);
    if (count > 2) options.interface = arguments[2];
    for (int i = 3; i < count; ++i) {
      if (arguments[i] == std::string("multicast"))
        options.multicast = true;
      else
        options.peers.push_back(arguments[i]);
    }
    tassilo::Peer peer(options);
    std::cout << "ready" << std::endl;
    for (std::string line; std::getline(std::cin, line);) {
      try {
        std::cout << peer.answer(line) << std::endl;
      } catch (const std::exception& error) {
        std::cout << "error: " << error.what() << std::endl;
      }
    }
  } catch (const std::exception& error) {
    std::cout << "error: " << error.what() << std::endl;
    return 1;
  }
  return 0;
}
