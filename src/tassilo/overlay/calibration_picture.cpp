#include "tassilo/overlay/calibration_picture.h"

#include <algorithm>
#include <cmath>

#include "tassilo/base/contract.h"
#include "tassilo/overlay/internal/canvas.h"
#include "tassilo/overlay/internal/text.h"

namespace tassilo {
namespace {

constexpr int kLeastWidth = 900, kLine = 28;  // [px]
constexpr double kUsualArrow = 14;            ///< Length of the root mean square residual. [px]

/// The largest of 1, 2, 5, 10, ... that is not above `value`.
double round_factor(double value) {
  if (!(value > 1)) return 1;
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double digit : {5., 2.})
    if (digit * power <= value) return digit * power;
  return power;
}

}  // namespace

Picture draw_calibration(const CalibrationDrawing& drawing) {
  expects(drawing.width > 0 && drawing.height > 0, "draw_calibration: an image size");
  expects(drawing.cell_points.size() == static_cast<std::size_t>(drawing.cell_columns * drawing.cell_rows),
          "draw_calibration: a number a cell");
  const double scale = std::max(1., std::ceil(static_cast<double>(kLeastWidth) / drawing.width));
  const Rect image{0, kLine, drawing.width * scale, drawing.height * scale};
  Canvas canvas(static_cast<int>(image.width), static_cast<int>(image.height) + 2 * kLine, kPanelInk);
  const int most = drawing.cell_points.empty() ? 0 : *std::ranges::max_element(drawing.cell_points);
  for (std::size_t cell = 0; cell < drawing.cell_points.size(); ++cell) {
    const auto column = static_cast<int>(cell) % drawing.cell_columns,
               row = static_cast<int>(cell) / drawing.cell_columns;
    const double width = image.width / drawing.cell_columns, height = image.height / drawing.cell_rows;
    const Rect place{image.x + column * width + 1, image.y + row * height + 1, width - 2, height - 2};
    const double share = most > 0 ? static_cast<double>(drawing.cell_points[cell]) / most : 0;
    canvas.fill_rect(place,
                     share > 0 ? kFreeInk.with_alpha(.08 + .22 * std::sqrt(share)) : kBlockedInk.with_alpha(.22));
  }
  double sum = 0, count = 0;
  for (const auto& point : drawing.points)
    if (point.used) {
      sum += dot(point.residual, point.residual);
      ++count;
    }
  const double rms = count > 0 ? std::sqrt(sum / count) : 0;
  const double factor = rms > 0 ? round_factor(kUsualArrow / (rms * scale)) : 1;
  for (const auto& point : drawing.points) {
    const CanvasPoint at{image.x + (point.at.x + .5) * scale, image.y + (point.at.y + .5) * scale};
    const CanvasPoint to = at + factor * scale * CanvasPoint{point.residual.x, point.residual.y};
    if (point.used)
      canvas.arrow(at, to, {.ink = kLineInk, .width = 1.2});
    else
      canvas.stroke_circle(at, 4, {.ink = kBallInk, .width = 1.5});
  }
  canvas.text(drawing.title, {10, kLine / 2.}, TextAnchor::left, {.size = 13, .weight = TextWeight::bold});
  canvas.text(joined({"arrows: residuals x " + fixed(factor, 0), "RMS " + fixed(rms, 3) + " px", "rings: outliers",
                      "red: no points"}),
              {10, image.bottom() + kLine / 2.}, TextAnchor::left, {.size = 12, .ink = kQuietTextInk});
  return canvas.picture();
}

}  // namespace tassilo
