// How long does the simulated camera take for a frame? 384x172 is the camera of the recordings.

#include <numbers>
#include <string>

#include "bench.h"
#include "tassilo/camera/test_world.h"
#include "tassilo/files/field_file.h"
#include "tassilo/sim/renderer.h"
#include "tassilo/sim/script.h"

namespace tassilo::bench {
namespace {

/// 0: among four others, 1: the same while looking at nothing but floor and wall.
SimState state_of(int scene) {
  SimState state = scripted_motion(read_field("msl98"), {.seed = 1})(0);
  state.ball.at = {.3, .2};
  for (std::size_t k = 0; k < state.robots.size(); ++k) {
    SimRobot& robot = state.robots[k];
    const double side = k % 2 == 0 ? 1 : -1;
    robot.at =
        k == 0 ? FieldPoint{2.2, .6} : FieldPoint{1. - static_cast<double>(k), side * .5 * static_cast<double>(k)};
  }
  state.robots[0].theta = scene == 0 ? 3.3 : std::numbers::pi / 2;
  return state;
}

void run(benchmark::State& state, const RenderOptions& options) {
  const SimState world = state_of(static_cast<int>(state.range(0)));
  Renderer renderer(read_field("msl98"), test::cameras()[0], options);
  const int me = world.robots[0].id;
  if (renderer.render(world, me).view.width() != 384) state.SkipWithError("not the frame that was asked for");
  for (auto _ : state) benchmark::DoNotOptimize(renderer.render(world, me));
  state.SetItemsProcessed(state.iterations() * 384 * 172);
}

}  // namespace

void register_benchmarks() {
  add("render/fast", {0, 1}, [](benchmark::State& state) { run(state, fast_rendering()); });
  add("render/full", {0}, [](benchmark::State& state) { run(state, {}); });
}

}  // namespace tassilo::bench
