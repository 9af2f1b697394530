#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "tassilo/camera/camera_model.h"
#include "tassilo/camera/mount.h"

namespace tassilo {

/// What camera.yaml says: a ROS camera_info file, with `camera_pose_in_robot` where the mount is known.
struct CameraFile {
  CameraModel model;
  std::optional<CameraMount> mount;
};

/// rectification_matrix and projection_matrix are checked when present, and not used. Throws Error with file and line.
CameraFile read_camera(const std::filesystem::path& file);
CameraFile camera_from_yaml(std::string_view text, const std::string& file);
/// The text of such a file; reading it gives the same camera, to the last bit.
std::string camera_yaml(const CameraFile& camera);
/// Written atomically.
void write_camera(const std::filesystem::path& file, const CameraFile& camera);

/// A HALCON area_scan_division parameter list, as a map with the keys f, kappa, sx, sy, cx, cy, image_width,
/// image_height [m, 1/m^2, m/px, px] or as the list of HALCON's camera parameter tuple: [area_scan_division, f, kappa,
/// sx, sy, cx, cy, image_width, image_height].
CameraModel read_halcon_camera(const std::filesystem::path& file);
CameraModel halcon_camera_from_yaml(std::string_view text, const std::string& file);
/// The map form. The sensor's pixel width sx [m/px] must be told; sizes in pixels do not contain it. Throws Error when
/// the camera's distortion is not `division` or sx <= 0.
std::string halcon_camera_yaml(const CameraModel& camera, double sx);
void write_halcon_camera(const std::filesystem::path& file, const CameraModel& camera, double sx);

}  // namespace tassilo
