#include "tassilo/color/segment.h"

#include "tassilo/base/contract.h"

namespace tassilo {

Classifier::Classifier(const ColorTable& table) : table_(std::make_shared<const ColorTable>(table)) {
  for (int y = 0; y < 256; ++y)
    for (const ColorClass color : kColorClasses)
      if (table.brightness[static_cast<std::size_t>(class_index(color))].contains(y))
        bright_[static_cast<std::size_t>(y)] |= class_bit(color);
  for (int claims = 1; claims < 256; ++claims)
    for (const ColorClass color : table.priority)
      if ((claims & class_bit(color)) != 0) {
        winner_[static_cast<std::size_t>(claims)] = static_cast<std::uint8_t>(color);
        break;
      }
}

void Classifier::row(const YuvRow& row, std::span<std::uint8_t> labels) const {
  const int width = static_cast<int>(labels.size());
  const ClassBits* chroma = table_->chroma.data();
  const auto label = [&](ClassBits claims, int c) { return winner_[claims & bright_[row.y[c * row.y_step]]]; };
  for (int c = 0; c + 1 < width; c += 2) {
    const int k = (c / 2) * row.chroma_step;
    const ClassBits claims = chroma[row.v[k] * 256 + row.u[k]];
    labels[static_cast<std::size_t>(c)] = label(claims, c);
    labels[static_cast<std::size_t>(c) + 1] = label(claims, c + 1);
  }
  if (width % 2 == 1) {
    const int k = (width / 2) * row.chroma_step;
    labels.back() = label(chroma[row.v[k] * 256 + row.u[k]], width - 1);
  }
}

Segmentation segment(const FrameView& frame, const Classifier& classifier, Segmentation recycled) {
  expects(frame.width() <= 32767 && frame.height() <= 32767, "run coordinates fit 16 bit");
  std::array<RunVector, kColorClassCount> runs;
  for (int k = 0; k < kColorClassCount; ++k) {
    runs[static_cast<std::size_t>(k)] = recycled.regions[static_cast<std::size_t>(k)].take_runs();
    runs[static_cast<std::size_t>(k)].clear();
  }
  const auto width = static_cast<std::size_t>(frame.width());
  recycled.labels.resize(width * static_cast<std::size_t>(frame.height()));
  for (int r = 0; r < frame.height(); ++r) {
    const std::span labels = std::span(recycled.labels).subspan(static_cast<std::size_t>(r) * width, width);
    classifier.row(frame.row(r), labels);
    for (std::size_t c = 0; c < labels.size();) {
      const std::uint8_t label = labels[c];
      std::size_t end = c + 1;
      while (end < labels.size() && labels[end] == label) ++end;
      if (label != 0)
        runs[label - 1u].push_back(
            {static_cast<std::int16_t>(r), static_cast<std::int16_t>(c), static_cast<std::int16_t>(end)});
      c = end;
    }
  }
  recycled.width = frame.width();
  recycled.height = frame.height();
  for (std::size_t k = 0; k < runs.size(); ++k) recycled.regions[k] = Region::from_sorted(std::move(runs[k]));
  return recycled;
}

}  // namespace tassilo
