// How long do morphology and components of one dense class take, for each kernel, beside OpenCV's, those of its run
// lengths (ximgproc::rl) and Leptonica's, where installed? And the whole chain, frame -> 8 classes -> opened ->
// components with area, centre and box, beside OpenCV's? The carpet in recordings and in a painted noisy scene of four
// sizes, frames cycled. Before any time counts all regions are compared pixel by pixel, and of all components area,
// centre and box. Runs in, runs out for ours and ximgproc::rl, masks in, masks out for the others.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bench.h"
#include "references.h"
#include "support/bench_frames.h"
#include "tassilo/base/contract.h"
#include "tassilo/base/kernel.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/components.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/raster.h"

namespace tassilo::bench {
namespace {

using test::bench_frames;
using test::BenchFrames;

/// One class of every frame.
struct Masks {
  std::string name;
  PixelBox box;
  std::vector<Region> regions;
};
const Masks& carpet(const benchmark::State& state) {
  static std::map<int, Masks> made;
  const int index = static_cast<int>(state.range(0));
  if (const auto it = made.find(index); it != made.end()) return it->second;
  const BenchFrames& frames = bench_frames(index);
  Masks masks{frames.name, {0, 0, frames.width(), frames.height()}, {}};
  for (const Frame& frame : frames.frames)
    masks.regions.push_back(segment(frame.view, frames.classifier).of(ColorClass::green));
  return made[index] = std::move(masks);
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

/// Theirs(k) must be the task of mask k, as far as the image reaches.
template <class Theirs>
void compare(const benchmark::State& state, const std::string& name, const Task& task, Theirs theirs) {
  once(task.name + name + std::to_string(state.range(0)), [&] {
    const Masks& masks = carpet(state);
    for (std::size_t k = 0; k < masks.regions.size(); ++k)
      expects(theirs(k) == clipped(task(masks.regions[k]), masks.box), "the other library finds the same region");
  });
}

void report_runs(benchmark::State& state, const Masks& masks) {
  std::size_t runs = 0;
  for (const Region& region : masks.regions) runs += region.runs().size();
  const double a_mask = static_cast<double>(runs) / static_cast<double>(masks.regions.size());
  state.counters["runs"] = a_mask;
  state.counters["ns_a_run"] = 1e3 * state.counters["us"] / a_mask;
  state.SetItemsProcessed(static_cast<std::int64_t>(static_cast<double>(state.iterations()) * a_mask));
  state.SetLabel(masks.name);
}

void ours(benchmark::State& state, const Task& task, Kernel kernel) {
  const Masks& masks = carpet(state);
  once(task.name + std::string(to_string(kernel)) + std::to_string(state.range(0)), [&] {
    for (const Region& region : masks.regions) {
      use_kernel(Kernel::plain);
      const Region plain = task(region);
      use_kernel(kernel);
      expects(plain == task(region), "a kernel equals the plain one");
    }
  });
  use_kernel(kernel);
  measure(state, masks.regions.size(), [&](std::size_t k) { benchmark::DoNotOptimize(task(masks.regions[k])); });
  report_runs(state, masks);
}

void our_components(benchmark::State& state) {
  const Masks& masks = carpet(state);
  measure(state, masks.regions.size(),
          [&](std::size_t k) { benchmark::DoNotOptimize(component_features(masks.regions[k])); });
  report_runs(state, masks);
}

void our_chain(benchmark::State& state) {
  const BenchFrames& frames = bench_frames(static_cast<int>(state.range(0)));
  use_kernel(supported_kernels().back());
  Segmentation opened;
  measure(state, frames.frames.size(),
          [&](std::size_t k) { opened = chain(frames.frames[k], frames.classifier, std::move(opened)); });
  frames.report(state);
}

#if defined(TASSILO_BENCH_OPENCV) || defined(TASSILO_BENCH_LEPTONICA)

/// Components in an order that all libraries agree on.
void sort_components(RecycledVector<ComponentFeatures>& parts) {
  std::ranges::sort(parts, {}, [](const ComponentFeatures& part) {
    return std::tuple(part.box.y0, part.box.x0, part.box.y1, part.box.x1, part.area, part.center.x, part.center.y);
  });
}
/// A library that only tells the boxes leaves areas 0.
void expect_same(RecycledVector<ComponentFeatures> theirs, RecycledVector<ComponentFeatures> ours) {
  sort_components(theirs);
  sort_components(ours);
  expects(theirs.size() == ours.size(), "the other library finds as many components");
  for (std::size_t i = 0; i < ours.size(); ++i) {
    expects(theirs[i].box == ours[i].box, "the other library finds the same boxes");
    if (theirs[i].area == 0) continue;
    expects(theirs[i].area == ours[i].area && std::abs(theirs[i].center.x - ours[i].center.x) < 1e-6 &&
                std::abs(theirs[i].center.y - ours[i].center.y) < 1e-6,
            "the other library finds the same areas and centers");
  }
}

#endif
#ifdef TASSILO_BENCH_OPENCV

std::vector<cv::Mat> mats_of(const Masks& masks) {
  cv::setNumThreads(1);
  std::vector<cv::Mat> mats;
  for (const Region& region : masks.regions) mats.push_back(mat_of(region, masks.box));
  return mats;
}

void opencv(benchmark::State& state, const Task& task) {
  const Masks& masks = carpet(state);
  const std::vector<cv::Mat> mats = mats_of(masks);
  const CvElement element(task.element);
  cv::Mat to;
  // The outside is background, as for us.
  const auto run = [&](std::size_t k) {
    if (task.opens)
      cv::morphologyEx(mats[k], to, cv::MORPH_OPEN, element.mat, element.anchor, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
    else
      cv::dilate(mats[k], to, element.mat, element.anchor, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  };
  compare(state, "opencv", task, [&](std::size_t k) {
    run(k);
    return region_of(to);
  });
  measure(state, mats.size(), run);
  report_runs(state, masks);
}

void opencv_components(benchmark::State& state) {
  const Masks& masks = carpet(state);
  const std::vector<cv::Mat> mats = mats_of(masks);
  cv::Mat labels, stats, centers;
  const auto run = [&](std::size_t k) { cv::connectedComponentsWithStats(mats[k], labels, stats, centers, 8); };
  once("components/opencv" + std::to_string(state.range(0)), [&] {
    for (std::size_t k = 0; k < mats.size(); ++k) {
      run(k);
      RecycledVector<ComponentFeatures> theirs;
      for (int i = 1; i < stats.rows; ++i) {  // 0 is the background
        const int* const stat = stats.ptr<int>(i);
        const int x = stat[cv::CC_STAT_LEFT], y = stat[cv::CC_STAT_TOP];
        theirs.push_back({stat[cv::CC_STAT_AREA],
                          {centers.at<double>(i, 0), centers.at<double>(i, 1)},
                          {x, y, x + stat[cv::CC_STAT_WIDTH], y + stat[cv::CC_STAT_HEIGHT]}});
      }
      expect_same(std::move(theirs), component_features(masks.regions[k]));
    }
  });
  measure(state, mats.size(), run);
  report_runs(state, masks);
}

/// What many write: convert to HSV, then for each of eight colors threshold, open, label. Its classes are others than
/// ours, so only the time can be compared.
void opencv_chain(benchmark::State& state) {
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
  measure(state, images.size(), [&](std::size_t k) {
    cv::cvtColor(images[k], bgr, cv::COLOR_YUV2BGR_YUYV);
    cv::cvtColor(bgr, hsv, cv::COLOR_BGR2HSV);
    for (int color = 0; color < 8; ++color) {
      cv::inRange(hsv, cv::Scalar(color * 22, 60, 40), cv::Scalar(color * 22 + 22, 255, 255), mask);
      cv::morphologyEx(mask, opened, cv::MORPH_OPEN, element);
      cv::connectedComponentsWithStats(opened, labels, stats, centers, 8);
    }
  });
  frames.report(state);
}

/// What an expert writes who has the labels already: for each class compare, open, follow contours.
void opencv_expert_chain(benchmark::State& state) {
  cv::setNumThreads(1);
  const BenchFrames& frames = bench_frames(static_cast<int>(state.range(0)));
  std::vector<Segmentation> segmented;
  for (const Frame& frame : frames.frames) segmented.push_back(segment(frame.view, frames.classifier));
  const cv::Mat element = cv::Mat::ones(3, 3, CV_8UC1);
  cv::Mat mask, opened;
  std::vector<std::vector<cv::Point>> contours;
  const auto open = [&](std::size_t k, int color) {
    Segmentation& labels = segmented[k];
    cv::compare(cv::Mat(labels.height, labels.width, CV_8UC1, labels.labels.data()), color, mask, cv::CMP_EQ);
    cv::morphologyEx(mask, opened, cv::MORPH_OPEN, element, {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  };
  once("chain/opencv_expert" + std::to_string(state.range(0)), [&] {
    for (std::size_t k = 0; k < segmented.size(); ++k) {
      const Segmentation ours = segment_opened(frames.frames[k].view, frames.classifier);
      for (const ColorClass color : kColorClasses) {
        open(k, class_index(color) + 1);
        expects(region_of(opened) == ours.of(color), "OpenCV finds the same opened class");
      }
    }
  });
  measure(state, segmented.size(), [&](std::size_t k) {
    for (int color = 1; color <= kColorClassCount; ++color) {
      open(k, color);
      cv::findContours(opened, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_SIMPLE);
      for (const auto& contour : contours) benchmark::DoNotOptimize(cv::boundingRect(contour));
    }
  });
  frames.report(state);
}

#endif
#ifdef TASSILO_BENCH_XIMGPROC

void ximgproc(benchmark::State& state, const Task& task) {
  const Masks& masks = carpet(state);
  const cv::Size size(masks.box.width(), masks.box.height());
  std::vector<cv::Mat> images;
  for (const Region& region : masks.regions) images.push_back(rl_of(region, size));
  const cv::Mat element = rl_of(task.element, {});
  expects(cv::ximgproc::rl::isRLMorphologyPossible(element), "ximgproc::rl can work with the element");
  cv::Mat eroded, to;
  const auto run = [&](std::size_t k) {
    if (task.opens) cv::ximgproc::rl::erode(images[k], eroded, element, false);
    cv::ximgproc::rl::dilate(task.opens ? eroded : images[k], to, element);
  };
  compare(state, "ximgproc_rl", task, [&](std::size_t k) {
    run(k);
    return region_of_rl(to, size);
  });
  measure(state, images.size(), run);
  report_runs(state, masks);
}

#endif
#ifdef TASSILO_BENCH_LEPTONICA

std::vector<Pix> pixes_of(const Masks& masks) {
  std::vector<Pix> pixes;
  for (const Region& region : masks.regions) pixes.push_back(pix_of(region, masks.box));
  return pixes;
}

void leptonica(benchmark::State& state, const Task& task) {
  const Masks& masks = carpet(state);
  const std::vector<Pix> pixes = pixes_of(masks);
  const PixelBox box = bounding_box(task.element);
  const Sel sel = sel_of(task.element);
  const bool brick = area(task.element) == box.area();
  const auto run = [&](std::size_t k) {
    PIX* const from = pixes[k].get();
    return Pix(brick        ? pixOpenBrick(nullptr, from, box.width(), box.height())
               : task.opens ? pixOpen(nullptr, from, sel.get())
                            : pixDilate(nullptr, from, sel.get()));
  };
  compare(state, "leptonica", task, [&](std::size_t k) { return region_of(run(k).get()); });
  measure(state, pixes.size(), [&](std::size_t k) { benchmark::DoNotOptimize(run(k).get()); });
  report_runs(state, masks);
}

/// Boxes only.
void leptonica_components(benchmark::State& state) {
  const Masks& masks = carpet(state);
  const std::vector<Pix> pixes = pixes_of(masks);
  const auto run = [&](std::size_t k) { return Boxa(pixConnCompBB(pixes[k].get(), 8)); };
  once("components/leptonica" + std::to_string(state.range(0)), [&] {
    for (std::size_t k = 0; k < pixes.size(); ++k) {
      const Boxa boxes = run(k);
      RecycledVector<ComponentFeatures> theirs, ours = component_features(masks.regions[k]);
      for (int i = 0; i < boxaGetCount(boxes.get()); ++i) {
        int x = 0, y = 0, width = 0, height = 0;
        boxaGetBoxGeometry(boxes.get(), i, &x, &y, &width, &height);
        theirs.push_back({0, {}, {x, y, x + width, y + height}});
      }
      expect_same(std::move(theirs), std::move(ours));
    }
  });
  measure(state, pixes.size(), [&](std::size_t k) { benchmark::DoNotOptimize(run(k).get()); });
  report_runs(state, masks);
}

#endif

}  // namespace

void register_benchmarks() {
  const std::vector<int> frames{0, 1, 2, 3, 4, 5};
  add_yardsticks(frames);
  for (const Task& task : tasks()) {
    for (const Kernel kernel : supported_kernels())
      add(task.name + "/" + std::string(to_string(kernel)), frames,
          [&task, kernel](benchmark::State& state) { ours(state, task, kernel); });
#ifdef TASSILO_BENCH_OPENCV
    add(task.name + "/opencv", frames, [&task](benchmark::State& state) { opencv(state, task); });
#endif
#ifdef TASSILO_BENCH_XIMGPROC
    add(task.name + "/ximgproc_rl", frames, [&task](benchmark::State& state) { ximgproc(state, task); });
#endif
#ifdef TASSILO_BENCH_LEPTONICA
    add(task.name + "/leptonica", frames, [&task](benchmark::State& state) { leptonica(state, task); });
#endif
  }
  add("components/ours", frames, our_components);
  add("chain/ours", frames, our_chain);
#ifdef TASSILO_BENCH_OPENCV
  add("components/opencv", frames, opencv_components);
  add("chain/opencv", frames, opencv_chain);
  add("chain/opencv_expert", frames, opencv_expert_chain);
#endif
#ifdef TASSILO_BENCH_LEPTONICA
  add("components/leptonica", frames, leptonica_components);
#endif
}

}  // namespace tassilo::bench
