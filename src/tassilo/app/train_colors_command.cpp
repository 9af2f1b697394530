#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "tassilo/app/commands.h"
#include "tassilo/app/written_files.h"
#include "tassilo/base/error.h"
#include "tassilo/color/quality.h"
#include "tassilo/color/train.h"
#include "tassilo/files/colors_file.h"
#include "tassilo/files/png.h"
#include "tassilo/files/samples_file.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/raster.h"
#include "tassilo/source/frame_source.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

struct TrainArguments {
  std::string samples, output, held_out;
  std::string range = "limited";
  TrainingOptions options;
  bool quiet = false;
};

/// Samples read, with the range of their images.
struct LoadedSamples {
  std::vector<ColorSample> samples;
  int images = 0;                   ///< That have samples; a frame of a video is an image.
  std::vector<NamedFile> files;     ///< All that were read, the list of samples among them.
  std::optional<ColorRange> range;  ///< Nothing when there is no sample.
};

void warn(const std::string& what, const std::string& reason) {
  std::fputs(fmt::format("tassilo: warning: {}: {}\n", what, reason).c_str(), stderr);
}

/// Does `read`; what fails is told with the place in the samples file that asked for it.
template <class Read>
auto read_at(const std::string& place, Read read) {
  try {
    return read();
  } catch (const Error& error) {
    throw Error(place, error.what());
  }
}

Region region_of(const TrainingSample& sample, const FrameView& frame, const std::string& place) {
  if (const auto* box = std::get_if<PixelBox>(&sample.shape)) return Region::from_box(*box);
  if (const auto* polygon = std::get_if<std::vector<PixelPoint>>(&sample.shape))
    return region_from_polygon(*polygon, {-frame.width(), -frame.height(), 2 * frame.width(), 2 * frame.height()});
  const auto& mask = std::get<SampleMask>(sample.shape);
  const GrayImage pixels = read_at(place, [&] { return read_png_gray(mask.path); });
  if (pixels.width != frame.width() || pixels.height != frame.height())
    throw Error(place, fmt::format("mask {} is {}x{}, its image is {}x{}", mask.path.string(), pixels.width,
                                   pixels.height, frame.width(), frame.height()));
  const Region region = region_where(ByteView{pixels.pixels.data(), pixels.width, pixels.height, pixels.width},
                                     [&](int value) { return value == mask.value; });
  // The rim of a mask is where two colors mix.
  return erosion(region, rectangle(3, 3));
}

/// Warns of regions of different classes that share pixels: at least one of them was drawn wrong.
void warn_of_overlap(const std::vector<std::pair<const TrainingSample*, Region>>& drawn, const std::string& file) {
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

/// The frames of one image or video that samples ask for, and the line that asks for the last of them.
struct WantedFrames {
  std::set<std::int64_t> indices;
  int line = 0;
};

LoadedSamples load_samples(const std::string& file, ColorRange images_range) {
  const std::vector<TrainingSample> list = read_samples(file);
  if (list.empty()) throw Error(file, "holds no samples, must hold at least one");
  std::map<fs::path, WantedFrames> wanted;
  for (const TrainingSample& sample : list) {
    WantedFrames& frames = wanted[sample.image];
    if (frames.indices.empty() || sample.frame > *frames.indices.rbegin()) frames.line = sample.line;
    frames.indices.insert(sample.frame);
  }

  LoadedSamples loaded;
  loaded.files.push_back({"samples", file});
  for (const TrainingSample& sample : list) {
    loaded.files.push_back({"an image", sample.image.string()});
    if (const auto* mask = std::get_if<SampleMask>(&sample.shape))
      loaded.files.push_back({"a mask", mask->path.string()});
  }
  int group = 0;
  for (const auto& [image, frames] : wanted) {
    const std::vector<std::int64_t> indices(frames.indices.begin(), frames.indices.end());
    const std::string place_of_last = fmt::format("{}:{}", file, frames.line);
    SourceOptions options;
    options.location = image.string();
    options.images_range = images_range;
    const std::vector<Frame> pictures = read_at(place_of_last, [&] { return read_frames(options, indices); });
    for (std::size_t i = 0; i < pictures.size(); ++i, ++group) {
      const Frame& frame = pictures[i];
      if (loaded.range && *loaded.range != frame.range)
        throw Error(place_of_last,
                    fmt::format("{} has {} color range, images before it have {}; a table is for one range",
                                image.string(), to_string(frame.range), to_string(*loaded.range)));
      loaded.range = frame.range;
      std::vector<std::pair<const TrainingSample*, Region>> drawn;
      for (const TrainingSample& sample : list) {
        if (sample.image != image || sample.frame != indices[i]) continue;
        const std::string place = fmt::format("{}:{}", file, sample.line);
        Region region = region_of(sample, frame.view, place);
        const auto whole = area(region);
        std::vector<YuvPixel> pixels = pixels_of(frame.view, region);
        if (pixels.empty()) {
          warn(place, fmt::format("{} has no pixel in the image ({}x{}); ignored", to_string(sample.color),
                                  frame.view.width(), frame.view.height()));
          continue;
        }
        if (static_cast<std::int64_t>(pixels.size()) < whole)
          warn(place, fmt::format("{} leaves the image; {} of {} pixels are used", to_string(sample.color),
                                  pixels.size(), whole));
        loaded.samples.push_back({sample.color, group, std::move(pixels)});
        drawn.emplace_back(&sample, std::move(region));
      }
      loaded.images += !drawn.empty();
      warn_of_overlap(drawn, file);
    }
  }
  return loaded;
}

std::string percent(const std::optional<double>& share) {
  return share ? fmt::format("{:.1f} %", 100 * *share) : std::string("-");
}

void print_quality(const ColorTable& table, const ColorQuality& quality, const std::string& how) {
  fmt::print("\nquality {}\n", how);
  fmt::print("{:10}{:>9}{:>10}{:>11}{:>12}  taken for; also claimed by\n", "class", "pixels", "recall", "precision",
             "brightness");
  for (const ColorClass color : kColorClasses) {
    const auto pixels = quality.pixels(color);
    const auto& interval = table.brightness[static_cast<std::size_t>(class_index(color))];
    if (pixels == 0 && interval.low > interval.high) {
      fmt::print("{:10}{:>9}   no samples: the class stays empty\n", to_string(color), 0);
      continue;
    }
    std::string remarks;
    const auto name = [](std::size_t k) { return to_string(static_cast<ColorClass>(k)); };
    const auto& confused = quality.confusion[static_cast<std::size_t>(color)];
    for (std::size_t k = 0; k < confused.size(); ++k)
      if (k != static_cast<std::size_t>(color) && confused[k] * 1000 > pixels)
        remarks += fmt::format("{}{} {}", remarks.empty() ? "" : ", ", name(k),
                               percent(static_cast<double>(confused[k]) / static_cast<double>(pixels)));
    std::string claimed;
    const auto& overlap = quality.overlap[static_cast<std::size_t>(color)];
    for (std::size_t k = 0; k < overlap.size(); ++k)
      if (overlap[k] * 1000 > pixels)
        claimed += fmt::format("{}{} {}", claimed.empty() ? "" : ", ", name(k),
                               percent(static_cast<double>(overlap[k]) / static_cast<double>(pixels)));
    if (!claimed.empty()) remarks += "; " + claimed;
    fmt::print("{:10}{:>9}{:>10}{:>11}{:>12}  {}\n", to_string(color), pixels, percent(quality.recall(color)),
               percent(quality.precision(color)), fmt::format("{}..{}", interval.low, interval.high), remarks);
  }
}

std::string today() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm local{};
  localtime_r(&now, &local);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", &local);
  return text;
}

int train_colors_command(const TrainArguments& arguments) {
  const ColorRange images_range = arguments.range == "full" ? ColorRange::full : ColorRange::limited;
  const LoadedSamples loaded = load_samples(arguments.samples, images_range);
  check_written_files(loaded.files,
                      std::array<NamedFile, 2>{
                          {{"--output", arguments.output},
                           {"the PNG of --output", fs::path(arguments.output).replace_extension(".png").string()}}});
  if (loaded.samples.empty()) throw Error(arguments.samples, "has no sample with a pixel in its image");
  if (std::ranges::all_of(loaded.samples, [](const ColorSample& s) { return s.color == ColorClass::no_color; }))
    throw Error(arguments.samples, "has samples of no_color alone, must have some of a color");

  ColorsFile file;
  file.table = train_colors(loaded.samples, *loaded.range, arguments.options);
  std::set<ColorClass> sampled;
  for (const ColorSample& sample : loaded.samples) sampled.insert(sample.color);
  for (const ColorClass color : sampled)
    if (color != ColorClass::no_color &&
        std::ranges::none_of(file.table.chroma, [&](ClassBits bits) { return (bits & class_bit(color)) != 0; }))
      warn(std::string(to_string(color)), "its samples have no common color; the class stays empty");

  ColorQuality quality;
  std::string how;
  if (!arguments.held_out.empty()) {
    const LoadedSamples held_out = load_samples(arguments.held_out, images_range);
    if (held_out.range && *held_out.range != *loaded.range)
      throw Error(arguments.held_out, fmt::format("has images of {} range, the training images have {}",
                                                  to_string(*held_out.range), to_string(*loaded.range)));
    add_quality(quality, Classifier(file.table), held_out.samples);
    how = "on " + arguments.held_out;
  } else {
    quality = cross_validate(loaded.samples, *loaded.range, arguments.options);
    how = loaded.images > 1           ? "cross-validated: on images held out in turn"
          : loaded.samples.size() > 1 ? "cross-validated: on samples of one image held out in turn"
                                      : "not measured: needs a second sample of each color, better in another image";
  }
  file.trained_from = Provenance{};
  file.trained_from->samples = arguments.samples;
  file.trained_from->date = today();
  file.trained_from->notes = how;
  for (const ColorClass color : kColorClasses)
    if (quality.pixels(color) > 0)
      file.trained_from->quality[color] = {quality.precision(color), quality.recall(color)};
  write_colors(arguments.output, file);
  if (!arguments.quiet) {
    fmt::print("{} samples, {} range\n", loaded.samples.size(), to_string(*loaded.range));
    print_quality(file.table, quality, how);
    fmt::print("\nwrote {}\n", arguments.output);
  }
  return 0;
}

}  // namespace

Command add_train_colors(CLI::App& train) {
  auto* command = train.add_subcommand("colors", "train a color table from labelled regions of images");
  auto arguments = std::make_shared<TrainArguments>();
  command->add_option("samples", arguments->samples, "samples.yaml: labelled rectangles, polygons and masks")
      ->required();
  command->add_option("-o,--output", arguments->output, "colors.yaml to write; its PNG is written beside it")
      ->required();
  command->add_option("--test", arguments->held_out, "samples to measure quality on (default: cross-validation)");
  command->add_option("--range", arguments->range, "range that RGB images become")
      ->check(CLI::IsMember({"limited", "full"}))
      ->capture_default_str();
  TrainingOptions& options = arguments->options;
  command->add_option("--outlier-share", options.outlier_share, "share of a class's pixels that may be wrong")
      ->capture_default_str();
  command->add_option("--closing", options.closing_px, "closing of the UV cluster [steps]")->capture_default_str();
  command->add_option("--opening", options.opening_px, "opening of the UV cluster [steps]")->capture_default_str();
  command->add_option("--noise-margin", options.noise_margin, "margin around the UV cluster [steps]")
      ->capture_default_str();
  command->add_option("--darkest-shade", options.darkest_shade, "darkest shade relative to the samples")
      ->capture_default_str();
  command->add_option("--brightest-light", options.brightest_light, "brightest light relative to the samples")
      ->capture_default_str();
  command->add_option("--white-reach", options.white_reach, "share of the gray between black and white that is white")
      ->capture_default_str();
  command->add_option("--black-reach", options.black_reach, "share of the gray between black and white that is black")
      ->capture_default_str();
  command->add_flag("-q,--quiet", arguments->quiet, "print nothing but warnings and errors");
  command->callback([arguments] {
    try {
      arguments->options.check();
    } catch (const Error& error) {
      throw CLI::ValidationError(error.what());
    }
  });
  return [arguments] { return train_colors_command(*arguments); };
}

}  // namespace tassilo
