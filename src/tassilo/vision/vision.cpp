#include "tassilo/vision/vision.h"

#include <array>
#include <chrono>
#include <string>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Runs a stage and notes how long it took.
template <class Stage>
auto timed(Scene& scene, const char* name, Stage stage) {
  const auto start = Clock::now();
  auto result = stage();
  scene.timing.push_back({name, ms_since(start)});
  return result;
}

std::string size_text(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

}  // namespace

Vision::Vision(const VisionSetup& setup) : classifier_(setup.colors), field_(setup.field), options_(setup.options) {
  setup.colors.check();
  setup.options.check();
  if (field_.line_width > 0) options_.surface.line_width = field_.line_width;
  if (!setup.camera || !setup.mount) return;
  setup.camera->check();
  setup.mount->check();
  CameraModel model = *setup.camera;
  model.name.clear();  // detectors copy cameras, and a long name would take memory each time
  const MountedCamera camera(model, *setup.mount);
  optics_ = std::make_unique<const Optics>(camera, options_.mount_sigma());
  sectors_ = std::make_unique<const SectorMap>(camera, options_.free_space);
  target_ = std::make_unique<const FieldTarget>(field_);
  start_pose_ = setup.start_pose;
}

void Vision::check_frames(const std::string& name, int width, int height, ColorRange range) const {
  const ColorRange trained_for = classifier_.table().range;
  if (range != trained_for)
    throw Error(name, "has " + std::string(to_string(range)) + " color range, the color table is for " +
                          std::string(to_string(trained_for)) +
                          " range; train the colors on images of this camera, or convert the video");
  if (!optics_) return;
  const CameraModel& camera = optics_->camera.model();
  if (width != camera.width || height != camera.height)
    throw Error(name, "is " + size_text(width, height) + ", the camera file is for " +
                          size_text(camera.width, camera.height) +
                          "; calibrate for this resolution, or leave `camera:` out of the robot file");
}

Scene Vision::operator()(const Frame& frame, VisionWorkspace& workspace, const Odometry* odometry) const {
  check_frames(frame.image.empty() ? "frame " + std::to_string(frame.index) : frame.image, frame.view.width(),
               frame.view.height(), frame.range);

  Scene scene;
  scene.frame = frame.index;
  scene.t = frame.t;
  scene.image = frame.image;
  const auto start = Clock::now();

  workspace.segmentation =
      timed(scene, "segment", [&] { return segment(frame.view, classifier_, std::move(workspace.segmentation)); });
  const Segmentation& segmentation = workspace.segmentation;

  workspace.surface = timed(scene, "surface", [&] {
    const std::array colored{&segmentation.of(ColorClass::black), &segmentation.of(ColorClass::blue),
                             &segmentation.of(ColorClass::cyan),  &segmentation.of(ColorClass::magenta),
                             &segmentation.of(ColorClass::red),   &segmentation.of(ColorClass::yellow)};
    return find_surface({.width = segmentation.width,
                         .height = segmentation.height,
                         .carpet = &segmentation.of(ColorClass::green),
                         .white = &segmentation.of(ColorClass::white),
                         .colored = colored},
                        optics_ ? &optics_->ground : nullptr, options_.surface, std::move(workspace.surface));
  });

  const View view{frame.view, segmentation, workspace.surface, field_, optics_.get()};
  BallSearch balls = timed(scene, "balls", [&] { return search_balls(view, options_.ball); });
  scene.balls = std::move(balls.balls);
  if (!balls.why.empty()) scene.why.emplace_back("balls", std::move(balls.why));
  GoalSearch goals = timed(scene, "goals", [&] { return search_goals(view, options_.goal); });
  scene.goals = std::move(goals.goals);
  for (RecycledString& why : goals.why) scene.why.emplace_back("goals", std::move(why));
  scene.robots = timed(scene, "robots", [&] { return find_robots(view, options_.robot); });
  if (sectors_) {
    Lines lines = timed(scene, "lines", [&] { return find_lines(view, options_.line); });
    scene.lines = std::move(lines.lines);
    scene.circles = std::move(lines.circles);
    scene.free_space =
        timed(scene, "free_space", [&] { return find_free_space(*sectors_, workspace.surface, scene.balls); });
    // A source that begins again is another drive.
    if (!workspace.belief || frame.t < workspace.belief->t) {
      workspace.belief = start_pose_ ? belief_in(*start_pose_, frame.t) : PoseBelief{};
      workspace.tracks = TrackState{};
      workspace.tracks->t = frame.t;
    }
    const RobotMotion motion = robot_motion(odometry, workspace.belief->t, frame.t, options_.motion);
    Localized localized = timed(scene, "localize", [&] {
      return localize(*target_, *workspace.belief, motion, {lines.marks, scene.goals, &*scene.free_space}, frame.t,
                      options_.localize);
    });
    scene.pose = localized.pose;
    scene.why.emplace_back("pose", std::move(localized.why));
    for (std::size_t k = 0; k < localized.line_of.size() && k < scene.lines.size(); ++k)
      if (localized.line_of[k] >= 0)
        scene.lines[k].model = target_->curves.lines[static_cast<std::size_t>(localized.line_of[k])].name;
    workspace.belief = std::move(localized.belief);
    workspace.tracks = timed(scene, "track", [&] {
      const TrackObservation seen{scene.balls, scene.robots, &*scene.free_space, &optics_->camera};
      return track(*workspace.tracks, motion, seen, frame.t, options_.track);
    });
    scene.tracks = told(*workspace.tracks, options_.track);
  }
  scene.timing.push_back({"total", ms_since(start)});
  return scene;
}

}  // namespace tassilo
