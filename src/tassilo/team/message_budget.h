#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "tassilo/message/topics.h"
#include "tassilo/team/rate_meter.h"

namespace tassilo {

/// How much one robot may say.
struct BudgetOptions {
  /// Of messages and pictures, as CDR: the transport adds some 100 bytes to each, and everything goes to each listening
  /// machine by itself. The default is an eighth of what a crowded hall's radio carries, for a team of five and some
  /// air. [B/s], 1000..1e9
  double bytes_per_second = 250'000;
  double picture_rate = 5;  ///< Annotated pictures, while somebody listens. [1/s], 0..100; 0: none
  /// By topic; those that are not named here or in kUsualRates are said with every image. [1/s], > 0
  std::map<std::string, double, std::less<>> rates = {};
  void check() const;  ///< Throws Error naming the first field out of range.
};

/// What changes slowly, or is large, need not be said with every image; nothing more than 30 times a second. [1/s]
double usual_rate(std::string_view topic);

/// Decides what is said: each topic at its rate, all together within the bytes.
///
/// A message that comes too soon after the one before is withheld, so a rate is an upper bound, kept on average. Bytes
/// that were not used are kept for a second. A picture is sent whole, however large, and paid from three quarters of
/// the bytes that follow; until then there is no other one.
class MessageBudget {
 public:
  explicit MessageBudget(const BudgetOptions& options);

  /// May a message of so many bytes be said now? Counts it, whatever the answer. Times grow; when they go back by more
  /// than a second, it begins anew. [s]
  bool allows(const Topic& topic, std::size_t bytes, double now);
  /// Is it time for a picture?
  bool is_picture_due(double now) const;

  std::uint64_t withheld() const { return withheld_; }
  double bytes_per_second(double now) const { return bytes_.per_second(now); }

 private:
  double period_of(std::string_view topic) const;
  void fill(double now);

  BudgetOptions options_;
  std::map<std::string, double, std::less<>> due_;  ///< When the next one of a topic is. [s]
  double left_ = 0;                                 ///< For messages. [B]
  double picture_debt_ = 0;                         ///< Of the last picture, not yet paid. [B]
  double filled_at_ = 0;                            ///< [s]
  bool has_begun_ = false;
  std::uint64_t withheld_ = 0;
  RateMeter bytes_;
};

}  // namespace tassilo
