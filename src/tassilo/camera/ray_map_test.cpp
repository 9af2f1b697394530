#include "tassilo/camera/ray_map.h"

#include <gtest/gtest.h>

#include "tassilo/camera/test_world.h"

namespace tassilo {
namespace {

// A hundredth of a pixel is far below what any edge is known to.
TEST(RayMap, EqualsUnprojectInAndAroundTheImage) {
  for (const MountedCamera& mounted : test::cameras()) {
    CameraModel camera = mounted.model();
    SCOPED_TRACE(distortion_name(camera.distortion));
    for (const int cut : {0, 1}) {  // even and odd sizes
      camera.width -= cut;
      camera.height -= cut;
      const RayMap map(camera);
      for (double row = -3; row <= camera.height + 2; row += 1.7)
        for (double column = -3; column <= camera.width + 2; column += 1.3) {
          const auto exact = unproject(camera, {column, row}), fast = map.at({column, row});
          ASSERT_EQ(exact.has_value(), fast.has_value());
          if (!exact) continue;
          EXPECT_NEAR(norm(*fast), 1, 1e-12);
          EXPECT_LT(norm(*fast - *exact), 0.01 / camera.fx) << column << ", " << row;
        }
    }
  }
}

}  // namespace
}  // namespace tassilo
