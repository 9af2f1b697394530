#include "tassilo/freespace/internal/ball_shape.h"

#include <gtest/gtest.h>

#include <vector>

#include "tassilo/freespace/test_ball.h"

namespace tassilo {
namespace {

// Against the sphere itself: no pixel of it is further outside than one pixel, none covered is further off it.
TEST(BallShape, IsTheOutlineOfTheSphere) {
  std::vector<MountedCamera> cameras = test::cameras();
  cameras.push_back(test::camera_of_flat_pixels());
  for (const MountedCamera& camera : cameras)
    for (const FloorPoint place : {FloorPoint{1, 0}, FloorPoint{1.2, .5}, FloorPoint{2.5, -1}}) {
      SCOPED_TRACE(testing::Message() << camera.model().width << "x" << camera.model().height << ", ball at " << place.x
                                      << ", " << place.y);
      const test::KnownBall ball{{place.x, place.y, .1}};
      const BallShape shape(camera, ball.seen(camera));
      int shown = 0;
      for (int r = 0; r < camera.model().height; ++r)
        for (int c = 0; c < camera.model().width; ++c) {
          const PixelPoint pixel{double(c), double(r)};
          if (ball.shows_at(camera, pixel)) {
            ++shown;
            ASSERT_TRUE(shape.covers(pixel, 1)) << c << ", " << r;
          } else {
            ASSERT_FALSE(shape.covers(pixel, -1)) << c << ", " << r;
          }
        }
      EXPECT_GT(shown, 20);
    }
}

}  // namespace
}  // namespace tassilo
