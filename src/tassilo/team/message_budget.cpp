#include "tassilo/team/message_budget.h"

#include <algorithm>

#include "tassilo/base/error.h"
#include "tassilo/base/option_check.h"

namespace tassilo {
namespace {

/// Frames come a little early or late; what is due within so much of its period is due. [1]
constexpr double kJitter = 0.3;
constexpr double kLeftForMessages = 0.25;  // share of the bytes [1]
constexpr double kCredit = 10'000;         // two seconds of states [B]

}  // namespace

double usual_rate(std::string_view topic) {
  constexpr double often = 30, sometimes = 10;
  for (const Topic& slow : {kScanTopic, kFreeSpaceTopic, kLinesTopic, kGoalsTopic})
    if (topic == slow.name) return sometimes;
  return often;
}

void BudgetOptions::check() const {
  check_between("bus.bytes_per_second", bytes_per_second, 1000, 1e9);
  check_between("bus.picture_rate", picture_rate, 0, 100);
  for (const auto& [topic, rate] : rates) {
    if (std::ranges::find(kTopics, topic, &Topic::name) == kTopics.end())
      throw Error("bus.rates." + topic, "is no topic of a robot");
    check_between("bus.rates." + topic, rate, 0.01, 1000);
  }
}

MessageBudget::MessageBudget(const BudgetOptions& options) : options_(options) { options_.check(); }

double MessageBudget::period_of(std::string_view topic) const {
  if (topic == kImageTopic.name) return 1 / options_.picture_rate;
  const auto named = options_.rates.find(topic);
  return 1 / (named != options_.rates.end() ? named->second : usual_rate(topic));
}

bool MessageBudget::is_picture_due(double now) const {
  if (options_.picture_rate <= 0) return false;
  const auto due = due_.find(kImageTopic.name);
  return due == due_.end() || now >= due->second - kJitter * period_of(kImageTopic.name);
}

void MessageBudget::fill(double now) {
  const double whole = options_.bytes_per_second;  // of one second
  constexpr double clock_was_set = 1;              // [s]
  if (!has_begun_ || now < filled_at_ - clock_was_set) {
    left_ = whole;
    due_.clear();
  } else {
    // What a picture took is paid in rates that leave something to messages.
    const double more = whole * std::max(0., now - filled_at_);
    const double paid = std::min(picture_debt_, (1 - kLeftForMessages) * more);
    picture_debt_ -= paid;
    left_ = std::min(whole, left_ + more - paid);
  }
  has_begun_ = true;
  filled_at_ = now;
}

bool MessageBudget::allows(const Topic& topic, std::size_t bytes, double now) {
  fill(now);
  const bool is_picture = topic.name == kImageTopic.name;
  const double size = static_cast<double>(bytes), period = period_of(topic.name);
  const auto [due, is_first] = due_.try_emplace(std::string(topic.name), now);
  const bool is_due = is_picture ? is_picture_due(now) : now >= due->second - kJitter * period;
  // That messages are withheld must be told, so a state is said on credit.
  const bool is_affordable = is_picture                           ? picture_debt_ <= 0
                             : topic.name == kTeamStateTopic.name ? left_ >= size - kCredit
                                                                  : left_ >= size;
  if (!is_due || !is_affordable) {
    ++withheld_;
    return false;
  }
  // On average at the rate, but no burst after a silence.
  due->second = std::max(due->second, now - period) + period;
  (is_picture ? picture_debt_ : left_) += is_picture ? size : -size;
  bytes_.add(now, size);
  return true;
}

}  // namespace tassilo
