// read_log FILE: prints a line for each message of a log, `topic schema encoding log_time publish_time sequence bytes`,
// bytes in hex or `-`; then `metadata NAME KEY=VALUE ..` for each note, and `complete` or what is wrong with the file.

#include <cstddef>
#include <iostream>
#include <span>
#include <string>

#include "tassilo/base/error.h"
#include "tassilo/record/mcap_reader.h"

namespace {

std::string hex(std::span<const std::byte> bytes) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text = bytes.empty() ? "-" : "";
  for (const std::byte byte : bytes) {
    text += kDigits[std::to_integer<int>(byte) / 16];
    text += kDigits[std::to_integer<int>(byte) % 16];
  }
  return text;
}

void print_log(const std::string& file) {
  tassilo::McapReader reader(file);
  std::uint64_t count = 0;
  while (const auto message = reader.next()) {
    const tassilo::McapChannel& channel = reader.channels().at(message->channel);
    std::cout << channel.topic << " " << channel.schema_name << " " << channel.message_encoding << " "
              << message->log_time_ns << " " << message->publish_time_ns << " " << message->sequence << " "
              << hex(message->data) << "\n";
    ++count;
  }
  for (const tassilo::McapMetadata& note : reader.metadata()) {
    std::cout << "metadata " << note.name;
    for (const auto& [key, value] : note.pairs) std::cout << " " << key << "=" << value;
    std::cout << "\n";
  }
  if (!reader.is_complete()) {
    std::cout << reader.damage() << "\n";
  } else if (reader.message_count() != count || reader.damaged_chunks() > 0) {
    std::cout << count << " messages of " << reader.message_count() << "\n";
  } else {
    std::cout << "complete\n";
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    print_log(argv[1]);
  } catch (const tassilo::Error& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
