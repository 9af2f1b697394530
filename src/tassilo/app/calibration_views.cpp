#include "tassilo/app/calibration_views.h"

#include <fmt/core.h>

#include <cstdio>
#include <filesystem>
#include <utility>

#include "tassilo/app/target_look.h"
#include "tassilo/base/error.h"
#include "tassilo/files/png.h"
#include "tassilo/source/frame_source.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostImages = 500;

Look look_at(const Frame& frame, const std::string& name, const std::vector<Target>& targets,
             std::vector<TargetView>& views) {
  TargetSearch search = find_any_target(gray_of(frame.view), targets);
  for (const std::string& remark : search.remarks) warn(name, remark);
  if (!search.view) return {name, {}, std::move(search.reason)};
  views.push_back(std::move(*search.view));
  return {name, views.size() - 1, {}};
}

}  // namespace

Looks look_at_all(const std::vector<std::string>& locations, const std::vector<Target>& targets) {
  Looks out;
  for (const std::string& location : locations) {
    FrameSource source = open_source({.location = location, .images_range = ColorRange::full});
    while (const auto frame = source.next()) {
      const bool is_in_folder = !frame->image.empty() && fs::is_directory(location);
      const bool is_of_video = !is_in_folder && (frame->index > 0 || source.info().frame_count.value_or(1) > 1);
      const std::string name = is_in_folder  ? (fs::path(location) / frame->image).string()
                               : is_of_video ? fmt::format("{} frame {}", location, frame->index)
                                             : location;
      if (out.looks.empty()) out.size = {frame->view.width(), frame->view.height()};
      if (frame->view.width() != out.size.width || frame->view.height() != out.size.height)
        throw Error(name, fmt::format("is {} x {}, must be {} x {} like the images before", frame->view.width(),
                                      frame->view.height(), out.size.width, out.size.height));
      if (out.looks.size() == kMostImages)
        throw Error(name, fmt::format("is one image too many, must be at most {}", kMostImages));
      out.looks.push_back(look_at(*frame, name, targets, out.views));
    }
  }
  return out;
}

void check_any_target(const Looks& looks) {
  if (looks.looks.empty()) throw Error("images", "are none, must be at least one");
  if (looks.views.empty())
    throw Error(looks.looks.front().image, "shows no target, like all images: " + looks.looks.front().reason);
}

void warn(const std::string& what, const std::string& reason) {
  std::fputs(fmt::format("tassilo: warning: {}: {}\n", what, reason).c_str(), stderr);
}

void check_folder_of(const std::string& output) {
  if (const fs::path folder = fs::path(output).parent_path(); !folder.empty() && !fs::is_directory(folder))
    throw Error(output, "cannot be created: there is no folder " + folder.string());
}

void write_residuals(const std::string& folder, const CalibrationDrawing& drawing) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) throw Error(folder, "cannot be made: " + failed.message());
  Picture picture = draw_calibration(drawing);
  write_png_rgb(fs::path(folder) / "residuals.png", {picture.width, picture.height, std::move(picture.pixels)});
}

}  // namespace tassilo
