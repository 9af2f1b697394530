#pragma once

#include <array>
#include <vector>

#include "tassilo/evaluate/internal/records.h"
#include "tassilo/geometry/point.h"

namespace tassilo {

/// Point of a true robot's outline on the floor that is nearest to our robot's origin.
FloorPoint nearest_outline_point(const TrueRobot& robot);

/// The field's walls and goals and one frame's robots, to be asked how far the floor is free.
class TrueObstacles {
 public:
  TrueObstacles(const TrueField& field, const TrueFrame& frame);

  /// Free distance from `origin` along `angle`, both robot frame; infinite where nothing stands.
  double range(FloorPoint origin, double angle) const;

 private:
  struct Wall {
    FieldPoint from, to;
  };
  struct Pillar {
    FieldPoint center;
    double radius;
  };

  TruePose robot_;
  std::vector<Wall> walls_;
  std::vector<Pillar> pillars_;
};

}  // namespace tassilo
