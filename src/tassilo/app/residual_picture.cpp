#include "tassilo/app/residual_picture.h"

#include <fmt/core.h>

#include <string>
#include <utility>

namespace tassilo {

std::vector<CalibrationDrawing::Point> drawn_points(std::span<const ViewResult> views) {
  std::vector<CalibrationDrawing::Point> points;
  for (const ViewResult& view : views)
    if (view.rejected.empty())
      for (const PointResidual& point : view.points) points.push_back({point.seen, point.residual, point.used});
  return points;
}

CalibrationDrawing residual_drawing(const Intrinsics& result) {
  CalibrationDrawing drawing;
  drawing.width = result.camera.width;
  drawing.height = result.camera.height;
  drawing.cell_columns = result.coverage.columns;
  drawing.cell_rows = result.coverage.rows;
  drawing.cell_points = result.coverage.points;
  drawing.points = drawn_points(result.views);
  const std::string_view model = distortion_name(result.camera.distortion);
  drawing.title = result.camera.name.empty() ? std::string(model) : fmt::format("{}: {}", result.camera.name, model);
  return drawing;
}

RgbImage residual_picture(const Intrinsics& result) {
  Picture picture = draw_calibration(residual_drawing(result));
  return {picture.width, picture.height, std::move(picture.pixels)};
}

}  // namespace tassilo
