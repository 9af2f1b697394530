#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tassilo/app/calibration_views.h"
#include "tassilo/app/commands.h"
#include "tassilo/app/number_list.h"
#include "tassilo/app/residual_picture.h"
#include "tassilo/app/robot_setup.h"
#include "tassilo/app/run.h"
#include "tassilo/app/written_files.h"
#include "tassilo/base/error.h"
#include "tassilo/calibrate/mount_from_lines.h"
#include "tassilo/calibrate/mount_from_target.h"
#include "tassilo/field/field_curves.h"
#include "tassilo/files/camera_file.h"
#include "tassilo/files/odometry_file.h"
#include "tassilo/files/robot_file.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/source/frame_source.h"
#include "tassilo/vision/vision.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

struct MountArguments {
  std::vector<std::string> images, targets, at;
  std::string camera, output, report;
  std::string robot, odometry, colors, start_pose;  ///< From field lines.
  std::vector<std::string> plugins;
  int frames = 40;
  MountFromTargetOptions from_target;
  bool quiet = false;
};

/// X,Y,YAW[,HEIGHT]. Throws CLI::ValidationError: what it refuses is wrong usage.
TargetPlace place_from(const std::string& text) {
  TargetPlace place;
  const std::array values{&place.x, &place.y, &place.yaw, &place.height};
  if (!read_numbers(text, values, 3))
    throw CLI::ValidationError("--at", "is " + text + ", must be X,Y,YAW or X,Y,YAW,HEIGHT in m and rad");
  try {
    place.check();
  } catch (const Error& error) {
    throw CLI::ValidationError("--at", error.what());
  }
  return place;
}

/// A mount that is far from the one before is more often a target that lies elsewhere than a camera that was moved.
void warn_of_change(const std::optional<CameraMount>& before, const CameraMount& now) {
  constexpr double far = .3, turned = radians(15);  // [m, rad] nobody sets a camera so far off by eye
  if (!before) return;
  const double moved = std::hypot(now.x - before->x, now.y - before->y, now.z - before->z);
  double angle = 0;
  for (const auto value : {&CameraMount::roll, &CameraMount::pitch, &CameraMount::yaw})
    angle = std::max(angle, std::abs(wrap_angle(now.*value - (*before).*value)));
  if (moved > far || angle > turned)
    warn("mount", fmt::format("is {:.0f} cm and up to {:.0f} degrees from the one before; does the target lie on the "
                              "floor where --at says, face up?",
                              100 * moved, degrees(angle)));
}

/// One line a value: before, now, change and standard deviation, or that it was kept.
void print_mount(const std::optional<CameraMount>& before, const EstimatedMount& now, bool places_measured) {
  struct Row {
    const char* name;
    double CameraMount::*value;
    double MountSigma::*sigma;
    bool is_angle, is_measured;
  };
  const std::array rows{Row{"x", &CameraMount::x, &MountSigma::x, false, places_measured},
                        Row{"y", &CameraMount::y, &MountSigma::y, false, places_measured},
                        Row{"z", &CameraMount::z, &MountSigma::z, false, true},
                        Row{"roll", &CameraMount::roll, &MountSigma::roll, true, true},
                        Row{"pitch", &CameraMount::pitch, &MountSigma::pitch, true, true},
                        Row{"yaw", &CameraMount::yaw, &MountSigma::yaw, true, places_measured}};
  fmt::print("\n{:12}{:>10}{:>10}{:>10}{:>10}\n", "mount", "before", "now", "change", "sigma");
  for (const Row& row : rows) {
    // Millimetres and hundredths of a degree are what people can set.
    const double unit = row.is_angle ? degrees(1) : 1000;
    const int digits = row.is_angle ? 3 : 1;
    const auto text = [&](double value) { return fmt::format("{:.{}f}", unit * value, digits); };
    const double value = now.mount.*row.value;
    const std::string was = before ? text((*before).*row.value) : "-";
    const double change = before ? value - (*before).*row.value : 0;
    fmt::print("{:12}{:>10}{:>10}{:>10}{:>10}\n", fmt::format("{} [{}]", row.name, row.is_angle ? "deg" : "mm"), was,
               text(value), before && row.is_measured ? text(row.is_angle ? wrap_angle(change) : change) : "-",
               row.is_measured ? text(now.sigma.*row.sigma) : "kept");
  }
}

void check_output(const MountArguments& arguments, const std::string& camera, std::vector<NamedFile> read) {
  // The camera file itself may be written: only its mount changes.
  if (fs::path(arguments.output).lexically_normal() != fs::path(camera).lexically_normal())
    read.push_back({"camera file", camera});
  check_written_files(read, std::vector<NamedFile>{{"--output", arguments.output}, {"--report", arguments.report}});
  check_folder_of(arguments.output);
}

int from_target(MountArguments arguments) {
  if (arguments.output.empty()) arguments.output = arguments.camera;
  std::vector<NamedFile> read;
  for (const std::string& image : arguments.images) read.push_back({"an image", image});
  check_output(arguments, arguments.camera, read);
  const CameraFile before = read_camera(arguments.camera);
  std::vector<Target> targets;
  for (const std::string& text : arguments.targets) targets.push_back(target_from_text(text));
  std::vector<TargetPlace> places;
  for (const std::string& text : arguments.at) places.push_back(place_from(text));

  const Looks looks = look_at_all(arguments.images, targets);
  check_any_target(looks);
  if (looks.size.width != before.model.width || looks.size.height != before.model.height)
    throw Error(
        looks.looks.front().image,
        fmt::format("is {} x {}, {} is for {} x {}; calibrate the lens for this resolution first", looks.size.width,
                    looks.size.height, arguments.camera, before.model.width, before.model.height));
  if (places.size() != 1 && places.size() != looks.looks.size())
    throw Error("--at", fmt::format("is there {} times, must be once, or once for each of the {} images", places.size(),
                                    looks.looks.size()));
  std::vector<PlacedView> views;
  for (std::size_t i = 0; i < looks.looks.size(); ++i)
    if (looks.looks[i].view) views.push_back({looks.views[*looks.looks[i].view], places.size() == 1 ? 0 : i});

  const MountFromTarget result = mount_from_target(before.model, places, views, arguments.from_target);
  if (!arguments.quiet) {
    fmt::print("{} of {} images show a target\n", looks.views.size(), looks.looks.size());
    fmt::print("\n{:32}{:20}{:>8}{:>10}\n", "image", "target", "points", "RMS [px]");
    for (const Look& look : looks.looks) {
      const std::string name = fs::path(look.image).filename().string();
      if (!look.view) {
        fmt::print("{:32}not used: {}\n", name, look.reason);
        continue;
      }
      const ViewResult& view = result.views[*look.view];
      fmt::print("{:32}{:20}{:>8}{:>10.3f}\n", name, to_text(looks.views[*look.view].target),
                 std::ranges::count_if(view.points, [](const PointResidual& p) { return p.used; }), view.rms_px);
    }
    print_mount(before.mount, result.estimate, true);
  }
  for (const std::string& warning : result.warnings) warn("mount", warning);
  warn_of_change(before.mount, result.estimate.mount);
  if (!arguments.report.empty()) {
    CalibrationDrawing drawing;
    drawing.width = before.model.width;
    drawing.height = before.model.height;
    drawing.points = drawn_points(result.views);
    drawing.title = fmt::format("{}: mount from a target on the floor", before.model.name);
    write_residuals(arguments.report, drawing);
  }
  write_camera(arguments.output, {before.model, result.estimate.mount});
  if (!arguments.quiet) fmt::print("\nwrote {}\n", arguments.output);
  return 0;
}

/// What one frame of a recording shows of the field's lines, where the pose is known.
std::optional<LineFrame> lines_of(const Scene& scene, const VisionWorkspace& workspace, const MountedCamera& camera,
                                  const FieldCurves& field) {
  if (!scene.pose) return std::nullopt;
  LineFrame frame{scene.pose->x, scene.pose->y, scene.pose->theta, scene.t, {}};
  const auto& marks = workspace.marks;
  for (std::size_t begin = 0, end = 0; begin < marks.size(); begin = end) {
    while (end < marks.size() && marks[end].line == marks[begin].line) ++end;
    const int line = marks[begin].line;
    SeenCurve seen;
    seen.is_arc = line == LineMark::kCircle;
    if (seen.is_arc) {
      if (field.arcs.empty()) continue;
    } else {
      if (line < 0 || static_cast<std::size_t>(line) >= workspace.line_of.size()) continue;
      const int of = workspace.line_of[static_cast<std::size_t>(line)];
      if (of < 0) continue;
      seen.curve = static_cast<std::size_t>(of);
    }
    for (std::size_t i = begin; i < end; ++i)
      if (const auto pixel = camera.project({marks[i].at.x, marks[i].at.y, 0})) seen.points.push_back(*pixel);
    frame.curves.push_back(std::move(seen));
  }
  return frame.curves.empty() ? std::nullopt : std::optional(std::move(frame));
}

/// So many of all, evenly, first and last among them.
std::vector<LineFrame> some_of(std::vector<LineFrame> all, std::size_t count) {
  if (all.size() <= count) return all;
  std::vector<LineFrame> some;
  for (std::size_t i = 0; i < count; ++i)
    some.push_back(std::move(all[count == 1 ? 0 : i * (all.size() - 1) / (count - 1)]));
  return some;
}

/// Sees the source with a mount that is only about right.
std::vector<LineFrame> seen_lines(const MountArguments& arguments, const RobotSetup& setup, const Odometry* odometry) {
  const Vision vision(setup.vision, setup.registry);
  const FieldCurves field = field_curves(setup.vision.field);
  constexpr int most_frames = 3000;  // some minutes of a usual camera
  std::vector<LineFrame> frames;
  VisionWorkspace workspace;
  for (const std::string& location : arguments.images) {
    FrameSource source = open_source({.location = location, .images_range = setup.vision.colors.range});
    vision.check_frames(location, source.info().width, source.info().height, source.info().range);
    workspace.history.clear();
    for (int count = 0; count < most_frames; ++count) {
      const auto frame = source.next();
      if (!frame) break;
      if (!frame->image.empty()) workspace.history.clear();  // stills may be taken anywhere
      const Scene scene = vision(*frame, workspace, odometry);
      auto lines = lines_of(scene, workspace, vision.optics()->camera, field);
      if (!lines) continue;
      if (!frame->image.empty()) lines->t = static_cast<double>(frames.size());
      frames.push_back(std::move(*lines));
    }
  }
  return frames;
}

int from_lines(MountArguments arguments) {
  RobotSetup setup = read_robot_setup(arguments.robot, arguments.colors, arguments.plugins);
  const auto robot_camera = read_robot(arguments.robot).camera;
  if (!robot_camera) throw Error(arguments.robot, "names no camera; its mount is where the search begins");
  const std::string camera = robot_camera->string();
  if (arguments.output.empty()) arguments.output = camera;
  std::vector<NamedFile> read{{"--odometry", arguments.odometry}};
  for (const NamedFile& file : setup.read)
    if (file.path != camera) read.push_back(file);
  for (const std::string& source : arguments.images) read.push_back({"the source", source});
  check_output(arguments, camera, read);
  if (!arguments.start_pose.empty()) setup.vision.start_pose = gaussian_of(*start_pose_from(arguments.start_pose));
  std::optional<Odometry> odometry;
  if (!arguments.odometry.empty()) {
    const auto samples = read_odometry(arguments.odometry);
    odometry.emplace(std::max<std::size_t>(2, samples.size()));
    for (const OdometrySample& sample : samples) odometry->add(sample);
  }

  const CameraFile before = read_camera(camera);
  const FieldCurves field = field_curves(setup.vision.field);
  MountFromLines result;
  std::size_t seen = 0;
  // What is found by a mount that is a little wrong is a little wrong; with the better one it is looked for again, and
  // lines are taken for the field's with less indulgence.
  constexpr double converged = .002;  // [m] 3 m away
  constexpr int most_passes = 5;
  double shift = 0;                              // of the last pass [m]
  double angle_sigma = .02, height_sigma = .02;  // [rad, m] a mount set by eye and tape
  for (int pass = 0; pass < most_passes; ++pass) {
    setup.vision.options.mount_angle_sigma = std::max(setup.vision.options.mount_angle_sigma, angle_sigma);
    setup.vision.options.mount_height_sigma = std::max(setup.vision.options.mount_height_sigma, height_sigma);
    if (pass > 0) {
      setup.vision.options.mount_angle_sigma = angle_sigma;
      setup.vision.options.mount_height_sigma = height_sigma;
    }
    const auto all = seen_lines(arguments, setup, odometry ? &*odometry : nullptr);
    seen = all.size();
    const auto frames = some_of(all, static_cast<std::size_t>(arguments.frames));
    if (frames.empty())
      throw Error(
          arguments.images.front(),
          "shows no place of the field by its lines; tell about where the robot starts (--start-pose), or begin "
          "with a better mount in " +
              camera);
    const CameraMount last = *setup.vision.mount;
    result = mount_from_lines({before.model, last}, field, frames);
    setup.vision.mount = result.estimate.mount;
    shift = floor_shift(last, result.estimate.mount);
    if (pass > 0 && shift < converged) break;
    angle_sigma = .003;
    height_sigma = .005;
  }

  if (shift >= converged)
    warn("mount", fmt::format("still moves what is 3 m away by {:.1f} cm from pass to pass, should be at most {:.1f}; "
                              "more frames, with lines in several directions, tell more",
                              100 * shift, 100 * converged));
  if (!arguments.quiet) {
    fmt::print("{} of {} frames that know their pose; {} lines, {} points, RMS {:.2f} px", result.frames, seen,
               result.curves, result.points, result.rms_px);
    if (result.curves_thrown_out > 0) fmt::print("; {} lines that do not fit left out", result.curves_thrown_out);
    fmt::print("\n");
    print_mount(before.mount, result.estimate, false);
    fmt::print("x, y and yaw of a camera show in lines only together with where the robot stands\n");
  }
  if (!arguments.report.empty()) {
    CalibrationDrawing drawing;
    drawing.width = before.model.width;
    drawing.height = before.model.height;
    for (const PointResidual& point : result.residuals)
      drawing.points.push_back({point.seen, point.residual, point.used});
    drawing.title = fmt::format("{}: mount from field lines", before.model.name);
    write_residuals(arguments.report, drawing);
  }
  write_camera(arguments.output, {before.model, result.estimate.mount});
  if (!arguments.quiet) fmt::print("\nwrote {}\n", arguments.output);
  return 0;
}

}  // namespace

Command add_calibrate_mount(CLI::App& calibrate) {
  auto* command = calibrate.add_subcommand(
      "mount", "where the camera sits on the robot, from a target on the floor or from field lines");
  auto arguments = std::make_shared<MountArguments>();
  command
      ->add_option("images", arguments->images,
                   "with --camera: images, or folders of images, of the target on the floor; with --robot: a video or "
                   "a folder of images that shows field lines")
      ->required();
  command->add_option("-c,--camera", arguments->camera, "camera.yaml: the lens as `calibrate intrinsics` wrote it");
  command->add_option("-t,--target", arguments->targets, kTargetHelp)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      ->add_option("--at", arguments->at,
                   "X,Y,YAW[,HEIGHT]: where the target's first point lies in the robot frame, which way its columns "
                   "run, how thick the board is [m, rad]; once, or once an image")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  MountFromTargetOptions& options = arguments->from_target;
  command->add_option("--at-sigma", options.place_sigma, "how well X and Y are measured [m]")->capture_default_str();
  command->add_option("--at-yaw-sigma", options.place_yaw_sigma, "how well YAW is measured [rad]")
      ->capture_default_str();
  command->add_option("-r,--robot", arguments->robot,
                      "robot.yaml, whose camera has about the right mount: from field lines; x, y and yaw are kept");
  command->add_option("--frames", arguments->frames, "with --robot: how many frames count, spread over all")
      ->check(CLI::Range(1, 500))
      ->capture_default_str();
  command->add_option("--odometry", arguments->odometry, "with --robot: odometry.jsonl on the clock of the frames");
  command->add_option("--start-pose", arguments->start_pose,
                      "with --robot: X,Y,THETA[,SIGMA_XY,SIGMA_THETA] on the field [m, rad]");
  command->add_option("--colors", arguments->colors, "with --robot: color table, instead of the robot file's");
  add_plugin_option(*command, arguments->plugins);
  command->add_option("-o,--output", arguments->output,
                      "camera.yaml to write (default: the camera file that is read, of which only the mount changes)");
  command->add_option("--report", arguments->report, "folder for a picture of the residuals, residuals.png");
  command->add_flag("-q,--quiet", arguments->quiet, "print nothing but warnings and errors");
  command->callback([arguments] {
    if (arguments->camera.empty() == arguments->robot.empty())
      throw CLI::ValidationError("mount", "give --camera with --target and --at, or --robot");
    if (!arguments->robot.empty()) {
      if (!arguments->targets.empty() || !arguments->at.empty())
        throw CLI::ValidationError("--robot", "goes without --target and --at, which go with --camera");
      start_pose_from(arguments->start_pose);
      return;
    }
    if (arguments->targets.empty()) throw CLI::RequiredError("--target");
    if (arguments->at.empty()) throw CLI::RequiredError("--at");
    for (const std::string& text : arguments->at) place_from(text);
    try {
      arguments->from_target.check();
      for (const std::string& text : arguments->targets) target_from_text(text);
    } catch (const Error& error) {
      throw CLI::ValidationError(error.what());
    }
  });
  return [arguments] { return arguments->robot.empty() ? from_target(*arguments) : from_lines(*arguments); };
}

}  // namespace tassilo
