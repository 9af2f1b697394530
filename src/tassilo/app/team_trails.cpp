#include "tassilo/app/team_trails.h"

#include <algorithm>

namespace tassilo {

void TeamTrails::add(const TeamPicture& picture) {
  constexpr double least_step = 0.095;  // ten a second, though pictures come a little early or late [s]
  for (const TeamMember& member : picture.members) {
    if (member.presence != Presence::here || !member.scene.pose) continue;
    std::deque<TeamTrail::Point>& points = points_[member.id];
    if (!points.empty() && picture.t - points.back().t < least_step) continue;
    points.push_back({picture.t, {member.scene.pose->x, member.scene.pose->y}});
  }
  for (auto& [robot, points] : points_)
    while (!points.empty() && points.front().t < picture.t - memory_s_) points.pop_front();
  std::erase_if(points_, [](const auto& entry) { return entry.second.empty(); });
}

std::vector<TeamTrail> TeamTrails::before(double t, double seconds) const {
  std::vector<TeamTrail> trails;
  for (const auto& [robot, points] : points_) {
    const auto begin = std::ranges::lower_bound(points, t - seconds, {}, &TeamTrail::Point::t);
    const auto end = std::ranges::upper_bound(points, t, {}, &TeamTrail::Point::t);
    if (begin < end) trails.push_back({robot, {begin, end}});
  }
  return trails;
}

}  // namespace tassilo
