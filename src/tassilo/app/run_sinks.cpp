#include "tassilo/app/run_sinks.h"

#include <fmt/core.h>

#include <algorithm>

#include "tassilo/app/boundary_steps.h"
#include "tassilo/files/scene_json.h"
#include "tassilo/overlay/overlay.h"

namespace tassilo {

RunSinks::RunSinks(const RunArguments& arguments) : arguments_(arguments) {
  if (!arguments.overlay.empty()) overlay_.emplace(arguments.overlay, VideoOptions{.threads = arguments.threads});
  if (!arguments.label_maps.empty()) label_maps_.emplace(arguments.label_maps);
  // Last, when nothing else is wrong: it replaces the scenes of another run.
  if (!arguments.output.empty()) output_.emplace(arguments.output);
}

void RunSinks::write(const Frame& frame, const Scene& scene, const VisionWorkspace& workspace, const Optics* optics) {
  if (output_) output_->write(to_json_line(scene));
  const Segmentation& segmentation = workspace.segmentation;
  if (label_maps_)
    label_maps_->write(GrayImage{segmentation.width, segmentation.height, segmentation.labels}, scene.frame);
  if (overlay_) overlay_->write(picture_of(frame, scene, workspace, optics), scene.frame, scene.t);
}

Picture RunSinks::picture_of(const Frame& frame, const Scene& scene, const VisionWorkspace& workspace,
                             const Optics* optics) const {
  OverlayOptions options;
  options.camera = optics != nullptr ? &optics->camera : nullptr;
  options.surface = &workspace.surface;
  StepPicture step;
  if (!arguments_.overlay_step.empty()) {
    const auto* const name = std::ranges::find(kBoundarySteps, arguments_.overlay_step);
    step.title = arguments_.overlay_step + ": nothing without a camera file";
    if (workspace.boundary && optics != nullptr)
      step =
          boundary_step(*workspace.boundary, static_cast<std::size_t>(name - kBoundarySteps.begin()), optics->camera);
    options.step = &step;
  }
  return draw_overlay(frame.view, frame.range, scene, options);
}

void RunSinks::finish() {
  if (overlay_) overlay_->finish();
}

std::string RunSinks::names() const {
  std::string text;
  if (output_ && arguments_.output != "-") text += fmt::format("scenes: {}\n", arguments_.output);
  if (overlay_) text += fmt::format("annotated picture: {}\n", arguments_.overlay);
  if (label_maps_) text += fmt::format("label maps: {}\n", arguments_.label_maps);
  return text.empty() ? text : "\n" + text;
}

}  // namespace tassilo
