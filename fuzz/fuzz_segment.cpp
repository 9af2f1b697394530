// Segmentation of a frame equals the definition, pixel by pixel, for any table, format and size, and for every kernel.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "bytes.h"
#include "tassilo/base/contract.h"
#include "tassilo/base/kernel.h"
#include "tassilo/color/color_table.h"
#include "tassilo/color/segment.h"
#include "tassilo/image/frame.h"

using namespace tassilo;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  ColorTable table;
  for (auto& interval : table.brightness) interval = {bytes.next(), bytes.next()};
  for (int boxes = bytes.below(12); boxes > 0; --boxes) {
    const int u0 = bytes.next(), v0 = bytes.next(), width = bytes.below(64), height = bytes.below(64);
    const ClassBits bits = bytes.next();
    for (int v = v0; v < std::min(v0 + height, 256); ++v)
      for (int u = u0; u < std::min(u0 + width, 256); ++u) table.cell(u, v) |= bits;
  }

  const PixelFormat formats[] = {PixelFormat::yuyv422, PixelFormat::uyvy422, PixelFormat::yuv422p, PixelFormat::yuv420p,
                                 PixelFormat::nv12};
  const PixelFormat format = formats[bytes.below(5)];
  const int width = bytes.below(150), height = bytes.below(6);
  const FrameBuffer buffer = make_frame_buffer(format, width, height, ColorRange::limited);
  const int rows[] = {height, format == PixelFormat::yuv422p ? height : (height + 1) / 2,
                      format == PixelFormat::yuv422p ? height : (height + 1) / 2};
  for (std::size_t plane = 0; plane < 3; ++plane) {
    if (!buffer.planes[plane]) continue;
    for (std::ptrdiff_t i = 0; i < buffer.strides[plane] * rows[plane]; ++i) buffer.planes[plane][i] = bytes.next();
  }

  const FrameView& view = buffer.frame.view;
  const Classifier classifier(table);
  const Segmentation segmentation = segment(view, classifier);
  const Segmentation opened = segment_opened(view, classifier);
  // Every other kernel says the same.
  const Kernel fastest = kernel_in_use();
  for (const Kernel kernel : supported_kernels()) {
    use_kernel(kernel);
    const Segmentation other = segment(view, classifier);
    expects(other.labels == segmentation.labels && other.regions == segmentation.regions, "kernels segment alike");
    const Segmentation other_opened = segment_opened(view, classifier);
    expects(other_opened.labels == opened.labels && other_opened.regions == opened.regions, "kernels open alike");
  }
  use_kernel(fastest);
  std::vector<ColorClass> labels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (const ColorClass color : kColorClasses) {
    for (const PixelRun& run : segmentation.of(color).runs()) {
      expects(run.row >= 0 && run.row < height && run.begin >= 0 && run.end <= width, "runs lie in the frame");
      for (int c = run.begin; c < run.end; ++c) {
        ColorClass& label = labels[static_cast<std::size_t>(run.row * width + c)];
        expects(label == ColorClass::no_color, "regions are disjoint");
        label = color;
      }
    }
  }
  for (int r = 0; r < height; ++r) {
    for (int c = 0; c < width; ++c) {
      const ColorClass label = labels[static_cast<std::size_t>(r * width + c)];
      expects(label == classify(table, view.y(c, r), view.u(c, r), view.v(c, r)), "segment is classify");
    }
  }
  return 0;
}
