#include "tassilo/fusion/internal/packed_state.h"

#include <span>

namespace tassilo {
namespace {

/// Those of a track that mean something.
template <class Track>
auto beliefs_of(Track& track) {
  return std::span(track.beliefs).first(track.may_be_kicked() ? 2 : 1);
}

}  // namespace

PackedState packed(const TeamState& state) {
  PackedState packed{state.t, state.next_id, {}, {}, state.mates};
  packed.facts.reserve(state.tracks.size());
  Eigen::Index count = 0;
  for (const FieldTrack& track : state.tracks)
    for (const Belief& belief : beliefs_of(track)) count += 1 + belief.mean.size() + belief.covariance.size();
  packed.numbers.reserve(static_cast<std::size_t>(count));
  const auto add = [&](const auto& matrix) {
    packed.numbers.insert(packed.numbers.end(), matrix.data(), matrix.data() + matrix.size());
  };
  for (const FieldTrack& track : state.tracks) {
    packed.facts.push_back(track);
    for (const Belief& belief : beliefs_of(track)) {
      packed.numbers.push_back(static_cast<double>(belief.mean.size()));
      add(belief.mean);
      add(belief.covariance);
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
    FieldTrack& track = state.tracks[i];
    static_cast<TrackFacts&>(track) = packed.facts[i];
    for (Belief& belief : beliefs_of(track)) {
      const auto size = static_cast<Eigen::Index>(*next++);
      belief.mean = Eigen::Map<const Eigen::VectorXd>(next, size);
      next += size;
      belief.covariance = Eigen::Map<const Eigen::MatrixXd>(next, size, size);
      next += size * size;
    }
  }
}

}  // namespace tassilo
