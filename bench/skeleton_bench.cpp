// How long does the skeleton of a frame's line region take, by kernel, beside Leptonica's thinning, where installed?
// Before any time counts all kernels' skeletons are compared, and Leptonica's must have the same parts and holes: which
// pixel of a thick line's middle stays is each algorithm's own choice.

#include <string>
#include <vector>

#include "bench.h"
#include "field_lines.h"
#include "references.h"
#include "tassilo/base/contract.h"
#include "tassilo/base/kernel.h"
#include "tassilo/region/components.h"
#include "tassilo/region/features.h"
#include "tassilo/region/skeleton.h"

namespace tassilo::bench {
namespace {

void report(benchmark::State& state, const FieldLines& masks) {
  double runs = 0;
  for (const Region& region : masks.lines) runs += static_cast<double>(region.runs().size());
  state.counters["runs"] = runs / static_cast<double>(masks.lines.size());
  state.SetLabel(masks.name);
}

void ours(benchmark::State& state, Kernel kernel) {
  const FieldLines& masks = field_lines(static_cast<int>(state.range(0)));
  once(std::string(to_string(kernel)) + std::to_string(state.range(0)), [&] {
    for (const Region& region : masks.lines) {
      use_kernel(Kernel::plain);
      const Region plain = skeleton(region);
      use_kernel(kernel);
      expects(plain == skeleton(region), "a kernel equals the plain one");
    }
  });
  use_kernel(kernel);
  measure(state, masks.lines.size(), [&](std::size_t k) { benchmark::DoNotOptimize(skeleton(masks.lines[k])); });
  report(state, masks);
}

#ifdef TASSILO_BENCH_LEPTONICA

void leptonica(benchmark::State& state) {
  const FieldLines& masks = field_lines(static_cast<int>(state.range(0)));
  std::vector<Pix> pixes;
  for (const Region& region : masks.lines) pixes.push_back(pix_of(region, masks.window()));
  const auto run = [&](std::size_t k) { return Pix(pixThinConnected(pixes[k].get(), L_THIN_FG, 8, 0)); };
  once("leptonica" + std::to_string(state.range(0)), [&] {
    for (std::size_t k = 0; k < pixes.size(); ++k) {
      const Region theirs = region_of(run(k).get()), ours = skeleton(masks.lines[k]);
      expects(label_runs(theirs).count == label_runs(ours).count && euler_number(theirs) == euler_number(ours),
              "Leptonica's skeleton has as many parts and holes");
    }
  });
  measure(state, pixes.size(), [&](std::size_t k) { benchmark::DoNotOptimize(run(k).get()); });
  report(state, masks);
}

#endif

}  // namespace

void register_benchmarks() {
  const std::vector<int> masks{0, 1, 2, 3};
  static_assert(kFieldLines == 4);
  add_yardsticks({1, 2, 3, 5});
  for (const Kernel kernel : supported_kernels())
    add("skeleton/" + std::string(to_string(kernel)), masks,
        [kernel](benchmark::State& state) { ours(state, kernel); });
#ifdef TASSILO_BENCH_LEPTONICA
  add("skeleton/leptonica", masks, leptonica);
#endif
}

}  // namespace tassilo::bench
