#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "tassilo/app/calibration_views.h"
#include "tassilo/app/commands.h"
#include "tassilo/app/residual_picture.h"
#include "tassilo/app/written_files.h"
#include "tassilo/base/error.h"
#include "tassilo/calibrate/april_grid.h"
#include "tassilo/calibrate/intrinsics.h"
#include "tassilo/files/atomic_file.h"
#include "tassilo/files/camera_file.h"
#include "tassilo/files/png.h"
#include "tassilo/overlay/target_sheet.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

constexpr double kScreenPixels = 4000;  ///< Of targets as PNG. [px/m]

struct IntrinsicsArguments {
  std::vector<std::string> images, targets;
  std::string model = "plumb_bob", output, report, name;
  IntrinsicsOptions options;
  bool keep_mount = true, quiet = false;
};

void print_views(const Looks& looks, const Intrinsics& result) {
  fmt::print("\n{:32}{:20}{:>8}{:>12}{:>10}\n", "image", "target", "points", "tilt [deg]", "RMS [px]");
  for (const Look& look : looks.looks) {
    const std::string name = fs::path(look.image).filename().string();
    if (!look.view) {
      fmt::print("{:32}not used: {}\n", name, look.reason);
      continue;
    }
    const ViewResult& view = result.views[*look.view];
    const auto used = std::ranges::count_if(view.points, [](const PointResidual& p) { return p.used; });
    const std::string target = to_text(looks.views[*look.view].target);
    if (!view.rejected.empty())
      fmt::print("{:32}{:20}  not used: {}\n", name, target, view.rejected);
    else
      fmt::print("{:32}{:20}{:>8}{:>12.0f}{:>10.3f}\n", name, target, used, view.pose.tilt() * 180 / std::numbers::pi,
                 view.rms_px);
  }
}

void print_result(const Intrinsics& result) {
  fmt::print("\nmodel {}\n", distortion_name(result.camera.distortion));
  for (const EstimatedValue& value : result.values) {
    const bool is_coefficient = value.name[0] == 'k' || value.name[0] == 'p';
    if (value.sigma > 0)
      fmt::print("{:4}{:>13.{}f} +- {:.{}f}{}\n", value.name, value.value, is_coefficient ? 6 : 3, value.sigma,
                 is_coefficient ? 6 : 3, is_coefficient ? "" : " px");
    else
      fmt::print("{:4}{:>13} not estimated\n", value.name, 0);
  }
  const auto used = std::ranges::count_if(result.views, [](const ViewResult& v) { return v.rejected.empty(); });
  fmt::print("RMS {:.3f} px in {} views", result.rms_px, used);
  if (result.cross_validated_rms_px) fmt::print("; {:.3f} px in views left out", *result.cross_validated_rms_px);
  if (result.frame_places > 0) fmt::print("\nstraight sides of frames: {} places used", result.frame_places);
  fmt::print(
      "\npoints in {:.0f} % of the image, up to {:.0f} % of the way to the farthest corner; directions known to {:.2f} "
      "px\n",
      100 * result.coverage.share, 100 * result.coverage.reach, result.worst_sigma_px);
}

int intrinsics_command(const IntrinsicsArguments& arguments) {
  std::vector<Target> targets;
  for (const std::string& text : arguments.targets) targets.push_back(target_from_text(text));
  std::vector<NamedFile> read;
  for (const std::string& image : arguments.images) read.push_back({"an image", image});
  check_written_files(read, std::vector<NamedFile>{{"--output", arguments.output}, {"--report", arguments.report}});
  std::optional<CameraMount> mount;
  if (arguments.keep_mount && fs::exists(arguments.output)) {
    try {
      mount = read_camera(arguments.output).mount;
    } catch (const Error& error) {
      throw Error(arguments.output, std::string("is there and no camera file whose mount could be kept (") +
                                        error.what() + "); --no-keep-mount replaces it");
    }
  }
  check_folder_of(arguments.output);

  const Looks looks = look_at_all(arguments.images, targets);
  if (!arguments.quiet) fmt::print("{} of {} images show a target\n", looks.views.size(), looks.looks.size());
  check_any_target(looks);
  Intrinsics result = calibrate_intrinsics(looks.size, looks.views, arguments.options);
  result.camera.name = arguments.name.empty() ? fs::path(arguments.output).stem().string() : arguments.name;
  if (!arguments.quiet) {
    print_views(looks, result);
    print_result(result);
  }
  for (const std::string& warning : result.warnings) warn("calibration", warning);
  if (!arguments.report.empty()) write_residuals(arguments.report, residual_drawing(result));
  write_camera(arguments.output, {result.camera, mount});
  if (!arguments.quiet) fmt::print("\nwrote {}\n", arguments.output);
  return 0;
}

struct TargetArguments {
  std::string target, output;
};

int target_command(const TargetArguments& arguments) {
  const Target target = target_from_text(arguments.target);
  const std::string extension = fs::path(arguments.output).extension().string();
  if (extension != ".svg" && extension != ".pdf" && extension != ".png")
    throw Error("--output", "is " + arguments.output + ", must end in .svg, .pdf or .png");
  TargetSheet sheet;
  sheet.columns = target.columns;
  sheet.rows = target.rows;
  if (target.kind == TargetKind::checkerboard) sheet.marks = TargetSheet::Marks::checkerboard;
  if (target.kind == TargetKind::april_grid) {
    sheet.marks = TargetSheet::Marks::tags;
    sheet.columns = target.columns / 2;
    sheet.rows = target.rows / 2;
    sheet.spacing = target.spacing;
    for (int r = sheet.rows - 1; r >= 0; --r)  // ids begin at the bottom
      for (int c = 0; c < sheet.columns; ++c) sheet.cells.push_back(tag_cells(r * sheet.columns + c));
  }
  sheet.pitch = target.pitch;
  sheet.radius = target.radius;
  sheet.caption = to_text(target) + " - print at 100 %, then measure the ruler";
  if (extension == ".png") {
    Picture picture = target_picture(sheet, kScreenPixels);
    write_png_rgb(arguments.output, {picture.width, picture.height, std::move(picture.pixels)});
    return 0;
  }
  write_atomically(arguments.output, target_sheet(sheet, extension == ".svg" ? SheetFormat::svg : SheetFormat::pdf));
  return 0;
}

Command add_intrinsics(CLI::App& calibrate) {
  auto* command = calibrate.add_subcommand("intrinsics", "lens and sensor from images of targets");
  auto arguments = std::make_shared<IntrinsicsArguments>();
  command->add_option("images", arguments->images, "images, or folders of images, that show a target each")->required();
  command->add_option("-t,--target", arguments->targets, kTargetHelp + "; repeat for several kinds")
      ->required()
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("-m,--model", arguments->model, "lens model")
      ->check(CLI::IsMember({"division", "plumb_bob", "equidistant"}))
      ->capture_default_str();
  command->add_option("-o,--output", arguments->output, "camera.yaml to write")->required();
  command->add_option("--report", arguments->report, "folder for a picture of residuals and coverage, residuals.png");
  command->add_option("--name", arguments->name, "camera_name (default: the name of --output)");
  command->add_flag("--keep-mount,!--no-keep-mount", arguments->keep_mount,
                    "keep camera_pose_in_robot of the file that is replaced (default)");
  IntrinsicsOptions& options = arguments->options;
  command->add_option("--radial-terms", options.radial_terms, "radial coefficients to estimate (0: all of the model)")
      ->capture_default_str();
  command->add_flag("--tangential,!--no-tangential", options.tangential, "estimate p1 and p2 of plumb_bob (default)");
  command->add_flag("--frames,!--no-frames", options.frames, "use the straight sides of dot targets' frames (default)");
  command
      ->add_option("--outlier-ratio", options.outlier_ratio,
                   "points and views so many times as far off as usual are thrown out")
      ->capture_default_str();
  command->add_option("--folds", options.folds, "parts of the cross-validation (0: none)")->capture_default_str();
  command->add_flag("-q,--quiet", arguments->quiet, "print nothing but warnings and errors");
  command->callback([arguments] {
    IntrinsicsOptions& chosen = arguments->options;
    chosen.model = arguments->model == "division"      ? LensModel::division
                   : arguments->model == "equidistant" ? LensModel::equidistant
                                                       : LensModel::plumb_bob;
    try {
      chosen.check();
      for (const std::string& text : arguments->targets) target_from_text(text);
    } catch (const Error& error) {
      throw CLI::ValidationError(error.what());
    }
  });
  return [arguments] { return intrinsics_command(*arguments); };
}

Command add_target(CLI::App& calibrate) {
  auto* command = calibrate.add_subcommand("target", "a target to print, to scale");
  auto arguments = std::make_shared<TargetArguments>();
  command->add_option("target", arguments->target, kTargetHelp)->required();
  command
      ->add_option("-o,--output", arguments->output,
                   "target.svg or target.pdf to write, or target.png with 4 pixels a millimetre")
      ->required();
  command->callback([arguments] {
    try {
      target_from_text(arguments->target);
    } catch (const Error& error) {
      throw CLI::ValidationError(error.what());
    }
  });
  return [arguments] { return target_command(*arguments); };
}

}  // namespace

Command add_calibrate(CLI::App& program) {
  auto* calibrate = program.add_subcommand("calibrate", "measure a camera, or make what is needed for it");
  calibrate->require_subcommand(1);
  const Command intrinsics = add_intrinsics(*calibrate), mount = add_calibrate_mount(*calibrate),
                target = add_target(*calibrate);
  return [=] {
    if (calibrate->got_subcommand("intrinsics")) return intrinsics();
    return calibrate->got_subcommand("mount") ? mount() : target();
  };
}

}  // namespace tassilo
