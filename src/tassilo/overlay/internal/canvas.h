#pragma once

#include <cairo.h>

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "tassilo/geometry/point.h"
#include "tassilo/overlay/internal/label_layout.h"
#include "tassilo/overlay/internal/palette.h"
#include "tassilo/overlay/picture.h"

namespace tassilo {

struct CanvasFrame;  ///< Picture pixels: x right, y down; (0, 0) is the upper left corner. [px]
using CanvasPoint = Point2<CanvasFrame>;

struct Pen {
  Ink ink;
  double width = 2;  ///< [px]
  bool dashed = false;
  bool cased = false;  ///< With a dark rim, for strokes on the image.
};

enum class TextWeight { normal, bold };
struct TextStyle {
  double size = 12;  ///< [px]
  Ink ink = kTextInk;
  TextWeight weight = TextWeight::normal;
};
enum class TextAnchor { left, center, right };

/// Cairo, in the words of the overlay. Shapes are anti-aliased; nothing throws.
class Canvas {
 public:
  Canvas(int width, int height, Ink background);

  int width() const { return width_; }
  int height() const { return height_; }

  /// The picture enlarged into `place`, smoothly or pixel by pixel.
  void image(const Picture& picture, const Rect& place);
  /// Label classes over `place`, half transparent.
  void label_map(std::span<const std::uint8_t> labels, int columns, const Rect& place);

  void fill_rect(const Rect& rect, Ink fill);
  void fill_rounded(const Rect& rect, double radius, Ink fill);
  void stroke_rounded(const Rect& rect, double radius, const Pen& pen);
  void polyline(std::span<const CanvasPoint> points, const Pen& pen);
  /// A stroke with an open head at `to`.
  void arrow(CanvasPoint from, CanvasPoint to, const Pen& pen);
  /// All polygons as one area: shared edges leave no seams.
  void fill_polygons(std::span<const std::vector<CanvasPoint>> polygons, Ink fill);
  /// Likewise where `shown`, a picture of the canvas's rectangle `place`, is 255: rows of `columns` bytes, 0 hides.
  void fill_polygons_where(std::span<const std::vector<CanvasPoint>> polygons, Ink fill,
                           std::span<const std::uint8_t> shown, int columns, const Rect& place);
  void stroke_circle(CanvasPoint center, double radius, const Pen& pen);
  void fill_circle(CanvasPoint center, double radius, Ink fill);

  /// Width of one line of text. [px]
  double text_width(const std::string& text, const TextStyle& style);
  /// One line of text with a dark halo; `at` is on the middle of its x-height.
  void text(const std::string& text, CanvasPoint at, TextAnchor anchor, const TextStyle& style);

  /// What `draw` draws shows inside `rect` only.
  void clipped(const Rect& rect, const std::function<void()>& draw);

  Picture picture() const;

 private:
  struct Free {
    void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  };
  using Surface = std::unique_ptr<cairo_surface_t, Free>;

  void paint_pixels(const Surface& pixels, const Rect& place, cairo_filter_t filter);
  void set_font(const TextStyle& style);
  void set_ink(Ink ink);
  /// Strokes the current path and forgets it.
  void stroke(const Pen& pen);
  void polygons_path(std::span<const std::vector<CanvasPoint>> polygons);
  void rounded_path(const Rect& rect, double radius);

  int width_, height_;
  Surface surface_;
  std::unique_ptr<cairo_t, Free> cairo_;
};

}  // namespace tassilo
