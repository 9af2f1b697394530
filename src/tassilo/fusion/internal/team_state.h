#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "tassilo/base/recycled.h"
#include "tassilo/fusion/internal/belief.h"
#include "tassilo/fusion/team_fusion.h"

// What the team knows, as a value: the next one follows from it and from one robot's image.

namespace tassilo {

/// One thing in one image, on the field.
struct SeenThing {
  TrackKind kind = TrackKind::ball;
  Team team = Team::unknown;
  double confidence = 1;
  Evidence evidence;
};
/// One image, with all that its sender may have got wrong taken out.
struct SeenImage {
  int robot = 0;
  std::int64_t stamp = 0;
  double t = 0;
  bool has_pose = false;  ///< One that is good enough; else nothing else is known.
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< Of the place.
  RecycledVector<SeenThing> things;                      ///< In an order that says nothing of how they were found.
};
SeenImage seen_image(const TeamObservation& observation, const TeamFusionOptions& options);

/// A robot that saw a thing, and when it did last.
struct Witness {
  int robot = 0;
  double seen_at = 0;
};
/// What is known of a thing followed over time, but where it is.
struct TrackFacts {
  int id = 0;  ///< 0 until it is sure enough to be told.
  TrackKind kind = TrackKind::ball;
  double kicked = 0;                             ///< Probability that it was just kicked.
  std::array<Witness, kMaxWitnesses> witnesses;  ///< Of beliefs, in their order.
  double seen_at = 0;                            ///< [s]
  double support = 0;                            ///< Confidences of all its sightings.
  int misses = 0;     ///< Images of its witnesses since then that do not show it; before it is told.
  double weight = 0;  ///< The same, fading.
  int cyan = 0, magenta = 0;

  bool may_be_kicked() const { return kind == TrackKind::ball; }
  Team team() const { return cyan > magenta ? Team::cyan : magenta > cyan ? Team::magenta : Team::unknown; }
};
/// A thing followed over time.
struct FieldTrack : TrackFacts {
  std::array<Belief, 2> beliefs;  ///< If it rolls; if it was just kicked: of a ball only.

  std::span<const Witness> known_witnesses() const {
    return {witnesses.data(), static_cast<std::size_t>(witness_count(beliefs[0]))};
  }
};
/// Where a robot of the team says it is.
struct Mate {
  int robot = 0;
  double t = 0;
  Eigen::Vector2d place;
  Eigen::Matrix2d covariance;
};
struct TeamState {
  double t = 0;
  RecycledVector<FieldTrack> tracks;  ///< Oldest first.
  RecycledVector<Mate> mates;         ///< By robot.
  int next_id = 1;
};

/// The state at t, not before it, nothing seen in between.
void advance(TeamState& state, double t, const TeamFusionOptions& options);
/// The state after an image, not before it.
void take(TeamState& state, const SeenImage& image, const TeamFusionOptions& options);
/// What is told of it.
TeamWorld told(const TeamState& state, const TeamFusionOptions& options);

}  // namespace tassilo
