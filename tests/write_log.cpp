// write_log FILE [COUNT]: writes a log of COUNT (10) messages on three channels, as tests/log_exchange_test.py knows
// it. write_log FILE COUNT killed: the same, but the process is killed before it has finished.

#include <signal.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/record/mcap_writer.h"

namespace {

using tassilo::McapChannel;

/// A message in CDR, little-endian: every number on a multiple of its size behind the four bytes of its head.
class Message {
 public:
  template <class T>
  Message& add(T value) {
    while ((bytes_.size() - 4) % sizeof(T) != 0) bytes_.push_back({});
    const auto raw = std::bit_cast<std::array<std::byte, sizeof(T)>>(value);
    bytes_.insert(bytes_.end(), raw.begin(), raw.end());
    return *this;
  }
  Message& add(const std::string& text) {
    add(static_cast<std::uint32_t>(text.size() + 1));
    for (const char c : text) add(c);
    return add('\0');
  }
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
};

constexpr std::int64_t kBegin = 1'764'288'000'000'000'000;

McapChannel header_channel(const std::string& topic) {
  return {.topic = topic,
          .schema_name = "std_msgs/msg/Header",
          .definition = "builtin_interfaces/Time stamp\nstring frame_id\n" + std::string(80, '=') +
                        "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n",
          .metadata = {{"offered_qos_profiles", ""}}};
}

McapChannel numbers_channel() {
  return {.topic = "/numbers",
          .schema_name = "tassilo_test/msg/Numbers",
          .definition = "float64[] few\nint64 large\nuint8[] bytes\nfloat32[2] pair\n"};
}

Message header(int i) {
  return Message()
      .add(std::int32_t{1764288000 + i})
      .add(std::uint32_t(i))
      .add("robot_" + std::string(static_cast<std::size_t>(i % 7), 'x'));
}

Message numbers(int i) {
  Message message;
  message.add(std::uint32_t{3});
  for (const double value :
       {.5 * i, std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()})
    message.add(value);
  message.add(std::numeric_limits<std::int64_t>::min() + i).add(static_cast<std::uint32_t>(20 * i));
  for (int k = 0; k < 20 * i; ++k) message.add(static_cast<std::uint8_t>(k));
  message.add(1.5f).add(std::numeric_limits<float>::infinity());
  return message;
}

void write_log(const std::string& file, int count, bool is_killed) {
  tassilo::McapWriter writer(file, {.chunk_bytes = 400});
  const std::uint16_t channels[] = {writer.add_channel(header_channel("/pose/header")),
                                    writer.add_channel(numbers_channel()),
                                    writer.add_channel(header_channel("/ball/header"))};
  writer.add_metadata("robot", {{"id", "3"}, {"team", "cyan"}});
  for (int i = 0; i < count; ++i) {
    // Every fourth message is late.
    const std::int64_t time = kBegin + 10'000'000 * std::int64_t{i} - (i % 4 == 3 ? 25'000'000 : 0);
    writer.write(channels[i % 3], time, time - 1000, (i % 3 == 1 ? numbers(i) : header(i)).bytes());
  }
  if (is_killed) ::raise(SIGKILL);
  writer.finish();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  try {
    write_log(argv[1], argc > 2 ? std::atoi(argv[2]) : 10, argc > 3);
  } catch (const tassilo::Error& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
