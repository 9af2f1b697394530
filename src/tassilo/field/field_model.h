#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace tassilo {

enum class GoalSide { plus_x, minus_x };
enum class GoalColor { yellow, blue };

struct Interval {
  double low = 0, high = 0;
  double middle() const { return (low + high) / 2; }
  friend bool operator==(const Interval&, const Interval&) = default;
};

/// The field by league, field frame, metres; see docs/conventions.md and config/fields.
struct FieldModel {
  struct Area {
    double depth = 0, width = 0;  ///< To the outer edges of the lines.
    friend bool operator==(const Area&, const Area&) = default;
  };
  struct Segment {
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< Middle of a line.
    friend bool operator==(const Segment&, const Segment&) = default;
  };
  struct Arc {
    double cx = 0, cy = 0, radius = 0, from = 0, to = 0;  ///< Middle of the line; angles counter-clockwise. [m, rad]
    friend bool operator==(const Arc&, const Arc&) = default;
  };
  struct Goal {
    GoalSide side = GoalSide::plus_x;
    GoalColor color = GoalColor::blue;
    double width = 0, height = 0, depth = 0;
    friend bool operator==(const Goal&, const Goal&) = default;
  };
  struct Walls {
    std::string color = "white";  ///< A color class name.
    double height = 0;
    Interval x, y;  ///< Inner faces.
    friend bool operator==(const Walls&, const Walls&) = default;
  };
  struct Ball {
    std::string color = "red";
    Interval radius{0.10, 0.11};
    friend bool operator==(const Ball&, const Ball&) = default;
  };
  struct Robots {
    Interval width{0.3, 0.6}, height{0.4, 0.9};
    std::string body = "black";
    std::vector<std::string> markers{"cyan", "magenta"};
    friend bool operator==(const Robots&, const Robots&) = default;
  };

  std::string name;
  double length = 0;  ///< Between the outer edges of the goal lines (inner wall faces where there are walls).
  double width = 0;   ///< Likewise for the touch lines.
  double line_width = 0;
  bool halfway_line = false;
  bool touchlines = false;
  double circle_radius = 0;  ///< To the line's middle; 0: none.
  std::vector<Area> areas;
  std::vector<Segment> segments;
  std::vector<Arc> arcs;
  std::vector<Goal> goals;
  std::optional<Walls> walls;
  Ball ball;
  Robots robots;

  friend bool operator==(const FieldModel&, const FieldModel&) = default;
  /// Throws Error naming the first value out of range (lengths finite and > 0, or >= 0 where 0 means none; intervals
  /// ordered).
  void check() const;
};

}  // namespace tassilo
