#include "tassilo/files/camera_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tassilo/files/internal/test_data.h"
#include "tassilo/files/internal/test_message.h"
#include "tassilo/files/test_folder.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

CameraFile camera_with(const Distortion& distortion) {
  CameraFile camera;
  camera.model = {.name = "a camera: #1",
                  .width = 640,
                  .height = 480,
                  .fx = 400.1,
                  .fy = 1.0 / 3 + 399,
                  .cx = 317.25,
                  .cy = 246,
                  .distortion = distortion};
  camera.mount = CameraMount{0.1, -0.02, 0.45, -0.005, 0.3, 1e-17};
  return camera;
}

TEST(CameraFile, WrittenCamerasReadBackToTheLastBit) {
  const TestFolder folder;
  for (const Distortion& distortion :
       {Distortion(PlumbBob{-0.262, 0.078, 0.0006, -0.0009, -0.008}),
        Distortion(RationalPolynomial{0.01, 0.02, 1e-4, -1e-4, 0.003, 0.001, 0.002, 0.0001}),
        Distortion(Equidistant{0.01, -0.002, 0.0003, -1e-5}), Distortion(Division{-0.1458})}) {
    const CameraFile camera = camera_with(distortion);
    SCOPED_TRACE(distortion_name(distortion));
    write_camera(folder / "camera.yaml", camera);
    const CameraFile read = read_camera(folder / "camera.yaml");
    EXPECT_EQ(read.model, camera.model);
    EXPECT_EQ(read.mount, camera.mount);
  }
}

TEST(CameraFile, MountAndNameAndUnusedMatricesMayBeMissing) {
  const CameraFile camera = camera_from_yaml(R"(image_width: 64
image_height: 48
camera_matrix: {rows: 3, cols: 3, data: [50, 0, 32, 0, 50, 24, 0, 0, 1]}
distortion_model: division
distortion_coefficients: {rows: 1, cols: 1, data: [0]}
)",
                                             "c");
  EXPECT_FALSE(camera.mount);
  EXPECT_EQ(camera.model.fx, 50);
}

TEST(CameraFile, MalformedFilesAreRefused) {
  const std::string good = camera_yaml(camera_with(PlumbBob{-0.262, 0.078, 0.0006, -0.0009, -0.008}));
  EXPECT_NO_THROW(camera_from_yaml(good, "c"));
  struct Case {
    std::string from, to, message;
  };
  const Case cases[] = {
      {"image_width: 640", "image_width: 0", "c:1:14: image_width is '0', must be >= 1 and <= 32767"},
      {"image_width: 640", "image_width: 640.5", "c:1:14: image_width is '640.5', must be a whole number"},
      {"image_height: 480\n", "", "c:1:1: key 'image_height' is missing"},
      {"image_height", "image_heigth",
       "c:2:1: unknown key 'image_heigth', must be image_width, image_height, camera_name, camera_matrix, "
       "distortion_model, "
       "distortion_coefficients, rectification_matrix, projection_matrix or camera_pose_in_robot; did you mean "
       "image_height?"},
      {"rows: 3", "rows: 2", "c:7:9: camera_matrix.data has 9 values, must have 6"},
      {"rows: 3\n  cols: 3", "rows: 1\n  cols: 9", "c:5:3: camera_matrix has 1x9 values, must have 3x3"},
      {"data: [400.1, 0,", "data: [400.1, 1,", "c:7:9: camera_matrix.data must be [fx, 0, cx, 0, fy, cy, 0, 0, 1]"},
      {"data: [400.1,", "data: [-400.1,", "c: fx: is "},
      {"data: [400.1,", "data: [.inf,", "c:7:10: camera_matrix.data[0] is '.inf', must be a finite number"},
      {"plumb_bob", "fisheye",
       "c:8:19: distortion_model is 'fisheye', must be plumb_bob, rational_polynomial, equidistant or division"},
      {"plumb_bob", "equidistant",
       "c:12:9: distortion_coefficients.data has 5 values, equidistant must have 4 (k1 k2 k3 k4)"},
      {"-0.262", "-10", "c: distortion_coefficients: plumb_bob folds before the image corner"},
      {"data: [1, 0, 0, 0, 1", "data: [1, 0, 0, 0, 2", "c:16:9: rectification_matrix.data is no rotation, must be one"},
      {"data: [1, 0, 0, 0, 1, 0, 0, 0, 1]", "data: [1, 0, 0, 0, 1, 0, 0, 0, -1]",
       "c:16:9: rectification_matrix.data is no rotation, must be one"},
      {"0, 0, 1, 0]", "0, 0, 2, 0]",
       "c:20:9: projection_matrix.data must be [fx, 0, cx, Tx, 0, fy, cy, Ty, 0, 0, 1, 0] with fx, fy > 0"},
      {"z: 0.45", "z: -0.45", "c:21:23: z: is -0.450000 m, must be > 0, above the floor"},
      {", yaw: 1e-17", "", "c:21:23: key 'camera_pose_in_robot.yaw' is missing"},
  };
  for (const Case& c : cases)
    EXPECT_THAT(message_of([&] { camera_from_yaml(spoiled(good, c.from, c.to), "c"); }),
                testing::StartsWith(c.message));
}

TEST(HalconCamera, MapAndTupleAreTheSameAndRoundTrip) {
  const std::string map =
      "f: 0.0027\nkappa: -20000.0\nsx: 1.25e-05\nsy: 1.52e-05\ncx: 187.3\ncy: 88.9\nimage_width: 384\nimage_height: "
      "172\n";
  const CameraModel camera = halcon_camera_from_yaml(map, "h");
  EXPECT_NEAR(camera.fx, 216, 1e-9);
  EXPECT_NEAR(std::get<Division>(camera.distortion).k, -0.1458, 1e-12);
  EXPECT_EQ(
      halcon_camera_from_yaml("[area_scan_division, 0.0027, -20000, 1.25e-05, 1.52e-05, 187.3, 88.9, 384, 172]", "h"),
      camera);
  const TestFolder folder;
  write_halcon_camera(folder / "h.yaml", camera, 1.25e-5);
  const CameraModel read = read_halcon_camera(folder / "h.yaml");
  EXPECT_NEAR(read.fx, camera.fx, 1e-9);
  EXPECT_NEAR(read.fy, camera.fy, 1e-9);
  EXPECT_NEAR(std::get<Division>(read.distortion).k, -0.1458, 1e-12);
  EXPECT_EQ(
      message_of([&] { halcon_camera_from_yaml(spoiled(map, "kappa", "kapa"), "h"); }),
      "h:2:1: unknown key 'kapa', must be f, kappa, sx, sy, cx, cy, image_width or image_height; did you mean kappa?");
  EXPECT_EQ(message_of([&] { halcon_camera_from_yaml(spoiled(map, "1.52e-05", "0"), "h"); }),
            "h:4:5: sy is '0', must be > 0");
  EXPECT_EQ(message_of([] { halcon_camera_from_yaml("[area_scan_polynomial, 1, 1, 1, 1, 1, 1, 1, 1]", "h"); }),
            "h:1:2: [0] is 'area_scan_polynomial', must be area_scan_division");
}

TEST(CameraFile, SharedCamerasLoad) {
  if (!fs::exists(shared_data())) GTEST_SKIP() << "../shared/data is not there";
  for (const fs::path& file : files_named(shared_data(), "camera.yaml")) {
    SCOPED_TRACE(file);
    EXPECT_TRUE(read_camera(file).mount);
  }
  const CameraModel div = read_camera(shared_data() / "msl98/calibration/div.yaml").model;
  const CameraModel lenz = read_halcon_camera(shared_data() / "msl98/calibration/div_lenz.yaml");
  EXPECT_NEAR(lenz.fx, div.fx, 1e-6);
  EXPECT_NEAR(lenz.fy, div.fy, 1e-6);
  EXPECT_NEAR(std::get<Division>(lenz.distortion).k, std::get<Division>(div.distortion).k, 1e-9);
  EXPECT_EQ(lenz.cx, div.cx);
  EXPECT_EQ(lenz.height, div.height);
}

}  // namespace
}  // namespace tassilo
