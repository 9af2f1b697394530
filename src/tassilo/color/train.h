#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "tassilo/color/color_table.h"
#include "tassilo/region/region.h"

namespace tassilo {

struct YuvPixel {
  std::uint8_t y = 0, u = 0, v = 0;
};

/// Pixels that a user said belong to one class, from one place of one image.
struct ColorSample {
  ColorClass color = ColorClass::no_color;
  int group = 0;  ///< Samples of one image share it; held out together when quality is measured.
  std::vector<YuvPixel> pixels;
};

/// The pixels of `region` that lie in the frame, row by row; empty when none does. O(pixels).
std::vector<YuvPixel> pixels_of(const FrameView& frame, const Region& region);

/// How samples become a table. Distances in the UV plane are in chroma quantization steps.
struct TrainingOptions {
  /// Share of a class's pixels that may be wrong or freak: the rarest cells of its UV histogram that together hold this
  /// share are dropped. [1], 0 .. .2
  double outlier_share = 0.002;
  /// Share of a class's pixels at either end of its brightness that are mixed with what lies beside, or in deep shade.
  /// [1], 0 .. .2
  double brightness_outlier_share = 0.02;
  /// A separate cluster of a class with a smaller share of its pixels is a slip of the hand. [1], 0 .. .5
  double min_cluster_share = 0.05;
  /// Side of the square that closes gaps between cells that were merely not drawn. [step], 1 .. 31
  int closing_px = 5;
  int opening_px = 3;  ///< Side of the square that removes single cells. [step], 1 .. 15
  /// Margin around the cluster: three standard deviations of chroma noise of an ordinary camera. [step], 0 .. 20
  double noise_margin = 3.0;
  /// Darkest shade that still counts: a colored surface in shade loses chroma and brightness in proportion.
  /// [1], .1 .. 1
  double darkest_shade = 0.45;
  /// Brightest light on the class relative to its samples. [1], 1 .. 2
  double brightest_light = 1.15;
  /// Between the brightest black and the darkest white lies gray that is neither (robots' gray parts, the hall): the
  /// share of this gap that white takes from above and black from below. [1], 0 .. .5
  double white_reach = 0.25, black_reach = 0.10;
  /// By class_index: brightness that the user set by hand, in place of the trained one. low <= high, in 0..255
  std::array<std::optional<BrightnessInterval>, kColorClassCount> brightness{};

  void check() const;  ///< Throws Error naming the first field out of range.
  friend bool operator==(const TrainingOptions&, const TrainingOptions&) = default;
};

/// One of the numbers above, for whoever lists them.
struct TrainingNumber {
  std::string_view key, unit;  ///< The field's name; "1": no unit.
  double low = 0, high = 0;    ///< Both belong to the range.
  std::string_view meaning;
  double TrainingOptions::*real = nullptr;  ///< Exactly one of these two is set.
  int TrainingOptions::*whole = nullptr;

  double of(const TrainingOptions& options) const { return real != nullptr ? options.*real : options.*whole; }
  /// Throws Error("train.KEY", what it must be) when the value is out of range or, of a whole number, not whole.
  void set(TrainingOptions& options, double value) const;
};
/// All of them, in the order of the fields.
std::span<const TrainingNumber> training_numbers();

/// Trains a color table.
///
/// samples  any order; classes without samples stay empty; no_color samples only take cells away from the others
/// range    quantization of the samples' frames; stored in the table
/// returns  one table with the default priority; where two classes come near each other in the UV plane each keeps the
///          cells that lie nearer to it
/// errors   throws Error when options are out of range; a class whose samples are all outliers stays empty
/// cost     O(pixels + classes x 256^2), some 10 ms
/// source   the AGILO training (histogram, threshold, closing, opening) with shading lines and competition (own)
ColorTable train_colors(const std::vector<ColorSample>& samples, ColorRange range, const TrainingOptions& options = {});

/// Trains again and again while samples and options change, and works out anew only what changed: some 5 ms when one
/// class did. Equals train_colors of the same samples. One thread at a time.
class IncrementalTraining {
 public:
  IncrementalTraining();
  ~IncrementalTraining();
  /// A sample counts as unchanged while it is the same object. Errors as for train_colors.
  ColorTable operator()(std::span<const std::shared_ptr<const ColorSample>> samples, ColorRange range,
                        const TrainingOptions& options);

 private:
  struct ClassState;
  std::vector<ClassState> classes_;  ///< By label.
  TrainingOptions options_;          ///< That the states were made with.
};

}  // namespace tassilo
