#include <gtest/gtest.h>

#include <string>

#include "tassilo/overlay/calibration_picture.h"
#include "tassilo/overlay/target_sheet.h"

namespace tassilo {
namespace {

/// Is the page dark at a place, seen from the first point? [pitch]
bool is_dark(const TargetSheet& sheet, const Picture& page, double scale, double column, double row) {
  const double border = sheet.marks == TargetSheet::Marks::dots ? 1.65 : 1.4;
  const auto x = static_cast<std::size_t>((column + border) * sheet.pitch * scale);
  const auto y = static_cast<std::size_t>((row + border) * sheet.pitch * scale);
  return page.pixels[3 * (y * static_cast<std::size_t>(page.width) + x)] < 128;
}

TEST(TargetSheet, DotsAndTheirMark) {
  const TargetSheet sheet{.columns = 5, .rows = 4, .pitch = .03, .radius = .008};
  const Picture page = target_picture(sheet, 2000);
  EXPECT_EQ(page.width, 438);  // 4 + 2 * 1.65 pitches of 60 pixels
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 5; ++c) {
      EXPECT_TRUE(is_dark(sheet, page, 2000, c, r)) << c << " " << r;
      EXPECT_FALSE(is_dark(sheet, page, 2000, c + .5, r)) << c << " " << r;
    }
  EXPECT_TRUE(is_dark(sheet, page, 2000, -1.12, 2));
  EXPECT_TRUE(is_dark(sheet, page, 2000, -.85, -.85));
  EXPECT_FALSE(is_dark(sheet, page, 2000, 4.85, -.85));
  EXPECT_FALSE(is_dark(sheet, page, 2000, -1.4, -1.4));
}

TEST(TargetSheet, SquaresBeginWithABlackOne) {
  const TargetSheet sheet{
      .marks = TargetSheet::Marks::checkerboard, .columns = 4, .rows = 3, .pitch = .03, .radius = 0};
  const Picture page = target_picture(sheet, 2000);
  for (int r = 0; r <= 3; ++r)
    for (int c = 0; c <= 4; ++c)
      EXPECT_EQ(is_dark(sheet, page, 2000, c - .5, r - .5), (c + r) % 2 == 0) << c << " " << r;
}

TEST(TargetSheet, VectorFilesAreToScale) {
  const TargetSheet sheet{
      .columns = 7, .rows = 7, .pitch = .0254, .radius = .006, .caption = "an inch from dot to dot"};
  const std::string svg = target_sheet(sheet, SheetFormat::svg);
  EXPECT_NE(svg.find("width=\"669.6pt\""), std::string::npos) << svg.substr(0, 300);  // 9.3 inches
  EXPECT_EQ(target_sheet(sheet, SheetFormat::pdf).substr(0, 5), "%PDF-");
}

TEST(CalibrationPicture, HasTheImagesShape) {
  CalibrationDrawing drawing{.width = 100, .height = 60, .points = {}, .cell_points = {}, .title = {}};
  const Picture empty = draw_calibration(drawing);
  EXPECT_EQ(empty.width, 900);
  EXPECT_GE(empty.height, 540);
  drawing.points = {{{10, 10}, {.1, 0}, true}, {{50, 30}, {0, -.1}, true}, {{99, 59}, {3, 3}, false}};
  drawing.cell_columns = 2;
  drawing.cell_rows = 1;
  drawing.cell_points = {2, 0};
  drawing.title = "camera";
  const Picture full = draw_calibration(drawing);
  EXPECT_EQ(full.width, empty.width);
  EXPECT_NE(full, empty);
  EXPECT_EQ(full, draw_calibration(drawing));
}

}  // namespace
}  // namespace tassilo
