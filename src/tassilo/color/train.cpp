#include "tassilo/color/train.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>

#include "tassilo/base/error.h"
#include "tassilo/color/internal/uv_plane.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/components.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

constexpr double kNeutral = 128;

bool is_gray(ColorClass color) { return color == ColorClass::black || color == ColorClass::white; }

struct UvHistogram {
  UvPlane<double> count;
  double total = 0;
};

UvHistogram histogram(const std::vector<YuvPixel>& pixels) {
  UvHistogram h;
  for (const YuvPixel& p : pixels) h.count(p.u, p.v) += 1;
  h.total = static_cast<double>(pixels.size());
  return h;
}

/// The densest cells that together hold all but `outlier_share` of the (smoothed) histogram.
Region dense_cells(const UvHistogram& h, double outlier_share) {
  const UvPlane<double> smooth = binomial_blur(h.count);
  std::vector<double> counts;
  for (const double n : smooth.cells)
    if (n > 0) counts.push_back(n);
  if (counts.empty()) return {};
  std::ranges::sort(counts, std::greater<>{});
  const double enough = (1 - outlier_share) * std::accumulate(counts.begin(), counts.end(), 0.0);
  double sum = 0, threshold = counts.back();
  for (const double n : counts) {
    sum += n;
    threshold = n;
    if (sum >= enough) break;
  }
  return region_where(smooth, [&](double n) { return n > 0 && n >= threshold; });
}

double weight(const UvHistogram& h, const Region& cells) {
  double sum = 0;
  for (const PixelRun& run : cells.runs())
    for (int u = run.begin; u < run.end; ++u) sum += h.count(u, run.row);
  return sum;
}

/// The class's cluster in the UV plane: threshold, closing, opening, slips of the hand removed.
Region cluster(const UvHistogram& h, const TrainingOptions& options) {
  const Region dense = dense_cells(h, options.outlier_share);
  const Region closed = clipped(closing(dense, rectangle(options.closing_px, options.closing_px)), kUvBox);
  Region opened = opening(closed, rectangle(options.opening_px, options.opening_px));
  // Few samples or a synthetic color can be one cell wide: better a thin cluster than none.
  if (weight(h, opened) < 0.5 * h.total) opened = closed;
  RunVector kept;
  for (const Region& part : components(opened))
    if (weight(h, part) >= options.min_cluster_share * h.total)
      kept.insert(kept.end(), part.runs().begin(), part.runs().end());
  return Region::from_runs(std::move(kept));
}

/// The cluster and its darker and brighter shades: cells on the lines from the neutral point through the cluster.
Region with_shades(const Region& cells, const TrainingOptions& options) {
  double sum = 0, furthest = 0;
  std::int64_t n = 0;
  for (const PixelRun& run : cells.runs())
    for (int u = run.begin; u < run.end; ++u, ++n) {
      const double saturation = std::hypot(u - kNeutral, run.row - kNeutral);
      sum += saturation;
      furthest = std::max(furthest, saturation);
    }
  if (n == 0) return {};
  const double least = options.darkest_shade * sum / static_cast<double>(n);
  UvPlane<std::uint8_t> shaded;
  for (const PixelRun& run : cells.runs())
    for (int u = run.begin; u < run.end; ++u) {
      shaded(u, run.row) = 1;
      const double du = u - kNeutral, dv = run.row - kNeutral, saturation = std::hypot(du, dv);
      if (saturation == 0) continue;  // neutral in every light
      const double last = std::min(options.brightest_light * saturation, options.brightest_light * furthest);
      const double first = std::max(options.darkest_shade * saturation, least);
      for (double s = first; s <= last; s += 0.5) {
        const int su = static_cast<int>(std::lround(kNeutral + du * s / saturation));
        const int sv = static_cast<int>(std::lround(kNeutral + dv * s / saturation));
        if (su >= 0 && su < 256 && sv >= 0 && sv < 256) shaded(su, sv) = 1;
      }
    }
  const Region all = region_where(shaded, [](std::uint8_t set) { return set != 0; });
  return clipped(closing(all, rectangle(3, 3)), kUvBox);
}

struct ClassModel {
  UvPlane<double> to_shades;    ///< Distance to the cluster with its shades.
  UvPlane<double> nearness;     ///< Distance by which classes compete for a cell.
  double dark = 0, bright = 0;  ///< Brightness of the samples without outliers.
};

/// The value below which the share `q` of the values lies, to the nearest rank; reorders them. At least one value.
double quantile(std::vector<std::uint8_t>& values, double q) {
  const auto at = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

std::optional<ClassModel> model_of(ColorClass color, const std::vector<YuvPixel>& pixels,
                                   const TrainingOptions& options) {
  if (pixels.empty()) return std::nullopt;
  const Region cells = cluster(histogram(pixels), options);
  if (cells.empty()) return std::nullopt;
  std::vector<std::uint8_t> brightness;
  for (const YuvPixel& p : pixels)
    if (contains(cells, p.u, p.v)) brightness.push_back(p.y);
  if (brightness.empty()) return std::nullopt;
  ClassModel model;
  model.dark = quantile(brightness, options.brightness_outlier_share);
  model.bright = quantile(brightness, 1 - options.brightness_outlier_share);
  // A cell of the cluster itself is better evidence than one of its shades: a quarter of the way to the cluster counts.
  const UvPlane<double> to_cells = distance_to(cells);
  model.to_shades =
      is_gray(color) || color == ColorClass::no_color ? to_cells : distance_to(with_shades(cells, options));
  model.nearness = model.to_shades;
  for (std::size_t i = 0; i < model.nearness.cells.size(); ++i) model.nearness.cells[i] += 0.25 * to_cells.cells[i];
  return model;
}

BrightnessInterval clamped(double low, double high) {
  return {static_cast<int>(std::floor(std::clamp(low, 0.0, 255.0))),
          static_cast<int>(std::ceil(std::clamp(high, 0.0, 255.0)))};
}

}  // namespace

std::vector<YuvPixel> pixels_of(const FrameView& frame, const Region& region) {
  std::vector<YuvPixel> pixels;
  const Region inside = clipped(region, {0, 0, frame.width(), frame.height()});
  for (const PixelRun& run : inside.runs())
    for (int c = run.begin; c < run.end; ++c)
      pixels.push_back({frame.y(c, run.row), frame.u(c, run.row), frame.v(c, run.row)});
  return pixels;
}

std::span<const TrainingNumber> training_numbers() {
  using T = TrainingOptions;
  static constexpr std::array kNumbers{
      TrainingNumber{"outlier_share", "1", 0, 0.2, "share of a class's pixels that may be wrong", &T::outlier_share},
      TrainingNumber{"brightness_outlier_share", "1", 0, 0.2,
                     "share of a class's pixels at either end of its brightness that are mixed or in deep shade",
                     &T::brightness_outlier_share},
      TrainingNumber{"min_cluster_share", "1", 0, 0.5,
                     "a separate cluster with a smaller share of the pixels is a slip", &T::min_cluster_share},
      TrainingNumber{"closing_px", "step", 1, 31, "closing of the UV cluster", nullptr, &T::closing_px},
      TrainingNumber{"opening_px", "step", 1, 15, "opening of the UV cluster", nullptr, &T::opening_px},
      TrainingNumber{"noise_margin", "step", 0, 20, "margin around the UV cluster", &T::noise_margin},
      TrainingNumber{"darkest_shade", "1", 0.1, 1, "darkest shade relative to the samples", &T::darkest_shade},
      TrainingNumber{"brightest_light", "1", 1, 2, "brightest light relative to the samples", &T::brightest_light},
      TrainingNumber{"white_reach", "1", 0, 0.5, "share of the gray between black and white that is white",
                     &T::white_reach},
      TrainingNumber{"black_reach", "1", 0, 0.5, "share of the gray between black and white that is black",
                     &T::black_reach},
  };
  return kNumbers;
}

void TrainingNumber::set(TrainingOptions& options, double value) const {
  const bool is_in_range = value >= low && value <= high;
  if (!is_in_range || (whole != nullptr && value != std::floor(value))) {
    std::ostringstream reason;
    reason << "is " << value << ", must be " << (is_in_range ? "a whole number " : "") << "in [" << low << ", " << high
           << "]";
    throw Error("train." + std::string(key), reason.str());
  }
  if (real != nullptr)
    options.*real = value;
  else
    options.*whole = static_cast<int>(value);
}

void TrainingOptions::check() const {
  TrainingOptions checked = *this;
  for (const TrainingNumber& number : training_numbers()) number.set(checked, number.of(*this));
  for (const ColorClass color : kColorClasses) {
    const auto& interval = brightness[static_cast<std::size_t>(class_index(color))];
    if (interval && !(0 <= interval->low && interval->low <= interval->high && interval->high <= 255))
      throw Error("train.brightness." + std::string(to_string(color)), "is [" + std::to_string(interval->low) + ", " +
                                                                           std::to_string(interval->high) +
                                                                           "], must be [low, high] in 0..255");
  }
}

namespace {

using ClassModels = std::array<const ClassModel*, kColorClassCount + 1>;  // by label; null: no samples

/// What the models are, without what only says how they share the plane.
TrainingOptions options_of_models(TrainingOptions options) {
  const TrainingOptions standard;
  options.noise_margin = standard.noise_margin;
  options.white_reach = standard.white_reach;
  options.black_reach = standard.black_reach;
  options.brightness = standard.brightness;
  return options;
}

ColorTable table_of(const ClassModels& models, ColorRange range, const TrainingOptions& options) {
  ColorTable table;
  table.range = range;
  table.brightness.fill({1, 0});
  for (const ColorClass color : kColorClasses) {
    const auto& model = models[static_cast<std::size_t>(color)];
    if (!model) continue;
    for (int v = 0; v < 256; ++v)
      for (int u = 0; u < 256; ++u) {
        if (model->to_shades(u, v) > options.noise_margin) continue;
        const double own = model->nearness(u, v);
        const bool nearest = std::ranges::all_of(kColorClasses, [&](ColorClass other) {
          const auto& rival = models[static_cast<std::size_t>(other)];
          // Black and white share the gray cells; their brightness tells them apart.
          return !rival || (is_gray(color) && is_gray(other)) || own <= rival->nearness(u, v);
        });
        if (nearest) table.cell(u, v) |= class_bit(color);
      }
    const double black_level = range == ColorRange::limited ? 16 : 0;
    const auto lit = [&](double y, double light) { return black_level + (y - black_level) * light; };
    table.brightness[static_cast<std::size_t>(class_index(color))] =
        clamped(lit(model->dark, options.darkest_shade), lit(model->bright, options.brightest_light) + 1);
  }

  // Gray classes: from the samples into the gap of gray between them, and all the way to the end of the scale.
  const auto& black = models[static_cast<std::size_t>(ColorClass::black)];
  const auto& white = models[static_cast<std::size_t>(ColorClass::white)];
  const double gap = black && white ? std::max(0.0, white->dark - black->bright) : 0;
  auto interval = [&](ColorClass color) -> BrightnessInterval& {
    return table.brightness[static_cast<std::size_t>(class_index(color))];
  };
  if (black) interval(ColorClass::black) = clamped(0, black->bright + options.black_reach * gap);
  if (white) interval(ColorClass::white) = clamped(white->dark - options.white_reach * gap, 255);
  // Gray that the user marked as no class bounds both.
  if (const auto& none = models[static_cast<std::size_t>(ColorClass::no_color)]) {
    if (black && none->dark > black->bright)
      interval(ColorClass::black).high = static_cast<int>((black->bright + none->dark) / 2);
    if (white && none->bright < white->dark)
      interval(ColorClass::white).low = static_cast<int>((white->dark + none->bright) / 2) + 1;
  }
  for (std::size_t k = 0; k < table.brightness.size(); ++k)
    if (options.brightness[k]) table.brightness[k] = *options.brightness[k];
  return table;
}

}  // namespace

ColorTable train_colors(const std::vector<ColorSample>& samples, ColorRange range, const TrainingOptions& options) {
  options.check();
  std::array<std::vector<YuvPixel>, kColorClassCount + 1> pixels;
  for (const ColorSample& sample : samples) {
    auto& all = pixels[static_cast<std::size_t>(sample.color)];
    all.insert(all.end(), sample.pixels.begin(), sample.pixels.end());
  }
  std::array<std::optional<ClassModel>, kColorClassCount + 1> models;
  ClassModels found{};
  for (std::size_t k = 0; k < models.size(); ++k) {
    models[k] = model_of(static_cast<ColorClass>(k), pixels[k], options);
    if (models[k]) found[k] = &*models[k];
  }
  return table_of(found, range, options);
}

struct IncrementalTraining::ClassState {
  std::vector<std::shared_ptr<const ColorSample>> samples;
  std::optional<ClassModel> model;
};

IncrementalTraining::IncrementalTraining() : classes_(kColorClassCount + 1) {}
IncrementalTraining::~IncrementalTraining() = default;

ColorTable IncrementalTraining::operator()(std::span<const std::shared_ptr<const ColorSample>> samples,
                                           ColorRange range, const TrainingOptions& options) {
  options.check();
  const bool is_same_kind = options_of_models(options) == options_of_models(options_);
  options_ = options;
  ClassModels models{};
  for (std::size_t k = 0; k < classes_.size(); ++k) {
    const auto color = static_cast<ColorClass>(k);
    std::vector<std::shared_ptr<const ColorSample>> own;
    std::ranges::copy_if(samples, std::back_inserter(own), [&](const auto& one) { return one->color == color; });
    ClassState& state = classes_[k];
    if (!is_same_kind || own != state.samples) {
      std::vector<YuvPixel> pixels;
      for (const auto& sample : own) pixels.insert(pixels.end(), sample->pixels.begin(), sample->pixels.end());
      state = {std::move(own), model_of(color, pixels, options)};
    }
    if (state.model) models[k] = &*state.model;
  }
  return table_of(models, range, options);
}

}  // namespace tassilo
