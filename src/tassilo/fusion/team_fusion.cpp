#include "tassilo/fusion/team_fusion.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "tassilo/base/option_check.h"
#include "tassilo/fusion/internal/packed_state.h"

namespace tassilo {
namespace {

/// A state is kept after so many observations each: half of them are done again, on average, for one that comes late.
constexpr std::size_t kStride = 16;

bool is_before(const SeenImage& a, const SeenImage& b) {
  return std::tuple(a.t, a.robot, a.stamp) < std::tuple(b.t, b.robot, b.stamp);
}

}  // namespace

void TeamFusionOptions::check() const {
  const auto above = [](const std::string& name, double value, double low) {
    check_above("fusion." + name, value, low);
    check_finite("fusion." + name, value);
  };
  const auto at_least = [](const std::string& name, double value, double low) {
    check_at_least("fusion." + name, value, low);
    check_finite("fusion." + name, value);
  };
  at_least("ball_friction", ball_friction, 0);
  above("ball_acceleration", ball_acceleration, 0);
  above("robot_acceleration", robot_acceleration, 0);
  above("ball_speed", ball_speed, 0);
  above("robot_speed", robot_speed, 0);
  at_least("kick_speed", kick_speed, 0);
  at_least("kick_rate", kick_rate, 0);
  above("kick_duration", kick_duration, 0);
  above("pose_memory", pose_memory, 0);
  at_least("max_pose_age", max_pose_age, 0);
  above("max_pose_sigma", max_pose_sigma, 0);
  above("max_heading_sigma", max_heading_sigma, 0);
  above("robot_width", robot_width, 0);
  at_least("robot_common", robot_common, 0);
  above("gate", gate, 0);
  above("support", support, 0);
  above("confirm_time", confirm_time, 0);
  check_at_least("fusion.misses", misses, 1);
  at_least("max_age", max_age, confirm_time);
  above("max_ball_sigma", max_ball_sigma, 0);
  above("max_robot_sigma", max_robot_sigma, 0);
  check_at_least("fusion.max_balls", max_balls, 1);
  check_at_least("fusion.max_opponents", max_opponents, 1);
  above("history", history, 0);
  at_least("ahead", ahead, 0);
  check_at_least("fusion.max_observations", max_observations, 16);
}

/// Observations by time, and states between them.
struct TeamFusion::History {
  /// The state after the first `count` images.
  struct Checkpoint {
    std::size_t count = 0;
    PackedState state;
  };

  explicit History(const TeamFusionOptions& with) : options(with) {
    options.check();
    images.reserve(static_cast<std::size_t>(options.max_observations) + 1);
    constexpr int usual = 32;  // more than an option's default, not more than there is memory
    newest.tracks.reserve(
        static_cast<std::size_t>(std::min(options.max_balls, usual) + std::min(options.max_opponents, usual)));
  }

  Contribution add(const TeamObservation& observation, double now);
  /// The state after the first `count` images.
  const TeamState& after(std::size_t count);
  /// Makes images a part of the past that cannot be changed any more, `count` of them or fewer.
  void settle(std::size_t count);

  TeamFusionOptions options;
  PackedState settled;                     ///< After all that is not in `images` any more.
  bool has_settled = false;                ///< Is there any?
  RecycledVector<SeenImage> images;        ///< By is_before.
  RecycledVector<Checkpoint> checkpoints;  ///< By rising count, multiples of kStride.
  TeamState newest;                        ///< The last one asked for.
  std::size_t newest_count = 0;            ///< After so many images; 0: none.
  std::size_t reckoned = 0;                ///< Images that were taken in before, for counts.replayed.
  TeamFusionCounts counts;
};

Contribution TeamFusion::History::add(const TeamObservation& observation, double now) {
  const double t = observation.t;
  if (!std::isfinite(t) || !std::isfinite(now) || t > now + options.ahead) {
    ++counts.refused;
    return Contribution::refused;
  }
  for (const SeenImage& image : images)
    if (image.robot == observation.robot && image.stamp == observation.stamp) {
      ++counts.duplicates;
      return Contribution::duplicate;
    }
  if (t < now - options.history || (has_settled && t <= settled.t)) {
    ++counts.too_late;
    return Contribution::too_late;
  }
  SeenImage image = seen_image(observation, options);
  counts.without_pose += !image.has_pose;
  const auto place = std::ranges::upper_bound(images, image, is_before);
  const auto index = static_cast<std::size_t>(place - images.begin());
  counts.out_of_order += index < images.size();
  ++counts.taken;
  if (index < reckoned) {
    counts.replayed += static_cast<std::int64_t>(reckoned - index);
    reckoned = index;
  }
  images.insert(place, std::move(image));
  std::erase_if(checkpoints, [&](const Checkpoint& one) { return one.count > index; });
  if (newest_count > index) newest_count = 0;

  const auto old =
      std::ranges::partition_point(images, [&](const SeenImage& one) { return one.t < now - options.history; });
  settle(static_cast<std::size_t>(old - images.begin()));
  if (images.size() > static_cast<std::size_t>(options.max_observations)) {
    after(kStride);
    settle(kStride);
  }
  return Contribution::taken;
}

const TeamState& TeamFusion::History::after(std::size_t count) {
  const auto next = std::ranges::upper_bound(checkpoints, count, {}, &Checkpoint::count);
  const Checkpoint* from = next == checkpoints.begin() ? nullptr : &*(next - 1);
  const std::size_t kept = from != nullptr ? from->count : 0;
  if (newest_count == 0 || newest_count > count || newest_count < kept) {
    unpack(from != nullptr ? from->state : settled, newest);
    newest_count = kept;
  }
  for (std::size_t i = newest_count; i < count; ++i) {
    take(newest, images[i], options);
    if ((i + 1) % kStride == 0 && (checkpoints.empty() || checkpoints.back().count < i + 1))
      checkpoints.push_back({i + 1, packed(newest)});
  }
  newest_count = count;
  reckoned = std::max(reckoned, count);
  return newest;
}

void TeamFusion::History::settle(std::size_t count) {
  const auto next = std::ranges::upper_bound(checkpoints, count, {}, &Checkpoint::count);
  if (next == checkpoints.begin()) return;
  const std::size_t gone = (next - 1)->count;
  settled = std::move((next - 1)->state);
  has_settled = true;
  checkpoints.erase(checkpoints.begin(), next);
  for (Checkpoint& one : checkpoints) one.count -= gone;
  images.erase(images.begin(), images.begin() + static_cast<std::ptrdiff_t>(gone));
  newest_count = newest_count >= gone ? newest_count - gone : 0;
  reckoned = reckoned >= gone ? reckoned - gone : 0;
}

TeamFusion::TeamFusion(const TeamFusionOptions& options) : history_(std::make_unique<History>(options)) {}
TeamFusion::~TeamFusion() = default;
TeamFusion::TeamFusion(TeamFusion&&) noexcept = default;
TeamFusion& TeamFusion::operator=(TeamFusion&&) noexcept = default;

Contribution TeamFusion::add(const TeamObservation& observation, double now) { return history_->add(observation, now); }

TeamWorld TeamFusion::at(double t) {
  TeamWorld world;
  world.t = t;
  if (!std::isfinite(t) || (history_->has_settled && t < history_->settled.t)) return world;
  const auto after = std::ranges::partition_point(history_->images, [&](const SeenImage& one) { return one.t <= t; });
  TeamState state = history_->after(static_cast<std::size_t>(after - history_->images.begin()));
  advance(state, t, history_->options);
  world = told(state, history_->options);
  world.t = t;
  return world;
}

const TeamFusionCounts& TeamFusion::counts() const { return history_->counts; }
std::size_t TeamFusion::size() const { return history_->images.size(); }

}  // namespace tassilo
