// How long do the sub-pixel edges near the field lines take, by kernel, and how does that compare with OpenCV's
// GaussianBlur and two Sobels on the bounding box of the same region, which give gradients only? OpenCV, where it is
// installed, runs in the same process with one thread.

#include <benchmark/benchmark.h>

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "field_lines.h"
#include "support/recording.h"
#include "tassilo/base/median.h"
#include "tassilo/contour/internal/edge_points.h"
#include "tassilo/contour/sub_pixel_edges.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/raster.h"

#ifdef TASSILO_BENCH_OPENCV
#include <opencv2/imgproc.hpp>
#endif

namespace tassilo {
namespace {

/// Frames of one camera, and the rims of the white regions in them: where edges of lines are.
struct Views {
  std::vector<Frame> frames;
  std::vector<Region> regions;

  void add(const Frame& frame, const Region& white) {
    const Region rim = difference(dilation(white, disc(3)), erosion(white, disc(3)));
    frames.push_back(frame);
    regions.push_back(clipped(rim, {0, 0, frame.view.width(), frame.view.height()}));
  }
};

Views synthetic(int width, int height) {
  Views views;
  for (const Frame& frame : bench::field_line_frames(width, height)) {
    const YuvRow first = frame.view.row(0);
    views.add(frame,
              region_where({first.y, width, height, frame.view.row(1).y - first.y}, [](int y) { return y > 130; }));
  }
  return views;
}

Views recorded(const std::string& name, const std::string& samples) {
  const test::Recording recording = test::load_recording(name, samples);
  const Classifier classifier(recording.setup.colors);
  Views views;
  for (const Frame& frame : recording.frames) views.add(frame, segment(frame.view, classifier).of(ColorClass::white));
  return views;
}

const Views& views_of(int source) {
  static std::map<int, Views> made;
  if (!made.contains(source)) {
    if (source == 0) made[source] = synthetic(640, 480);
    if (source == 1) made[source] = synthetic(1920, 1080);
    if (source == 2) made[source] = recorded("d06_vga", "train_vga/samples.yaml");
    if (source == 3) made[source] = recorded("d01_approach", "train_div/samples.yaml");
  }
  return made.at(source);
}

/// Time of a call by frame, the median of several, as the mean over all frames. [s]
template <class Call>
double seconds_per_frame(const Views& views, Call call) {
  std::vector<std::vector<double>> seconds(views.frames.size());
  for (int round = 0; round < 15; ++round)
    for (std::size_t k = 0; k < seconds.size(); ++k) {
      const auto start = std::chrono::steady_clock::now();
      call(k);
      seconds[k].push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
  double sum = 0;
  for (std::vector<double>& frame : seconds) sum += median(std::move(frame));
  return sum / static_cast<double>(seconds.size());
}

#ifdef TASSILO_BENCH_OPENCV

double opencv_seconds(const Views& views) {
  cv::setNumThreads(1);
  std::vector<cv::Mat> images;
  for (std::size_t k = 0; k < views.frames.size(); ++k) {
    const FrameView& view = views.frames[k].view;
    const PixelBox box = bounding_box(views.regions[k]);
    cv::Mat image(box.height(), box.width(), CV_8U);
    for (int r = 0; r < box.height(); ++r)
      for (int c = 0; c < box.width(); ++c) image.at<std::uint8_t>(r, c) = view.y(box.x0 + c, box.y0 + r);
    images.push_back(image);
  }
  // Boxes differ from frame to frame: results of their own, so that nothing is allocated while the clock runs.
  std::vector<cv::Mat> smooth(images.size()), x(images.size()), y(images.size());
  return seconds_per_frame(views, [&](std::size_t k) {
    cv::GaussianBlur(images[k], smooth[k], {5, 5}, 1);
    cv::Sobel(smooth[k], x[k], CV_16S, 1, 0);
    cv::Sobel(smooth[k], y[k], CV_16S, 0, 1);
    benchmark::DoNotOptimize(x[k].data);
    benchmark::DoNotOptimize(y[k].data);
  });
}

#endif

void BM_Edges(benchmark::State& state) {
  const auto kernels = gradient_kernels();
  const auto index = static_cast<std::size_t>(state.range(1));
  if (index >= kernels.size() || !is_supported(kernels[index].kernel)) {
    state.SkipWithError("this machine does not have the kernel");
    return;
  }
  const GradientKernel& kernel = kernels[index];
  const Views& views = views_of(static_cast<int>(state.range(0)));
  const EdgeOptions options;
  double pixels = 0, points = 0, box = 0;
  const double share = 1 / static_cast<double>(views.frames.size());
  for (std::size_t k = 0; k < views.frames.size(); ++k) {
    const auto found = sub_pixel_edges_by(kernel, views.frames[k].view, views.regions[k], options);
    const auto plain = sub_pixel_edges_by(kernels[0], views.frames[k].view, views.regions[k], options);
    bool same = found.size() == plain.size();
    for (std::size_t i = 0; same && i < found.size(); ++i) same = found[i].points == plain[i].points;
    if (!same) {
      state.SkipWithError("differs from the plain kernel");
      return;
    }
    for (const Contour& contour : found) points += share * static_cast<double>(contour.points.size());
    pixels += share * static_cast<double>(area(views.regions[k]));
    box += share * bounding_box(views.regions[k]).width() * bounding_box(views.regions[k]).height();
  }
  std::size_t next = 0;
  for (auto _ : state) {
    const std::size_t k = next++ % views.frames.size();
    benchmark::DoNotOptimize(sub_pixel_edges_by(kernel, views.frames[k].view, views.regions[k], options));
  }
  const double seconds = seconds_per_frame(views, [&](std::size_t k) {
    benchmark::DoNotOptimize(sub_pixel_edges_by(kernel, views.frames[k].view, views.regions[k], options));
  });
  state.counters["us_per_frame"] = 1e6 * seconds;
  state.counters["points_us"] =
      1e6 * seconds_per_frame(views, [&](std::size_t k) {
        benchmark::DoNotOptimize(edge_points(kernel, views.frames[k].view, views.regions[k], options));
      });
  // Nothing is steep enough: what remains is the gradients.
  state.counters["gradients_us"] = 1e6 * seconds_per_frame(views, [&](std::size_t k) {
                                     benchmark::DoNotOptimize(edge_points(kernel, views.frames[k].view,
                                                                          views.regions[k], {.low = 1e4, .high = 1e4}));
                                   });
  state.counters["points"] = points;
  state.counters["pixels"] = pixels;
  state.counters["box_pixels"] = box;
#ifdef TASSILO_BENCH_OPENCV
  const double theirs = opencv_seconds(views);
  state.counters["opencv_us"] = 1e6 * theirs;
  state.counters["of_opencv"] = seconds / theirs;
#endif
  const FrameView& view = views.frames[0].view;
  state.SetLabel(std::to_string(view.width()) + "x" + std::to_string(view.height()) + " " +
                 std::string(to_string(kernel.kernel)));
}

BENCHMARK(BM_Edges)
    ->ArgsProduct({{0, 1, 2, 3}, {0, 1, 2}})
    ->ArgNames({"source", "kernel"})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace tassilo

BENCHMARK_MAIN();
