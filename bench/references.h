#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "tassilo/geometry/box.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/raster.h"
#include "tassilo/region/region.h"

#ifdef TASSILO_BENCH_OPENCV
#include <opencv2/imgproc.hpp>
#endif
#ifdef TASSILO_BENCH_XIMGPROC
#include <opencv2/ximgproc.hpp>
#include <opencv2/ximgproc/run_length_morphology.hpp>
#endif
#ifdef TASSILO_BENCH_LEPTONICA
#include <allheaders.h>
#endif

// Regions as other libraries take them, and back; each where it was installed when the benchmarks were built.

namespace tassilo::bench {

#ifdef TASSILO_BENCH_OPENCV

/// The window's pixels, 255 in the region.
inline cv::Mat mat_of(const Region& region, const PixelBox& window, std::uint8_t inside = 255) {
  cv::Mat mat(window.height(), window.width(), CV_8U);
  const std::vector<std::uint8_t> bytes = to_mask(region, window, inside);
  std::copy(bytes.begin(), bytes.end(), mat.data);
  return mat;
}
/// The pixels of a mask that are not 0; its first one is (0, 0).
inline Region region_of(const cv::Mat& mask) {
  return region_where({mask.data, mask.cols, mask.rows, static_cast<std::ptrdiff_t>(mask.step[0])},
                      [](int byte) { return byte != 0; });
}
/// A structuring element and where its origin is.
struct CvElement {
  cv::Mat mat;
  cv::Point anchor;

  explicit CvElement(const Region& element)
      : mat(mat_of(element, bounding_box(element), 1)), anchor(-bounding_box(element).x0, -bounding_box(element).y0) {}
};

#endif
#ifdef TASSILO_BENCH_XIMGPROC

/// As cv::ximgproc::rl has it: columns of runs are inclusive there. An element has the size {0, 0}.
inline cv::Mat rl_of(const Region& region, cv::Size size) {
  std::vector<cv::Point3i> runs;
  for (const PixelRun& run : region.runs()) runs.emplace_back(run.begin, run.end - 1, run.row);
  cv::Mat rl;
  cv::ximgproc::rl::createRLEImage(runs, rl, size);
  return rl;
}
inline Region region_of_rl(const cv::Mat& rl, cv::Size size) {
  cv::Mat mask = cv::Mat::zeros(size, CV_8U);
  cv::ximgproc::rl::paint(mask, rl, cv::Scalar(255));
  return region_of(mask);
}

#endif
#ifdef TASSILO_BENCH_LEPTONICA

struct LeptonicaDelete {
  void operator()(PIX* pix) const { pixDestroy(&pix); }
  void operator()(SEL* sel) const { selDestroy(&sel); }
  void operator()(BOXA* boxes) const { boxaDestroy(&boxes); }
  void operator()(BOX* box) const { boxDestroy(&box); }
  void operator()(NUMA* numbers) const { numaDestroy(&numbers); }
};
using Pix = std::unique_ptr<PIX, LeptonicaDelete>;
using Sel = std::unique_ptr<SEL, LeptonicaDelete>;
using Boxa = std::unique_ptr<BOXA, LeptonicaDelete>;

inline Pix pix_of(const Region& region, const PixelBox& window) {
  Pix pix(pixCreate(window.width(), window.height(), 1));
  const Region inside = clipped(region, window);
  for (const PixelRun& run : inside.runs())
    for (int c = run.begin; c < run.end; ++c) pixSetPixel(pix.get(), c - window.x0, run.row - window.y0, 1);
  return pix;
}
/// The pixels that are 1; the first one is (0, 0).
inline Region region_of(PIX* pix) {
  RunVector runs;
  for (int r = 0; r < pixGetHeight(pix); ++r)
    for (int c = 0; c < pixGetWidth(pix); ++c) {
      l_uint32 value = 0;
      pixGetPixel(pix, c, r, &value);
      if (value != 0)
        runs.push_back({static_cast<std::int16_t>(r), static_cast<std::int16_t>(c), static_cast<std::int16_t>(c + 1)});
    }
  return Region::from_runs(std::move(runs));
}
/// `hit` must be set, `miss` must not be.
inline Sel sel_of(const Region& hit, const Region& miss = {}) {
  const PixelBox box = bounding_box(union_of(hit, miss));
  Sel sel(selCreate(box.height(), box.width(), "element"));
  selSetOrigin(sel.get(), -box.y0, -box.x0);
  for (int r = 0; r < box.height(); ++r)
    for (int c = 0; c < box.width(); ++c) {
      const int x = box.x0 + c, y = box.y0 + r;
      selSetElement(sel.get(), r, c, contains(hit, x, y) ? SEL_HIT : contains(miss, x, y) ? SEL_MISS : SEL_DONT_CARE);
    }
  return sel;
}

#endif

}  // namespace tassilo::bench
