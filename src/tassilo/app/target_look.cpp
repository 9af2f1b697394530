#include "tassilo/app/target_look.h"

#include <fmt/core.h>

#include "tassilo/calibrate/find_target.h"

namespace tassilo {

GrayImage gray_of(const FrameView& view) {
  GrayImage gray{view.width(), view.height(), {}};
  gray.pixels.reserve(static_cast<std::size_t>(gray.width) * static_cast<std::size_t>(gray.height));
  for (int r = 0; r < gray.height; ++r)
    for (int c = 0; c < gray.width; ++c) gray.pixels.push_back(view.y(c, r));
  return gray;
}

TargetSearch find_any_target(const GrayImage& image, std::span<const Target> targets) {
  const ByteView view{image.pixels.data(), image.width, image.height, image.width};
  TargetSearch none;
  for (const Target& target : targets) {
    TargetSearch search = find_target(view, target);
    search.remarks.insert(search.remarks.begin(), none.remarks.begin(), none.remarks.end());
    if (search.view) return search;
    none.remarks = std::move(search.remarks);
    none.reason += fmt::format("{}no {}: {}", none.reason.empty() ? "" : "; ", to_text(target), search.reason);
  }
  return none;
}

}  // namespace tassilo
