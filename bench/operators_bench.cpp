// What does each operator on regions cost a run, on a dense and on a sparse region of three sizes? bench/report fits
// costs of a call, a run and a pixel, and the power of the number of runs that the time of dense regions grows with.
// The dense region is the carpet of a painted noisy scene, the sparse one its red ball and goal, frames cycled. Before
// any time counts the regions that the fastest kernel gives are compared with those of the plain one; all else is left
// to the tests. memcpy and the scalar reference run in the same process.

#include <cstdint>
#include <map>
#include <numbers>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "bench.h"
#include "support/bench_frames.h"
#include "tassilo/base/contract.h"
#include "tassilo/base/kernel.h"
#include "tassilo/contour/boundary_contours.h"
#include "tassilo/contour/skeleton_contours.h"
#include "tassilo/files/coco_mask.h"
#include "tassilo/region/affine.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/components.h"
#include "tassilo/region/distance.h"
#include "tassilo/region/elements.h"
#include "tassilo/region/enclosing.h"
#include "tassilo/region/features.h"
#include "tassilo/region/feret.h"
#include "tassilo/region/fill.h"
#include "tassilo/region/gray.h"
#include "tassilo/region/hit_or_miss.h"
#include "tassilo/region/inscribed.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/outline.h"
#include "tassilo/region/partition.h"
#include "tassilo/region/raster.h"
#include "tassilo/region/relation.h"
#include "tassilo/region/remove_noise.h"
#include "tassilo/region/residue.h"
#include "tassilo/region/roundness.h"
#include "tassilo/region/select.h"
#include "tassilo/region/skeleton.h"
#include "tassilo/region/transform.h"

namespace tassilo::bench {
namespace {

/// A region of a frame, and what operators take that are not regions.
struct Input {
  Region region, other;  ///< Of this frame and of the next one.
  PixelBox window;
  std::vector<std::uint8_t> mask, labels;
  FrameView frame;
  RecycledVector<Outline> outlines;
  RecycledVector<Region> parts;
  Region thin;
  std::vector<std::uint32_t> counts;

  ByteView view_of(const std::vector<std::uint8_t>& bytes) const {
    return {bytes.data(), window.width(), window.height(), window.width()};
  }
  CocoMask coco() const { return {window.width(), window.height(), region}; }
};

enum class Density { dense, sparse };

const std::vector<Input>& inputs_of(int index, Density density) {
  static std::map<std::pair<int, Density>, std::vector<Input>> made;
  const auto [it, is_new] = made.try_emplace({index, density});
  if (!is_new) return it->second;
  const test::BenchFrames& frames = test::bench_frames(index);
  const ColorClass color = density == Density::dense ? ColorClass::green : ColorClass::red;
  for (std::size_t k = 0; k < frames.frames.size(); ++k) {
    Segmentation segmentation = segment(frames.frames[k].view, frames.classifier);
    const Frame& next = frames.frames[(k + 1) % frames.frames.size()];
    Input input;
    input.region = segmentation.of(color);
    input.other = segment(next.view, frames.classifier).of(color);
    input.window = {0, 0, frames.width(), frames.height()};
    input.mask = to_mask(input.region, input.window);
    input.labels = std::move(segmentation.labels);
    input.frame = frames.frames[k].view;
    input.outlines = outlines(input.region);
    input.parts = components(input.region);
    input.thin = skeleton(input.region);
    input.counts = coco_counts(input.coco());
    it->second.push_back(std::move(input));
  }
  return it->second;
}

/// Registers name/dense and name/sparse; `call` takes an Input.
template <class Call>
void add_operator(const std::string& name, Call call) {
  for (const Density density : {Density::dense, Density::sparse}) {
    const std::string full = name + (density == Density::dense ? "/dense" : "/sparse");
    add(full, {2, 3, 5}, [=](benchmark::State& state) {
      const auto index = static_cast<int>(state.range(0));
      const std::vector<Input>& inputs = inputs_of(index, density);
      const Kernel fastest = supported_kernels().back();
      if constexpr (std::is_same_v<std::invoke_result_t<Call, const Input&>, Region>)
        once(full + std::to_string(index), [&] {
          for (const Input& input : inputs) {
            use_kernel(Kernel::plain);
            const Region plain = call(input);
            use_kernel(fastest);
            expects(plain == call(input), "a kernel equals the plain one");
          }
        });
      use_kernel(fastest);
      measure(state, inputs.size(), [&](std::size_t k) { benchmark::DoNotOptimize(call(inputs[k])); });
      double runs = 0, box_pixels = 0;
      for (const Input& input : inputs) {
        runs += static_cast<double>(input.region.runs().size());
        const PixelBox box = bounding_box(input.region);
        box_pixels += box.width() * box.height();
      }
      state.counters["runs"] = runs / static_cast<double>(inputs.size());
      state.counters["box_pixels"] = box_pixels / static_cast<double>(inputs.size());
      state.counters["pixels"] = inputs[0].window.width() * inputs[0].window.height();
      state.counters["ns_a_run"] = 1e3 * state.counters["us"] / state.counters["runs"];
      state.SetLabel(test::bench_frames(index).name);
    });
  }
}

void add_algebra() {
  add_operator("union", [](const Input& in) { return union_of(in.region, in.other); });
  add_operator("union of all parts", [](const Input& in) { return union_of(in.parts); });
  add_operator("intersection", [](const Input& in) { return intersection(in.region, in.other); });
  add_operator("difference", [](const Input& in) { return difference(in.region, in.other); });
  add_operator("symmetric difference", [](const Input& in) { return symmetric_difference(in.region, in.other); });
  add_operator("complement", [](const Input& in) { return complement(in.region, in.window); });
  add_operator("clip", [](const Input& in) {
    return clipped(in.region, {in.window.x1 / 4, in.window.y1 / 4, in.window.x1 * 3 / 4, in.window.y1 * 3 / 4});
  });
  add_operator("intersection over union", [](const Input& in) { return intersection_over_union(in.region, in.other); });
  add_operator("move", [](const Input& in) { return translated(in.region, {7, -3}); });
  add_operator("mirror left, right", [](const Input& in) { return mirrored_left_right(in.region, 100); });
  add_operator("mirror top, bottom", [](const Input& in) { return mirrored_top_bottom(in.region, 100); });
  add_operator("transpose", [](const Input& in) { return transposed(in.region); });
  add_operator("zoom by 1.5 and .75", [](const Input& in) { return zoomed(in.region, {1.5, .75}); });
  add_operator("rotate by 10 degrees", [](const Input& in) {
    return mapped(in.region, rotation_about({in.window.x1 / 2., in.window.y1 / 2.}, std::numbers::pi / 18));
  });
  add_operator("partition, 32 x 32", [](const Input& in) { return partition_into_rectangles(in.region, {32, 32}); });
}

void add_morphology() {
  // The last one is a crescent: a region as any other, not symmetric, not convex.
  const std::vector<std::pair<std::string, Region>> elements{
      {"rectangle 5 x 5", rectangle(5, 5)},
      {"disc 3.5", disc(3.5)},
      {"octagon 3", octagon(3)},
      {"line 9, 30 degrees", line_element({9, std::numbers::pi / 6})},
      {"region", difference(disc(4), translated(disc(3.5), {2, 0}))},
  };
  for (const auto& [name, e] : elements) {
    add_operator("dilation, " + name, [e = e](const Input& in) { return dilation(in.region, e); });
    add_operator("erosion, " + name, [e = e](const Input& in) { return erosion(in.region, e); });
    add_operator("opening, " + name, [e = e](const Input& in) { return opening(in.region, e); });
    add_operator("closing, " + name, [e = e](const Input& in) { return closing(in.region, e); });
  }
  add_operator("top hat, 3 x 3", [](const Input& in) { return top_hat(in.region, rectangle(3, 3)); });
  add_operator("bottom hat, 3 x 3", [](const Input& in) { return bottom_hat(in.region, rectangle(3, 3)); });
  const Region hit = Region::from_box({0, 0, 2, 2}), miss = Region::from_box({-1, 0, 0, 2});
  add_operator("hit or miss, left rim", [=](const Input& in) { return hit_or_miss(in.region, hit, miss); });
  add_operator("inner boundary", [](const Input& in) { return inner_boundary(in.region); });
  add_operator("outer boundary", [](const Input& in) { return outer_boundary(in.region); });
  add_operator("remove noise", [](const Input& in) { return remove_noise(in.region, NoiseNeighbors::n_48); });
  add_operator("fill holes", [](const Input& in) { return fill_holes(in.region); });
  add_operator("fill up, round holes", [](const Input& in) {
    const FeatureRange round{.feature = Feature::circularity, .min = .5};
    return fill_up(in.region, {&round, 1});
  });
  add_operator("skeleton", [](const Input& in) { return skeleton(in.region); });
}

void add_features() {
  add_operator("components, 4", [](const Input& in) { return components(in.region, Connectivity::four); });
  add_operator("components, 8", [](const Input& in) { return components(in.region, Connectivity::eight); });
  add_operator("features of components", [](const Input& in) { return component_features(in.region); });
  add_operator("select parts of 20 pixels", [](const Input& in) { return select(in.parts, {{Feature::area, 20}}); });
  add_operator("sort parts by area", [](const Input& in) { return sorted(in.parts, Feature::area); });
  add_operator("area", [](const Input& in) { return area(in.region); });
  add_operator("shape features", [](const Input& in) { return shape_features(in.region).circularity; });
  add_operator("Euler number", [](const Input& in) { return euler_number(in.region); });
  add_operator("contour length", [](const Input& in) { return contour_length(in.region); });
  add_operator("roundness", [](const Input& in) { return roundness(in.region).sides; });
  add_operator("rectangularity", [](const Input& in) { return rectangularity(in.region); });
  add_operator("gray features", [](const Input& in) { return gray_features(in.region, in.frame).mean; });
  add_operator("diameter", [](const Input& in) { return diameter(in.region).length; });
  add_operator("Feret diameters", [](const Input& in) { return feret_diameters(in.region).max.length; });
  add_operator("convex hull", [](const Input& in) { return convex_hull(in.region); });
  add_operator("convex region", [](const Input& in) { return convex_region(in.region); });
  add_operator("smallest circle", [](const Input& in) { return smallest_circle(in.region).radius; });
  add_operator("smallest rectangle", [](const Input& in) { return smallest_rectangle(in.region).phi; });
  add_operator("inner circle", [](const Input& in) { return inner_circle(in.region).radius; });
  add_operator("inner rectangle", [](const Input& in) { return inner_rectangle(in.region).x0; });
}

/// The window's pixels count here, not only the region's runs.
void add_conversions() {
  add_operator("distance inside, window", [](const Input& in) { return distance_inside(in.region, in.window); });
  add_operator("distance to, window", [](const Input& in) { return distance_to(in.region, in.window); });
  add_operator("to mask, window", [](const Input& in) { return to_mask(in.region, in.window); });
  add_operator("from mask, window",
               [](const Input& in) { return region_where(in.view_of(in.mask), [](int byte) { return byte != 0; }); });
  add_operator("to label image, window", [](const Input& in) { return to_labels(in.parts, in.window); });
  add_operator("from label image, window",
               [](const Input& in) { return regions_of_labels(in.view_of(in.labels), kColorClassCount); });
  add_operator("boundary contours", [](const Input& in) { return boundary_contours(in.region); });
  add_operator("contours of the skeleton", [](const Input& in) { return skeleton_contours(in.thin).contours; });
  add_operator("to polygons", [](const Input& in) { return outlines(in.region); });
  add_operator("from polygons", [](const Input& in) { return region_from_outlines(in.outlines, in.window); });
  add_operator("to COCO run lengths", [](const Input& in) { return coco_counts(in.coco()); });
  add_operator("from COCO run lengths", [](const Input& in) {
    return coco_mask_from_counts({in.window.width(), in.window.height(), {}}, in.counts, "bench").region;
  });
}

}  // namespace

void register_benchmarks() {
  add_yardsticks({2, 3, 5});
  add_algebra();
  add_morphology();
  add_features();
  add_conversions();
}

}  // namespace tassilo::bench
