#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tassilo/app/calibration_views.h"
#include "tassilo/app/commands.h"
#include "tassilo/app/residual_picture.h"
#include "tassilo/app/written_files.h"
#include "tassilo/base/error.h"
#include "tassilo/calibrate/mount_from_target.h"
#include "tassilo/files/camera_file.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

struct MountArguments {
  std::vector<std::string> images, targets, at;
  std::string camera, output, report;
  MountFromTargetOptions from_target;
  bool quiet = false;
};

/// X,Y,YAW[,HEIGHT]. Throws CLI::ValidationError: what it refuses is wrong usage.
TargetPlace place_from(const std::string& text) {
  TargetPlace place;
  const std::array values{&place.x, &place.y, &place.yaw, &place.height};
  std::size_t count = 0;
  bool good = true;
  for (std::size_t begin = 0; good && begin <= text.size(); ++count) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    double value = NAN;
    const auto [rest, error] = std::from_chars(text.data() + begin, text.data() + end, value);
    good = count < values.size() && error == std::errc{} && rest == text.data() + end && std::isfinite(value);
    if (good) *values[count] = value;
    begin = end + 1;
  }
  if (!good || count < 3)
    throw CLI::ValidationError("--at", "is " + text + ", must be X,Y,YAW or X,Y,YAW,HEIGHT in m and rad");
  try {
    place.check();
  } catch (const Error& error) {
    throw CLI::ValidationError("--at", error.what());
  }
  return place;
}

/// One line a value: before, now, change and standard deviation; `measured` is false where it was kept.
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

}  // namespace

Command add_calibrate_mount(CLI::App& calibrate) {
  auto* command = calibrate.add_subcommand("mount", "where the camera sits on the robot, from a target on the floor");
  auto arguments = std::make_shared<MountArguments>();
  command->add_option("images", arguments->images, "images, or folders of images, that show the target on the floor")
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
  command->add_option("-o,--output", arguments->output,
                      "camera.yaml to write (default: the camera file that is read, of which only the mount changes)");
  command->add_option("--report", arguments->report, "folder for a picture of the residuals, residuals.png");
  command->add_flag("-q,--quiet", arguments->quiet, "print nothing but warnings and errors");
  command->callback([arguments] {
    if (arguments->camera.empty()) throw CLI::RequiredError("--camera");
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
  return [arguments] { return from_target(*arguments); };
}

}  // namespace tassilo
