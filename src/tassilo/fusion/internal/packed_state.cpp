#include "tassilo/fusion/internal/packed_state.h"

#include <algorithm>

namespace tassilo {
namespace {

int belief_count(const TrackFacts& facts) { return facts.may_be_kicked() ? 2 : 1; }

}  // namespace

PackedState packed(const TeamState& state) {
  PackedState packed{state.t, state.next_id, {}, {}, state.mates};
  packed.facts.reserve(state.tracks.size());
  std::size_t count = 0;
  for (const FieldTrack& track : state.tracks)
    for (int k = 0; k < belief_count(track); ++k) {
      const auto size = static_cast<std::size_t>(track.beliefs[static_cast<std::size_t>(k)].mean.size());
      count += 1 + size + size * size;
    }
  packed.numbers.reserve(count);
  for (const FieldTrack& track : state.tracks) {
    packed.facts.push_back(track);
    for (int k = 0; k < belief_count(track); ++k) {
      const Belief& belief = track.beliefs[static_cast<std::size_t>(k)];
      packed.numbers.push_back(static_cast<double>(belief.mean.size()));
      packed.numbers.insert(packed.numbers.end(), belief.mean.data(), belief.mean.data() + belief.mean.size());
      packed.numbers.insert(packed.numbers.end(), belief.covariance.data(),
                            belief.covariance.data() + belief.covariance.size());
    }
  }
  return packed;
}

void unpack(const PackedState& packed, TeamState& state) {
  state.t = packed.t;
  state.next_id = packed.next_id;
  state.mates = packed.mates;
  state.tracks.resize(packed.facts.size());
  const double* next = packed.numbers.data();
  for (std::size_t i = 0; i < packed.facts.size(); ++i) {
    static_cast<TrackFacts&>(state.tracks[i]) = packed.facts[i];
    for (int k = 0; k < belief_count(packed.facts[i]); ++k) {
      Belief& belief = state.tracks[i].beliefs[static_cast<std::size_t>(k)];
      const auto size = static_cast<Eigen::Index>(*next++);
      belief.mean = Eigen::Map<const Eigen::VectorXd>(next, size);
      next += size;
      belief.covariance = Eigen::Map<const Eigen::MatrixXd>(next, size, size);
      next += size * size;
    }
  }
}

}  // namespace tassilo
