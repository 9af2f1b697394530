#include "tassilo/contour/skeleton_contours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"

namespace tassilo {
namespace {

constexpr int kNone = -1;

/// The eight directions, clockwise from the right; i + 4 is opposite to i, odd ones are diagonal.
enum Direction : std::size_t { right, lower_right, below, lower_left, left, upper_left, above, upper_right };

/// A pixel of the skeleton as a node of a graph.
struct Node {
  PixelPoint at;
  std::array<std::int32_t, 8> neighbor;  ///< Index by direction; kNone where there is none or none connected.
  int degree = 0;
  int junction = kNone;
  bool used = false;  ///< In a contour.
};

/// Pixels with their neighbors by rows and columns, from runs in one sweep.
RecycledVector<Node> nodes_of(std::span<const PixelRun> runs) {
  RecycledVector<Node> nodes;
  std::size_t above_run = 0;     // first run that may still touch the current pixel from the row above
  std::int32_t above_index = 0;  // its first node
  for (const PixelRun& run : runs) {
    for (int c = run.begin; c < run.end; ++c) {
      const auto index = static_cast<std::int32_t>(nodes.size());
      nodes.push_back({{double(c), double(run.row)}, {}, 0, kNone, false});
      nodes.back().neighbor.fill(kNone);
      const auto join = [&](std::int32_t other, Direction direction) {
        nodes[static_cast<std::size_t>(index)].neighbor[direction] = other;
        nodes[static_cast<std::size_t>(other)].neighbor[(direction + 4) % 8] = index;
      };
      if (c > run.begin) join(index - 1, left);
      const auto passed = [&](const PixelRun& other) {
        return other.row < run.row - 1 || (other.row == run.row - 1 && other.end < c);
      };
      while (passed(runs[above_run])) above_index += runs[above_run++].length();
      std::int32_t first = above_index;
      for (std::size_t i = above_run; runs[i].row == run.row - 1 && runs[i].begin <= c + 1;
           first += runs[i++].length()) {
        const auto join_above = [&](int column, Direction direction) {
          if (column >= runs[i].begin && column < runs[i].end) join(first + column - runs[i].begin, direction);
        };
        join_above(c - 1, upper_left);
        join_above(c, above);
        join_above(c + 1, upper_right);
      }
    }
  }
  return nodes;
}

/// Takes a skeleton's nodes apart.
class Tracer {
 public:
  Tracer(const Region& skeleton, const SkeletonContourOptions& options)
      : nodes_(nodes_of(skeleton.runs())), min_points_(static_cast<std::size_t>(options.min_points)) {}

  SkeletonContours contours() && {
    connect();
    for (std::int32_t i = 0; i < count(); ++i)
      if (node(i).degree >= 3 && node(i).junction == kNone) add_junction(i);
    for (std::int32_t i = 0; i < count(); ++i) {
      if (node(i).degree == 1) result_.ends.push_back(node(i).at);
      if (node(i).degree < 2 && !node(i).used) trace(i, i);
      if (node(i).junction == kNone) continue;
      for (const std::int32_t next : node(i).neighbor)
        if (next != kNone && node(next).junction == kNone && !node(next).used) trace(i, next);
    }
    for (std::int32_t i = 0; i < count(); ++i)
      if (!node(i).used && node(i).junction == kNone) trace(i, i);
    return std::move(result_);
  }

 private:
  Node& node(std::int32_t index) { return nodes_[static_cast<std::size_t>(index)]; }
  std::int32_t count() const { return static_cast<std::int32_t>(nodes_.size()); }

  /// Removes diagonal connections beside which there is a way along edges.
  void connect() {
    for (Node& node : nodes_)
      for (const Direction diagonal : {lower_right, lower_left, upper_left, upper_right}) {
        // Edges only are asked for, which stay.
        if (node.neighbor[diagonal - 1] != kNone || node.neighbor[(diagonal + 1) % 8] != kNone)
          node.neighbor[diagonal] = kNone;
      }
    for (Node& node : nodes_)
      for (const std::int32_t next : node.neighbor) node.degree += next != kNone;
  }

  /// The junction of all pixels that are connected with `first` through pixels of degree three and more.
  void add_junction(std::int32_t first) {
    const int index = static_cast<int>(result_.junctions.size());
    RecycledVector<std::int32_t> members{first};
    node(first).junction = index;
    for (std::size_t k = 0; k < members.size(); ++k)
      for (const std::int32_t next : node(members[k]).neighbor)
        if (next != kNone && node(next).degree >= 3 && node(next).junction == kNone) {
          node(next).junction = index;
          members.push_back(next);
        }
    std::sort(members.begin(), members.end());
    Junction junction;
    for (const std::int32_t member : members) {
      junction.pixels.push_back(node(member).at);
      junction.center = junction.center + (1. / static_cast<double>(members.size())) * node(member).at;
    }
    result_.junctions.push_back(std::move(junction));
  }

  /// Follows a stretch from `start`: a junction's pixel, or start = next, which is an end or any pixel of a loop.
  void trace(std::int32_t start, std::int32_t next) {
    SkeletonContour stretch;
    stretch.from = node(start).junction;
    auto& points = stretch.contour.points;
    if (next != start) points.push_back(node(start).at);
    std::int32_t before = start;
    for (std::int32_t at = next;;) {
      node(at).used = true;
      points.push_back(node(at).at);
      std::int32_t following = kNone;
      for (const std::int32_t other : node(at).neighbor)
        if (other != kNone && other != before && following == kNone) following = other;
      if (following == kNone) break;
      if (node(following).junction != kNone) {
        stretch.to = node(following).junction;
        points.push_back(node(following).at);
        break;
      }
      if (node(following).used) {  // around a loop
        stretch.contour.closed = true;
        break;
      }
      before = at;
      at = following;
    }
    if (points.size() >= min_points_) result_.contours.push_back(std::move(stretch));
  }

  RecycledVector<Node> nodes_;
  std::size_t min_points_;
  SkeletonContours result_;
};

}  // namespace

void SkeletonContourOptions::check() const {
  if (min_points < 1)
    throw Error("skeleton_contours.min_points", "is " + std::to_string(min_points) + ", must be >= 1");
}

SkeletonContours skeleton_contours(const Region& skeleton, const SkeletonContourOptions& options) {
  options.check();
  return Tracer(skeleton, options).contours();
}

Contour centered(Contour contour, const Region& region, int reach) {
  expects(reach >= 1, "centered: a reach of at least 1");
  // Twice the middle and the width of the stretch through a pixel; nothing when it goes on beyond the reach.
  struct Stretch {
    double middle = 0;
    int width = 0;
  };
  const auto stretch = [&](int from, auto inside) -> std::optional<Stretch> {
    int low = from, high = from;
    while (from - low <= reach && inside(low - 1)) --low;
    while (high - from <= reach && inside(high + 1)) ++high;
    if (from - low > reach || high - from > reach) return std::nullopt;
    return Stretch{0.5 * (low + high), high - low};
  };
  for (PixelPoint& point : contour.points) {
    const int column = static_cast<int>(std::lround(point.x)), row = static_cast<int>(std::lround(point.y));
    if (!contains(region, column, row)) continue;
    const auto down = stretch(row, [&](int r) { return contains(region, column, r); });
    const auto along = stretch(column, [&](int c) { return contains(region, c, row); });
    if (down && (!along || down->width <= along->width))
      point.y = down->middle;
    else if (along)
      point.x = along->middle;
  }
  return contour;
}

}  // namespace tassilo
