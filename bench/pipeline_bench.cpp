// How long does a frame take from memory to scene, as a whole and by stage? On the shipped recordings, frames cycled.
// memcpy and the scalar reference run in the same process on frames of the same recordings: compare ratios. That scenes
// are right is left to the tests.

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bench.h"
#include "support/recording.h"
#include "tassilo/base/median.h"

namespace tassilo::bench {
namespace {

const test::Recording& recording(int index) {
  static const std::array names{std::pair("d01_approach", "train_div/samples.yaml"),
                                std::pair("d06_vga", "train_vga/samples.yaml")};
  static std::map<int, test::Recording> loaded;
  const auto& [name, samples] = names[static_cast<std::size_t>(index)];
  if (!loaded.contains(index)) loaded.emplace(index, test::load_recording(name, samples));
  return loaded.at(index);
}

/// With stages chosen as below `vision:` in a robot file.
void frame_to_scene(benchmark::State& state, const std::map<std::string, std::string, std::less<>>& stages_chosen) {
  const test::Recording& r = recording(static_cast<int>(state.range(0)));
  VisionSetup setup = r.setup;
  setup.options.stages = stages_chosen;
  const Vision vision(setup);
  VisionWorkspace workspace;
  std::map<std::string, std::vector<double>> stages;
  measure(state, r.frames.size(), [&](std::size_t k) {
    const Scene scene = vision(r.frames[k], workspace);
    for (const StageTime& time : scene.timing) stages[time.stage].push_back(time.ms);
  });
  for (auto& [stage, ms] : stages) state.counters[stage + "_ms"] = median(std::move(ms));
  const FrameView& view = r.frames[0].view;
  state.SetLabel(std::to_string(view.width()) + "x" + std::to_string(view.height()) + " recorded");
}

}  // namespace

void register_benchmarks() {
  add_yardsticks({0, 1});  // these recordings
  add("scene/ours", {0, 1}, [](benchmark::State& state) { frame_to_scene(state, {}); });
  for (const char* way : {"skeleton", "subpixel"})
    add("scene/boundary_" + std::string(way), {0, 1}, [way](benchmark::State& state) {
      frame_to_scene(state, {{"localization", "boundary"}, {"field_boundary", way}});
    });
}

}  // namespace tassilo::bench
