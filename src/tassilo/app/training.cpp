#include "tassilo/app/training.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <map>
#include <set>
#include <utility>
#include <variant>

#include "tassilo/base/error.h"
#include "tassilo/files/png.h"
#include "tassilo/files/samples_file.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/raster.h"
#include "tassilo/source/frame_source.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxCoordinate = 32767;  // regions are 16 bit

/// Does `read`; what fails is told with the place in the samples file that asked for it.
template <class Read>
auto read_at(const std::string& place, Read read) {
  try {
    return read();
  } catch (const Error& error) {
    throw Error(place, error.what());
  }
}

/// Warns of regions of different classes that share pixels: at least one of them was drawn wrong.
void warn_of_overlap(const std::vector<std::pair<const TrainingSample*, Region>>& drawn, const std::string& file,
                     const Warn& warn) {
  for (std::size_t i = 0; i < drawn.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      if (drawn[i].first->color == drawn[k].first->color) continue;
      if (intersection(bounding_box(drawn[i].second), bounding_box(drawn[k].second)).empty()) continue;
      const auto shared = area(intersection(drawn[i].second, drawn[k].second));
      if (shared > 0)
        warn(fmt::format("{}:{}", file, drawn[i].first->line),
             fmt::format("{} shares {} pixels with {} in line {}", to_string(drawn[i].first->color), shared,
                         to_string(drawn[k].first->color), drawn[k].first->line));
    }
}

/// The frames of one image or video that samples ask for.
struct WantedFrames {
  fs::path image;
  std::set<std::int64_t> indices;
  int first_line = 0;    ///< That asks for the image.
  int line_of_last = 0;  ///< That asks for its last frame.
};

/// In the order of the file.
std::vector<WantedFrames> wanted_frames(const std::vector<TrainingSample>& samples) {
  std::vector<WantedFrames> wanted;
  std::map<fs::path, std::size_t> places;
  for (const TrainingSample& sample : samples) {
    const auto [place, is_new] = places.try_emplace(sample.image, wanted.size());
    if (is_new) wanted.push_back({.image = sample.image, .indices = {}, .first_line = sample.line});
    WantedFrames& frames = wanted[place->second];
    if (frames.indices.empty() || sample.frame > *frames.indices.rbegin()) frames.line_of_last = sample.line;
    frames.indices.insert(sample.frame);
  }
  return wanted;
}

std::string today() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm local{};
  localtime_r(&now, &local);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", &local);
  return text;
}

}  // namespace

Region sample_region(const SampleShape& shape, const FrameView& frame, const std::string& place) {
  // What is drawn beyond the image is counted for a warning, but not without end.
  const PixelBox around{-frame.width(), -frame.height(), std::min(2 * frame.width(), kMaxCoordinate),
                        std::min(2 * frame.height(), kMaxCoordinate)};
  if (const auto* box = std::get_if<PixelBox>(&shape)) return Region::from_box(*box);
  if (const auto* polygon = std::get_if<std::vector<PixelPoint>>(&shape)) return region_from_polygon(*polygon, around);
  if (const auto* stroke = std::get_if<SampleStroke>(&shape))
    return region_from_stroke(stroke->way, stroke->radius, around);
  const auto& mask = std::get<SampleMask>(shape);
  const GrayImage pixels = read_at(place, [&] { return read_png_gray(mask.path); });
  if (pixels.width != frame.width() || pixels.height != frame.height())
    throw Error(place, fmt::format("mask {} is {}x{}, its image is {}x{}", mask.path.string(), pixels.width,
                                   pixels.height, frame.width(), frame.height()));
  const Region region = region_where(ByteView{pixels.pixels.data(), pixels.width, pixels.height, pixels.width},
                                     [&](int value) { return value == mask.value; });
  // The rim of a mask is where two colors mix.
  return erosion(region, rectangle(3, 3));
}

void for_sample_images(const std::vector<TrainingSample>& list, const std::string& list_name, ColorRange images_range,
                       const std::function<void(const SampleImage&)>& use) {
  for (const WantedFrames& wanted : wanted_frames(list)) {
    const std::vector<std::int64_t> indices(wanted.indices.begin(), wanted.indices.end());
    SourceOptions options;
    options.location = wanted.image.string();
    options.images_range = images_range;
    const std::vector<Frame> frames =
        read_at(fmt::format("{}:{}", list_name, wanted.line_of_last), [&] { return read_frames(options, indices); });
    for (std::size_t i = 0; i < frames.size(); ++i)
      use({wanted.image, indices[i], indices.size() > 1 || indices[i] > 0, wanted.first_line, frames[i]});
  }
}

LoadedSamples load_samples(const std::string& file, ColorRange images_range, const Warn& warn) {
  const std::vector<TrainingSample> list = read_samples(file);
  if (list.empty()) throw Error(file, "holds no samples, must hold at least one");
  LoadedSamples loaded;
  loaded.files.push_back({"samples", file});
  for (const TrainingSample& sample : list) {
    loaded.files.push_back({"an image", sample.image.string()});
    if (const auto* mask = std::get_if<SampleMask>(&sample.shape))
      loaded.files.push_back({"a mask", mask->path.string()});
  }
  int group = 0;
  int first_line = 0;  // of the file's samples
  for_sample_images(list, file, images_range, [&](const SampleImage& image) {
    const Frame& frame = image.frame;
    if (loaded.range && *loaded.range != frame.range)
      throw Error(fmt::format("{}:{}", file, image.first_line),
                  fmt::format("{} has {} color range, the image in line {} has {}; a table is for one range",
                              image.file.string(), to_string(frame.range), first_line, to_string(*loaded.range)));
    if (!loaded.range) first_line = image.first_line;
    loaded.range = frame.range;
    std::vector<std::pair<const TrainingSample*, Region>> drawn;
    for (const TrainingSample& sample : list) {
      if (sample.image != image.file || sample.frame != image.index) continue;
      const std::string place = fmt::format("{}:{}", file, sample.line);
      Region region = sample_region(sample.shape, frame.view, place);
      const auto whole = area(region);
      std::vector<YuvPixel> pixels = pixels_of(frame.view, region);
      if (pixels.empty()) {
        warn(place, fmt::format("{} has no pixel in the image ({}x{}); ignored", to_string(sample.color),
                                frame.view.width(), frame.view.height()));
        continue;
      }
      if (static_cast<std::int64_t>(pixels.size()) < whole)
        warn(place, fmt::format("{} leaves the image; {} of {} pixels are used", to_string(sample.color), pixels.size(),
                                whole));
      loaded.samples.push_back({sample.color, group, std::move(pixels)});
      drawn.emplace_back(&sample, std::move(region));
    }
    ++group;
    loaded.images += !drawn.empty();
    warn_of_overlap(drawn, file, warn);
  });
  return loaded;
}

TrainedColors train_colors_file(const TrainingSet& set, const TrainingSet* held_out, const TrainingOptions& options,
                                const Warn& warn, const ColorQuality* measured) {
  const LoadedSamples& loaded = set.loaded;
  if (loaded.samples.empty()) throw Error(set.name, "has no sample with a pixel in its image");
  if (std::ranges::all_of(loaded.samples, [](const ColorSample& s) { return s.color == ColorClass::no_color; }))
    throw Error(set.name, "has samples of no_color alone, must have some of a color");
  if (held_out && held_out->loaded.range && *held_out->loaded.range != *loaded.range)
    throw Error(held_out->name, fmt::format("has images of {} range, the training images have {}",
                                            to_string(*held_out->loaded.range), to_string(*loaded.range)));

  TrainedColors trained;
  ColorTable& table = trained.file.table;
  table = train_colors(loaded.samples, *loaded.range, options);
  std::set<ColorClass> sampled;
  for (const ColorSample& sample : loaded.samples) sampled.insert(sample.color);
  for (const ColorClass color : sampled)
    if (color != ColorClass::no_color &&
        std::ranges::none_of(table.chroma, [&](ClassBits bits) { return (bits & class_bit(color)) != 0; }))
      warn(std::string(to_string(color)), "its samples have no common color; the class stays empty");

  Provenance provenance;
  provenance.samples = set.name;
  provenance.date = today();
  if (held_out) {
    add_quality(trained.quality, Classifier(table), held_out->loaded.samples);
    provenance.notes = "on " + held_out->name;
  } else {
    trained.quality = measured != nullptr ? *measured : cross_validate(loaded.samples, *loaded.range, options);
    const bool is_measured =
        std::ranges::any_of(sampled, [&](ColorClass color) { return trained.quality.pixels(color) > 0; });
    provenance.notes = !is_measured ? "not measured: needs a second sample of each color, better in another image"
                       : loaded.images > 1 ? "cross-validated: on images held out in turn"
                                           : "cross-validated: on samples of one image held out in turn";
  }
  for (const TrainingNumber& number : training_numbers())
    if (number.of(options) != number.of({})) provenance.options[std::string(number.key)] = number.of(options);
  for (const ColorClass color : kColorClasses)
    if (const auto& interval = options.brightness[static_cast<std::size_t>(class_index(color))])
      provenance.brightness[color] = *interval;
  for (const ColorClass color : kColorClasses)
    if (trained.quality.pixels(color) > 0)
      provenance.quality[color] = {trained.quality.precision(color), trained.quality.recall(color)};
  trained.file.trained_from = std::move(provenance);
  return trained;
}

}  // namespace tassilo
