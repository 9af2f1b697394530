#include "tassilo/image/sample.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tassilo {
namespace {

/// The two neighbors of a coordinate and the weight of the second.
struct Between {
  int low, high;
  double weight;
};

Between between(double at, int count) {
  const double clamped = std::clamp(at, 0.0, static_cast<double>(count - 1));
  const int low = static_cast<int>(clamped);
  return {low, std::min(low + 1, count - 1), clamped - low};
}

double mixed(double first, double second, double weight) { return (1 - weight) * first + weight * second; }

template <class Value>
double bilinear(const Between& c, const Between& r, Value value) {
  return mixed(mixed(value(c.low, r.low), value(c.high, r.low), c.weight),
               mixed(value(c.low, r.high), value(c.high, r.high), c.weight), r.weight);
}

bool has_halved_rows(const FrameView& frame) {
  return frame.format() == PixelFormat::yuv420p || frame.format() == PixelFormat::nv12;
}

/// One channel where the four samples around each place exist: no coordinate needs to be held back at the border.
struct Inner {
  const std::uint8_t* upper;
  const std::uint8_t* lower;
  int step;
  double right, below;

  double operator()(int column) const {
    const std::uint8_t *a = upper + column * step, *b = lower + column * step;
    return mixed(mixed(a[0], a[step], right), mixed(b[0], b[step], right), below);
  }
};

}  // namespace

double sample_y(const FrameView& frame, double column, double row) {
  return bilinear(between(column, frame.width()), between(row, frame.height()),
                  [&](int c, int r) { return double{1} * frame.y(c, r); });
}

YuvValue sample(const FrameView& frame, double column, double row) {
  const bool halved_rows = has_halved_rows(frame);
  // Chroma cell k lies at column 2k + .5, and at row 2k + .5 where rows are halved.
  const Between c = between((column - 0.5) / 2, (frame.width() + 1) / 2);
  const Between r = halved_rows ? between((row - 0.5) / 2, (frame.height() + 1) / 2) : between(row, frame.height());
  const int row_step = halved_rows ? 2 : 1;
  return {sample_y(frame, column, row),
          bilinear(c, r, [&](int k, int l) { return double{1} * frame.u(2 * k, row_step * l); }),
          bilinear(c, r, [&](int k, int l) { return double{1} * frame.v(2 * k, row_step * l); })};
}

void sample_line(const FrameView& frame, const SampleLine& line, std::span<YuvValue> values) {
  const auto place = [&](std::size_t i) {
    const auto k = static_cast<double>(i);
    return std::pair(line.column + k * line.column_step, line.row + k * line.row_step);
  };
  // Both ends lie further inside than half a chroma sample, so all between them do.
  constexpr double rim = 2;
  const auto is_inner = [&](std::size_t i) {
    const auto [column, row] = place(i);
    return column >= rim && row >= rim && column < frame.width() - 1 - rim && row < frame.height() - 1 - rim;
  };
  if (values.empty()) return;
  if (!is_inner(0) || !is_inner(values.size() - 1)) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto [column, row] = place(i);
      values[i] = sample(frame, column, row);
    }
    return;
  }
  const bool halved_rows = has_halved_rows(frame);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto [column, row] = place(i);
    const double chroma_column = (column - 0.5) / 2, chroma_row = halved_rows ? (row - 0.5) / 2 : row;
    const int c = static_cast<int>(column), r = static_cast<int>(row);
    const int k = static_cast<int>(chroma_column), l = static_cast<int>(chroma_row), first = halved_rows ? 2 * l : l;
    const YuvRow here = frame.row(r), below = frame.row(r + 1);
    const YuvRow chroma = frame.row(first), chroma_below = frame.row(first + (halved_rows ? 2 : 1));
    const double to_right = chroma_column - k, down = chroma_row - l;
    values[i] = {Inner{here.y, below.y, here.y_step, column - c, row - r}(c),
                 Inner{chroma.u, chroma_below.u, chroma.chroma_step, to_right, down}(k),
                 Inner{chroma.v, chroma_below.v, chroma.chroma_step, to_right, down}(k)};
  }
}

}  // namespace tassilo
