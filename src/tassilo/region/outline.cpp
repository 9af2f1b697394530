#include "tassilo/region/outline.h"

#include <cstddef>
#include <cstdint>
#include <utility>

#include "tassilo/region/internal/polygon_scan.h"
#include "tassilo/region/internal/row_sweep.h"

namespace tassilo {
namespace {

// Run k has two vertical edges: 2k at its begin, walked upwards, and 2k + 1 at its end, walked downwards; so the region
// is on the right.
using Edge = std::uint32_t;
constexpr Edge kNoEdge = ~Edge{0};

bool is_upwards(Edge edge) { return edge % 2 == 0; }
double column_of(std::span<const PixelRun> runs, Edge edge) {
  const PixelRun& run = runs[edge / 2];
  return (is_upwards(edge) ? run.begin : run.end) - .5;
}
/// Where the walk leaves the edge.
double row_behind(std::span<const PixelRun> runs, Edge edge) {
  return runs[edge / 2].row + (is_upwards(edge) ? -.5 : .5);
}

/// Which vertical edge follows each one, found line by line between rows.
class EdgeLinks {
 public:
  EdgeLinks(std::size_t runs, Connectivity foreground) : next_(2 * runs, kNoEdge), foreground_(foreground) {}

  /// Two rows on each other; the first run of each has index `first_upper`, `first_lower` of all.
  struct Rows {
    std::span<const PixelRun> upper, lower;
    Edge first_upper = 0, first_lower = 0;
  };
  void add_line(const Rows& rows) {
    // The edges of a row come in the order of the sweep: begin, end, begin, end.
    Edge upper = 2 * rows.first_upper, lower = 2 * rows.first_lower;
    bool was_upper = false, was_lower = false;
    Edge along = kNoEdge;  // the vertical edge at the left end of the horizontal one that leads here
    sweep_rows(rows.upper, rows.lower, [&](int, bool in_upper, bool in_lower) {
      const Edge north = in_upper != was_upper ? upper++ : kNoEdge;
      const Edge south = in_lower != was_lower ? lower++ : kNoEdge;
      const bool from_west = was_upper != was_lower, to_east = in_upper != in_lower;
      if (from_west && to_east) {
        // Two pixels touch by a corner: below west and above east, or the other two. The walk turns to the other one or
        // stays with its own.
        const Edge first = (foreground_ == Connectivity::eight) == was_lower ? north : south;
        join(along, first, was_lower);
        along = first == north ? south : north;
      } else if (from_west) {
        join(along, north != kNoEdge ? north : south, was_lower);
      } else if (to_east) {
        along = north != kNoEdge ? north : south;
      } else if (is_upwards(north)) {
        next_[south] = north;
      } else {
        next_[north] = south;
      }
      was_upper = in_upper;
      was_lower = in_lower;
    });
  }

  /// By edge; every edge has one.
  RecycledVector<Edge> next() && { return std::move(next_); }

 private:
  /// Joins the two vertical edges at the ends of a horizontal one; along the region's top the walk goes to the right.
  void join(Edge left, Edge right, bool is_top) {
    if (is_top)
      next_[left] = right;
    else
      next_[right] = left;
  }

  RecycledVector<Edge> next_;
  Connectivity foreground_;
};

RecycledVector<Edge> linked_edges(std::span<const PixelRun> runs, Connectivity foreground) {
  EdgeLinks links(runs.size(), foreground);
  EdgeLinks::Rows rows;
  for (std::size_t i = 0; i < runs.size();) {
    const std::size_t end = row_end(runs, i);
    if (!rows.upper.empty() && rows.upper.front().row != runs[i].row - 1) {
      links.add_line(rows);
      rows.upper = {};
    }
    rows.lower = runs.subspan(i, end - i);
    rows.first_lower = static_cast<Edge>(i);
    links.add_line(rows);
    rows = {.upper = rows.lower, .lower = {}, .first_upper = rows.first_lower, .first_lower = 0};
    i = end;
  }
  links.add_line(rows);
  return std::move(links).next();
}

double sign(double value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }
/// Where a side along an axis or a diagonal leads.
PixelPoint direction(PixelPoint from, PixelPoint to) { return {sign(to.x - from.x), sign(to.y - from.y)}; }

/// The pixels that lie on the right of a polygon along edges, without those that a straight walk passes.
RecycledVector<PixelPoint> center_polygon(const RecycledVector<PixelPoint>& edges) {
  RecycledVector<PixelPoint> walk;
  const auto visit = [&](PixelPoint pixel) {
    if (walk.empty() || walk.back() != pixel) walk.push_back(pixel);
  };
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const PixelPoint from = edges[i], to = edges[i + 1 < edges.size() ? i + 1 : 0], step = direction(from, to);
    const PixelPoint right{-step.y, step.x};
    visit(from + .5 * (step + right));
    visit(to + .5 * (right - step));
  }
  if (walk.size() > 1 && walk.back() == walk.front()) walk.pop_back();
  RecycledVector<PixelPoint> corners;
  for (std::size_t i = 0; i < walk.size(); ++i) {
    const PixelPoint before = walk[i > 0 ? i - 1 : walk.size() - 1], next = walk[i + 1 < walk.size() ? i + 1 : 0];
    if (walk.size() < 3 || direction(before, walk[i]) != direction(walk[i], next)) corners.push_back(walk[i]);
  }
  return corners;
}

}  // namespace

RecycledVector<Outline> outlines(const Region& region, Connectivity foreground) {
  const auto runs = region.runs();
  if (runs.empty()) return {};
  RecycledVector<Edge> next = linked_edges(runs, foreground);
  RecycledVector<Outline> result;
  for (Edge start = 0; start < next.size(); ++start) {
    if (next[start] == kNoEdge) continue;  // walked already
    // The topmost then leftmost edge of an outline has the region on its right exactly when it is an outer one.
    Outline outline{{}, !is_upwards(start)};
    for (Edge edge = start; next[edge] != kNoEdge;) {
      const Edge following = std::exchange(next[edge], kNoEdge);
      const double from = column_of(runs, edge), to = column_of(runs, following), row = row_behind(runs, edge);
      if (from != to) {
        outline.corners.push_back({from, row});
        outline.corners.push_back({to, row});
      }
      edge = following;
    }
    result.push_back(std::move(outline));
  }
  return result;
}

RecycledVector<Outline> center_outlines(const Region& region) {
  RecycledVector<Outline> result = outlines(region, Connectivity::eight);
  for (Outline& outline : result) outline.corners = center_polygon(outline.corners);
  return result;
}

Region region_from_outlines(std::span<const Outline> outlines, const PixelBox& window) {
  PolygonScan scan(window);
  for (const Outline& outline : outlines) scan.add(outline.corners);
  return std::move(scan).region();
}

}  // namespace tassilo
