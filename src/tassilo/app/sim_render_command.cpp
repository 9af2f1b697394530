#include <fmt/core.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "tassilo/app/commands.h"
#include "tassilo/app/progress.h"
#include "tassilo/app/signals.h"
#include "tassilo/base/error.h"
#include "tassilo/color/color_class.h"
#include "tassilo/field/field_curves.h"
#include "tassilo/files/atomic_file.h"
#include "tassilo/files/camera_file.h"
#include "tassilo/files/field_file.h"
#include "tassilo/files/odometry_file.h"
#include "tassilo/files/png.h"
#include "tassilo/files/robot_file.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/geometry/pose2.h"
#include "tassilo/record/json_lines_writer.h"
#include "tassilo/record/lossless_video.h"
#include "tassilo/sim/renderer.h"
#include "tassilo/sim/script.h"
#include "tassilo/sim/truth.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

constexpr int kSampleFrames = 6;  ///< So many label maps become samples for training.

struct RenderArguments {
  std::string output, camera, robot, field, size;
  std::string difficulty = "normal", range = "limited", format = "yuv422p";
  double seconds = 2, fps = 20;
  std::uint64_t seed = 1;
  std::optional<int> others, rays, stills;
  std::optional<double> ball_radius;
  bool start_pose = false, quiet = false;
};

/// What a recording is made of.
struct Shoot {
  RobotFile robot;
  FieldModel field;
  CameraFile camera;
  Difficulty difficulty = Difficulty::normal;
  RenderOptions rendering;
  ScriptOptions script;
};

/// The same view with other pixels.
CameraModel resized(CameraModel camera, const std::string& size) {
  int width = 0, height = 0, length = 0;
  if (std::sscanf(size.c_str(), "%5dx%5d%n", &width, &height, &length) != 2 ||
      static_cast<std::size_t>(length) != size.size() || width < 16 || height < 16 || width > 8192 || height > 8192)
    throw Error("--size", "is '" + size + "', must be WIDTHxHEIGHT, as 640x480, each 16 .. 8192");
  const double x = static_cast<double>(width) / camera.width, y = static_cast<double>(height) / camera.height;
  camera.fx *= x;
  camera.fy *= y;
  camera.cx = (camera.cx + .5) * x - .5;
  camera.cy = (camera.cy + .5) * y - .5;
  camera.width = width;
  camera.height = height;
  return camera;
}

Shoot read_shoot(const RenderArguments& arguments) {
  Shoot shoot;
  if (!arguments.robot.empty()) shoot.robot = read_robot(arguments.robot);
  if (!arguments.camera.empty()) shoot.robot.camera = arguments.camera;
  if (!arguments.field.empty()) shoot.robot.field = arguments.field;
  if (!shoot.robot.camera) throw Error(arguments.robot, "names no camera; add `camera:` to it, or give --camera FILE");
  if (!shoot.robot.field)
    throw Error(arguments.robot.empty() ? "--field" : arguments.robot,
                "no field is named; give --field, as --field msl98");
  if (arguments.robot.empty()) shoot.robot.id = 1;
  if (shoot.robot.team == Team::unknown) shoot.robot.team = Team::cyan;
  shoot.camera = read_camera(*shoot.robot.camera);
  if (!shoot.camera.mount)
    throw Error(shoot.robot.camera->string(),
                "has no camera_pose_in_robot; where the camera sits must be known to see with it");
  if (!arguments.size.empty()) shoot.camera.model = resized(shoot.camera.model, arguments.size);
  shoot.field = read_field(*shoot.robot.field);

  static const std::map<std::string, Difficulty> difficulties{
      {"easy", Difficulty::easy}, {"normal", Difficulty::normal}, {"hard", Difficulty::hard}};
  shoot.difficulty = difficulties.at(arguments.difficulty);
  shoot.rendering = rendering_of(shoot.difficulty, shoot.field);
  shoot.rendering.seed = arguments.seed;
  shoot.rendering.range = arguments.range == "full" ? ColorRange::full : ColorRange::limited;
  shoot.rendering.format = arguments.format == "yuv420p" ? PixelFormat::yuv420p : PixelFormat::yuv422p;
  if (arguments.rays) shoot.rendering.rays_per_side = *arguments.rays;
  constexpr std::array usual_others{2, 4, 6};
  shoot.script = {.others = arguments.others.value_or(usual_others[static_cast<std::size_t>(shoot.difficulty)]),
                  .ball_radius = arguments.ball_radius.value_or(0),
                  .team = shoot.robot.team,
                  .id = shoot.robot.id,
                  .seed = arguments.seed};
  shoot.rendering.check();
  shoot.script.check();
  return shoot;
}

std::string frame_name(std::int64_t frame) { return fmt::format("{:04}.png", frame); }

std::string meta_json(const RenderArguments& arguments, const Shoot& shoot, std::int64_t frames, double ball_radius) {
  const FieldModel& field = shoot.field;
  const FieldExtent extent = field_extent(field);
  nlohmann::ordered_json of_field{{"length", extent.x.high - extent.x.low},
                                  {"width", extent.y.high - extent.y.low},
                                  {"line_width", field.line_width},
                                  {"circle_radius", field.circle_radius},
                                  {"area_depth", field.areas.empty() ? 0. : field.areas[0].depth},
                                  {"area_width", field.areas.empty() ? 0. : field.areas[0].width},
                                  {"goal_width", field.goals.empty() ? 0. : field.goals[0].width},
                                  {"goal_height", field.goals.empty() ? 0. : field.goals[0].height},
                                  {"goal_depth", field.goals.empty() ? 0. : field.goals[0].depth},
                                  {"wall_height", field.walls ? field.walls->height : 0.},
                                  {"walls", field.walls.has_value()},
                                  {"touchlines", field.touchlines}};
  nlohmann::ordered_json meta{
      {"name", fs::path(arguments.output).filename().string()},
      {"camera", shoot.camera.model.name},
      {"fps", arguments.stills ? 1 : arguments.fps},
      {"video", "video.mkv"},
      {"pixel_format", std::string(to_string(shoot.rendering.format)) + " (lossless)"},
      {"color_range", std::string(to_string(shoot.rendering.range))},
      {"matrix", "Rec.601"},
      {"field", of_field},
      {"own_team", std::string(to_string(shoot.robot.team))},
      {"ball_radius", ball_radius},
      {"note", "rendered by tassilo sim render, difficulty " + arguments.difficulty + ", seed " +
                   std::to_string(arguments.seed)},
      {"distractors",
       shoot.rendering.ball_colored_people ? nlohmann::json{"ball-colored shirts"} : nlohmann::json::array()},
      {"frames", frames},
      {"image_size", {shoot.camera.model.width, shoot.camera.model.height}},
      {"field_name", field.name}};
  return meta.dump(1) + "\n";
}

/// As if somebody had put the robot there: 5 cm and 2 degrees off.
StartPose start_pose(const SimRobot& robot, std::uint64_t seed) {
  SlippingWheels dice(seed + 17);
  const auto off = [&] { return (dice.measured({1, 0, 0}).dx - 1) / .03; };  // about one standard deviation
  return {.x = robot.at.x + .05 * std::clamp(off(), -2., 2.),
          .y = robot.at.y + .05 * std::clamp(off(), -2., 2.),
          .theta = wrap_angle(robot.theta + radians(2 * std::clamp(off(), -2., 2.))),
          .sigma_xy = .1,
          .sigma_theta = .05};
}

/// Complete label maps of a few frames as samples.
std::string samples_yaml(const std::map<std::int64_t, std::set<std::uint8_t>>& classes) {
  std::string text = "# label maps of some frames as training regions\n";
  for (const auto& [frame, labels] : classes)
    for (const std::uint8_t label : labels)
      text += fmt::format("- {{image: video.mkv, frame: {}, class: {}, mask: labels/{}, value: {}}}\n", frame,
                          to_string(static_cast<ColorClass>(label)), frame_name(frame), label);
  return text;
}

void make_folder(const fs::path& folder) {
  std::error_code problem;
  if (folder.has_parent_path()) fs::create_directories(folder.parent_path(), problem);
  if (!problem && !fs::create_directory(folder, problem) && !problem)
    throw Error(folder.string(), "exists already; recordings are never overwritten, so name another folder");
  if (!problem) fs::create_directory(folder / "labels", problem);
  if (problem) throw Error(folder.string(), "cannot be made: " + problem.message());
}

/// In the middle of a hard recording half of the lamps become weak.
std::vector<SimLamp> lamps_after_the_middle(std::vector<SimLamp> lamps) {
  for (std::size_t k = 1; k < lamps.size(); k += 2) lamps[k].intensity *= .4;
  return lamps;
}

int sim_render_command(const RenderArguments& arguments) {
  const Shoot shoot = read_shoot(arguments);
  const double fps = arguments.stills ? 1 : arguments.fps;
  const std::int64_t frames =
      arguments.stills ? *arguments.stills : std::max<std::int64_t>(1, std::llround(arguments.seconds * fps));
  const fs::path folder = fs::path(arguments.output).lexically_normal();
  Renderer renderer(shoot.field, {shoot.camera.model, *shoot.camera.mount}, shoot.rendering);
  const SimMotion motion =
      arguments.stills ? scripted_stills(shoot.field, shoot.script) : scripted_motion(shoot.field, shoot.script);
  const TruthLines truth(shoot.field, {shoot.camera.model, *shoot.camera.mount});
  make_folder(folder);
  end_cleanly_on_signals();

  const auto time_of = [&](std::int64_t frame) { return std::round(1000 * static_cast<double>(frame) / fps) / 1000; };
  const int me = shoot.robot.id;
  SlippingWheels wheels(arguments.seed);
  Pose2<FieldFrame, RobotFrame> odometry;
  SimRobot before;
  double ball_radius = 0;
  std::map<std::int64_t, std::set<std::uint8_t>> classes;
  TruthOfFrame of_frame;
  of_frame.ambient = shoot.rendering.ambient;
  of_frame.lamps = shoot.rendering.lamps;
  LosslessVideo video((folder / "video.mkv").string());
  JsonLinesWriter truth_lines((folder / "gt.jsonl").string()), odometry_lines((folder / "odometry.jsonl").string());
  Progress progress(!arguments.quiet, frames);
  std::int64_t done = 0;
  for (; done < frames && !is_interrupted(); ++done) {
    if (shoot.difficulty == Difficulty::hard && done == frames / 2 && done > 0) {
      of_frame.lamps = lamps_after_the_middle(shoot.rendering.lamps);
      of_frame.light = "change";
      renderer.set_light(of_frame.lamps, shoot.rendering.exposure);
    }
    const SimState state = motion(time_of(done));
    const SimRobot& robot = *find_robot(state, me);
    of_frame.frame = done;
    if (done > 0 && !arguments.stills) {
      of_frame.motion = motion_between(before, robot);
      of_frame.odometry = wheels.measured(of_frame.motion);
      odometry = odometry * make_pose2<RobotFrame, RobotFrame>(of_frame.odometry.dx, of_frame.odometry.dy,
                                                               of_frame.odometry.dtheta);
    }
    if (done == 0) {
      ball_radius = state.ball.radius;
      RobotFile written = shoot.robot;
      written.camera = fs::absolute(folder) / "camera.yaml";
      written.colors = fs::absolute(folder) / "colors.yaml";
      // Those of the robot file are of another drive.
      written.start_pose.reset();
      written.start_state.reset();
      if (arguments.start_pose || shoot.field.goals.empty()) written.start_pose = start_pose(robot, arguments.seed);
      write_atomically(folder / "robot.yaml", robot_yaml(written, fs::absolute(folder)));
      write_camera(folder / "camera.yaml", shoot.camera);
    }
    before = robot;
    Frame frame = renderer.render(state, me);
    frame.index = done;
    video.write(frame);
    const SimView& view = renderer.look(state, me);
    truth_lines.write(truth.line(state, me, view, of_frame));
    odometry_lines.write(
        odometry_line({.sample = {.t = state.t, .x = odometry.x, .y = odometry.y, .theta = odometry.theta()}}));
    write_png_gray(folder / "labels" / frame_name(done), {view.width, view.height, view.labels});
    const std::int64_t every = arguments.stills ? 1 : std::max<std::int64_t>(1, frames / kSampleFrames);
    if (done % every == 0) {
      std::array<int, 256> pixels{};
      for (const std::uint8_t label : view.labels) ++pixels[label];
      for (const ColorClass color : kColorClasses)
        if (pixels[static_cast<std::size_t>(color)] >= 30) classes[done].insert(static_cast<std::uint8_t>(color));
    }
    progress.frame(done + 1);
  }
  video.finish();
  write_atomically(folder / "samples.yaml", samples_yaml(classes));
  write_atomically(folder / "meta.json", meta_json(arguments, shoot, done, ball_radius));
  progress.finish();
  if (!arguments.quiet)
    fmt::print(
        "{}{} frames, {:.1f} s, in {}\n"
        "see it:  tassilo train colors {}/samples.yaml --output {}/colors.yaml\n"
        "         tassilo run --robot {}/robot.yaml --source {}/video.mkv --odometry {}/odometry.jsonl --output "
        "scenes.jsonl\n"
        "         tassilo eval {}/gt.jsonl scenes.jsonl\n",
        done < frames ? "interrupted: " : "", done, static_cast<double>(done) / fps, folder.string(), folder.string(),
        folder.string(), folder.string(), folder.string(), folder.string(), folder.string());
  return 0;
}

}  // namespace

Command add_sim_render(CLI::App& sim) {
  auto* command = sim.add_subcommand("render", "render a recording with its truth: video, labels, odometry, gt.jsonl");
  auto arguments = std::make_shared<RenderArguments>();
  command->add_option("-o,--output", arguments->output, "folder to make; it must not exist")
      ->required()
      ->option_text("FOLDER");
  auto* camera = command->add_option("--camera", arguments->camera, "camera.yaml with its pose in the robot")
                     ->check(CLI::ExistingFile)
                     ->option_text("FILE");
  auto* robot =
      command->add_option("--robot", arguments->robot, "robot.yaml whose camera, field, team and number are taken")
          ->check(CLI::ExistingFile)
          ->option_text("FILE");
  command
      ->add_option("--field", arguments->field,
                   "shipped field (msl98, rcj_soccer, ...) or a field file; default: the robot's")
      ->option_text("NAME|FILE");
  command
      ->add_option("--difficulty", arguments->difficulty,
                   "light, noise, motion blur, people and clutter, number of robots")
      ->check(CLI::IsMember({"easy", "normal", "hard"}))
      ->capture_default_str();
  command->add_option("--seconds", arguments->seconds, "length [s]")
      ->check(CLI::Range(.001, 36000.))
      ->capture_default_str();
  command
      ->add_option("--stills", arguments->stills,
                   "no drive, but so many pictures for training, in which everything is seen in turn")
      ->check(CLI::Range(1, 10000));
  command->add_option("--fps", arguments->fps, "frames a second")->check(CLI::Range(.1, 1000.))->capture_default_str();
  command
      ->add_option("--seed", arguments->seed, "of motion, people, clutter and noise; the same gives the same recording")
      ->capture_default_str();
  command->add_option("--size", arguments->size, "the camera's view with so many pixels instead of its own")
      ->option_text("WIDTHxHEIGHT");
  command->add_option("--others", arguments->others, "other robots on the field; default: 2, 4, 6 by difficulty")
      ->check(CLI::Range(0, 20));
  command->add_option("--ball-radius", arguments->ball_radius, "default: the middle of what the field says [m]")
      ->check(CLI::Range(.005, .5));
  command->add_option("--rays", arguments->rays, "a pixel is looked at n x n times; default: by difficulty")
      ->check(CLI::Range(1, 8));
  command->add_option("--range", arguments->range, "range of Y, U, V")
      ->check(CLI::IsMember({"limited", "full"}))
      ->capture_default_str();
  command->add_option("--format", arguments->format, "pixel format")
      ->check(CLI::IsMember({"yuv422p", "yuv420p"}))
      ->capture_default_str();
  command->add_flag(
      "--start-pose", arguments->start_pose,
      "robot.yaml tells where the robot starts, 5 cm and 2 degrees off; always so on fields without goals");
  command->add_flag("-q,--quiet", arguments->quiet, "print nothing but warnings and errors");
  command->callback([arguments, camera, robot] {
    if (camera->count() == 0 && robot->count() == 0) throw CLI::RequiredError("--camera or --robot");
  });
  return [arguments] { return sim_render_command(*arguments); };
}

}  // namespace tassilo
