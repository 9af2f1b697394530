#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tassilo/calibrate/intrinsics.h"
#include "tassilo/calibrate/target.h"
#include "tassilo/overlay/calibration_picture.h"

namespace tassilo {

// What the verbs below `tassilo calibrate` share.

/// How a target is named on the command line, for help texts.
inline const std::string kTargetHelp =
    "dots:COLUMNSxROWS:PITCH:RADIUS, checker:COLUMNSxROWS:PITCH (inner corners), in metres, or "
    "aprilgrid:TAGCOLSxTAGROWS:TAGSIZE:TAGSPACING (spacing: share of the size)";

/// An image that was looked at, and what was found.
struct Look {
  std::string image;
  std::optional<std::size_t> view;  ///< Index of its view.
  std::string reason;               ///< Why there is none.
};

struct Looks {
  ImageSize size;
  std::vector<Look> looks;
  std::vector<TargetView> views;
};

/// Looks for each target until one is there, in every image of files, folders and videos. Throws Error when images
/// differ in size or there are more than 500.
Looks look_at_all(const std::vector<std::string>& locations, const std::vector<Target>& targets);
/// Throws Error with the reason when no image shows a target.
void check_any_target(const Looks& looks);

/// A warning on standard error.
void warn(const std::string& what, const std::string& reason);

/// Throws Error when the folder of a file that is to be written is not there.
void check_folder_of(const std::string& output);

/// Writes residuals.png to a folder, which is made.
void write_residuals(const std::string& folder, const CalibrationDrawing& drawing);

}  // namespace tassilo
