// Operators on runs equal their definitions on sets of pixels.
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "bytes.h"
#include "tassilo/base/contract.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/components.h"
#include "tassilo/region/distance.h"
#include "tassilo/region/enclosing.h"
#include "tassilo/region/features.h"
#include "tassilo/region/fill.h"
#include "tassilo/region/inscribed.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/outline.h"
#include "tassilo/region/partition.h"
#include "tassilo/region/region.h"
#include "tassilo/region/transform.h"

using namespace tassilo;

namespace {

using Pixels = std::set<std::pair<int, int>>;  // (row, column)

Region next_region(Bytes& bytes, int most_runs, int extent) {
  RunVector runs;
  for (int n = bytes.below(most_runs + 1); n > 0; --n) {
    const int row = bytes.below(extent) - extent / 2, begin = bytes.below(extent) - extent / 2;
    runs.push_back({static_cast<std::int16_t>(row), static_cast<std::int16_t>(begin),
                    static_cast<std::int16_t>(begin + bytes.below(extent))});
  }
  return Region::from_runs(std::move(runs));
}

Pixels pixels_of(const Region& region) {
  Pixels pixels;
  for (const PixelRun& run : region.runs())
    for (int c = run.begin; c < run.end; ++c) pixels.insert({run.row, c});
  return pixels;
}

/// Minkowski sum: all p + e.
Pixels sum(const Pixels& pixels, const Pixels& element) {
  Pixels out;
  for (const auto& [r, c] : pixels)
    for (const auto& [dr, dc] : element) out.insert({r + dr, c + dc});
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  const Region a = next_region(bytes, 24, 40), b = next_region(bytes, 24, 40), element = next_region(bytes, 5, 7);
  const Pixels pixels_a = pixels_of(a), pixels_b = pixels_of(b), pixels_element = pixels_of(element);

  Pixels both, either = pixels_a;
  for (const auto& pixel : pixels_b) {
    if (pixels_a.contains(pixel)) both.insert(pixel);
    either.insert(pixel);
  }
  expects(pixels_of(intersection(a, b)) == both, "intersection");
  expects(pixels_of(union_of(a, b)) == either, "union");
  expects(union_of(difference(a, b), intersection(a, b)) == a, "a without b, and both, is a");
  expects(symmetric_difference(a, b) == difference(union_of(a, b), intersection(a, b)), "symmetric difference");
  expects(transposed(transposed(a)) == a && reflected(reflected(a)) == a, "twice is nothing");

  if (!element.empty()) {
    expects(pixels_of(dilation(a, element)) == sum(pixels_a, pixels_element), "dilation is the Minkowski sum");
    expects(difference(opening(a, element), a).empty(), "an opening lies within");
    expects(difference(a, closing(a, element)).empty(), "a closing lies around");
    expects(opening(opening(a, element), element) == opening(a, element), "an opening opens once");
  }

  for (const Connectivity connectivity : {Connectivity::four, Connectivity::eight}) {
    const RecycledVector<Region> parts = components(a, connectivity);
    expects(union_of(parts) == a, "components are all of the region");
    std::int64_t total = 0;
    for (const Region& part : parts) {
      total += area(part);
      expects(components(part, connectivity).size() == 1, "a component is connected");
    }
    expects(total == area(a), "components are disjoint");
  }

  const PixelBox box = bounding_box(a);
  for (const Connectivity connectivity : {Connectivity::four, Connectivity::eight})
    expects(region_from_outlines(outlines(a, connectivity), box) == a, "outlines give the region back");
  const Region convex = convex_region(a);
  expects(difference(a, convex).empty() && area(convex) == convex_area(a), "the convex hull's pixels");
  expects(difference(Region::from_box(inner_rectangle(a)), a).empty(), "the inner box lies within");
  const int about = bytes.below(9) - 4;
  expects(mirrored_left_right(mirrored_top_bottom(a, about), about) == translated(reflected(a), {2 * about, 2 * about}),
          "both mirrors turn by half");
  const int wider = 1 + bytes.below(3), higher = 1 + bytes.below(3);
  expects(area(zoomed(a, {double(wider), double(higher)})) == area(a) * wider * higher, "zoom repeats pixels");
  expects(union_of(partition_into_rectangles(a, {1 + bytes.below(9), 1 + bytes.below(9)})) == a, "parts are all of it");
  if (!b.empty() && !box.empty()) {
    const DistanceImage to_b = distance_to(b, box);
    const Pixels near = sum(pixels_b, pixels_of(disc(1.5)));
    for (const auto& [r, c] : pixels_a)
      expects((to_b.at(c, r) <= 2) == near.contains({r, c}), "near pixels are in the dilation with a disc");
  }
  return 0;
}
