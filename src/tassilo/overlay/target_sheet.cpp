#include "tassilo/overlay/target_sheet.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <numbers>

#include "tassilo/base/contract.h"

namespace tassilo {
namespace {

constexpr double kPointsPerMetre = 72 / .0254;
constexpr double kRulerHeight = .016;  ///< With its numbers and the caption. [m]
constexpr double kMargin = .4;         ///< White around. [pitch]

struct Free {
  void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};

cairo_status_t append(void* bytes, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

/// From the first point to what is outermost of the black marks. [pitch]
double border(const TargetSheet& sheet) {
  switch (sheet.marks) {
    case TargetSheet::Marks::checkerboard:
      return 1;
    case TargetSheet::Marks::tags:
      return sheet.spacing;
    case TargetSheet::Marks::dots:
      break;
  }
  return 1.25;
}

/// From the first point to the last along a side with `count` marks. [m]
double extent(const TargetSheet& sheet, int count) {
  if (sheet.marks != TargetSheet::Marks::tags) return (count - 1) * sheet.pitch;
  return ((count - 1) * (1 + sheet.spacing) + 1) * sheet.pitch;
}

// Units of all drawing: metres; origin: the first point.

void draw_dots(cairo_t* cairo, const TargetSheet& sheet) {
  const double q = sheet.pitch, right = (sheet.columns - 1) * q, bottom = (sheet.rows - 1) * q;
  for (int r = 0; r < sheet.rows; ++r)
    for (int c = 0; c < sheet.columns; ++c) {
      cairo_new_sub_path(cairo);
      cairo_arc(cairo, c * q, r * q, sheet.radius, 0, 2 * std::numbers::pi);
    }
  cairo_fill(cairo);
  cairo_set_fill_rule(cairo, CAIRO_FILL_RULE_EVEN_ODD);
  for (const double out : {1.25 * q, q}) cairo_rectangle(cairo, -out, -out, right + 2 * out, bottom + 2 * out);
  cairo_fill(cairo);
  // It overlaps the frame a little, so that no gap shows.
  const double corner = -1.1 * q, leg = .7 * q;
  cairo_move_to(cairo, corner, corner);
  cairo_line_to(cairo, corner + leg, corner);
  cairo_line_to(cairo, corner, corner + leg);
  cairo_fill(cairo);
}

void draw_squares(cairo_t* cairo, const TargetSheet& sheet) {
  const double q = sheet.pitch;
  for (int r = 0; r <= sheet.rows; ++r)
    for (int c = 0; c <= sheet.columns; ++c)
      if ((c + r) % 2 == 0) cairo_rectangle(cairo, (c - 1) * q, (r - 1) * q, q, q);
  cairo_fill(cairo);
}

void draw_tags(cairo_t* cairo, const TargetSheet& sheet) {
  const double size = sheet.pitch, gap = sheet.spacing * size, step = size + gap;
  // Cells that touch must show no seam between them.
  cairo_set_antialias(cairo, CAIRO_ANTIALIAS_NONE);
  for (int r = 0; r <= sheet.rows; ++r)
    for (int c = 0; c <= sheet.columns; ++c) cairo_rectangle(cairo, c * step - gap, r * step - gap, gap, gap);
  for (int r = 0; r < sheet.rows; ++r)
    for (int c = 0; c < sheet.columns; ++c) {
      const std::vector<bool>& black = sheet.cells[static_cast<std::size_t>(r * sheet.columns + c)];
      const auto side = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(black.size()))));
      const double cell = size / static_cast<double>(side);
      for (std::size_t i = 0; i < side; ++i)
        for (std::size_t k = 0; k < side; ++k)
          if (black[i * side + k])
            cairo_rectangle(cairo, c * step + static_cast<double>(k) * cell, r * step + static_cast<double>(i) * cell,
                            cell, cell);
    }
  cairo_fill(cairo);
}

void draw_text(cairo_t* cairo, double x, double y, const std::string& text) {
  cairo_move_to(cairo, x, y);
  cairo_show_text(cairo, text.c_str());
}

/// A ruler from (0, 0) to the right, as long as fits.
void draw_ruler(cairo_t* cairo, double width, const std::string& caption) {
  constexpr double step = .01;
  const int count = std::clamp(static_cast<int>(width / step), 1, 10);
  cairo_set_line_width(cairo, .0002);
  cairo_move_to(cairo, 0, 0);
  cairo_line_to(cairo, count * step, 0);
  for (int i = 0; i <= count; ++i) {
    cairo_move_to(cairo, i * step, 0);
    cairo_line_to(cairo, i * step, i % 5 == 0 ? -.004 : -.002);
  }
  cairo_stroke(cairo);
  cairo_select_font_face(cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo, .0035);
  draw_text(cairo, 0, .005, "0");
  draw_text(cairo, count * step - .004, .005, std::to_string(10 * count) + " mm");
  draw_text(cairo, 0, .0095, caption);
}

/// Width and height. [m]
struct Page {
  double width = 0, height = 0, around = 0;  ///< around: from the first point to the left and upper edge.
};

Page page_of(const TargetSheet& sheet) {
  expects(sheet.columns >= 1 && sheet.rows >= 1 && sheet.pitch > 0 && sheet.radius >= 0, "target_sheet: valid sizes");
  if (sheet.marks == TargetSheet::Marks::tags)
    expects(sheet.cells.size() == static_cast<std::size_t>(sheet.columns * sheet.rows),
            "target_sheet: cells of each tag");
  const double around = (border(sheet) + kMargin) * sheet.pitch;
  return {extent(sheet, sheet.columns) + 2 * around, extent(sheet, sheet.rows) + 2 * around + kRulerHeight, around};
}

void draw_page(cairo_surface_t* surface, const TargetSheet& sheet, double scale) {
  const Page page = page_of(sheet);
  const std::unique_ptr<cairo_t, Free> cairo(cairo_create(surface));
  cairo_scale(cairo.get(), scale, scale);
  cairo_set_source_rgb(cairo.get(), 1, 1, 1);
  cairo_paint(cairo.get());
  cairo_set_source_rgb(cairo.get(), 0, 0, 0);
  cairo_save(cairo.get());
  cairo_translate(cairo.get(), page.around, page.around);
  if (sheet.marks == TargetSheet::Marks::dots) draw_dots(cairo.get(), sheet);
  if (sheet.marks == TargetSheet::Marks::checkerboard) draw_squares(cairo.get(), sheet);
  if (sheet.marks == TargetSheet::Marks::tags) draw_tags(cairo.get(), sheet);
  cairo_restore(cairo.get());
  cairo_translate(cairo.get(), .4 * page.around, page.height - kRulerHeight + .005);
  draw_ruler(cairo.get(), page.width - .8 * page.around, sheet.caption);
}

}  // namespace

std::string target_sheet(const TargetSheet& sheet, SheetFormat format) {
  const Page page = page_of(sheet);
  std::string bytes;
  const auto make =
      format == SheetFormat::svg ? cairo_svg_surface_create_for_stream : cairo_pdf_surface_create_for_stream;
  const std::unique_ptr<cairo_surface_t, Free> surface(
      make(append, &bytes, page.width * kPointsPerMetre, page.height * kPointsPerMetre));
  if (format == SheetFormat::pdf)
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, sheet.caption.c_str());
  draw_page(surface.get(), sheet, kPointsPerMetre);
  cairo_surface_finish(surface.get());
  return bytes;
}

Picture target_picture(const TargetSheet& sheet, double pixels_per_metre) {
  expects(pixels_per_metre > 0, "target_picture: a scale");
  const Page page = page_of(sheet);
  Picture picture{static_cast<int>(std::ceil(page.width * pixels_per_metre)),
                  static_cast<int>(std::ceil(page.height * pixels_per_metre)),
                  {}};
  const std::unique_ptr<cairo_surface_t, Free> surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture.width, picture.height));
  draw_page(surface.get(), sheet, pixels_per_metre);
  cairo_surface_flush(surface.get());
  const unsigned char* pixels = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  picture.pixels.reserve(std::size_t{3} * static_cast<std::size_t>(picture.width) *
                         static_cast<std::size_t>(picture.height));
  for (int r = 0; r < picture.height; ++r)
    for (int c = 0; c < picture.width; ++c) {
      std::uint32_t rgb = 0;
      std::memcpy(&rgb, pixels + std::ptrdiff_t{r} * stride + 4 * c, sizeof rgb);
      for (const int shift : {16, 8, 0}) picture.pixels.push_back(static_cast<std::uint8_t>(rgb >> shift & 255));
    }
  return picture;
}

}  // namespace tassilo
