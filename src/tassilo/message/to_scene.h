#pragma once

#include "tassilo/message/ros_messages.h"
#include "tassilo/message/tassilo_messages.h"
#include "tassilo/scene/scene.h"

// What another robot told, as a scene holds it: floor values in that robot's frame, nothing of its image. The way back
// of from_scene.h; messages have been looked at, see plausible.h.

namespace tassilo {

/// Kind, age and mirror are told by the team state.
PoseSeen pose_from(const ros::PoseWithCovarianceStamped& message);
/// Adds those; the kind stays where the state tells of none.
void add_state(PoseSeen& pose, const msgs::TeamState& state);
RecycledVector<Ball> balls_from(const msgs::BallArray& message);
RecycledVector<Goal> goals_from(const msgs::GoalArray& message);
RecycledVector<RobotSeen> robots_from(const msgs::RobotArray& message);
RecycledVector<LineSeen> lines_from(const msgs::LineArray& message);
RecycledVector<CircleSeen> circles_from(const msgs::LineArray& message);
RecycledVector<TrackSeen> tracks_from(const msgs::TrackArray& message);
FreeSpace free_space_from(const msgs::FreeSpace& message);

Team team_from(std::uint8_t number);
/// Nothing for NO_POSE and what is no kind.
std::optional<PoseKind> pose_kind_from(std::uint8_t number);

}  // namespace tassilo
