#include "tassilo/region/fill.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "tassilo/region/algebra.h"

namespace tassilo {
namespace {

Region holes_up_to(const Region& region, const FillOptions& options) {
  // Within the bounding box a background part leads outside exactly when it touches the box's border.
  const PixelBox box = bounding_box(region);
  const Region gaps = complement(region, box);
  const RunLabels labels = label_runs(gaps, dual(options.foreground));
  struct Part {
    std::int64_t area = 0;
    bool outside = false;
  };
  RecycledVector<Part> parts(static_cast<std::size_t>(labels.count));
  const auto runs = gaps.runs();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const PixelRun& run = runs[i];
    Part& part = parts[static_cast<std::size_t>(labels.label[i])];
    part.area += run.length();
    part.outside |= run.row == box.y0 || run.row == box.y1 - 1 || run.begin == box.x0 || run.end == box.x1;
  }
  RunVector kept;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Part& part = parts[static_cast<std::size_t>(labels.label[i])];
    if (!part.outside && part.area >= options.min_area_px && part.area <= options.max_area_px) kept.push_back(runs[i]);
  }
  return Region::from_sorted(std::move(kept));
}

}  // namespace

Region holes(const Region& region, Connectivity foreground) { return holes_up_to(region, {.foreground = foreground}); }

Region fill_holes(const Region& region, const FillOptions& options) {
  return union_of(region, holes_up_to(region, options));
}

}  // namespace tassilo
