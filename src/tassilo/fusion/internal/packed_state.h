#pragma once

#include <cstddef>

#include "tassilo/fusion/internal/team_state.h"

namespace tassilo {

/// A TeamState for keeping, of a tenth of its size: beliefs have room for all robots that might have seen a thing, this
/// for those that did.
struct PackedState {
  double t = 0;
  int next_id = 1;
  RecycledVector<TrackFacts> facts;
  RecycledVector<double> numbers;  ///< Of each belief in turn: its size, mean, covariance by columns.
  RecycledVector<Mate> mates;
};
/// O(what is known).
PackedState packed(const TeamState& state);
/// The same state to the bit, into one whose memory is used again. O(what is known).
void unpack(const PackedState& packed, TeamState& state);

}  // namespace tassilo
