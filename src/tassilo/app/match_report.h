#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tassilo/app/match_air.h"

// How good what was seen and known in a simulated match was, against what is true. Memory does not grow with its
// length.

namespace tassilo {

/// How often which value came, in bins of one width from 0 on; whatever is beyond the last is in it.
class Histogram {
 public:
  explicit Histogram(double width) : width_(width) {}
  /// A finite value.
  void add(double value);
  std::int64_t size() const { return size_; }
  bool is_beyond(double q) const { return quantile(q) > (kBins - 1) * width_; }  ///< In the last bin.
  /// The middle of the bin of the value in which the share q of all is reached; of none: 0. Within half a width of the
  /// truth, but for values beyond the last bin. O(bins).
  double quantile(double q) const;
  double share_above(double value) const;  ///< Of what lies in bins beyond that of the value.

 private:
  static constexpr std::size_t kBins = 20000;
  std::size_t bin_of(double value) const;
  double width_;
  std::int64_t size_ = 0;
  std::vector<std::uint32_t> counts_ = std::vector<std::uint32_t>(kBins);
};
/// Of places. [m]
inline Histogram place_errors() { return Histogram(1e-4); }

/// What somebody made of the ball, in moments in which at least one robot of the team sees it.
struct BallKnowledge {
  std::int64_t moments = 0, known = 0;
  Histogram errors = place_errors();    ///< [m]
  Histogram squared = Histogram(0.01);  ///< Errors by their covariance, squared; 2 in the mean and 1.39 in the median.
};

/// The bench over air of one kind.
struct RadioFigures {
  double loss = 0, delay_s = 0;
  BallKnowledge ball;
};

struct MatchReport {
  std::int64_t images = 0;
  std::map<std::string, std::int64_t> deeds;  ///< Images after which cyan did this.
  static constexpr double kAnother = 0.5;     ///< Further off, what was seen is not the ball. [m]
  Histogram ball_errors = place_errors();     ///< Of balls that robots saw, on the floor, up to that. [m]
  std::int64_t false_balls = 0;               ///< Images with balls of which none is the ball.
  Histogram pose_errors = place_errors();     ///< [m]
  double longest_lost = 0;                    ///< Without a pose within half a metre of the truth, one robot. [s]
  BallKnowledge surest;                       ///< The one robot that is surest at that moment, each by itself.
  BallKnowledge seeing, blind;                ///< Each robot with what it heard, by whether it sees the ball itself.
  BallKnowledge bench;                        ///< With what it heard of all.
  std::vector<RadioFigures> radios;           ///< Benches over other air, where they were asked for.
  AirCounts air;
  std::int64_t on_the_way = 0;
  std::int64_t taken = 0, late = 0, repeated = 0, of_no_time = 0;  ///< What became of what was heard.
  std::int64_t left = 0, came_back = 0;                            ///< Robots.
};

/// For people, lines with their ends.
std::string text_of(const MatchReport& report);

}  // namespace tassilo
