#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "tassilo/message/topics.h"
#include "tassilo/team/bus.h"
#include "tassilo/team/message_budget.h"

namespace tassilo {

/// A message that is ready to be sent.
struct Spoken {
  const Topic* topic = nullptr;
  std::vector<std::byte> data;  ///< CDR.
};

/// What one robot says on the bus: each topic at its rate, within its budget, and each time how it is with all that.
///
/// threads  one at a time
class RobotVoice {
 public:
  /// Throws Error as Bus::writer does, and for a budget out of range.
  RobotVoice(Bus& bus, int robot, const BudgetOptions& budget, BusReliability reliability);

  /// Sends what may be sent of the messages, in their order, then the state with the voice's own numbers in it.
  /// now   grows [s]
  /// returns   the state as it was sent, or would have been
  msgs::TeamState say(std::span<const Spoken> messages, msgs::TeamState state, double now);
  /// Does somebody listen to pictures, and may one be sent now?
  bool is_picture_wanted(double now) const;
  void show(const ros::CompressedImage& picture, double now);

  std::uint64_t messages() const { return sent_; }  ///< That were sent, but for pictures.
  std::uint64_t withheld() const { return budget_.withheld(); }
  double bytes_per_second(double now) const { return budget_.bytes_per_second(now); }

 private:
  bool send(const Topic& topic, std::span<const std::byte> data, double now);

  MessageBudget budget_;
  std::map<std::string_view, BusWriter> writers_;
  std::uint64_t sent_ = 0, counted_ = 0;
};

/// Does TeamState::messages count those of this topic? Not pictures, not the scan, which is the free space once more,
/// and not transforms, which are of all robots together: who watches a robot does not listen to them.
bool is_counted(const Topic& topic);

}  // namespace tassilo
