#pragma once

#include <deque>
#include <map>
#include <vector>

#include "tassilo/team/team_view.h"

namespace tassilo {

/// Where a robot was.
struct TeamTrail {
  struct Point {
    double t = 0;   ///< On the clock of team pictures. [s]
    FieldPoint at;  ///< [m]
  };
  int robot = 0;
  std::vector<Point> points;  ///< In the order of time.
};

/// Where all robots were lately; at most ten points a second each.
///
/// threads  one at a time
class TeamTrails {
 public:
  /// What is older is forgotten. [s], > 0
  explicit TeamTrails(double memory_s) : memory_s_(memory_s) {}
  /// Times grow. Robots that are silent, or do not know where they are, leave no trail.
  void add(const TeamPicture& picture);
  void clear() { points_.clear(); }
  /// From `seconds` before t until t, by robot; robots without points are left out.
  std::vector<TeamTrail> before(double t, double seconds) const;

 private:
  double memory_s_;
  std::map<int, std::deque<TeamTrail::Point>> points_;
};

}  // namespace tassilo
