#include "tassilo/color/quality.h"

#include <algorithm>
#include <numeric>
#include <set>

namespace tassilo {
namespace {

std::size_t label(ColorClass color) { return static_cast<std::size_t>(color); }

}  // namespace

std::int64_t ColorQuality::pixels(ColorClass color) const {
  const auto& row = confusion[label(color)];
  return std::accumulate(row.begin(), row.end(), std::int64_t{0});
}

std::optional<double> ColorQuality::recall(ColorClass color) const {
  const std::int64_t all = pixels(color);
  if (all == 0) return std::nullopt;
  return static_cast<double>(confusion[label(color)][label(color)]) / static_cast<double>(all);
}

std::optional<double> ColorQuality::precision(ColorClass color) const {
  std::int64_t found = 0;
  for (const auto& row : confusion) found += row[label(color)];
  if (found == 0) return std::nullopt;
  return static_cast<double>(confusion[label(color)][label(color)]) / static_cast<double>(found);
}

void add_quality(ColorQuality& quality, const Classifier& classifier, std::span<const ColorSample> samples) {
  const ColorTable& table = classifier.table();
  for (const ColorSample& sample : samples)
    for (const YuvPixel& p : sample.pixels) {
      ++quality.confusion[label(sample.color)][label(classifier(p.y, p.u, p.v))];
      const ClassBits bits = table.cell(p.u, p.v);
      for (const ColorClass other : kColorClasses)
        if (other != sample.color && (bits & class_bit(other)) != 0 &&
            table.brightness[static_cast<std::size_t>(class_index(other))].contains(p.y))
          ++quality.overlap[label(sample.color)][label(other)];
    }
}

ColorQuality cross_validate(const std::vector<ColorSample>& samples, ColorRange range, const TrainingOptions& options) {
  constexpr std::size_t most_folds = 5;
  std::set<int> groups;
  for (const ColorSample& sample : samples) groups.insert(sample.group);
  const bool by_group = groups.size() > 1;
  const std::vector<int> order(groups.begin(), groups.end());
  const std::size_t folds = std::min(most_folds, by_group ? order.size() : samples.size());
  const auto fold_of = [&](std::size_t i) {
    if (!by_group) return i % folds;
    return static_cast<std::size_t>(std::ranges::lower_bound(order, samples[i].group) - order.begin()) % folds;
  };
  ColorQuality quality;
  if (folds < 2) return quality;
  for (std::size_t fold = 0; fold < folds; ++fold) {
    std::vector<ColorSample> training, held_out;
    for (std::size_t i = 0; i < samples.size(); ++i) (fold_of(i) == fold ? held_out : training).push_back(samples[i]);
    std::erase_if(held_out, [&](const ColorSample& sample) {
      return sample.color != ColorClass::no_color &&
             std::ranges::find(training, sample.color, &ColorSample::color) == training.end();
    });
    add_quality(quality, Classifier(train_colors(training, range, options)), held_out);
  }
  return quality;
}

}  // namespace tassilo
