#pragma once

#include <array>
#include <optional>
#include <span>

#include "tassilo/color/segment.h"
#include "tassilo/color/train.h"

namespace tassilo {

/// How well a table names pixels whose class is known.
struct ColorQuality {
  /// confusion[true][found], labels 0..8. [px]
  std::array<std::array<std::int64_t, kColorClassCount + 1>, kColorClassCount + 1> confusion{};
  /// overlap[a][b]: pixels of true class a that class b claims, too, whatever the priority decides. [px]
  std::array<std::array<std::int64_t, kColorClassCount + 1>, kColorClassCount + 1> overlap{};

  std::int64_t pixels(ColorClass color) const;
  std::optional<double> recall(ColorClass color) const;     ///< Nothing where the class has no pixels.
  std::optional<double> precision(ColorClass color) const;  ///< Nothing where the class was never found.
};

/// Adds the verdict of a table over samples to `quality`. O(pixels).
void add_quality(ColorQuality& quality, const Classifier& classifier, std::span<const ColorSample> samples);

/// Quality on pixels the table was not trained with: each of up to five folds of sample groups is held out once, and
/// tables trained from the others judge it. With a single group the samples themselves are dealt out to the folds.
/// Samples of a class of which the others have none are not counted: they tell nothing about the class. Throws Error
/// when options are out of range. Costs up to five trainings.
ColorQuality cross_validate(const std::vector<ColorSample>& samples, ColorRange range,
                            const TrainingOptions& options = {});

}  // namespace tassilo
