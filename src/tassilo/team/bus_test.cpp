#include "tassilo/team/bus.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <sstream>
#include <thread>

#include "tassilo/base/error.h"
#include "tassilo/team/test_bus_domain.h"
#include "tassilo/team/test_bus_pattern.h"

namespace tassilo {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Clock = std::chrono::steady_clock;

constexpr char kType[] = "std_msgs::msg::dds_::ByteMultiArray_";
constexpr char kOtherType[] = "std_msgs::msg::dds_::Float64MultiArray_";
constexpr std::chrono::seconds kPatience{20};  // something hangs, whatever the machine and the sanitizer

BusOptions on(int domain) {
  BusOptions options;
  options.domain = domain;
  return options;
}

BusTopic topic(const std::string& name, BusReliability reliability = BusReliability::reliable, int depth = 10) {
  return {name, kType, reliability, depth};
}

/// Waits on the bus until it holds; false when it does not in a long time.
bool until(Bus& bus, const std::function<bool()>& holds) {
  const auto end = Clock::now() + kPatience;
  while (!holds()) {
    if (Clock::now() > end) return false;
    bus.wait(20ms);
  }
  return true;
}

/// All that comes until there are `count`.
std::vector<BusSample> take(Bus& bus, BusReader& reader, std::size_t count) {
  std::vector<BusSample> samples;
  until(bus, [&] {
    std::ranges::move(reader.take(), std::back_inserter(samples));
    return samples.size() >= count;
  });
  return samples;
}

/// The program test_bus_peer, which has a bus of its own.
class Peer {
 public:
  explicit Peer(int domain) {
    int to[2], from[2];
    if (pipe(to) != 0 || pipe(from) != 0) throw std::runtime_error("no pipe");
    process_ = fork();
    if (process_ == 0) {
      dup2(to[0], STDIN_FILENO);
      dup2(from[1], STDOUT_FILENO);
      for (const int end : {to[0], to[1], from[0], from[1]}) close(end);
      execl(TASSILO_BUS_PEER, TASSILO_BUS_PEER, std::to_string(domain).c_str(), nullptr);
      _exit(127);
    }
    close(to[0]);
    close(from[1]);
    to_ = fdopen(to[1], "w");
    from_ = fdopen(from[0], "r");
    EXPECT_EQ(line(), "ready");
  }
  ~Peer() { end(); }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  std::string ask(const std::string& text) {
    std::fputs((text + "\n").c_str(), to_);
    std::fflush(to_);
    return line();
  }
  void signal(int number) { kill(process_, number); }
  /// Leaves the domain as it should, unless it was killed.
  void end() {
    if (process_ < 0) return;
    std::fclose(to_);
    signal(SIGCONT);
    waitpid(process_, nullptr, 0);
    std::fclose(from_);
    process_ = -1;
  }

 private:
  std::string line() {
    std::string text;
    for (int c; (c = std::fgetc(from_)) != EOF && c != '\n';) text += static_cast<char>(c);
    return text;
  }

  pid_t process_ = -1;
  std::FILE *to_ = nullptr, *from_ = nullptr;
};

std::string failure_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(BusOptions, NamesTheFieldThatIsOutOfRange) {
  const auto failure = [](const std::function<void(BusOptions&)>& spoil) {
    BusOptions options;
    spoil(options);
    return failure_of([&] { options.check(); });
  };
  EXPECT_EQ(failure([](BusOptions&) {}), "");
  EXPECT_EQ(failure([](BusOptions& o) { o.domain = 233; }), "bus.domain: is 233, must be in 0..232");
  EXPECT_THAT(failure([](BusOptions& o) { o.domain = -1; }), HasSubstr("bus.domain"));
  EXPECT_THAT(failure([](BusOptions& o) { o.interface = "lo\"/>"; }), HasSubstr("bus.interface"));
  EXPECT_THAT(failure([](BusOptions& o) { o.peers = {"robot1", "${HOME}"}; }), HasSubstr("bus.peers"));
  EXPECT_THAT(failure([](BusOptions& o) { o.multicast = true; }), HasSubstr("bus.multicast"));
  EXPECT_THAT(failure([](BusOptions& o) { o.max_participants = 61; }), HasSubstr("bus.max_participants"));
  EXPECT_EQ(failure([](BusOptions& o) { o.lease_s = 0.5; }), "bus.lease_s: is 0.5, must be in 1..60");
  EXPECT_THAT(failure([](BusOptions& o) { o.max_block_ms = -1; }), HasSubstr("bus.max_block_ms"));
  EXPECT_THAT(failure([](BusOptions& o) { o.max_bytes = 0; }), HasSubstr("bus.max_bytes"));
  EXPECT_THAT(failure_of([] { BusTopic{"rt/a b", kType}.check(); }), HasSubstr("bus.topic.name"));
  EXPECT_THAT(failure_of([] { BusTopic{"rt/a", ""}.check(); }), HasSubstr("bus.topic.type"));
  EXPECT_THAT(failure_of([] { topic("rt/a", BusReliability::reliable, 0).check(); }), HasSubstr("bus.topic.depth"));
}

TEST(Bus, ABadInterfaceIsAnErrorThatNamesIt) {
  BusOptions options = on(free_domain());
  options.interface = "nonesuch0";
  EXPECT_THAT(failure_of([&] { Bus bus(options); }), HasSubstr("nonesuch0"));
}

/// How many packets to the UDP port of this machine the kernel has thrown away.
long dropped_at(int port) {
  std::ifstream table("/proc/net/udp");
  std::string line;
  std::getline(table, line);
  while (std::getline(table, line)) {
    std::istringstream words(line);
    std::string word, local, last;
    words >> word >> local;
    while (words >> word) last = word;
    if (std::stoi(local.substr(local.find(':') + 1), nullptr, 16) == port) return std::stol(last);
  }
  return -1;
}

/// An address of this machine that is not a loopback one, in network byte order: where packets to elsewhere come from.
/// 0: none.
in_addr_t address_beyond_loopback() {
  const int asking = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(9);
  address.sin_addr.s_addr = htonl(0xc0000201);  // 192.0.2.1, for documentation; connecting UDP sends nothing
  socklen_t size = sizeof address;
  const bool found = connect(asking, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                     getsockname(asking, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  close(asking);
  return found && (ntohl(address.sin_addr.s_addr) >> 24) != 127 ? address.sin_addr.s_addr : 0;
}

TEST(Bus, OnLoopbackNothingFromElsewhereReachesIt) {
  const in_addr_t elsewhere = address_beyond_loopback();
  if (elsewhere == 0) GTEST_SKIP() << "this machine has loopback only, so nothing can come from elsewhere";
  const int domain = free_domain();
  Bus bus(on(domain));
  for (const int port : {7400 + 250 * domain + 10, 7400 + 250 * domain + 11}) {
    SCOPED_TRACE(port);
    const long before = dropped_at(port);
    ASSERT_GE(before, 0);
    for (const in_addr_t source : {htonl(INADDR_LOOPBACK), elsewhere}) {
      const int sending = socket(AF_INET, SOCK_DGRAM, 0);
      sockaddr_in address{};
      address.sin_family = AF_INET;
      address.sin_addr.s_addr = source;
      ASSERT_EQ(bind(sending, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
      address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      address.sin_port = htons(static_cast<std::uint16_t>(port));
      ASSERT_EQ(sendto(sending, "hello", 5, 0, reinterpret_cast<sockaddr*>(&address), sizeof address), 5);
      close(sending);
    }
    ASSERT_TRUE(until(bus, [&] { return dropped_at(port) > before; }));  // the kernel takes its time to count
    EXPECT_EQ(dropped_at(port), before + 1);
  }
}

TEST(Bus, BytesPassUnchangedWithinAProcess) {
  const int domain = free_domain();
  Bus bus(on(domain)), other(on(domain));
  BusWriter writer = bus.writer(topic("rt/a"));
  BusReader reader = other.reader(topic("rt/a"));
  ASSERT_TRUE(until(bus, [&] { return writer.readers() == 1 && reader.writers() == 1; }));
  for (const std::size_t size : {0, 1, 2, 3, 4, 5, 1000, 100'001}) {
    SCOPED_TRACE(size);
    const auto sent = bus_pattern(size, 3);
    ASSERT_TRUE(writer.write(sent));
    const auto got = take(other, reader, 1);
    ASSERT_EQ(got.size(), 1u);
    EXPECT_EQ(got[0].data, sent);
    EXPECT_EQ(got[0].writer, writer.id());
  }
  EXPECT_EQ(reader.lost(), 0);
  EXPECT_EQ(reader.refused(), 0);
}

TEST(Bus, BytesPassUnchangedBetweenProcesses) {
  const int domain = free_domain();
  Bus bus(on(domain));
  Peer peer(domain);
  ASSERT_EQ(peer.ask(std::string("reader rt/there ") + kType + " reliable 10"), "ok");
  ASSERT_EQ(peer.ask(std::string("writer rt/back ") + kType + " reliable 10"), "ok");
  BusWriter writer = bus.writer(topic("rt/there"));
  BusReader reader = bus.reader(topic("rt/back"));
  ASSERT_TRUE(until(bus, [&] { return writer.readers() == 1 && reader.writers() == 1; }));
  ASSERT_EQ(peer.ask("writers rt/there 1"), "ok");
  ASSERT_EQ(peer.ask("readers rt/back 1"), "ok");
  const auto now_ns = [] {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
        .count();
  };
  int seed = 0;
  for (const std::size_t size :
       {0, 1, 2, 3, 4, 5, 6, 7, 8, 1000, 1343, 1344, 14'717, 65'501, 100'000, 300'001, 1'000'000}) {
    SCOPED_TRACE(size);
    const auto sent = bus_pattern(size, ++seed);
    const auto before = now_ns();
    ASSERT_EQ(peer.ask("pattern rt/back " + std::to_string(size) + " " + std::to_string(seed)), "sent");
    const auto got = take(bus, reader, 1);
    ASSERT_EQ(got.size(), 1u);
    EXPECT_TRUE(got[0].data == sent) << got[0].data.size();
    EXPECT_LE(before, got[0].source_time_ns);
    EXPECT_LE(got[0].source_time_ns, got[0].arrival_ns);
    EXPECT_LE(got[0].arrival_ns, now_ns());

    ASSERT_TRUE(writer.write(sent));
    std::string hex;
    for (const std::byte byte : sent) {
      hex += "0123456789abcdef"[std::to_integer<int>(byte >> 4)];
      hex += "0123456789abcdef"[std::to_integer<int>(byte & std::byte{15})];
    }
    EXPECT_TRUE(peer.ask("take rt/there 1") == hex);
  }
  EXPECT_EQ(reader.lost(), 0);
}

TEST(Bus, BestEffortArrives) {
  const int domain = free_domain();
  Bus bus(on(domain));
  Peer peer(domain);
  ASSERT_EQ(peer.ask(std::string("writer rt/image ") + kType + " best_effort 1"), "ok");
  BusReader reader = bus.reader(topic("rt/image", BusReliability::best_effort, 5));
  ASSERT_TRUE(until(bus, [&] { return reader.writers() == 1; }));
  ASSERT_EQ(peer.ask("readers rt/image 1"), "ok");
  // As it may be lost, it is sent until one comes: whole, or not at all.
  int seed = 0;
  std::vector<BusSample> got;
  ASSERT_TRUE(until(bus, [&] {
    peer.ask("pattern rt/image 100000 " + std::to_string(++seed));
    got = reader.take();
    return !got.empty();
  }));
  EXPECT_EQ(got[0].data.size(), 100'004u);
  bool is_known = false;
  for (int i = 1; i <= seed; ++i) is_known = is_known || got[0].data == bus_pattern(100'000, i);
  EXPECT_TRUE(is_known);
}

TEST(Bus, ABestEffortWriterIsHeardByNoReliableReaderAndThatIsTold) {
  const int domain = free_domain();
  Bus bus(on(domain));
  Peer peer(domain);
  ASSERT_EQ(peer.ask(std::string("writer rt/a ") + kType + " best_effort 1"), "ok");
  ASSERT_EQ(peer.ask(std::string("writer rt/b ") + kType + " reliable 1"), "ok");
  BusReader strict = bus.reader(topic("rt/a", BusReliability::reliable));
  BusReader easy = bus.reader(topic("rt/b", BusReliability::best_effort));
  ASSERT_TRUE(until(bus, [&] { return easy.writers() == 1 && bus.conflicts().size() == 1; }));
  EXPECT_THAT(bus.conflicts(), ElementsAre(HasSubstr("the reader asks for reliable")));
  EXPECT_EQ(strict.writers(), 0);
}

TEST(Bus, KeepsTheNewestAndCountsTheRest) {
  Bus bus(on(free_domain()));
  BusWriter writer = bus.writer(topic("rt/a"));
  BusReader reader = bus.reader(topic("rt/a", BusReliability::reliable, 3));
  ASSERT_TRUE(until(bus, [&] { return writer.readers() == 1 && reader.writers() == 1; }));
  writer.write(bus_pattern(8, 0));
  EXPECT_EQ(take(bus, reader, 1).size(), 1u);
  for (int seed = 1; seed <= 10; ++seed) writer.write(bus_pattern(8, seed));
  const auto got = take(bus, reader, 3);
  ASSERT_EQ(got.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(got[static_cast<std::size_t>(i)].data, bus_pattern(8, 8 + i));
  EXPECT_EQ(reader.lost(), 7);
  EXPECT_THAT(reader.take(), IsEmpty());
}

TEST(Bus, DomainsDoNotHearEachOther) {
  Bus bus(on(free_domain())), elsewhere(on(free_domain()));
  BusWriter writer = bus.writer(topic("rt/a"));
  BusReader here = bus.reader(topic("rt/a")), there = elsewhere.reader(topic("rt/a"));
  ASSERT_TRUE(until(bus, [&] { return writer.readers() == 1 && here.writers() == 1; }));
  writer.write(bus_pattern(8, 1));
  EXPECT_EQ(take(bus, here, 1).size(), 1u);
  EXPECT_EQ(there.writers(), 0);
  EXPECT_THAT(there.take(), IsEmpty());
  EXPECT_THAT(elsewhere.publications(), IsEmpty());
}

TEST(Bus, ADomainHasOneSetOfOptionsInAProcess) {
  const int domain = free_domain();
  {
    Bus bus(on(domain));
    BusOptions other = on(domain);
    other.lease_s = 5;
    EXPECT_THAT(failure_of([&] { Bus second(other); }), HasSubstr("other options"));
  }
  BusOptions other = on(domain);
  other.lease_s = 5;
  EXPECT_EQ(failure_of([&] { Bus second(other); }), "");
}

TEST(Bus, ReadersAndWritersMayOutliveIt) {
  auto bus = std::make_unique<Bus>(on(free_domain()));
  BusWriter writer = bus->writer(topic("rt/a"));
  BusReader reader = bus->reader(topic("rt/a"));
  ASSERT_TRUE(until(*bus, [&] { return writer.readers() == 1 && reader.writers() == 1; }));
  bus.reset();
  EXPECT_TRUE(writer.write(bus_pattern(8, 1)));
  std::vector<BusSample> got;
  for (const auto end = Clock::now() + kPatience; got.empty() && Clock::now() < end;) got = reader.take();
  EXPECT_EQ(got.size(), 1u);
}

TEST(Bus, FindsPublicationsItDoesNotKnowAndForgetsThem) {
  const int domain = free_domain();
  Bus bus(on(domain));
  EXPECT_THAT(bus.publications(), IsEmpty());
  {
    Peer peer(domain);
    ASSERT_EQ(peer.ask("writer rt/robot3/pose geometry_msgs::msg::dds_::PoseWithCovarianceStamped_ best_effort 1"),
              "ok");
    ASSERT_EQ(peer.ask(std::string("reader rt/robot3/orders ") + kType + " reliable 1"), "ok");
    ASSERT_TRUE(until(bus, [&] { return bus.publications().size() == 1 && bus.subscriptions().size() == 1; }));
    const BusEndpoint found = bus.publications()[0];
    EXPECT_EQ(found.topic, "rt/robot3/pose");
    EXPECT_EQ(found.type, "geometry_msgs::msg::dds_::PoseWithCovarianceStamped_");
    EXPECT_EQ(found.reliability, BusReliability::best_effort);
    EXPECT_FALSE(found.is_own);
    EXPECT_THAT(peer.ask("publications"), HasSubstr(to_string(found.id)));
    EXPECT_EQ(bus.subscriptions()[0].participant, found.participant);
    EXPECT_EQ(bus.subscriptions()[0].reliability, BusReliability::reliable);
  }
  EXPECT_TRUE(until(bus, [&] { return bus.publications().empty() && bus.subscriptions().empty(); }));

  const BusWriter own = bus.writer(topic("rt/own"));
  ASSERT_TRUE(until(bus, [&] { return bus.publications().size() == 1; }));
  EXPECT_TRUE(bus.publications()[0].is_own);
  EXPECT_EQ(bus.publications()[0].id, own.id());
  EXPECT_EQ(bus.publications()[0].participant, bus.id());
}

TEST(Bus, WhoIsKilledIsGoneAfterTheLeaseAndMayComeAgain) {
  const int domain = free_domain();
  BusOptions options = on(domain);
  Bus bus(options);
  BusReader reader = bus.reader(topic("rt/a"));
  for (int life = 0; life < 2; ++life) {
    SCOPED_TRACE(life);
    Peer peer(domain);
    ASSERT_EQ(peer.ask(std::string("writer rt/a ") + kType + " reliable 1"), "ok");
    ASSERT_TRUE(until(bus, [&] { return reader.writers() == 1; }));
    ASSERT_EQ(peer.ask("readers rt/a 1"), "ok");
    ASSERT_EQ(peer.ask("pattern rt/a 100 7"), "sent");
    EXPECT_EQ(take(bus, reader, 1).size(), 1u);
    peer.signal(SIGKILL);
    const auto killed = Clock::now();
    ASSERT_TRUE(until(bus, [&] { return bus.publications().empty() && reader.writers() == 0; }));
    // Its last sign of life was at most one second ago; it is not given up long before the lease that it has told of.
    EXPECT_GT(Clock::now() - killed, std::chrono::duration<double>(options.lease_s - 1.5));
  }
}

TEST(Bus, WhoIsStoppedForLongComesAgain) {
  const int domain = free_domain();
  Bus bus(on(domain));
  BusReader reader = bus.reader(topic("rt/a"));
  Peer peer(domain);
  ASSERT_EQ(peer.ask(std::string("writer rt/a ") + kType + " reliable 1"), "ok");
  ASSERT_TRUE(until(bus, [&] { return reader.writers() == 1; }));
  peer.signal(SIGSTOP);
  ASSERT_TRUE(until(bus, [&] { return reader.writers() == 0; }));
  peer.signal(SIGCONT);
  ASSERT_TRUE(until(bus, [&] { return reader.writers() == 1; }));
  EXPECT_TRUE(until(bus, [&] {
    peer.ask("pattern rt/a 100 7");
    return !reader.take().empty();
  }));
}

TEST(Bus, AnotherTypeOnATopicIsToldAndNotHeard) {
  const int domain = free_domain();
  Bus bus(on(domain));
  BusWriter writer = bus.writer(topic("rt/a"));
  BusReader reader = bus.reader(topic("rt/a"));
  EXPECT_THAT(failure_of([&] { bus.reader({"rt/a", kOtherType}); }), HasSubstr(kType));
  ASSERT_TRUE(until(bus, [&] { return reader.writers() == 1; }));
  EXPECT_THAT(bus.conflicts(), IsEmpty());

  Peer peer(domain);
  ASSERT_EQ(peer.ask(std::string("reader rt/a ") + kOtherType + " best_effort 1"), "ok");
  ASSERT_TRUE(until(bus, [&] { return !bus.conflicts().empty(); }));
  EXPECT_THAT(bus.conflicts(), ElementsAre(testing::AllOf(HasSubstr("rt/a"), HasSubstr(kType), HasSubstr(kOtherType))));
  writer.write(bus_pattern(8, 1));
  EXPECT_EQ(take(bus, reader, 1).size(), 1u);
  EXPECT_EQ(peer.ask("taken rt/a"), "0");
  EXPECT_EQ(writer.readers(), 1);
}

TEST(Bus, AMessageIsAHeaderAtLeastAndNotTooLarge) {
  BusOptions options = on(free_domain());
  options.max_bytes = 2000;
  Bus bus(options);
  BusWriter writer = bus.writer(topic("rt/a"));
  BusReader reader = bus.reader(topic("rt/a"));
  ASSERT_TRUE(until(bus, [&] { return writer.readers() == 1 && reader.writers() == 1; }));
  EXPECT_THAT(failure_of([&] { writer.write(std::vector<std::byte>(3)); }),
              HasSubstr("has 3 bytes, must have 4..2000"));
  EXPECT_THAT(failure_of([&] { writer.write(std::vector<std::byte>(2001)); }), HasSubstr("rt/a"));
  EXPECT_TRUE(writer.write(std::vector<std::byte>(2000)));
  EXPECT_EQ(take(bus, reader, 1).size(), 1u);
}

TEST(Bus, WhatIsTooLargeForTheReaderIsThrownAwayAndTheNextComes) {
  const int domain = free_domain();
  BusOptions options = on(domain);
  options.max_bytes = 2000;
  Bus bus(options);
  Peer peer(domain);  // with the default, 4 MiB
  ASSERT_EQ(peer.ask(std::string("writer rt/a ") + kType + " reliable 10"), "ok");
  BusReader reader = bus.reader(topic("rt/a"));
  ASSERT_TRUE(until(bus, [&] { return reader.writers() == 1; }));
  ASSERT_EQ(peer.ask("readers rt/a 1"), "ok");
  ASSERT_EQ(peer.ask("pattern rt/a 1996 1"), "sent");
  EXPECT_EQ(take(bus, reader, 1).size(), 1u);
  for (const char* const size : {"2000", "100000"})
    ASSERT_EQ(peer.ask(std::string("pattern rt/a ") + size + " 2"), "sent");
  ASSERT_EQ(peer.ask("pattern rt/a 10 3"), "sent");
  const auto got = take(bus, reader, 1);
  ASSERT_EQ(got.size(), 1u);
  EXPECT_EQ(got[0].data, bus_pattern(10, 3));
  EXPECT_EQ(reader.lost(), 2);
}

TEST(Bus, WritingToNobodyReturnsAtOnce) {
  Bus bus(on(free_domain()));
  BusWriter writer = bus.writer(topic("rt/a"));
  const auto data = bus_pattern(100'000, 1);
  const auto begin = Clock::now();
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(writer.write(data));
  EXPECT_LT(Clock::now() - begin, kPatience);
}

TEST(Bus, AReliableReaderThatStandsStillHoldsUpNoWriter) {
  const int domain = free_domain();
  BusOptions options = on(domain);
  options.max_block_ms = 20;
  Bus bus(options);
  Peer peer(domain);
  ASSERT_EQ(peer.ask(std::string("reader rt/a ") + kType + " reliable 10"), "ok");
  BusWriter writer = bus.writer(topic("rt/a"));
  ASSERT_TRUE(until(bus, [&] { return writer.readers() == 1; }));
  peer.signal(SIGSTOP);
  const auto data = bus_pattern(100'000, 1);
  Clock::duration longest{};
  for (int i = 0; i < 100; ++i) {
    const auto begin = Clock::now();
    writer.write(data);
    longest = std::max(longest, Clock::now() - begin);
  }
  EXPECT_LT(longest, std::chrono::seconds(1));  // with what a loaded machine adds
  // It is still in its lease, and goes on with what is newest.
  peer.signal(SIGCONT);
  ASSERT_TRUE(writer.write(bus_pattern(8, 1)));
  EXPECT_THAT(peer.ask("take rt/a 1"), HasSubstr("00010000"));
}

TEST(Bus, AWaitEndsWhenItIsWokenAndWhenTimeIsOver) {
  Bus bus(on(free_domain()));
  while (bus.wait(0ms)) {
  }
  EXPECT_FALSE(bus.wait(1ms));
  bus.wake();
  EXPECT_TRUE(bus.wait(kPatience));
  EXPECT_FALSE(bus.wait(0ms));
  std::jthread other([&] { bus.wake(); });
  EXPECT_TRUE(bus.wait(kPatience));
}

TEST(Bus, AWaitEndsWhenThereIsSomethingToTake) {
  Bus bus(on(free_domain()));
  BusWriter writer = bus.writer(topic("rt/a"));
  BusReader reader = bus.reader(topic("rt/a"));
  ASSERT_TRUE(until(bus, [&] { return writer.readers() == 1 && reader.writers() == 1; }));
  while (bus.wait(0ms)) {
  }
  writer.write(bus_pattern(8, 1));
  EXPECT_TRUE(bus.wait(kPatience));
  EXPECT_EQ(reader.take().size(), 1u);
}

}  // namespace
}  // namespace tassilo
