#include "tassilo/source/line_stream.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;

/// Standard input as a pipe, while alive.
class PipedInput {
 public:
  PipedInput() : before_(::dup(STDIN_FILENO)) {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
    ::dup2(ends[0], STDIN_FILENO);
    ::close(ends[0]);
    write_end_ = ends[1];
  }
  ~PipedInput() {
    end();
    ::dup2(before_, STDIN_FILENO);
    ::close(before_);
  }
  void write(const std::string& text) const {
    ASSERT_EQ(::write(write_end_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  void end() {
    if (write_end_ >= 0) ::close(write_end_);
    write_end_ = -1;
  }

 private:
  int before_, write_end_ = -1;
};

/// All lines up to `count`.
std::vector<std::string> wait_for(LineStream& stream, std::size_t count) {
  std::vector<std::string> lines;
  for (int looks = 0; looks < 200 && lines.size() < count; ++looks)
    for (std::string& line : stream.take(milliseconds(50))) lines.push_back(std::move(line));
  return lines;
}

TEST(LineStream, LinesOfStandardInputAsTheyCome) {
  PipedInput input;
  LineStream stream("-");
  EXPECT_THAT(stream.take(milliseconds(0)), ElementsAre());
  input.write("one\ntw");
  EXPECT_THAT(wait_for(stream, 1), ElementsAre("one"));
  EXPECT_FALSE(stream.over());
  input.write("o\r\n\nthree");
  EXPECT_THAT(wait_for(stream, 1), ElementsAre("two"));
  input.end();
  EXPECT_THAT(wait_for(stream, 1), ElementsAre("three"));
  for (int looks = 0; looks < 200 && !stream.over(); ++looks) ::usleep(1000);
  EXPECT_TRUE(stream.over());
}

TEST(LineStream, LongLinesAreDroppedAndMemoryIsBounded) {
  PipedInput input;
  LineStream stream("-");
  input.write(std::string(10000, 'x') + "\n" + std::string(4096, 'y') + "\n" + std::string(4097, 'z') + "\nok\n");
  const auto lines = wait_for(stream, 2);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].size(), 4096U);
  EXPECT_EQ(lines[1], "ok");
  EXPECT_EQ(stream.dropped(), 2);

  constexpr int kLines = 200000;
  for (int k = 0; k < kLines; ++k) input.write(std::to_string(k) + "\n");
  input.end();
  while (!stream.over()) ::usleep(1000);
  const auto rest = wait_for(stream, 1);
  EXPECT_EQ(rest.back(), std::to_string(kLines - 1)) << "the newest are kept";
  EXPECT_LE(rest.size(), 65536U);
  EXPECT_GE(rest.size(), 32768U);
  EXPECT_EQ(static_cast<std::int64_t>(rest.size()) + stream.dropped() - 2, kLines);
}

/// A free port of this machine, as good as certainly still free a moment later.
int free_port() {
  const int fd = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ::bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof address);
  socklen_t length = sizeof address;
  ::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &length);
  ::close(fd);
  return ntohs(address.sin_port);
}

TEST(LineStream, DatagramsOfThisMachine) {
  const int port = free_port();
  const std::string location = "udp:127.0.0.1:" + std::to_string(port);
  LineStream stream(location);
  const int fd = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  for (const std::string text : {"one\ntwo", "", "three\n"})
    ::sendto(fd, text.data(), text.size(), 0, reinterpret_cast<sockaddr*>(&address), sizeof address);
  EXPECT_THAT(wait_for(stream, 3), ElementsAre("one", "two", "three"));
  EXPECT_FALSE(stream.over());
  ::close(fd);
  EXPECT_THROW(LineStream{location}, Error) << "the port is taken";
}

TEST(LineStream, OtherMachinesAreNotListenedTo) {
  for (const std::string location : {"udp:0.0.0.0:5000", "udp:5000", "udp:127.0.0.1", "udp:127.0.0.1:0",
                                     "udp:127.0.0.1:65536", "udp:127.0.0.1:50x", "udp:[::1]:5000"}) {
    SCOPED_TRACE(location);
    EXPECT_TRUE(is_line_stream(location));
    try {
      const LineStream stream(location);
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("must be udp:127.0.0.1:PORT"));
    }
  }
  EXPECT_FALSE(is_line_stream("odometry.jsonl"));
}

}  // namespace
}  // namespace tassilo
