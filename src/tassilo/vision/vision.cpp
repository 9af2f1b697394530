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

Vision::Vision(const VisionSetup& setup) : Vision(setup, built_in_stages()) {}

Vision::Vision(const VisionSetup& setup, const StageRegistry& registry)
    : classifier_(setup.colors),
      field_(setup.field),
      options_((setup.options.check(), setup.options)),
      stages_(chosen_stages(registry, setup.options)) {
  setup.colors.check();
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
  if (stages_.localization.needs_walls && !field_.walls)
    throw Error("vision.localization", "needs walls, and field " + field_.name + " has none; take `model`");
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
  BallSearch balls = timed(scene, "balls", [&] { return stages_.balls(view); });
  scene.balls = std::move(balls.balls);
  if (!balls.why.empty()) scene.why.emplace_back("balls", std::move(balls.why));
  GoalSearch goals = timed(scene, "goals", [&] { return stages_.goals(view); });
  scene.goals = std::move(goals.goals);
  for (RecycledString& why : goals.why) scene.why.emplace_back("goals", std::move(why));
  scene.robots = timed(scene, "robots", [&] { return stages_.robots(view); });
  if (sectors_) {
    Lines lines = timed(scene, "lines", [&] { return stages_.lines(view); });
    scene.lines = std::move(lines.lines);
    scene.circles = std::move(lines.circles);
    workspace.marks = std::move(lines.marks);
    scene.free_space =
        timed(scene, "free_space", [&] { return stages_.free_space(*sectors_, workspace.surface, scene.balls); });
    VisionHistory& history = workspace.history;
    if (history.beliefs.latest() != nullptr && history.beliefs.latest()->t >= frame.t) history.clear();
    const Timed<PoseBelief>* const known = history.beliefs.before(frame.t);
    const PoseBelief begin = known == nullptr && start_pose_ ? belief_in(*start_pose_, frame.t) : PoseBelief{};
    const PoseBelief& before = known != nullptr ? known->value : begin;
    const RobotMotion motion = robot_motion(odometry, known != nullptr ? known->t : frame.t, frame.t, options_.motion);
    workspace.boundary.reset();
    if (stages_.localization.needs_boundary || workspace.watch_boundary)
      workspace.boundary = timed(scene, "boundary", [&] { return stages_.field_boundary(view); });
    Localized localized = timed(scene, "localize", [&] {
      return stages_.localization.run({view,
                                       *target_,
                                       before,
                                       motion,
                                       {workspace.marks, scene.goals, &*scene.free_space},
                                       workspace.boundary ? &*workspace.boundary : nullptr,
                                       frame.t});
    });
    scene.pose = localized.pose;
    scene.why.emplace_back("pose", std::move(localized.why));
    for (std::size_t k = 0; k < localized.line_of.size() && k < scene.lines.size(); ++k)
      if (localized.line_of[k] >= 0)
        scene.lines[k].model = target_->curves.lines[static_cast<std::size_t>(localized.line_of[k])].name;
    workspace.line_of = std::move(localized.line_of);
    history.beliefs.add(frame.t, std::move(localized.belief));
    const Timed<TrackState>* const followed = history.tracks.before(frame.t);
    TrackState nothing;
    nothing.t = frame.t;
    TrackState tracks = timed(scene, "track", [&] {
      const TrackObservation seen{scene.balls, scene.robots, &*scene.free_space, &optics_->camera};
      return track(followed != nullptr ? followed->value : nothing, motion, seen, frame.t, options_.track);
    });
    scene.tracks = told(tracks, options_.track);
    history.tracks.add(frame.t, std::move(tracks));
  }
  scene.timing.push_back({"total", ms_since(start)});
  return scene;
}

}  // namespace tassilo
