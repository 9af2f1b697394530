#include "tassilo/overlay/internal/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tassilo {
namespace {

std::uint32_t premultiplied(Ink ink) {
  const auto byte = [](double value) { return static_cast<std::uint32_t>(std::lround(255 * value)); };
  return byte(ink.a) << 24 | byte(ink.r * ink.a) << 16 | byte(ink.g * ink.a) << 8 | byte(ink.b * ink.a);
}

std::uint32_t* row_of(cairo_surface_t* surface, int r) {
  return reinterpret_cast<std::uint32_t*>(cairo_image_surface_get_data(surface) +
                                          static_cast<std::ptrdiff_t>(r) * cairo_image_surface_get_stride(surface));
}

}  // namespace

Canvas::Canvas(int width, int height, Ink background)
    : width_(width),
      height_(height),
      surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)),
      cairo_(cairo_create(surface_.get())) {
  fill_rect({0, 0, static_cast<double>(width), static_cast<double>(height)}, background);
  cairo_set_line_cap(cairo_.get(), CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(cairo_.get(), CAIRO_LINE_JOIN_ROUND);
}

void Canvas::set_ink(Ink ink) { cairo_set_source_rgba(cairo_.get(), ink.r, ink.g, ink.b, ink.a); }

void Canvas::paint_pixels(const Surface& pixels, const Rect& place, cairo_filter_t filter) {
  const double columns = cairo_image_surface_get_width(pixels.get());
  const double rows = cairo_image_surface_get_height(pixels.get());
  if (columns == 0 || rows == 0) return;
  cairo_t* cairo = cairo_.get();
  cairo_save(cairo);
  cairo_rectangle(cairo, place.x, place.y, place.width, place.height);
  cairo_clip(cairo);
  cairo_translate(cairo, place.x, place.y);
  cairo_scale(cairo, place.width / columns, place.height / rows);
  cairo_set_source_surface(cairo, pixels.get(), 0, 0);
  cairo_pattern_set_filter(cairo_get_source(cairo), filter);
  cairo_pattern_set_extend(cairo_get_source(cairo), CAIRO_EXTEND_PAD);
  cairo_paint(cairo);
  cairo_restore(cairo);
}

void Canvas::image(const Picture& picture, const Rect& place) {
  const Surface pixels(cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture.width, picture.height));
  const std::uint8_t* from = picture.pixels.data();
  for (int r = 0; r < picture.height; ++r) {
    std::uint32_t* to = row_of(pixels.get(), r);
    for (int c = 0; c < picture.width; ++c, from += 3)
      to[c] = static_cast<std::uint32_t>(from[0] << 16 | from[1] << 8 | from[2]);
  }
  cairo_surface_mark_dirty(pixels.get());
  paint_pixels(pixels, place, CAIRO_FILTER_BILINEAR);
}

void Canvas::label_map(std::span<const std::uint8_t> labels, int columns, const Rect& place) {
  constexpr double kAlpha = .45;
  std::array<std::uint32_t, kLabelInks.size()> colors{};
  for (std::size_t k = 1; k < colors.size(); ++k) colors[k] = premultiplied(kLabelInks[k].with_alpha(kAlpha));
  const int rows = columns > 0 ? static_cast<int>(labels.size()) / columns : 0;
  const Surface pixels(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, columns, rows));
  for (int r = 0; r < rows; ++r) {
    std::uint32_t* to = row_of(pixels.get(), r);
    for (int c = 0; c < columns; ++c) {
      const std::uint8_t label =
          labels[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(c)];
      to[c] = label < colors.size() ? colors[label] : 0;
    }
  }
  cairo_surface_mark_dirty(pixels.get());
  paint_pixels(pixels, place, CAIRO_FILTER_NEAREST);
}

void Canvas::fill_rect(const Rect& rect, Ink fill) {
  cairo_rectangle(cairo_.get(), rect.x, rect.y, rect.width, rect.height);
  set_ink(fill);
  cairo_fill(cairo_.get());
}

void Canvas::rounded_path(const Rect& rect, double radius) {
  constexpr double kQuarter = std::numbers::pi / 2;
  const double r = std::min({radius, rect.width / 2, rect.height / 2});
  cairo_t* cairo = cairo_.get();
  cairo_new_path(cairo);
  cairo_arc(cairo, rect.right() - r, rect.y + r, r, -kQuarter, 0);
  cairo_arc(cairo, rect.right() - r, rect.bottom() - r, r, 0, kQuarter);
  cairo_arc(cairo, rect.x + r, rect.bottom() - r, r, kQuarter, 2 * kQuarter);
  cairo_arc(cairo, rect.x + r, rect.y + r, r, 2 * kQuarter, 3 * kQuarter);
  cairo_close_path(cairo);
}

void Canvas::fill_rounded(const Rect& rect, double radius, Ink fill) {
  rounded_path(rect, radius);
  set_ink(fill);
  cairo_fill(cairo_.get());
}

void Canvas::stroke_rounded(const Rect& rect, double radius, const Pen& pen) {
  rounded_path(rect, radius);
  stroke(pen);
}

void Canvas::stroke(const Pen& pen) {
  constexpr double kRim = 2, kRimAlpha = .55;
  cairo_t* cairo = cairo_.get();
  const double dash = 3 * pen.width;
  cairo_set_dash(cairo, &dash, pen.dashed ? 1 : 0, 0);
  if (pen.cased) {
    set_ink(kHaloInk.with_alpha(kRimAlpha * pen.ink.a));
    cairo_set_line_width(cairo, pen.width + kRim);
    cairo_stroke_preserve(cairo);
  }
  set_ink(pen.ink);
  cairo_set_line_width(cairo, pen.width);
  cairo_stroke(cairo);
  cairo_set_dash(cairo, nullptr, 0, 0);
}

void Canvas::polyline(std::span<const CanvasPoint> points, const Pen& pen) {
  if (points.size() < 2) return;
  cairo_new_path(cairo_.get());
  for (const CanvasPoint& p : points) cairo_line_to(cairo_.get(), p.x, p.y);
  stroke(pen);
}

void Canvas::arrow(CanvasPoint from, CanvasPoint to, const Pen& pen) {
  const CanvasPoint along = to - from;
  const double length = norm(along);
  if (!(length > 0)) return;
  const CanvasPoint back = (-std::min(3.5 * pen.width, length / 2) / length) * along, aside{-back.y, back.x};
  cairo_new_path(cairo_.get());
  for (const CanvasPoint& p : {from, to, to + back + .7 * aside, to, to + back - .7 * aside})
    cairo_line_to(cairo_.get(), p.x, p.y);
  stroke(pen);
}

void Canvas::polygons_path(std::span<const std::vector<CanvasPoint>> polygons) {
  cairo_new_path(cairo_.get());
  for (const std::vector<CanvasPoint>& polygon : polygons) {
    if (polygon.size() < 3) continue;
    cairo_new_sub_path(cairo_.get());
    for (const CanvasPoint& p : polygon) cairo_line_to(cairo_.get(), p.x, p.y);
    cairo_close_path(cairo_.get());
  }
}

void Canvas::fill_polygons(std::span<const std::vector<CanvasPoint>> polygons, Ink fill) {
  polygons_path(polygons);
  set_ink(fill);
  cairo_fill(cairo_.get());
}

void Canvas::fill_polygons_where(std::span<const std::vector<CanvasPoint>> polygons, Ink fill,
                                 std::span<const std::uint8_t> shown, int columns, const Rect& place) {
  const int rows = columns > 0 ? static_cast<int>(shown.size()) / columns : 0;
  if (rows == 0) return;
  const Surface mask(cairo_image_surface_create(CAIRO_FORMAT_A8, columns, rows));
  unsigned char* to = cairo_image_surface_get_data(mask.get());
  for (int r = 0; r < rows; ++r, to += cairo_image_surface_get_stride(mask.get()))
    std::ranges::copy(shown.subspan(static_cast<std::size_t>(r) * static_cast<std::size_t>(columns),
                                    static_cast<std::size_t>(columns)),
                      to);
  cairo_surface_mark_dirty(mask.get());
  cairo_t* cairo = cairo_.get();
  cairo_save(cairo);
  polygons_path(polygons);
  cairo_clip(cairo);
  cairo_translate(cairo, place.x, place.y);
  cairo_scale(cairo, place.width / columns, place.height / rows);
  const std::unique_ptr<cairo_pattern_t, decltype(&cairo_pattern_destroy)> pattern(
      cairo_pattern_create_for_surface(mask.get()), &cairo_pattern_destroy);
  cairo_pattern_set_extend(pattern.get(), CAIRO_EXTEND_PAD);
  set_ink(fill);
  cairo_mask(cairo, pattern.get());
  cairo_restore(cairo);
}

void Canvas::stroke_circle(CanvasPoint center, double radius, const Pen& pen) {
  cairo_new_path(cairo_.get());
  cairo_arc(cairo_.get(), center.x, center.y, radius, 0, 2 * std::numbers::pi);
  stroke(pen);
}

void Canvas::fill_circle(CanvasPoint center, double radius, Ink fill) {
  cairo_new_path(cairo_.get());
  cairo_arc(cairo_.get(), center.x, center.y, radius, 0, 2 * std::numbers::pi);
  set_ink(fill);
  cairo_fill(cairo_.get());
}

void Canvas::set_font(const TextStyle& style) {
  const cairo_font_weight_t weight =
      style.weight == TextWeight::bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL;
  cairo_select_font_face(cairo_.get(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, weight);
  cairo_set_font_size(cairo_.get(), style.size);
}

double Canvas::text_width(const std::string& text, const TextStyle& style) {
  set_font(style);
  cairo_text_extents_t extents{};
  cairo_text_extents(cairo_.get(), text.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(const std::string& text, CanvasPoint at, TextAnchor anchor, const TextStyle& style) {
  constexpr double kCapHeight = .73;  // of DejaVu Sans, in text sizes
  const double width = text_width(text, style);
  const double x = anchor == TextAnchor::left ? at.x : anchor == TextAnchor::right ? at.x - width : at.x - width / 2;
  cairo_t* cairo = cairo_.get();
  cairo_new_path(cairo);
  cairo_move_to(cairo, x, at.y + kCapHeight * style.size / 2);
  cairo_text_path(cairo, text.c_str());
  set_ink(kHaloInk.with_alpha(.75));
  cairo_set_line_width(cairo, style.size / 5);
  cairo_stroke_preserve(cairo);
  set_ink(style.ink);
  cairo_fill(cairo);
}

void Canvas::clipped(const Rect& rect, const std::function<void()>& draw) {
  cairo_save(cairo_.get());
  cairo_rectangle(cairo_.get(), rect.x, rect.y, rect.width, rect.height);
  cairo_clip(cairo_.get());
  draw();
  cairo_restore(cairo_.get());
}

Picture Canvas::picture() const {
  cairo_surface_flush(surface_.get());
  Picture picture{width_, height_, {}};
  picture.pixels.resize(3 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  std::uint8_t* to = picture.pixels.data();
  for (int r = 0; r < height_; ++r) {
    const std::uint32_t* from = row_of(surface_.get(), r);
    for (int c = 0; c < width_; ++c, to += 3) {
      to[0] = static_cast<std::uint8_t>(from[c] >> 16);
      to[1] = static_cast<std::uint8_t>(from[c] >> 8);
      to[2] = static_cast<std::uint8_t>(from[c]);
    }
  }
  return picture;
}

}  // namespace tassilo
