#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "tassilo/localize/pose_belief.h"
#include "tassilo/track/tracks.h"

namespace tassilo {

/// All that the vision knew after one frame: the next one follows from it as it did where it was written.
struct StartState {
  double t = 0;  ///< Of that frame. [s]
  PoseBelief belief;
  TrackState tracks;
};

/// Such a file as `start_state_yaml` writes it. Throws Error with file, line and column, also for numbers that are no
/// state: covariances that are none, negative counts.
StartState read_start_state(const std::filesystem::path& file);
StartState start_state_from_yaml(std::string_view text, const std::string& file);
/// Reading it gives the same state to the last bit.
std::string start_state_yaml(const StartState& state);

}  // namespace tassilo
