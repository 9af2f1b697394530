#include "tassilo/detect/edge.h"

#include <array>
#include <cmath>
#include <span>

namespace tassilo {
namespace {

YuvValue mean(const YuvValue& a, const YuvValue& b) { return {(a.y + b.y) / 2, (a.u + b.u) / 2, (a.v + b.v) / 2}; }

}  // namespace

std::optional<PixelPoint> find_edge(const FrameView& frame, const EdgeSearch& search) {
  constexpr double step = 0.5;
  constexpr int most = 64;
  const int half = std::min(most / 2 - 1, static_cast<int>(std::lround(search.reach_px / step)));
  const int count = 2 * half + 1;
  std::array<YuvValue, most> values;
  const PixelPoint first = search.at - (step * half) * search.outward;
  sample_line(frame, {first.x, first.y, step * search.outward.x, step * search.outward.y},
              std::span(values).first(static_cast<std::size_t>(count)));
  // Each side is the mean of its two outermost pixels' worth of samples.
  const auto value = [&](int i) { return values[static_cast<std::size_t>(i)]; };
  const YuvValue inner = mean(value(0), value(2)), outer = mean(value(count - 1), value(count - 3));
  const double dy = inner.y - outer.y, du = inner.u - outer.u, dv = inner.v - outer.v;
  const double contrast_squared = dy * dy + du * du + dv * dv;
  if (contrast_squared < search.min_contrast * search.min_contrast) return std::nullopt;
  /// 1 on the inner side, 0 on the outer.
  const auto share = [&](int i) {
    const YuvValue& p = value(i);
    return ((p.y - outer.y) * dy + (p.u - outer.u) * du + (p.v - outer.v) * dv) / contrast_squared;
  };
  std::optional<double> best;
  for (int i = 0; i + 1 < count; ++i) {
    const double here = share(i), next = share(i + 1);
    if (here >= 0.5 && next < 0.5) {
      const double offset = step * (i - half + (here - 0.5) / (here - next));
      if (!best || std::abs(offset) < std::abs(*best)) best = offset;
    }
  }
  if (!best) return std::nullopt;
  return search.at + *best * search.outward;
}

}  // namespace tassilo
