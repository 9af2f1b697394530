#pragma once

#include <array>
#include <chrono>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tassilo {

// The team bus: DDS, as ROS 2 speaks it. What is published here is a topic of ROS 2, and the other way round; the bytes
// of messages are made and read elsewhere and pass unchanged.
//
// DDS has no passwords: whoever reaches the ports may publish under any name, and everybody may listen. What arrives is
// not to be trusted, and a bus that leaves this machine belongs on a network of one's own (docs/decisions/0020).

struct BusOptions {
  int domain = 0;  ///< Those of one domain see each other: ROS_DOMAIN_ID. 0..232
  /// Name or IPv4 address of the network interface that is used; "lo": nothing leaves this machine, and nothing comes
  /// in. The middleware binds its sockets to 0.0.0.0 all the same: two UDP ports of 7410 + 250 domain and up, and with
  /// multicast 7400 + 250 domain and the next. On loopback the kernel is told to pass on to them only what comes from
  /// 127.0.0.0/8; on any other interface they take what comes in by all of them: only a firewall keeps it out.
  std::string interface = "lo";
  /// Hosts to look for others at, names or IPv4 addresses, where multicast does not go; without multicast this machine
  /// is always looked at. Who is not among them may come all the same. Names are resolved once; unknown ones are told
  /// by complaints().
  std::vector<std::string> peers;
  /// Others are looked for at 239.255.0.1, too, as ROS 2 does; messages go to each reader by itself all the same. Not
  /// on loopback, whose multicast Linux turns off.
  bool multicast = false;
  /// Processes on one machine that find each other without multicast; each takes the first free two of so many
  /// ports. 1..60
  int max_participants = 32;
  double lease_s = 3;       ///< Who has been silent for so long is gone; others are told so, too. [s], 1..60
  int max_block_ms = 5;     ///< A write that a reader holds up is given up after so long. [ms], 0..1000
  int max_bytes = 4 << 20;  ///< Of a message; larger ones are neither taken nor written. [B], 1024..64 Mi
  void check() const;       ///< Throws Error naming the first field out of range.

  bool operator==(const BusOptions&) const = default;
};

enum class BusReliability {
  best_effort,  ///< What is lost is lost: sensor data.
  reliable,     ///< Sent again until it arrives or `depth` newer ones have been written.
};

/// A topic of ROS 2 as it is on the wire: "rt/robot3/pose" for "/robot3/pose".
std::string wire_topic_name(std::string_view ros_name);
/// And back; empty for what is no topic of ROS 2.
std::string ros_topic_name(std::string_view wire_name);

struct BusTopic {
  std::string name;  ///< As on the wire.
  std::string type;  ///< As on the wire: "geometry_msgs::msg::dds_::PoseWithCovarianceStamped_".
  BusReliability reliability = BusReliability::best_effort;
  int depth = 1;       ///< The newest so many are kept, of all writers together: "keep last". 1..1000
  void check() const;  ///< Throws Error naming the first field out of range.
};

/// A reader, a writer or a participant, unique on the network (a GUID of DDS); but whoever likes may use another's.
struct BusId {
  std::array<std::uint8_t, 16> bytes{};
  auto operator<=>(const BusId&) const = default;
};
/// 32 hexadecimal digits.
std::string to_string(const BusId& id);

/// A message as it came. Its bytes are anybody's.
struct BusSample {
  /// The CDR with its encapsulation header of 4 bytes; at least these, at most max_bytes. Writers other than this class
  /// may leave up to 3 bytes of padding at the end, for they send whole words.
  std::vector<std::byte> data;
  std::int64_t source_time_ns = 0;  ///< When it was written, on the writer's clock: UNIX time. [ns]
  std::int64_t arrival_ns = 0;      ///< When it arrived here, whole: UNIX time. [ns]
  BusId writer;                     ///< All zeros where the writer is already forgotten.
};

/// A writer or a reader somewhere on the domain, as its participant tells. Names are 1..255 visible ASCII characters;
/// endpoints with others are not told of.
struct BusEndpoint {
  BusId id;
  BusId participant;
  std::string topic;
  std::string type;
  BusReliability reliability = BusReliability::best_effort;
  bool is_own = false;  ///< Of the bus that is asked.
};

namespace internal {
class BusCore;
}

/// Publishes on one topic. Move-only; may outlive its Bus.
class BusWriter {
 public:
  BusWriter(BusWriter&&) noexcept;
  BusWriter& operator=(BusWriter&&) noexcept;
  ~BusWriter();

  /// Sends a message, CDR with its encapsulation header; the header's last two bits are used for the transport.
  /// Returns false when it was given up because readers are slower than max_block_ms allows; with "keep last" that is
  /// rare, since newer messages push out older ones.
  ///
  /// cost     some us to all readers of this machine; without readers about 1 us. Safe from any thread.
  /// throws   Error when data is shorter than its header or longer than max_bytes
  bool write(std::span<const std::byte> data);
  /// Readers that get what is written, now.
  int readers() const;
  BusId id() const;

 private:
  friend class Bus;
  class Implementation;
  explicit BusWriter(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

/// Listens to one topic. Move-only; may outlive its Bus.
class BusReader {
 public:
  BusReader(BusReader&&) noexcept;
  BusReader& operator=(BusReader&&) noexcept;
  ~BusReader();

  /// What has come since the last time, oldest first for each writer; at most `depth` messages. Never waits. One thread
  /// at a time.
  std::vector<BusSample> take();
  /// Messages that were written and never came out of take(): lost on the way, or pushed out by newer ones here or at
  /// the writer. Known from the gaps in the numbers that writers give them, when the next one is taken.
  std::int64_t lost() const;
  /// Messages of this type on this domain that were thrown away: without a header, or larger than max_bytes.
  std::int64_t refused() const;
  /// Writers that are heard, now.
  int writers() const;

 private:
  friend class Bus;
  class Implementation;
  explicit BusReader(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

/// One participant on a domain.
///
/// Any number in a process; those on one domain share its sockets and must have equal options. Its threads (about 6 for
/// a domain) are the middleware's. Nothing here trusts what comes from the network, but see docs/decisions/0020 for
/// what the middleware itself is known to withstand.
///
/// threads  all members from any thread
class Bus {
 public:
  /// Throws Error when the domain cannot be entered: no such interface, all ports taken, other options in use.
  explicit Bus(const BusOptions& options = {});
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// Throws Error when the options are out of range, or this bus uses, or has used, the topic with another type.
  BusWriter writer(const BusTopic& topic);
  BusReader reader(const BusTopic& topic);

  /// All writers that are on the domain now, this bus's own among them, by topic and id.
  std::vector<BusEndpoint> publications() const;
  /// All readers, likewise.
  std::vector<BusEndpoint> subscriptions() const;
  /// Why pairs of one of our own and one of another's endpoints on a topic of the same name do not talk: other types,
  /// or a reliable reader of a best-effort writer. A line each; none when all is well.
  std::vector<std::string> conflicts() const;

  /// Until a reader of this bus has something to take, an endpoint has come or gone, wake() was called, or the time is
  /// over. Returns whether it was ended by one of these.
  bool wait(std::chrono::milliseconds timeout);
  /// Ends the wait that goes on, or the next one. Safe from any thread.
  void wake();

  BusId id() const;
  /// What the middleware had to complain of, in this process, at most the last 20, in ASCII; for a log.
  static std::vector<std::string> complaints();

 private:
  std::shared_ptr<internal::BusCore> core_;
};

}  // namespace tassilo
