#include "tassilo/region/gray.h"

#include <algorithm>
#include <cmath>

#include "tassilo/base/contract.h"
#include "tassilo/region/algebra.h"

namespace tassilo {
namespace {

/// Calls visit(run, first byte) for the runs inside the image.
template <class Visit>
void for_each_run(const Region& region, const GrayView& image, Visit visit) {
  const Region visible = clipped(region, {0, 0, image.width, image.height});
  for (const PixelRun& run : visible.runs())
    visit(run, image.data + run.row * image.row_step + run.begin * image.pixel_step);
}

}  // namespace

GrayView::GrayView(ByteView image)
    : data(image.data), width(image.width), height(image.height), row_step(image.stride) {}

GrayView::GrayView(const FrameView& frame) : width(frame.width()), height(frame.height()) {
  if (frame.empty()) return;
  const YuvRow first = frame.row(0);
  data = first.y;
  pixel_step = first.y_step;
  row_step = height > 1 ? frame.row(1).y - first.y : 0;
}

GrayHistogram gray_histogram(const Region& region, GrayView image) {
  GrayHistogram histogram;
  for_each_run(region, image, [&](const PixelRun& run, const std::uint8_t* byte) {
    for (int n = run.length(); n > 0; --n, byte += image.pixel_step) ++histogram.count[*byte];
  });
  return histogram;
}

GrayFeatures gray_features(const GrayHistogram& histogram) {
  GrayFeatures features;
  std::int64_t sum = 0, sum_of_squares = 0;
  for (int value = 0; value < 256; ++value) {
    const std::int64_t n = histogram.count[static_cast<std::size_t>(value)];
    if (n == 0) continue;
    if (features.count == 0) features.min = value;
    features.max = value;
    features.count += n;
    sum += n * value;
    sum_of_squares += n * value * value;
  }
  if (features.count == 0) return features;
  const double count = static_cast<double>(features.count);
  features.mean = static_cast<double>(sum) / count;
  const double variance = static_cast<double>(sum_of_squares) / count - features.mean * features.mean;
  // Equal values must give 0, not rounding noise.
  features.deviation = features.min == features.max ? 0 : std::sqrt(std::max(0.0, variance));
  features.median = gray_quantile(histogram, .5);
  for (const std::int64_t n : histogram.count) {
    const double share = static_cast<double>(n) / count;
    if (n > 0 && n < features.count) features.entropy -= share * std::log2(share);
  }
  return features;
}

GrayFeatures gray_features(const Region& region, GrayView image) {
  return gray_features(gray_histogram(region, image));
}

int gray_quantile(const GrayHistogram& histogram, double share) {
  expects(share >= 0 && share <= 1, "a quantile's share is 0 to 1");
  std::int64_t all = 0;
  for (const std::int64_t n : histogram.count) all += n;
  const auto wanted = std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(share * static_cast<double>(all))));
  std::int64_t seen = 0;
  for (int value = 0; value < 256; ++value) {
    seen += histogram.count[static_cast<std::size_t>(value)];
    if (seen >= wanted) return value;
  }
  return 0;
}

GrayMoments gray_moments(const Region& region, GrayView image) {
  std::int64_t volume = 0;
  double sum_c = 0, sum_r = 0, sum_cc = 0, sum_rc = 0, sum_rr = 0;
  // About the middle of the image, so that little is lost when the centre's own part is taken off.
  const int column0 = image.width / 2, row0 = image.height / 2;
  for_each_run(region, image, [&](const PixelRun& run, const std::uint8_t* byte) {
    std::int64_t w = 0, wc = 0, wcc = 0;
    for (std::int64_t c = run.begin - column0; c < run.end - column0; ++c, byte += image.pixel_step) {
      w += *byte;
      wc += *byte * c;
      wcc += *byte * c * c;
    }
    const double r = run.row - row0;
    volume += w;
    sum_c += static_cast<double>(wc);
    sum_cc += static_cast<double>(wcc);
    sum_r += r * static_cast<double>(w);
    sum_rc += r * static_cast<double>(wc);
    sum_rr += r * r * static_cast<double>(w);
  });
  GrayMoments result;
  if (volume == 0) return result;
  result.volume = static_cast<double>(volume);
  const double c = sum_c / result.volume, r = sum_r / result.volume;
  result.center = {column0 + c, row0 + r};
  result.moments = {.rr = std::max(0.0, sum_rr / result.volume - r * r),
                    .rc = sum_rc / result.volume - r * c,
                    .cc = std::max(0.0, sum_cc / result.volume - c * c)};
  result.ellipse = equivalent_ellipse(result.moments);
  return result;
}

}  // namespace tassilo
