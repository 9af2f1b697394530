#include "tassilo/files/start_state_file.h"

#include <array>
#include <limits>

#include "tassilo/files/internal/exact_number.h"
#include "tassilo/files/yaml.h"

namespace tassilo {
namespace {

constexpr std::size_t kMost = 1000;  // hypotheses, tracks
constexpr std::array<std::string_view, 2> kKinds{"ball", "robot"};

template <class Matrix>
std::string matrix_yaml(const Matrix& matrix) {
  std::string out = "[";
  for (Eigen::Index r = 0; r < matrix.rows(); ++r)
    for (Eigen::Index c = 0; c < matrix.cols(); ++c)
      out.append(r + c > 0 ? ", " : "").append(exact_number(matrix(r, c)));
  return out + "]";
}

template <class Matrix>
Matrix covariance_of(const Value& value) {
  Matrix matrix;
  const auto numbers = value.numbers(static_cast<std::size_t>(matrix.size()));
  for (Eigen::Index r = 0; r < matrix.rows(); ++r)
    for (Eigen::Index c = 0; c < matrix.cols(); ++c)
      matrix(r, c) = numbers[static_cast<std::size_t>(r * matrix.cols() + c)];
  // Rounding leaves traces; more than them is no covariance.
  constexpr double slack = 1e-6;
  for (Eigen::Index r = 0; r < matrix.rows(); ++r)
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) {
      const double bound = std::sqrt(std::abs(matrix(r, r))) * std::sqrt(std::abs(matrix(c, c)));
      if (matrix(r, r) < 0 || std::abs(matrix(r, c)) > (1 + slack) * bound ||
          std::abs(matrix(r, c) - matrix(c, r)) > slack * bound)
        value.fail("is no covariance, must be symmetric with variances >= 0");
    }
  return matrix;
}

int count_of(const Value& value) { return static_cast<int>(value.integer(0, std::numeric_limits<int>::max())); }

PoseHypothesis hypothesis_of(const Value& value) {
  const Map map = value.map({"pose", "cov", "log_weight"});
  const auto pose = map.at("pose").numbers(3);
  PoseHypothesis hypothesis;
  hypothesis.pose = {pose[0], pose[1], pose[2], covariance_of<Eigen::Matrix3d>(map.at("cov"))};
  constexpr double most = 1e6;
  hypothesis.log_weight = map.at("log_weight").number(-most, most);
  return hypothesis;
}

PoseBelief belief_of(const Value& value) {
  const Map map = value.map({"t", "fixed_at", "tied", "told", "doubts", "hypotheses"});
  PoseBelief belief;
  belief.t = map.at("t").number();
  belief.fixed_at = map.at("fixed_at").number();
  belief.tied = map.at("tied").boolean();
  belief.told = map.at("told").boolean();
  belief.doubts = count_of(map.at("doubts"));
  for (const Value& hypothesis : map.at("hypotheses").list(0, kMost))
    belief.hypotheses.push_back(hypothesis_of(hypothesis));
  return belief;
}

Track track_of(const Value& value) {
  const Map map = value.map({"id", "kind", "mean", "cov", "seen_at", "sightings", "clear_misses", "cyan", "magenta"});
  Track track;
  track.id = count_of(map.at("id"));
  track.kind = map.at("kind").choice(kKinds) == 0 ? TrackKind::ball : TrackKind::robot;
  const auto mean = map.at("mean").numbers(4);
  track.mean << mean[0], mean[1], mean[2], mean[3];
  track.covariance = covariance_of<Eigen::Matrix4d>(map.at("cov"));
  track.seen_at = map.at("seen_at").number();
  track.sightings = count_of(map.at("sightings"));
  track.clear_misses = count_of(map.at("clear_misses"));
  track.cyan = count_of(map.at("cyan"));
  track.magenta = count_of(map.at("magenta"));
  return track;
}

TrackState tracks_of(const Value& value) {
  const Map map = value.map({"t", "next_id", "own_velocity_cov", "tracks"});
  TrackState state;
  state.t = map.at("t").number();
  state.next_id = static_cast<int>(map.at("next_id").integer(1, std::numeric_limits<int>::max()));
  state.own_velocity_covariance = covariance_of<Eigen::Matrix3d>(map.at("own_velocity_cov"));
  for (const Value& track : map.at("tracks").list(0, kMost)) state.tracks.push_back(track_of(track));
  return state;
}

StartState state_of(const Value& root) {
  const Map map = root.map({"t", "belief", "tracks"});
  return {map.at("t").number(), belief_of(map.at("belief")), tracks_of(map.at("tracks"))};
}

const char* bool_text(bool value) { return value ? "true" : "false"; }

}  // namespace

StartState read_start_state(const std::filesystem::path& file) { return state_of(read_yaml(file)); }
StartState start_state_from_yaml(std::string_view text, const std::string& file) {
  return state_of(parse_yaml(text, file));
}

std::string start_state_yaml(const StartState& state) {
  const PoseBelief& belief = state.belief;
  std::string out = "t: " + exact_number(state.t) + "\nbelief:\n  t: " + exact_number(belief.t) +
                    "\n  fixed_at: " + exact_number(belief.fixed_at) + "\n  tied: " + bool_text(belief.tied) +
                    "\n  told: " + bool_text(belief.told) + "\n  doubts: " + std::to_string(belief.doubts) +
                    "\n  hypotheses:" + (belief.hypotheses.empty() ? " []" : "") + "\n";
  for (const PoseHypothesis& one : belief.hypotheses)
    out += "    - {pose: [" + exact_number(one.pose.x) + ", " + exact_number(one.pose.y) + ", " +
           exact_number(one.pose.theta) + "], cov: " + matrix_yaml(one.pose.covariance) +
           ", log_weight: " + exact_number(one.log_weight) + "}\n";
  const TrackState& tracks = state.tracks;
  out += "tracks:\n  t: " + exact_number(tracks.t) + "\n  next_id: " + std::to_string(tracks.next_id) +
         "\n  own_velocity_cov: " + matrix_yaml(tracks.own_velocity_covariance) +
         "\n  tracks:" + (tracks.tracks.empty() ? " []" : "") + "\n";
  for (const Track& track : tracks.tracks)
    out += "    - {id: " + std::to_string(track.id) + ", kind: " + (track.kind == TrackKind::ball ? "ball" : "robot") +
           ", mean: " + matrix_yaml(track.mean.transpose()) + ", cov: " + matrix_yaml(track.covariance) +
           ", seen_at: " + exact_number(track.seen_at) + ", sightings: " + std::to_string(track.sightings) +
           ", clear_misses: " + std::to_string(track.clear_misses) + ", cyan: " + std::to_string(track.cyan) +
           ", magenta: " + std::to_string(track.magenta) + "}\n";
  return out;
}

}  // namespace tassilo
