#include <fmt/core.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "tassilo/app/commands.h"
#include "tassilo/base/kernel.h"
#include "tassilo/files/field_file.h"
#include "tassilo/source/camera.h"
#include "tassilo/vision/options.h"

namespace tassilo {
namespace {

void print_options() {
  fmt::print("Keys below `vision:` in robot.yaml; every one may be left out.\n\n");
  fmt::print("{:24}{:>10}  {:6}{:18}  {}\n", "key", "default", "unit", "range", "meaning");
  for (const OptionInfo& option : vision_option_infos())
    fmt::print("{:24}{:>10}  {:6}{:18}  {}\n", option.key, fmt::format("{:g}", option.standard), option.unit,
               fmt::format("{:g} .. {:g}{}", option.low, option.high, option.whole ? " whole" : ""), option.meaning);
}

void print_overview() {
  std::string others;
  for (const Kernel kernel : supported_kernels())
    if (kernel != kernel_in_use()) others += (others.empty() ? "" : ", ") + std::string(to_string(kernel));
  const char* const chosen = std::getenv("TASSILO_KERNEL");
  fmt::print("tassilo {}\n\nkernel: {}, {}; this machine also runs {} (TASSILO_KERNEL=name chooses)\n", TASSILO_VERSION,
             to_string(kernel_in_use()),
             chosen != nullptr ? "chosen by TASSILO_KERNEL" : "the fastest that this machine runs",
             others.empty() ? "no other" : others);
  fmt::print("\nfolders of shipped files, first hit wins:\n");
  for (const auto& folder : config_folders()) fmt::print("  {}\n", folder.string());
}

/// "640x480 (30), 1280x720 (10)" of all modes of one format.
std::string sizes_of(const CameraInfo& camera, const std::string& format) {
  std::string text;
  for (const CameraMode& mode : camera.modes) {
    if (mode.format != format) continue;
    text += fmt::format("{}{}x{}", text.empty() ? "" : ", ", mode.width, mode.height);
    if (mode.fps > 0) text += fmt::format(" ({:.4g})", mode.fps);
  }
  return text;
}

void print_cameras() {
  const std::vector<CameraInfo> cameras = list_cameras();
  if (cameras.empty())
    fmt::print(
        "no camera: none of /dev/video0 to /dev/video255 captures video; is it plugged in, and in a container, is "
        "the device passed on?\n");
  for (const CameraInfo& camera : cameras) {
    if (camera.name.empty()) {
      fmt::print("{}: cannot be opened: {}{}\n", camera.path, camera.problem,
                 camera.problem == "permission denied" ? "; is the user in the group video?" : "");
      continue;
    }
    fmt::print("{}: {}, {}\n", camera.path, camera.name, camera.bus);
    std::string last;
    for (const CameraMode& mode : camera.modes) {
      if (mode.format == last) continue;
      last = mode.format;
      fmt::print("  {:6} {}{}\n", mode.format, sizes_of(camera, mode.format), mode.usable ? "" : "  (not for Tassilo)");
    }
  }
  if (!cameras.empty()) fmt::print("\nformat, sizes [px], highest rate [frames/s]\n");
}

}  // namespace

Command add_info(CLI::App& program) {
  auto* command = program.add_subcommand("info", "tell about this program");
  auto options = std::make_shared<bool>(false);
  command->add_flag("--options", *options, "list the options of the vision: default, unit, range, meaning");
  auto cameras = std::make_shared<bool>(false);
  command->add_flag("--cameras", *cameras, "list the cameras of this machine: device, name, formats, sizes, rates");
  return [options, cameras] {
    if (*cameras)
      print_cameras();
    else
      *options ? print_options() : print_overview();
    return 0;
  };
}

}  // namespace tassilo
