#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "tassilo/behavior/roles.h"
#include "tassilo/fusion/team_observation.h"
#include "tassilo/scene/scene.h"

// How the robots of a simulated match hear each other: the messages of the bus as bytes, over air that loses and delays
// them.

namespace tassilo {

/// The messages that a robot tells its team with one image, as CDR.
struct TeamPacket {
  std::vector<std::byte> state, balls, robots;
  std::vector<std::byte> pose;  ///< Empty: it does not know where it is.
};
/// Of what a robot saw at scene.t, and the role it plays.
TeamPacket packet_of(int robot, Team team, const Scene& scene, Role role);

/// What is understood of them.
struct TeamWord {
  TeamObservation observation;  ///< Its time is the sender's.
  std::optional<Role> role;     ///< Missing: none that is known.
};
/// Nothing: no such messages, or not to be believed of this robot.
std::optional<TeamWord> word_of(const TeamPacket& packet, int robot);

/// The same with bytes changed, messages cut short, or numbers that are none. For trying how others bear it.
TeamPacket spoiled(TeamPacket packet, std::mt19937_64& random);

struct AirOptions {
  double loss = 0;     ///< Share of packets that do not come. 0..1
  double delay_s = 0;  ///< Of the others, in the mean; each takes between none and twice of it. [s], >= 0
  std::uint64_t seed = 1;
  void check() const;  ///< Throws Error naming the first field out of range.
};

/// told = lost + refused + heard + those on their way.
struct AirCounts {
  std::int64_t told = 0, lost = 0, refused = 0, heard = 0;
};

/// Carries packets from robot to robot.
///
/// threads  one at a time
class MatchAir {
 public:
  /// Throws Error for options out of range.
  explicit MatchAir(const AirOptions& options);

  /// At t, to one that listens.
  void tell(double t, int from, int to, const std::shared_ptr<const TeamPacket>& packet);
  struct Heard {
    int to = 0;
    TeamWord word;
  };
  /// What has come by now and is understood; in the order in which it was told. O(what is on its way).
  std::vector<Heard> hear(double now);
  /// One listens no longer: what is on its way to it is lost.
  void leave(int listener);

  const AirCounts& counts() const { return counts_; }
  std::size_t on_the_way() const { return packets_.size(); }

 private:
  struct Flying {
    double due = 0;  ///< [s]
    int from = 0, to = 0;
    std::shared_ptr<const TeamPacket> packet;
  };
  AirOptions options_;
  std::mt19937_64 random_;
  std::vector<Flying> packets_;
  AirCounts counts_;
};

}  // namespace tassilo
