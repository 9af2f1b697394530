#include "tassilo/color/segment.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "tassilo/base/contract.h"
#include "tassilo/color/internal/color_kernel.h"
#include "tassilo/color/internal/run_sinks.h"

namespace tassilo {
namespace {

/// The labels of a frame's rows, one after the other from the top.
class RowLabeler {
 public:
  RowLabeler(const FrameView& frame, const Classifier& classifier, const ColorKernel& kernel)
      : frame_(frame),
        table_(classifier.kernel_table()),
        kernel_(kernel),
        claims_(static_cast<std::size_t>(frame.width() + 1) / 2) {}

  /// Returns the number of runs, which are left out where `runs` is null.
  int operator()(int r, std::uint8_t* labels, const RowRuns* runs) {
    const YuvRow row = frame_.row(r);
    // With halved chroma rows two rows share their claims.
    if (row.u != claimed_u_ || row.v != claimed_v_)
      kernel_.claims(table_, row, (frame_.width() + 1) / 2, claims_.data());
    claimed_u_ = row.u;
    claimed_v_ = row.v;
    return kernel_.labels(table_, claims_.data(), row, frame_.width(), labels, runs);
  }

 private:
  const FrameView& frame_;
  const KernelTable& table_;
  const ColorKernel& kernel_;
  RecycledBuffer<std::uint8_t> claims_;
  const std::uint8_t *claimed_u_ = nullptr, *claimed_v_ = nullptr;  ///< Chroma row that the claims are of.
};

void set_size(Segmentation& segmentation, int width, int height) {
  segmentation.width = width;
  segmentation.height = height;
  segmentation.labels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
}

std::uint8_t* row_of(Segmentation& segmentation, int r) {
  return segmentation.labels.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(segmentation.width);
}

/// Opens the labels that labels_of(r) points to, asked for once a row from the top; they must last for three rows.
///
/// Labels stay labels: the erosion keeps one where nine neighbors share it. In the opening a pixel belongs to a square
/// of equal labels, two squares of different ones have no pixel in common, so the dilation meets one label and no_color
/// only.
template <class LabelsOf>
void open_rows(Segmentation& opened, RunSinks& sinks, const ColorKernel& kernel, LabelsOf labels_of) {
  const auto width = static_cast<std::size_t>(opened.width);
  const int height = opened.height;
  const RecycledVector<std::uint8_t> outside(width);
  std::array<RecycledVector<std::uint8_t>, 3> eroded;  // rows r - 1, r and r + 1, at their number modulo 3
  eroded.fill(outside);
  const auto eroded_row = [&](int r) { return eroded[static_cast<std::size_t>((r + 3) % 3)].data(); };
  ThreeRows rows{outside.data(), outside.data(), height > 0 ? labels_of(0) : outside.data()};
  for (int r = 0; r < height; ++r) {
    rows = {rows.here, rows.below, r + 1 < height ? labels_of(r + 1) : outside.data()};
    // Of the first and the last row nothing is left: what lies outside is background.
    if (r > 0) {
      kernel.erode(rows, opened.width, eroded_row(r));
      sinks.add_row(r - 1, kernel.dilate({eroded_row(r - 2), eroded_row(r - 1), eroded_row(r)}, opened.width,
                                         row_of(opened, r - 1), sinks.row_runs()));
    }
  }
  if (height > 0) {
    std::ranges::fill(eroded[static_cast<std::size_t>(height % 3)], std::uint8_t{0});
    sinks.add_row(height - 1, kernel.dilate({eroded_row(height - 2), eroded_row(height - 1), eroded_row(height)},
                                            opened.width, row_of(opened, height - 1), sinks.row_runs()));
  }
}

}  // namespace

Classifier::Classifier(const ColorTable& table)
    : table_(std::make_shared<const ColorTable>(table)), kernel_table_(std::make_shared<const KernelTable>(table)) {}

ColorClass Classifier::operator()(int y, int u, int v) const {
  const KernelTable& table = *kernel_table_;
  const std::uint8_t claims = table.chroma[static_cast<std::size_t>(v * 256 + u)];
  return static_cast<ColorClass>(table.label(claims, static_cast<std::uint8_t>(y)));
}

Segmentation segment(const FrameView& frame, const Classifier& classifier, Segmentation recycled) {
  expects(frame.width() <= 32767 && frame.height() <= 32767, "run coordinates fit 16 bit");
  set_size(recycled, frame.width(), frame.height());
  RunSinks sinks(recycled);
  RowLabeler label(frame, classifier, version_in_use(color_kernels()));
  const RowRuns runs = sinks.row_runs();
  for (int r = 0; r < frame.height(); ++r) sinks.add_row(r, label(r, row_of(recycled, r), &runs));
  std::move(sinks).finish(recycled);
  return recycled;
}

Segmentation segment_opened(const FrameView& frame, const Classifier& classifier, Segmentation recycled) {
  expects(frame.width() <= 32767 && frame.height() <= 32767, "run coordinates fit 16 bit");
  set_size(recycled, frame.width(), frame.height());
  RunSinks sinks(recycled);
  const ColorKernel& kernel = version_in_use(color_kernels());
  RowLabeler label(frame, classifier, kernel);
  RecycledBuffer<std::uint8_t> rows(3 * static_cast<std::size_t>(frame.width()));
  open_rows(recycled, sinks, kernel, [&](int r) {
    std::uint8_t* labels = rows.data() + static_cast<std::ptrdiff_t>(r % 3) * frame.width();
    label(r, labels, nullptr);
    return labels;
  });
  std::move(sinks).finish(recycled);
  return recycled;
}

Segmentation opening3x3(const Segmentation& segmentation, Segmentation recycled) {
  const auto width = static_cast<std::size_t>(segmentation.width);
  expects(segmentation.labels.size() == width * static_cast<std::size_t>(segmentation.height), "one label a pixel");
  set_size(recycled, segmentation.width, segmentation.height);
  RunSinks sinks(recycled);
  open_rows(recycled, sinks, version_in_use(color_kernels()),
            [&](int r) { return segmentation.labels.data() + static_cast<std::size_t>(r) * width; });
  std::move(sinks).finish(recycled);
  return recycled;
}

}  // namespace tassilo
