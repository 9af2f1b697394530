// How long does the skeleton of a frame's line region take, by kernel, and how many times faster is it than Leptonica's
// thinning? Leptonica runs in the same process, where it is installed; its skeletons must have the same parts and
// holes.

#include <benchmark/benchmark.h>

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "field_lines.h"
#include "support/recording.h"
#include "tassilo/base/median.h"
#include "tassilo/region/components.h"
#include "tassilo/region/features.h"
#include "tassilo/region/internal/thinning.h"
#include "tassilo/region/raster.h"
#include "tassilo/region/skeleton.h"

#ifdef TASSILO_BENCH_LEPTONICA
#include <allheaders.h>
#endif

namespace tassilo {
namespace {

/// Regions of the lines of one camera, and the size of its frames.
struct Masks {
  int width = 0, height = 0;
  std::vector<Region> regions;
};

Masks synthetic(int width, int height) {
  Masks masks{width, height, {}};
  for (const Frame& frame : bench::field_line_frames(width, height)) {
    const YuvRow first = frame.view.row(0);
    masks.regions.push_back(
        region_where({first.y, width, height, frame.view.row(1).y - first.y}, [](int y) { return y > 130; }));
  }
  return masks;
}

Masks recorded(const std::string& name, const std::string& samples) {
  const test::Recording recording = test::load_recording(name, samples);
  const Classifier classifier(recording.setup.colors);
  Masks masks{recording.frames[0].view.width(), recording.frames[0].view.height(), {}};
  for (const Frame& frame : recording.frames)
    masks.regions.push_back(segment(frame.view, classifier).of(ColorClass::white));
  return masks;
}

const Masks& masks_of(int source) {
  static std::map<int, Masks> made;
  if (!made.contains(source)) {
    if (source == 0) made[source] = synthetic(640, 480);
    if (source == 1) made[source] = synthetic(1920, 1080);
    if (source == 2) made[source] = recorded("d06_vga", "train_vga/samples.yaml");
    if (source == 3) made[source] = recorded("d01_approach", "train_div/samples.yaml");
  }
  return made.at(source);
}

/// Time of a call by mask, the median of several, as the mean over all masks. [s]
template <class Call>
double seconds_per_mask(const Masks& masks, int rounds, Call call) {
  std::vector<std::vector<double>> seconds(masks.regions.size());
  for (int round = 0; round < rounds; ++round)
    for (std::size_t k = 0; k < seconds.size(); ++k) {
      const auto start = std::chrono::steady_clock::now();
      call(k);
      seconds[k].push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
  double sum = 0;
  for (std::vector<double>& mask : seconds) sum += median(std::move(mask));
  return sum / static_cast<double>(seconds.size());
}

#ifdef TASSILO_BENCH_LEPTONICA

PIX* pix_of(const Region& region, int width, int height) {
  PIX* pix = pixCreate(width, height, 1);
  for (const PixelRun& run : region.runs())
    for (int c = run.begin; c < run.end; ++c) pixSetPixel(pix, c, run.row, 1);
  return pix;
}

Region region_of(PIX* pix) {
  RunVector runs;
  for (int r = 0; r < pixGetHeight(pix); ++r)
    for (int c = 0; c < pixGetWidth(pix); ++c) {
      l_uint32 value = 0;
      pixGetPixel(pix, c, r, &value);
      if (value != 0)
        runs.push_back({static_cast<std::int16_t>(r), static_cast<std::int16_t>(c), static_cast<std::int16_t>(c + 1)});
    }
  return Region::from_runs(std::move(runs));
}

/// Time of Leptonica by mask [s], after a look at its answers; 0 when they do not agree with ours.
double leptonica_seconds(int source) {
  static std::map<int, double> measured;
  if (measured.contains(source)) return measured[source];
  const Masks& masks = masks_of(source);
  std::vector<PIX*> pixes;
  bool agrees = true;
  for (const Region& region : masks.regions) {
    pixes.push_back(pix_of(region, masks.width, masks.height));
    PIX* thin = pixThinConnected(pixes.back(), L_THIN_FG, 8, 0);
    const Region theirs = region_of(thin), ours = skeleton(region);
    agrees &= label_runs(theirs).count == label_runs(ours).count && euler_number(theirs) == euler_number(ours);
    pixDestroy(&thin);
  }
  const double seconds = seconds_per_mask(masks, 3, [&](std::size_t k) {
    PIX* thin = pixThinConnected(pixes[k], L_THIN_FG, 8, 0);
    benchmark::DoNotOptimize(thin);
    pixDestroy(&thin);
  });
  for (PIX*& pix : pixes) pixDestroy(&pix);
  return measured[source] = agrees ? seconds : 0;
}

#endif

void BM_Skeleton(benchmark::State& state) {
  const auto kernels = thinning_kernels();
  const auto index = static_cast<std::size_t>(state.range(1));
  if (index >= kernels.size() || !is_supported(kernels[index].kernel)) {
    state.SkipWithError("this machine does not have the kernel");
    return;
  }
  const ThinningKernel& kernel = kernels[index];
  const Masks& masks = masks_of(static_cast<int>(state.range(0)));
  double runs = 0, pixels = 0;
  for (const Region& region : masks.regions) {
    if (skeleton_by(kernel, region) != skeleton_by(kernels[0], region)) {
      state.SkipWithError("differs from the plain kernel");
      return;
    }
    runs += static_cast<double>(region.runs().size()) / static_cast<double>(masks.regions.size());
    pixels += static_cast<double>(area(region)) / static_cast<double>(masks.regions.size());
  }
  std::size_t next = 0;
  for (auto _ : state) benchmark::DoNotOptimize(skeleton_by(kernel, masks.regions[next++ % masks.regions.size()]));
  const double seconds = seconds_per_mask(
      masks, 20, [&](std::size_t k) { benchmark::DoNotOptimize(skeleton_by(kernel, masks.regions[k])); });
  state.counters["runs"] = runs;
  state.counters["pixels"] = pixels;
  state.counters["us_per_mask"] = 1e6 * seconds;
#ifdef TASSILO_BENCH_LEPTONICA
  const double theirs = leptonica_seconds(static_cast<int>(state.range(0)));
  if (theirs == 0) {
    state.SkipWithError("Leptonica's skeletons have other parts or holes");
    return;
  }
  state.counters["leptonica_us"] = 1e6 * theirs;
  state.counters["x_leptonica"] = theirs / seconds;
#endif
  state.SetLabel(std::to_string(masks.width) + "x" + std::to_string(masks.height) + " " +
                 std::string(to_string(kernel.kernel)));
}

BENCHMARK(BM_Skeleton)
    ->ArgsProduct({{0, 1, 2, 3}, {0, 1, 2}})
    ->ArgNames({"source", "kernel"})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace tassilo

BENCHMARK_MAIN();
