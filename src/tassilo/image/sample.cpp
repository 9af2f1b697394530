#include "tassilo/image/sample.h"

#include <algorithm>
#include <cmath>

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

template <class Value>
double bilinear(const Between& c, const Between& r, Value value) {
  const double upper = (1 - c.weight) * value(c.low, r.low) + c.weight * value(c.high, r.low);
  const double lower = (1 - c.weight) * value(c.low, r.high) + c.weight * value(c.high, r.high);
  return (1 - r.weight) * upper + r.weight * lower;
}

}  // namespace

double sample_y(const FrameView& frame, double column, double row) {
  return bilinear(between(column, frame.width()), between(row, frame.height()),
                  [&](int c, int r) { return double{1} * frame.y(c, r); });
}

YuvValue sample(const FrameView& frame, double column, double row) {
  const bool halved_rows = frame.format() == PixelFormat::yuv420p || frame.format() == PixelFormat::nv12;
  // Chroma cell k lies at column 2k + .5, and at row 2k + .5 where rows are halved.
  const Between c = between((column - 0.5) / 2, (frame.width() + 1) / 2);
  const Between r = halved_rows ? between((row - 0.5) / 2, (frame.height() + 1) / 2) : between(row, frame.height());
  const int row_step = halved_rows ? 2 : 1;
  return {sample_y(frame, column, row),
          bilinear(c, r, [&](int k, int l) { return double{1} * frame.u(2 * k, row_step * l); }),
          bilinear(c, r, [&](int k, int l) { return double{1} * frame.v(2 * k, row_step * l); })};
}

}  // namespace tassilo
