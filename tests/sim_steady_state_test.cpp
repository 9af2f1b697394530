// The simulated camera allocates nothing per frame once it has seen as many robots as there are, but what Embree does
// by itself whenever things have moved.

#include <gtest/gtest.h>

#include <cstdint>

#include "support/counted_new.h"
#include "tassilo/camera/test_world.h"
#include "tassilo/files/field_file.h"
#include "tassilo/sim/renderer.h"
#include "tassilo/sim/script.h"

namespace tassilo {
namespace {

constexpr std::int64_t kOfEmbree = 2;  ///< A line of its log and a builder, by rtcCommitScene.

TEST(SteadyState, TheSimulatedCameraAllocatesNothingPerFrame) {
  const FieldModel field = read_field("msl98");
  RenderOptions options = fast_rendering();
  options.shutter = .01;
  options.sub_frames = 2;
  Renderer renderer(field, test::cameras()[0], options);
  const SimMotion motion = scripted_motion(field, {.seed = 4});
  for (int k = 0; k < 4; ++k) {
    const SimState state = motion(k * .05);
    renderer.render(state, 1);
    renderer.look(state, 1);
  }
  for (int k = 4; k < 12; ++k) {
    const SimState state = motion(k * .05);
    const std::int64_t before = test::allocations;
    renderer.render(state, 1);
    renderer.look(state, 1);
    const int moments = options.sub_frames + 1;  // of the frame, and of the truth about it
    EXPECT_LE(test::allocations - before, moments * kOfEmbree) << "frame " << k;
  }
}

}  // namespace
}  // namespace tassilo
