#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "tassilo/app/commands.h"
#include "tassilo/app/robot_setup.h"
#include "tassilo/base/kernel.h"
#include "tassilo/files/field_file.h"
#include "tassilo/source/camera.h"
#include "tassilo/vision/stages.h"

namespace tassilo {
namespace {

struct InfoArguments {
  bool cameras = false;
  bool options = false, stages = false;
  std::string robot;
  std::vector<std::string> plugins;
};

/// What can be set below `vision:`, and what the robot file sets.
struct Settable {
  std::vector<StageInfo> stages;
  RobotFile robot;
  VisionOptions chosen;

  bool runs(const StageInfo& stage, const StageInfo::Alternative& alternative) const {
    return alternative.name == chosen_name(stage, chosen);
  }
  /// "; here 7" where the robot file says so.
  std::string here(const std::string& key) const {
    const auto set = std::ranges::find(robot.vision, key, [](const auto& entry) { return entry.first; });
    return set != robot.vision.end() ? "; here " + set->second.text : "";
  }
};

Settable settable(const InfoArguments& arguments) {
  Settable all;
  if (!arguments.robot.empty()) all.robot = read_robot(arguments.robot);
  const StageRegistry registry = registry_of(all.robot, arguments.robot, arguments.plugins);
  all.chosen = vision_options(all.robot.vision, registry);
  all.stages = stage_infos(registry);
  return all;
}

void print_row(int indent, const std::string& key, const std::array<std::string, 4>& rest) {
  fmt::print("{:{}}{:{}}{:>8}  {:8}{:18}  {}\n", "", indent, key, 36 - indent, rest[0], rest[1], rest[2], rest[3]);
}

void print_option(int indent, const OptionInfo& option, const Settable& all) {
  print_row(indent, option.key,
            {fmt::format("{:g}", option.standard), option.unit,
             fmt::format("{:g} .. {:g}{}", option.low, option.high, option.whole ? " whole" : ""),
             option.meaning + all.here(option.key)});
}

void print_options(const Settable& all) {
  fmt::print("Keys below `vision:` in robot.yaml; every one may be left out.\n\n");
  print_row(0, "key", {"default", "unit", "range", "meaning"});
  for (const StageInfo& stage : all.stages) {
    for (const OptionInfo& option : stage.options) print_option(0, option, all);
    for (const auto& alternative : stage.alternatives)
      for (const OptionInfo& option : alternative.options) print_option(0, option, all);
  }
  fmt::print("\nAlternatives of stages, the default first, likewise; `tassilo info --stages` tells more.\n\n");
  for (const StageInfo& stage : all.stages) {
    std::string names;
    for (const auto& alternative : stage.alternatives) names += (names.empty() ? "" : ", ") + alternative.name;
    if (!names.empty()) fmt::print("{:36}{}{}\n", stage.key, names, all.here(std::string(stage.key)));
  }
}

void print_stages(const Settable& all, const std::string& robot) {
  fmt::print(
      "The stages of the vision in the order they run: below each its alternatives, * marks {}, and its options.\n"
      "All are keys below `vision:` in robot.yaml, as `field_boundary: skeleton` or `ball_max: 3`.\n\n",
      robot.empty() ? "the default" : "what " + robot + " takes");
  print_row(4, "option", {"default", "unit", "range", "meaning"});
  for (const StageInfo& stage : all.stages) {
    fmt::print("\n{}: {}\n", stage.key, stage.meaning);
    for (const auto& alternative : stage.alternatives) {
      fmt::print("  {} {:14}  {}\n", all.runs(stage, alternative) ? '*' : ' ', alternative.name, alternative.meaning);
      for (const OptionInfo& option : alternative.options) print_option(8, option, all);
    }
    for (const OptionInfo& option : stage.options) print_option(4, option, all);
  }
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

int info_command(const InfoArguments& arguments) {
  if (arguments.cameras) {
    print_cameras();
  } else if (arguments.stages || arguments.options) {
    const Settable all = settable(arguments);
    arguments.stages ? print_stages(all, arguments.robot) : print_options(all);
  } else {
    print_overview();
  }
  return 0;
}

}  // namespace

Command add_info(CLI::App& program) {
  auto* command = program.add_subcommand("info", "tell about this program, and what the vision can be set to");
  auto arguments = std::make_shared<InfoArguments>();
  auto* options = command->add_flag("--options", arguments->options,
                                    "list the options of the vision: default, unit, range, meaning");
  command
      ->add_flag("--stages", arguments->stages, "list the stages of the vision, their alternatives and their options")
      ->excludes(options);
  command->add_option("-r,--robot", arguments->robot, "robot.yaml: also tell what it chooses");
  add_plugin_option(*command, arguments->plugins);
  command
      ->add_flag("--cameras", arguments->cameras,
                 "list the cameras of this machine: device, name, formats, sizes, rates")
      ->excludes("--options")
      ->excludes("--stages");
  command->callback([arguments] {
    if (!arguments->options && !arguments->stages && !(arguments->robot.empty() && arguments->plugins.empty()))
      throw CLI::ValidationError("--robot and --plugin", "tell what the vision can be set to, --stages is missing");
  });
  return [arguments] { return info_command(*arguments); };
}

}  // namespace tassilo
