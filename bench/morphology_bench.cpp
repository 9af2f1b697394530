// How long do morphology and components of one dense class take, for each kernel, beside OpenCV's and Leptonica's
// (where installed)? And the whole chain, frame -> 8 classes -> opened -> components with area, centre and box, beside
// OpenCV's? The carpet of a painted noisy scene, frames cycled; OpenCV's masks are compared with our regions, and the
// number of components, before time counts. Runs in, runs out for ours, masks in, masks out for the others.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "support/bench_frames.h"
#include "tassilo/base/contract.h"
#include "tassilo/base/kernel.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/components.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/raster.h"

#ifdef TASSILO_BENCH_OPENCV
#include <opencv2/imgproc.hpp>
#endif
#ifdef TASSILO_BENCH_LEPTONICA
#include <allheaders.h>
#endif

namespace tassilo {
namespace {

using test::bench_frames;
using test::BenchFrames;

/// One class of every frame, as a region and as what the others take.
struct Masks {
  PixelBox box;
  std::vector<Region> regions;
  std::vector<std::vector<std::uint8_t>> bytes;  ///< 255 inside.
};
const Masks& carpet(int frames_index) {
  static std::map<int, Masks> made;
  if (const auto it = made.find(frames_index); it != made.end()) return it->second;
  const BenchFrames& frames = bench_frames(frames_index);
  Masks masks{{0, 0, frames.width(), frames.height()}, {}, {}};
  for (const Frame& frame : frames.frames) {
    masks.regions.push_back(segment(frame.view, frames.classifier).of(ColorClass::green));
    masks.bytes.push_back(to_mask(masks.regions.back(), masks.box));
  }
  return made[frames_index] = std::move(masks);
}

struct Task {
  std::string name;
  Region element;
  bool opens;
  Region operator()(const Region& region) const { return opens ? opening(region, element) : dilation(region, element); }
};
const std::vector<Task>& tasks() {
  static const std::vector<Task> all{{"open3x3", rectangle(3, 3), true},
                                     {"open5x5", rectangle(5, 5), true},
                                     {"dilate_disc3.5", disc(3.5), false},
                                     {"dilate_disc7.5", disc(7.5), false}};
  return all;
}

void set_label(benchmark::State& state) { state.SetLabel(bench_frames(static_cast<int>(state.range(0))).name); }

void BM_Ours(benchmark::State& state, const Task* task, Kernel kernel) {
  use_kernel(kernel);
  const Masks& masks = carpet(static_cast<int>(state.range(0)));
  std::size_t next = 0;
  for (auto _ : state) benchmark::DoNotOptimize((*task)(masks.regions[next++ % masks.regions.size()]));
  state.counters["runs"] = static_cast<double>(masks.regions[0].runs().size());
  set_label(state);
}

void BM_OurComponents(benchmark::State& state) {
  const Masks& masks = carpet(static_cast<int>(state.range(0)));
  std::size_t next = 0, runs = 0;
  for (auto _ : state) {
    const Region& region = masks.regions[next++ % masks.regions.size()];
    benchmark::DoNotOptimize(component_features(region));
    runs += region.runs().size();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(runs));  // runs a second
  set_label(state);
}

#ifdef TASSILO_BENCH_OPENCV
cv::Mat mat_of(const Masks& masks, std::size_t i) {
  return {masks.box.height(), masks.box.width(), CV_8UC1, const_cast<std::uint8_t*>(masks.bytes[i].data())};
}
cv::Mat element_of(const Region& element) {
  // Symmetric elements, so that the anchor in the middle is the origin.
  const PixelBox box = bounding_box(element);
  cv::Mat mat(box.height(), box.width(), CV_8UC1);
  const auto bytes = to_mask(element, box, 1);
  std::copy(bytes.begin(), bytes.end(), mat.data);
  return mat;
}

void BM_OpenCv(benchmark::State& state, const Task* task) {
  cv::setNumThreads(1);
  const Masks& masks = carpet(static_cast<int>(state.range(0)));
  const cv::Mat element = element_of(task->element);
  cv::Mat to;
  const auto run = [&](std::size_t i) {
    // The outside is background, as for us.
    if (task->opens)
      cv::morphologyEx(mat_of(masks, i), to, cv::MORPH_OPEN, element, {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
    else
      cv::dilate(mat_of(masks, i), to, element, {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  };
  for (std::size_t i = 0; i < masks.regions.size(); ++i) {
    run(i);
    const Region ours = clipped((*task)(masks.regions[i]), masks.box);
    expects(region_where({to.data, to.cols, to.rows, static_cast<std::ptrdiff_t>(to.step)},
                         [](int byte) { return byte != 0; }) == ours,
            "OpenCV finds the same region");
  }
  std::size_t next = 0;
  for (auto _ : state) run(next++ % masks.regions.size());
  set_label(state);
}

void BM_OpenCvComponents(benchmark::State& state) {
  cv::setNumThreads(1);
  const Masks& masks = carpet(static_cast<int>(state.range(0)));
  cv::Mat labels, stats, centers;
  std::size_t next = 0;
  for (std::size_t i = 0; i < masks.regions.size(); ++i)
    expects(cv::connectedComponentsWithStats(mat_of(masks, i), labels, stats, centers, 8) - 1 ==
                static_cast<int>(component_features(masks.regions[i]).size()),
            "OpenCV finds as many components");
  for (auto _ : state)
    cv::connectedComponentsWithStats(mat_of(masks, next++ % masks.regions.size()), labels, stats, centers, 8);
  set_label(state);
}

/// What many write: convert to HSV, then for each of eight colors threshold, open, label.
void BM_OpenCvChain(benchmark::State& state) {
  cv::setNumThreads(1);
  const BenchFrames& frames = bench_frames(static_cast<int>(state.range(0)));
  const int width = frames.width(), height = frames.height();
  std::vector<cv::Mat> images;
  for (const Frame& frame : frames.frames) {
    cv::Mat yuyv(height, width, CV_8UC2);
    for (int r = 0; r < height; ++r)
      for (int c = 0; c < width; ++c)
        yuyv.at<cv::Vec2b>(r, c) = {frame.view.y(c, r), c % 2 == 0 ? frame.view.u(c, r) : frame.view.v(c, r)};
    images.push_back(yuyv);
  }
  const cv::Mat element = cv::Mat::ones(3, 3, CV_8UC1);
  cv::Mat bgr, hsv, mask, opened, labels, stats, centers;
  std::size_t next = 0;
  for (auto _ : state) {
    cv::cvtColor(images[next++ % images.size()], bgr, cv::COLOR_YUV2BGR_YUYV);
    cv::cvtColor(bgr, hsv, cv::COLOR_BGR2HSV);
    for (int color = 0; color < 8; ++color) {
      cv::inRange(hsv, cv::Scalar(color * 22, 60, 40), cv::Scalar(color * 22 + 22, 255, 255), mask);
      cv::morphologyEx(mask, opened, cv::MORPH_OPEN, element);
      cv::connectedComponentsWithStats(opened, labels, stats, centers, 8);
    }
  }
  set_label(state);
}

/// What an expert writes who has the labels already: for each class compare, open, follow contours.
void BM_OpenCvExpertChain(benchmark::State& state) {
  cv::setNumThreads(1);
  const BenchFrames& frames = bench_frames(static_cast<int>(state.range(0)));
  std::vector<Segmentation> segmented;
  for (const Frame& frame : frames.frames) segmented.push_back(segment(frame.view, frames.classifier));
  const cv::Mat element = cv::Mat::ones(3, 3, CV_8UC1);
  cv::Mat mask, opened;
  std::vector<std::vector<cv::Point>> contours;
  std::size_t next = 0;
  for (auto _ : state) {
    Segmentation& labels = segmented[next++ % segmented.size()];
    const cv::Mat image(labels.height, labels.width, CV_8UC1, labels.labels.data());
    for (int color = 1; color <= 8; ++color) {
      cv::compare(image, color, mask, cv::CMP_EQ);
      cv::morphologyEx(mask, opened, cv::MORPH_OPEN, element);
      cv::findContours(opened, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_SIMPLE);
      for (const auto& contour : contours) benchmark::DoNotOptimize(cv::boundingRect(contour));
    }
  }
  set_label(state);
}
#endif

#ifdef TASSILO_BENCH_LEPTONICA
struct PixDelete {
  void operator()(PIX* pix) const { pixDestroy(&pix); }
};
using Pix = std::unique_ptr<PIX, PixDelete>;

void BM_Leptonica(benchmark::State& state, const Task* task) {
  const Masks& masks = carpet(static_cast<int>(state.range(0)));
  std::vector<Pix> images;
  for (const Region& region : masks.regions) {
    images.emplace_back(pixCreate(masks.box.width(), masks.box.height(), 1));
    for (const PixelRun& run : region.runs())
      for (int c = run.begin; c < run.end; ++c) pixSetPixel(images.back().get(), c, run.row, 1);
  }
  const PixelBox box = bounding_box(task->element);
  const auto bytes = to_mask(task->element, box, 1);
  SEL* sel = selCreate(box.height(), box.width(), "element");
  selSetOrigin(sel, -box.y0, -box.x0);
  for (int r = 0; r < box.height(); ++r)
    for (int c = 0; c < box.width(); ++c)
      selSetElement(sel, r, c, bytes[static_cast<std::size_t>(r * box.width() + c)] ? SEL_HIT : SEL_DONT_CARE);
  const bool brick = area(task->element) == box.area();
  std::size_t next = 0;
  for (auto _ : state) {
    PIX* from = images[next++ % images.size()].get();
    const Pix to(brick         ? pixOpenBrick(nullptr, from, box.width(), box.height())
                 : task->opens ? pixOpen(nullptr, from, sel)
                               : pixDilate(nullptr, from, sel));
    benchmark::DoNotOptimize(to.get());
  }
  selDestroy(&sel);
  set_label(state);
}
#endif

void register_all() {
  const auto at_sizes = [](const std::string& name, auto... what) {
    // 640x480 and 1920x1080
    benchmark::RegisterBenchmark(name.c_str(), what...)->Arg(3)->Arg(5)->Unit(benchmark::kMicrosecond);
  };
  for (const Task& task : tasks()) {
    for (const Kernel kernel : supported_kernels())
      at_sizes(task.name + "/" + std::string(to_string(kernel)), BM_Ours, &task, kernel);
#ifdef TASSILO_BENCH_OPENCV
    at_sizes(task.name + "/opencv", BM_OpenCv, &task);
#endif
#ifdef TASSILO_BENCH_LEPTONICA
    at_sizes(task.name + "/leptonica", BM_Leptonica, &task);
#endif
  }
  at_sizes("components/ours", BM_OurComponents);
#ifdef TASSILO_BENCH_OPENCV
  at_sizes("components/opencv", BM_OpenCvComponents);
  at_sizes("chain/opencv", BM_OpenCvChain);
  at_sizes("chain/opencv_expert", BM_OpenCvExpertChain);
#endif
}

}  // namespace
}  // namespace tassilo

int main(int argc, char** argv) {
  tassilo::register_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
