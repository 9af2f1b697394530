#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tassilo/app/bus_arguments.h"
#include "tassilo/app/source_arguments.h"
#include "tassilo/files/robot_file.h"

namespace tassilo {

class LiveView;
class Recorder;

/// What the command line says of a run.
struct RunArguments {
  SourceArguments source;
  std::string robot, odometry, output, overlay, overlay_step, label_maps, colors, start_pose;
  std::string record;  ///< Folder for recordings; with `run`, one begins at once.
  std::string log;     ///< MCAP file of what is told.
  bool says_on_bus = false;
  BusArguments bus;
  std::optional<int> robot_id;  ///< Instead of the robot file's.
  std::vector<std::string> plugins;
  std::optional<StartPose> start;  ///< What `start_pose` says.
  int every = 1;
  int threads = 1;
  bool watch = false;
  bool quiet = false;
};

/// X,Y,THETA[,SIGMA_XY,SIGMA_THETA]; nothing for an empty text. Throws CLI::ValidationError: what it refuses is wrong
/// usage.
std::optional<StartPose> start_pose_from(const std::string& text);

/// Adds what all verbs that run the vision understand. They call `understand` when all is parsed.
void add_run_options(CLI::App& command, RunArguments& arguments);
/// Throws CLI::ValidationError: what it refuses is wrong usage.
void understand(RunArguments& arguments);

/// Do the source's frames wait until somebody wants them?
bool loses_nothing(const SourceArguments& source);

/// Sees every frame of the source. With a live view what is seen is shown there, stages may be changed from there, and
/// files play in real time, again and again. With a recorder what is seen may be recorded. Ends at the source's end or
/// by a signal; returns the exit code. Throws Error when something in the world fails.
int run(const RunArguments& arguments, LiveView* live, Recorder* recorder);

}  // namespace tassilo
