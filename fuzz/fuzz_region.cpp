// Operators from regions to regions equal their definitions on sets of pixels, keep their laws, and give the same with
// every kernel.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <utility>
#include <vector>

#include "bytes.h"
#include "regions.h"
#include "tassilo/base/contract.h"
#include "tassilo/region/affine.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/components.h"
#include "tassilo/region/distance.h"
#include "tassilo/region/elements.h"
#include "tassilo/region/enclosing.h"
#include "tassilo/region/features.h"
#include "tassilo/region/fill.h"
#include "tassilo/region/hit_or_miss.h"
#include "tassilo/region/inscribed.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/outline.h"
#include "tassilo/region/partition.h"
#include "tassilo/region/raster.h"
#include "tassilo/region/region.h"
#include "tassilo/region/relation.h"
#include "tassilo/region/remove_noise.h"
#include "tassilo/region/residue.h"
#include "tassilo/region/select.h"
#include "tassilo/region/shapes.h"
#include "tassilo/region/skeleton.h"
#include "tassilo/region/transform.h"

using namespace tassilo;

namespace {

/// Minkowski sum: all p + e.
Pixels sum(const Pixels& pixels, const Pixels& element) {
  Pixels out;
  for (const auto& [r, c] : pixels)
    for (const auto& [dr, dc] : element) out.insert({r + dr, c + dc});
  return out;
}

/// The pixels that hold(row, column) keeps.
template <class Holds>
Pixels only(const Pixels& pixels, Holds holds) {
  Pixels out;
  for (const auto& [r, c] : pixels)
    if (holds(r, c)) out.insert({r, c});
  return out;
}

void check_algebra(const Region& a, const Region& b, Bytes& bytes) {
  const Pixels pixels_a = pixels_of(a), pixels_b = pixels_of(b);
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
  const PixelBox domain = bounding_box(b);
  expects(clipped(a, domain) == intersection(a, Region::from_box(domain)), "a box clips as its region does");
  expects(complement(a, domain) == difference(Region::from_box(domain), a), "complement");

  expects(common_area(a, b) == static_cast<std::int64_t>(both.size()), "common area");
  expects(overlaps(a, b) == !both.empty(), "overlap");
  expects(is_subset(a, b) == (both.size() == pixels_a.size()), "subset");
  expects(hamming_distance(a, b) == area(symmetric_difference(a, b)), "Hamming distance");
  const double shared = intersection_over_union(a, b);
  expects(either.empty() ? shared == 0 : shared == double(both.size()) / double(either.size()), "Jaccard index");

  const int about = bytes.below(9) - 4;
  expects(mirrored_left_right(mirrored_top_bottom(a, about), about) == translated(reflected(a), {2 * about, 2 * about}),
          "both mirrors turn by half");
  const int columns = 1 + bytes.below(3), rows = 1 + bytes.below(3);
  expects(area(zoomed(a, {double(columns), double(rows)})) == area(a) * columns * rows, "zoom repeats pixels");
}

void check_morphology(const Region& a, const Region& element, const Region& miss) {
  if (element.empty()) return;
  const Pixels pixels = pixels_of(a), pixels_element = pixels_of(element), pixels_miss = pixels_of(miss);
  const Region dilated = dilation(a, element), eroded = erosion(a, element), opened = opening(a, element),
               closed = closing(a, element);
  expects(pixels_of(dilated) == sum(pixels, pixels_element), "dilation is the Minkowski sum");
  expects(opened == dilation(eroded, element) && closed == erosion(dilated, element),
          "opening and closing are two steps");
  expects(is_subset(opened, a), "an opening lies within");
  expects(is_subset(a, closed), "a closing lies around");
  expects(opening(opened, element) == opened && closing(closed, element) == closed, "once is enough");
  const PixelBox inner = wider(bounding_box(a), 10), outer = wider(inner, 10);
  expects(eroded == clipped(complement(dilation(complement(a, outer), reflected(element)), outer), inner),
          "erosion is the dilation of what is outside");
  expects(top_hat(a, element) == difference(a, opened) && bottom_hat(a, element) == difference(closed, a), "hats");

  const auto fits_at = [&](int r, int c) {
    return std::ranges::all_of(pixels_element,
                               [&](auto p) {
                                 return pixels.contains({r + p.first, c + p.second});
                               }) &&
           std::ranges::none_of(pixels_miss, [&](auto p) {
             return pixels.contains({r + p.first, c + p.second});
           });
  };
  expects(pixels_of(hit_or_miss(a, element, miss)) == only(sum(pixels, pixels_of(reflected(element))), fits_at),
          "a pattern is found where it fits");
}

/// What depends on a pixel and its eight neighbors.
void check_neighborhoods(const Region& a) {
  const Pixels pixels = pixels_of(a), around = sum(pixels, pixels_of(rectangle(3, 3)));
  const auto neighbors = [&](int r, int c, bool edges, bool corners) {
    int count = 0;
    for (int dr = -1; dr <= 1; ++dr)
      for (int dc = -1; dc <= 1; ++dc) {
        const int steps = std::abs(dr) + std::abs(dc);
        if ((steps == 1 && edges) || (steps == 2 && corners)) count += pixels.contains({r + dr, c + dc});
      }
    return count;
  };
  for (const bool eight : {false, true}) {
    const Connectivity connectivity = eight ? Connectivity::eight : Connectivity::four;
    const int all = eight ? 8 : 4;
    expects(pixels_of(inner_boundary(a, connectivity)) ==
                only(pixels, [&](int r, int c) { return neighbors(r, c, true, eight) < all; }),
            "inner boundary");
    expects(pixels_of(outer_boundary(a, connectivity)) ==
                only(around,
                     [&](int r, int c) {
                       return !pixels.contains({r, c}) && neighbors(r, c, true, eight) > 0;
                     }),
            "outer boundary");
  }
  const auto check_noise = [&](NoiseNeighbors name, bool edges, bool corners) {
    expects(pixels_of(remove_noise(a, name)) ==
                only(pixels, [&](int r, int c) { return neighbors(r, c, edges, corners) > 0; }),
            "noise has no neighbors");
  };
  check_noise(NoiseNeighbors::n_4, true, false);
  check_noise(NoiseNeighbors::n_8, false, true);
  check_noise(NoiseNeighbors::n_48, true, true);
}

void check_parts(const Region& a, Bytes& bytes) {
  const PixelBox box = bounding_box(a);
  for (const Connectivity connectivity : {Connectivity::four, Connectivity::eight}) {
    const RecycledVector<Region> parts = components(a, connectivity);
    const auto features = component_features(a, connectivity);
    expects(union_of(parts) == a, "components are all of the region");
    expects(features.size() == parts.size(), "features of each component");
    std::int64_t total = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      total += area(parts[i]);
      expects(components(parts[i], connectivity).size() == 1, "a component is connected");
      expects(features[i].area == area(parts[i]) && features[i].box == bounding_box(parts[i]),
              "features of a component");
    }
    expects(total == area(a), "components are disjoint");

    // Holes are the parts of the background that do not reach the outside.
    const PixelBox window = wider(box, 1);
    RecycledVector<Region> inner = components(complement(a, window), dual(connectivity));
    std::erase_if(inner, [&](const Region& part) { return bounding_box(part) == window; });
    if (a.empty()) inner.clear();
    const Region open = holes(a, connectivity), filled = fill_holes(a, {.foreground = connectivity});
    expects(open == union_of(inner), "holes are cut off from the outside");
    expects(filled == union_of(a, open) && holes(filled, connectivity).empty(), "filled, there are none");
    expects(hole_count(a, connectivity) == std::ssize(inner), "number of holes");
    expects(euler_number(a, connectivity) == std::ssize(parts) - std::ssize(inner), "Euler number");
    const int min_area = bytes.below(20);
    const FeatureRange large{.feature = Feature::area, .min = double(min_area)};
    expects(
        fill_up(a, {&large, 1}, connectivity) == fill_holes(a, {.min_area_px = min_area, .foreground = connectivity}),
        "holes chosen by area");
    RecycledVector<Region> chosen = parts;
    std::erase_if(chosen, [&](const Region& part) { return area(part) < min_area; });
    expects(select(parts, {large}) == chosen, "chosen by area");
    const auto rising = sorted(parts, Feature::area), by_place = sorted_by_first_point(parts);
    expects(rising.size() == parts.size() && std::ranges::is_sorted(rising, {}, area), "ordered by area");
    expects(by_place == parts, "components come by their first pixels");

    expects(region_from_outlines(outlines(a, connectivity), box) == a, "outlines give the region back");
  }
  const PartSize size{1 + bytes.below(9), 1 + bytes.below(9)};
  std::int64_t total = 0;
  const auto cells = partition_into_rectangles(a, size);
  for (const Region& cell : cells) total += area(cell);
  expects(union_of(cells) == a && total == area(a), "parts of a grid are all of it, once");
  expects(to_labels(components(a), box).size() == static_cast<std::size_t>(box.width()) * std::size_t(box.height()),
          "a label a pixel");
  const auto mask = to_mask(a, box);
  const Region again =
      region_where(ByteView{mask.data(), box.width(), box.height(), box.width()}, [](int b) { return b > 0; });
  expects(translated(again, {box.x0, box.y0}) == a, "a mask gives the region back");
}

void check_skeleton(const Region& a) {
  const Region lines = skeleton(a);
  expects(is_subset(lines, a), "a skeleton lies within");
  expects(skeleton(lines) == lines, "a skeleton's skeleton is itself");
  const auto parts = components(a);
  expects(components(lines).size() == parts.size(), "as many parts");
  for (const Region& part : parts) expects(components(intersection(lines, part)).size() == 1, "a part in each part");
  expects(hole_count(lines) == hole_count(a), "as many holes");
  expects(skeleton(translated(a, {37, -11})) == translated(lines, {37, -11}), "moves with the region");
}

/// All kernels on rows of many words; and runs, as which a region is worked on where its box is mostly empty.
void check_kernels(const Region& a, const Region& b, const Region& element) {
  const Region lines = skeleton(a);
  with_every_kernel([&] { expects(skeleton(a) == lines, "kernels thin alike"); });
  if (element.empty()) return;
  const Region far = union_of(a, Region::from_box({20000, 20000, 20001, 20001}));
  const auto near = [](const Region& region) { return clipped(region, {-5000, -5000, 5000, 5000}); };
  const Region dilated = near(dilation(far, element)), eroded = near(erosion(far, element)),
               opened = near(opening(far, element)), closed = near(closing(far, element));
  const Region both = intersection(a, b);
  with_every_kernel([&] {
    expects(dilation(a, element) == dilated, "bits dilate as runs do");
    expects(erosion(a, element) == eroded, "bits erode as runs do");
    expects(opening(a, element) == opened, "bits open as runs do");
    expects(closing(a, element) == closed, "bits close as runs do");
    expects(intersection(a, b) == both, "kernels intersect alike");
  });
}

void check_map(const Region& a, Bytes& bytes) {
  const auto next = [&](double unit) { return (bytes.next() - 128) * unit; };
  const AffineMap map{next(1 / 128.), next(1 / 128.), next(.25), next(1 / 128.), next(1 / 128.), next(.25)};
  const Region moved = mapped(a, map);
  // Of so few binary digits that all is exact.
  const double det = map.xx * map.yy - map.xy * map.yx;
  if (det == 0) return expects(moved.empty(), "a map without an inverse gives nothing");
  const PixelBox box = wider(bounding_box(moved), 2);
  for (int r = box.y0; r < box.y1; ++r)
    for (int c = box.x0; c < box.x1; ++c) {
      const double x = c - map.x0, y = r - map.y0;
      const double from_x = (map.yy * x - map.xy * y) / det + .5, from_y = (map.xx * y - map.yx * x) / det + .5;
      const double spare = 1e-9;
      if (std::abs(from_x - std::round(from_x)) < spare || std::abs(from_y - std::round(from_y)) < spare) continue;
      expects(contains(moved, c, r) == contains(a, int(std::floor(from_x)), int(std::floor(from_y))),
              "a pixel comes from the one nearest to its centre mapped back");
    }
  const Region quarter = mapped(a, rotation_about({}, std::numbers::pi / 2));
  expects(area(quarter) == area(a), "a quarter turn keeps every pixel");
  expects(mapped(a, {.xx = 0, .xy = 1, .yx = 1, .yy = 0}) == transposed(a), "a map may transpose");
}

void check_shapes(Bytes& bytes) {
  const auto next = [&](double unit) { return bytes.next() * unit; };
  const PixelPoint center{next(1 / 32.), next(1 / 32.)};
  const double a = next(1 / 32.), b = next(1 / 32.), phi = next(1 / 40.) - std::numbers::pi;
  const PixelPoint along{std::cos(phi), -std::sin(phi)};
  const Region circle = circle_region({center, a}), ellipse = ellipse_region(center, {a, b, phi}),
               rectangle = rectangle_region({center, a, b, phi});
  constexpr double kNear = 1e-6;
  for (int r = -13; r < 21; ++r)
    for (int c = -13; c < 21; ++c) {
      const PixelPoint p = PixelPoint{double(c), double(r)} - center;
      const double x = std::abs(dot(along, p)), y = std::abs(cross(along, p));
      const auto holds = [&](const Region& shape, auto inside, const char* what) {
        if (inside(kNear) == inside(-kNear)) expects(contains(shape, c, r) == inside(0), what);
      };
      holds(
          circle, [&](double d) { return norm(p) <= a + d; }, "a circle's pixels");
      holds(
          ellipse, [&](double d) { return a + d > 0 && b + d > 0 && std::hypot(x / (a + d), y / (b + d)) <= 1; },
          "an ellipse's pixels");
      holds(
          rectangle, [&](double d) { return x <= a + d && y <= b + d; }, "a rectangle's pixels");
    }
  const LineShape shape{.length_px = 1 + a, .angle = phi};
  const Region line = line_element(shape);
  expects(line == reflected(line) && contains(line, 0, 0) && components(line).size() == 1, "a line through the origin");
  const int radius = bytes.below(12);
  expects(is_subset(diamond(radius), disc(radius)) && is_subset(disc(radius), octagon(radius)), "a disc lies between");
}

void check_polygons(Bytes& bytes) {
  const auto next = [&] {
    const double x = bytes.next() / 8., y = bytes.next() / 8.;
    return PixelPoint{x, y};
  };
  const std::array<PixelPoint, 4> p{next(), next(), next(), next()};
  const PixelBox window{4, 4, 28, 28};
  const auto within = [&](std::vector<PixelPoint> corners) { return region_from_polygon(corners, window); };
  const Region first = within({p[0], p[1], p[2]}), second = within({p[0], p[2], p[3]}),
               whole = within({p.begin(), p.end()});
  expects(whole == symmetric_difference(first, second), "polygons with a side in common share no pixel, leave no gap");
  expects(whole == within({p[3], p[2], p[1], p[0]}), "either way around");
}

void check_distances(const Region& a, const Region& b) {
  const PixelBox box = bounding_box(a);
  if (b.empty() || box.empty()) return;
  const Pixels pixels_b = pixels_of(b);
  const DistanceImage squared = distance_to(b, box), chessboard = distance_to(b, box, DistanceMetric::chessboard),
                      city_block = distance_to(b, box, DistanceMetric::city_block);
  const Pixels near = sum(pixels_b, pixels_of(disc(1.5))), square = sum(pixels_b, pixels_of(rectangle(5, 5))),
               steps = sum(pixels_b, pixels_of(diamond(2)));
  for (int r = box.y0; r < box.y1; ++r)
    for (int c = box.x0; c < box.x1; ++c) {
      expects((squared.at(c, r) <= 2) == near.contains({r, c}), "near pixels are in the dilation with a disc");
      expects((chessboard.at(c, r) <= 2) == square.contains({r, c}), "chessboard steps");
      expects((city_block.at(c, r) <= 2) == steps.contains({r, c}), "city block steps");
    }
  for (const DistanceMetric metric :
       {DistanceMetric::euclidean_squared, DistanceMetric::chessboard, DistanceMetric::city_block})
    expects(distance_inside(b, bounding_box(b), metric).values ==
                distance_to(complement(b, wider(bounding_box(b), 1)), bounding_box(b), metric).values,
            "inside, to what is outside");
  const Region hull = convex_region(a);
  expects(is_subset(a, hull) && area(hull) == convex_area(a), "the convex hull's pixels");
  expects(is_subset(Region::from_box(inner_rectangle(a)), a), "the inner box lies within");
  expects(is_subset(circle_region(inner_circle(a)), a), "the inner circle lies within");
  expects(is_subset(a, circle_region(smallest_circle(a))), "the outer circle lies around");
  expects(is_subset(a, rectangle_region(smallest_rectangle(a))), "the outer rectangle lies around");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  const Region a = next_region(bytes, 24, 40), b = next_region(bytes, 24, 40), element = next_region(bytes, 5, 7),
               miss = next_region(bytes, 3, 5);
  check_algebra(a, b, bytes);
  check_morphology(a, element, miss);
  check_neighborhoods(a);
  check_parts(a, bytes);
  check_skeleton(a);
  check_kernels(union_of(a, translated(b, {3 * bytes.next(), 0})), b, element);
  check_map(a, bytes);
  check_shapes(bytes);
  check_polygons(bytes);
  check_distances(a, b);
  return 0;
}
