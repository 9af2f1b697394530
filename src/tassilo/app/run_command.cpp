#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tassilo/app/boundary_steps.h"
#include "tassilo/app/commands.h"
#include "tassilo/app/number_list.h"
#include "tassilo/app/recorder.h"
#include "tassilo/app/run.h"
#include "tassilo/app/topic_input.h"

namespace tassilo {
std::optional<StartPose> start_pose_from(const std::string& text) {
  if (text.empty()) return std::nullopt;
  StartPose pose;
  const std::array values{&pose.x, &pose.y, &pose.theta, &pose.sigma_xy, &pose.sigma_theta};
  if (!read_numbers(text, values, 3) || !(pose.sigma_xy > 0) || !(pose.sigma_theta > 0) ||
      std::abs(pose.theta) > 2 * std::numbers::pi)
    throw CLI::ValidationError(
        "--start-pose",
        "is " + text +
            ", must be X,Y,THETA or X,Y,THETA,SIGMA_XY,SIGMA_THETA in m and rad, sigmas > 0, THETA at most a turn");
  return pose;
}

void add_run_options(CLI::App& command, RunArguments& arguments) {
  command.add_option("-r,--robot", arguments.robot, "robot.yaml: camera, colors, field and options of one robot");
  arguments.source.add_to(command);
  command.add_option(
      "--odometry", arguments.odometry,
      "odometry.jsonl on the clock of the frames; live: - for standard input, udp:127.0.0.1:PORT, or a topic "
      "of ROS 2 such as topic:/odom");
  command.add_option("--start-pose", arguments.start_pose,
                     "X,Y,THETA[,SIGMA_XY,SIGMA_THETA] on the field, instead of the robot file's [m, rad]");
  command.add_option("-o,--output", arguments.output, "scenes as JSON Lines; - for standard output");
  command.add_option("--overlay", arguments.overlay, "annotated pictures: a .mkv or .mp4 video, or a folder of PNGs");
  command
      .add_option("--overlay-step", arguments.overlay_step,
                  "draw what this step of finding the boundary saw, instead of what is in the scene")
      ->check(CLI::IsMember(std::vector<std::string>(kBoundarySteps.begin(), kBoundarySteps.end())));
  command.add_option("--label-maps", arguments.label_maps, "folder for color classes 0..8 as NNNN.png");
  command.add_option("--colors", arguments.colors, "color table, instead of the robot file's");
  add_plugin_option(command, arguments.plugins);
  command.add_flag("--bus", arguments.says_on_bus,
                   "tell the team what is seen, as topics /robot<id>/... of ROS 2; files then play in real time");
  command.add_option("--robot-id", arguments.robot_id, "number on the bus and in logs, instead of the robot file's")
      ->check(CLI::Range(0, 255));
  arguments.bus.add_to(command);
  command.add_option("--threads", arguments.threads, "for decoding and encoding; seeing itself takes one core")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command.add_option("--every", arguments.every, "look at every N-th frame only, as if the others had been lost")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command.add_flag("-q,--quiet", arguments.quiet, "print nothing but errors");
}

void understand(RunArguments& arguments) {
  if (!arguments.overlay_step.empty() && arguments.overlay.empty())
    throw CLI::ValidationError("--overlay-step", "says what is drawn, --overlay is missing");
  if (arguments.watch && arguments.robot.empty())
    throw CLI::ValidationError("--watch", "watches the robot file, --robot is missing");
  if (arguments.odometry == "-" && arguments.source.source == "-")
    throw CLI::ValidationError("--odometry", "and --source cannot both be standard input");
  arguments.source.understand();
  if (is_topic(arguments.odometry)) topic_from("--odometry", arguments.odometry);
  arguments.start = start_pose_from(arguments.start_pose);
}

Command add_run(CLI::App& program) {
  auto* command =
      program.add_subcommand("run", "see: balls, goals, robots, lines, free space and pose in every frame of a source");
  auto arguments = std::make_shared<RunArguments>();
  add_run_options(*command, *arguments);
  command->add_flag("--watch", arguments->watch,
                    "take changes of the robot file, and of the files it names, over between two frames");
  command->add_option("--record", arguments->record,
                      "record into a new folder below this one: lossless video, odometry, scenes and configuration, "
                      "from which the same scenes come again; or, NAME.mcap, into a log of the messages that --bus "
                      "sends, with annotated pictures");
  command->callback([arguments] {
    understand(*arguments);
    if (std::filesystem::path(arguments->record).extension() == ".mcap")
      arguments->log = std::exchange(arguments->record, "");
  });
  return [arguments] {
    if (arguments->record.empty()) return run(*arguments, nullptr, nullptr);
    Recorder recorder(arguments->record, loses_nothing(arguments->source));
    return run(*arguments, nullptr, &recorder);
  };
}

}  // namespace tassilo
