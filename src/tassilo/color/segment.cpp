#include "tassilo/color/segment.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "tassilo/base/contract.h"
#include "tassilo/color/internal/color_kernel.h"
#include "tassilo/color/internal/run_sinks.h"

namespace tassilo {

Classifier::Classifier(const ColorTable& table)
    : table_(std::make_shared<const ColorTable>(table)), kernel_table_(std::make_shared<const KernelTable>(table)) {}

ColorClass Classifier::operator()(int y, int u, int v) const {
  const KernelTable& table = *kernel_table_;
  return static_cast<ColorClass>(
      table.label(table.chroma[static_cast<std::size_t>(v * 256 + u)], static_cast<std::uint8_t>(y)));
}

Segmentation segment(const FrameView& frame, const Classifier& classifier, Segmentation recycled) {
  expects(frame.width() <= 32767 && frame.height() <= 32767, "run coordinates fit 16 bit");
  const ColorKernel& kernel = color_kernel(kernel_in_use());
  const KernelTable& table = classifier.kernel_table();
  const auto width = static_cast<std::size_t>(frame.width());
  const int pairs = (frame.width() + 1) / 2;
  recycled.width = frame.width();
  recycled.height = frame.height();
  recycled.labels.resize(width * static_cast<std::size_t>(frame.height()));
  RunSinks sinks(recycled);
  RecycledBuffer<std::uint8_t> claims(static_cast<std::size_t>(pairs));
  const std::uint8_t* chroma_of_claims = nullptr;
  for (int r = 0; r < frame.height(); ++r) {
    const YuvRow row = frame.row(r);
    // With halved chroma rows two rows share their claims.
    if (row.u != chroma_of_claims) kernel.claims(table, row, pairs, claims.data());
    chroma_of_claims = row.u;
    std::uint8_t* labels = recycled.labels.data() + static_cast<std::size_t>(r) * width;
    kernel.labels(table, claims.data(), row, frame.width(), labels);
    sinks.add_row(kernel, r, labels);
  }
  std::move(sinks).finish(recycled);
  return recycled;
}

}  // namespace tassilo
