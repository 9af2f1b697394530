#include "tassilo/files/start_state_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "tassilo/files/internal/test_message.h"

namespace tassilo {
namespace {

using testing::HasSubstr;

template <class Matrix>
Matrix covariance(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Matrix root;
  for (Eigen::Index i = 0; i < root.size(); ++i) root(i) = normal(random);
  return root * root.transpose() * 1e-3;
}

StartState state_of(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  StartState state;
  state.t = 1.7e9 + normal(random);
  state.belief.t = state.t;
  state.belief.fixed_at = state.t - 0.1;
  state.belief.tied = seed % 2 == 0;
  state.belief.told = seed % 3 == 0;
  state.belief.doubts = static_cast<int>(seed % 4);
  for (unsigned k = 0; k < seed % 5; ++k)
    state.belief.hypotheses.push_back(
        {{normal(random), k == 1 ? -0. : normal(random), normal(random), covariance<Eigen::Matrix3d>(random)},
         -normal(random) * normal(random)});
  state.tracks.t = state.t;
  state.tracks.next_id = static_cast<int>(seed) + 1;
  if (seed % 2 == 1) state.tracks.own_velocity_covariance = covariance<Eigen::Matrix3d>(random);
  for (unsigned k = 0; k < seed % 4; ++k) {
    Track track;
    track.id = static_cast<int>(k);
    track.kind = k % 2 == 0 ? TrackKind::robot : TrackKind::ball;
    track.mean << normal(random), -0., normal(random), 1e-300;
    track.covariance = covariance<Eigen::Matrix4d>(random);
    track.seen_at = state.t - 0.3;
    track.sightings = 4;
    track.clear_misses = 1;
    track.cyan = 2;
    track.magenta = 1;
    state.tracks.tracks.push_back(track);
  }
  return state;
}

void expect_bits(double a, double b) { EXPECT_EQ(std::bit_cast<std::uint64_t>(a), std::bit_cast<std::uint64_t>(b)); }
template <class Matrix>
void expect_bits_of(const Matrix& a, const Matrix& b) {
  for (Eigen::Index i = 0; i < a.size(); ++i) expect_bits(a(i), b(i));
}

TEST(StartStateFile, WrittenStatesReadBackToTheLastBit) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    const StartState given = state_of(seed);
    const StartState read = start_state_from_yaml(start_state_yaml(given), "state.yaml");
    expect_bits(read.t, given.t);
    expect_bits(read.belief.t, given.belief.t);
    expect_bits(read.belief.fixed_at, given.belief.fixed_at);
    EXPECT_EQ(read.belief.tied, given.belief.tied);
    EXPECT_EQ(read.belief.told, given.belief.told);
    EXPECT_EQ(read.belief.doubts, given.belief.doubts);
    ASSERT_EQ(read.belief.hypotheses.size(), given.belief.hypotheses.size());
    for (std::size_t k = 0; k < given.belief.hypotheses.size(); ++k) {
      const PoseHypothesis &a = read.belief.hypotheses[k], &b = given.belief.hypotheses[k];
      expect_bits(a.pose.x, b.pose.x);
      expect_bits(a.pose.y, b.pose.y);
      expect_bits(a.pose.theta, b.pose.theta);
      expect_bits_of(a.pose.covariance, b.pose.covariance);
      expect_bits(a.log_weight, b.log_weight);
    }
    EXPECT_EQ(read.tracks.next_id, given.tracks.next_id);
    expect_bits_of(read.tracks.own_velocity_covariance, given.tracks.own_velocity_covariance);
    ASSERT_EQ(read.tracks.tracks.size(), given.tracks.tracks.size());
    for (std::size_t k = 0; k < given.tracks.tracks.size(); ++k) {
      const Track &a = read.tracks.tracks[k], &b = given.tracks.tracks[k];
      EXPECT_EQ(a.id, b.id);
      EXPECT_EQ(a.kind, b.kind);
      expect_bits_of(a.mean, b.mean);
      expect_bits_of(a.covariance, b.covariance);
      expect_bits(a.seen_at, b.seen_at);
      EXPECT_EQ(a.sightings, b.sightings);
      EXPECT_EQ(a.clear_misses, b.clear_misses);
      EXPECT_EQ(a.cyan, b.cyan);
      EXPECT_EQ(a.magenta, b.magenta);
    }
  }
}

TEST(StartStateFile, WhatIsNoStateIsRefused) {
  const std::string good = start_state_yaml(state_of(3));
  const auto message = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    EXPECT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
    return message_of([&] { start_state_from_yaml(text, "state.yaml"); });
  };
  EXPECT_THAT(message("doubts: 3", "doubts: -3"), HasSubstr("belief.doubts is '-3', must be >= 0"));
  EXPECT_THAT(message("kind: robot", "kind: dog"), HasSubstr("must be ball or robot"));
  EXPECT_THAT(message("next_id: 4", "next_id: 0"), HasSubstr("must be >= 1"));
  EXPECT_THAT(message("own_velocity_cov: [", "own_velocity_cov: [1, "), HasSubstr("own_velocity_cov"));
  EXPECT_THAT(message("own_velocity_cov: [", "own_velocity_cov: [-"), HasSubstr("is no covariance"));
  EXPECT_THAT(message("tied", "tide"), HasSubstr("unknown key 'tide'"));
  EXPECT_THAT(message("t: 1", "t: .nan #"), HasSubstr("must be a finite number"));
}

}  // namespace
}  // namespace tassilo
