// How long do the sub-pixel edges near the field lines take, by kernel, and how does that compare with OpenCV's
// GaussianBlur and two Sobels on the bounding box of the same region, where installed? Those give gradients only, so
// there are no answers to compare; all kernels' edges are, before any time counts.

#include <string>
#include <utility>
#include <vector>

#include "bench.h"
#include "field_lines.h"
#include "references.h"
#include "tassilo/base/contract.h"
#include "tassilo/base/kernel.h"
#include "tassilo/contour/internal/edge_points.h"
#include "tassilo/contour/sub_pixel_edges.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/morphology.h"

namespace tassilo::bench {
namespace {

/// The rims of the white regions: where edges of lines are.
std::vector<Region> rims_of(const FieldLines& views) {
  std::vector<Region> rims;
  for (const Region& white : views.lines)
    rims.push_back(clipped(difference(dilation(white, disc(3)), erosion(white, disc(3))), views.window()));
  return rims;
}

void report(benchmark::State& state, const FieldLines& views, const std::vector<Region>& rims) {
  double pixels = 0, box_pixels = 0;
  for (const Region& rim : rims) {
    pixels += static_cast<double>(area(rim));
    box_pixels += bounding_box(rim).width() * bounding_box(rim).height();
  }
  state.counters["pixels"] = pixels / static_cast<double>(rims.size());
  state.counters["box_pixels"] = box_pixels / static_cast<double>(rims.size());
  state.SetLabel(views.name);
}

void edges(benchmark::State& state, Kernel kernel) {
  const FieldLines& views = field_lines(static_cast<int>(state.range(0)));
  const std::vector<Region> rims = rims_of(views);
  double points = 0;
  for (std::size_t k = 0; k < rims.size(); ++k) {
    use_kernel(Kernel::plain);
    const auto plain = sub_pixel_edges(views.frames[k].view, rims[k]);
    use_kernel(kernel);
    const auto found = sub_pixel_edges(views.frames[k].view, rims[k]);
    expects(found.size() == plain.size(), "a kernel finds as many edges as the plain one");
    for (std::size_t i = 0; i < found.size(); ++i) {
      expects(found[i].points == plain[i].points, "a kernel finds the plain one's edges");
      points += static_cast<double>(found[i].points.size());
    }
  }
  measure(state, rims.size(),
          [&](std::size_t k) { benchmark::DoNotOptimize(sub_pixel_edges(views.frames[k].view, rims[k])); });
  state.counters["points"] = points / static_cast<double>(rims.size());
  report(state, views, rims);
}

/// All but linking and fitting; no point at all when `options` want edges steeper than there are.
void points(benchmark::State& state, Kernel kernel, const EdgeOptions& options) {
  const FieldLines& views = field_lines(static_cast<int>(state.range(0)));
  const std::vector<Region> rims = rims_of(views);
  use_kernel(kernel);
  const GradientKernel& gradient = version_in_use(gradient_kernels());
  measure(state, rims.size(), [&](std::size_t k) {
    benchmark::DoNotOptimize(edge_points(gradient, views.frames[k].view, rims[k], options));
  });
  report(state, views, rims);
}

#ifdef TASSILO_BENCH_OPENCV

void opencv(benchmark::State& state) {
  cv::setNumThreads(1);
  const FieldLines& views = field_lines(static_cast<int>(state.range(0)));
  const std::vector<Region> rims = rims_of(views);
  std::vector<cv::Mat> images;
  for (std::size_t k = 0; k < rims.size(); ++k) {
    const PixelBox box = bounding_box(rims[k]);
    cv::Mat image(box.height(), box.width(), CV_8U);
    for (int r = 0; r < box.height(); ++r)
      for (int c = 0; c < box.width(); ++c)
        image.at<std::uint8_t>(r, c) = views.frames[k].view.y(box.x0 + c, box.y0 + r);
    images.push_back(image);
  }
  // Boxes differ from frame to frame: results of their own, so that nothing is allocated while the clock runs.
  std::vector<cv::Mat> smooth(images.size()), x(images.size()), y(images.size());
  measure(state, images.size(), [&](std::size_t k) {
    cv::GaussianBlur(images[k], smooth[k], {5, 5}, 1);
    cv::Sobel(smooth[k], x[k], CV_16S, 1, 0);
    cv::Sobel(smooth[k], y[k], CV_16S, 0, 1);
    benchmark::DoNotOptimize(x[k].data);
    benchmark::DoNotOptimize(y[k].data);
  });
  report(state, views, rims);
}

#endif

}  // namespace

void register_benchmarks() {
  const std::vector<int> views{0, 1, 2, 3};
  static_assert(kFieldLines == 4);
  add_yardsticks({1, 2, 3, 5});
  for (const Kernel kernel : supported_kernels()) {
    const std::string name(to_string(kernel));
    add("edges/" + name, views, [kernel](benchmark::State& state) { edges(state, kernel); });
    add("points/" + name, views, [kernel](benchmark::State& state) { points(state, kernel, {}); });
    add("gradients/" + name, views,
        [kernel](benchmark::State& state) { points(state, kernel, {.low = 1e4, .high = 1e4}); });
  }
#ifdef TASSILO_BENCH_OPENCV
  add("edges/opencv_gradients", views, opencv);
#endif
}

}  // namespace tassilo::bench
