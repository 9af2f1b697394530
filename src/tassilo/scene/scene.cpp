#include "tassilo/scene/scene.h"

namespace tassilo {

std::string_view to_string(GoalColor color) { return color == GoalColor::yellow ? "yellow" : "blue"; }
std::string_view to_string(PostSide side) { return side == PostSide::left ? "left" : "right"; }
std::string_view to_string(LineKind kind) { return kind == LineKind::line ? "line" : "boundary"; }
std::string_view to_string(TrackKind kind) { return kind == TrackKind::ball ? "ball" : "robot"; }

std::string_view to_string(Team team) {
  switch (team) {
    case Team::cyan:
      return "cyan";
    case Team::magenta:
      return "magenta";
    case Team::unknown:
      break;
  }
  return "unknown";
}
std::string_view to_string(SectorState state) {
  switch (state) {
    case SectorState::free:
      return "free";
    case SectorState::blocked:
      return "blocked";
    case SectorState::unseen:
      break;
  }
  return "unseen";
}
std::string_view to_string(PoseKind kind) {
  switch (kind) {
    case PoseKind::two_lines:
      return "two_lines";
    case PoseKind::one_line:
      return "one_line";
    case PoseKind::predicted:
      return "predicted";
    case PoseKind::goal:
      return "goal";
    case PoseKind::model:
      return "model";
    case PoseKind::start:
      break;
  }
  return "start";
}

}  // namespace tassilo
