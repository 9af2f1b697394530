#include <fmt/core.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tassilo/app/commands.h"
#include "tassilo/app/training.h"
#include "tassilo/app/written_files.h"
#include "tassilo/base/error.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

struct TrainArguments {
  std::string samples, output, held_out;
  std::string range = "limited";
  TrainingOptions options;
  bool quiet = false;
};

void warn(const std::string& what, const std::string& reason) {
  std::fputs(fmt::format("tassilo: warning: {}: {}\n", what, reason).c_str(), stderr);
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
    const std::string brightness = fmt::format("{}..{}", interval.low, interval.high);
    if (pixels == 0) {
      fmt::print("{:10}{:>9}{:>21}{:>12}\n", to_string(color), 0, "not measured", brightness);
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
               percent(quality.precision(color)), brightness, remarks);
  }
}

/// "green=40,180"
void set_brightness(TrainingOptions& options, const std::string& text) {
  const auto mark = text.find('=');
  const auto color = color_class_from(text.substr(0, mark));
  BrightnessInterval interval;
  int length = 0;
  if (mark == std::string::npos || !color || *color == ColorClass::no_color ||
      std::sscanf(text.c_str() + mark, "=%3d,%3d%n", &interval.low, &interval.high, &length) != 2 ||
      mark + static_cast<std::size_t>(length) != text.size())
    throw CLI::ValidationError("--brightness", "is '" + text + "', must be CLASS=LOW,HIGH, as green=40,180");
  options.brightness[static_cast<std::size_t>(class_index(*color))] = interval;
}

int train_colors_command(const TrainArguments& arguments) {
  const ColorRange images_range = arguments.range == "full" ? ColorRange::full : ColorRange::limited;
  const TrainingSet samples{arguments.samples, load_samples(arguments.samples, images_range, warn)};
  check_written_files(samples.loaded.files,
                      std::array<NamedFile, 2>{{{"--output", arguments.output},
                                                {"the PNG of --output", table_paths(arguments.output).next.string()}}});
  std::optional<TrainingSet> held_out;
  if (!arguments.held_out.empty())
    held_out = {arguments.held_out, load_samples(arguments.held_out, images_range, warn)};
  const auto [file, quality] = train_colors_file(samples, held_out ? &*held_out : nullptr, arguments.options, warn);
  write_colors(arguments.output, file);
  if (!arguments.quiet) {
    fmt::print("{} samples, {} range\n", samples.loaded.samples.size(), to_string(file.table.range));
    print_quality(file.table, quality, file.trained_from->notes);
    fmt::print("\nwrote {}\n", arguments.output);
  }
  return 0;
}

}  // namespace

Command add_train_colors(CLI::App& train) {
  auto* command = train.add_subcommand("colors", "train a color table from labelled regions of images");
  auto arguments = std::make_shared<TrainArguments>();
  command->add_option("samples", arguments->samples, "samples.yaml: labelled rectangles, polygons, strokes and masks")
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
  command
      ->add_option_function<std::vector<std::string>>(
          "--brightness",
          [arguments](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) set_brightness(arguments->options, text);
          },
          "brightness of a class instead of the trained one, as green=40,180; may be given for several classes")
      ->expected(1, -1);
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
