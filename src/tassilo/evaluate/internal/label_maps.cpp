#include "tassilo/evaluate/internal/label_maps.h"

#include <algorithm>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/evaluate/internal/statistics.h"
#include "tassilo/files/png.h"

namespace tassilo {
namespace {

constexpr int kClasses = 9;
constexpr std::uint8_t kIgnore = 255;

void add(Confusion& to, const Confusion& more) {
  for (std::size_t i = 0; i < to.size(); ++i)
    for (std::size_t k = 0; k < to.size(); ++k) to[i][k] += more[i][k];
}

/// Whether all neighbors inside the image carry the pixel's own label: what is left of a class eroded by one pixel.
bool is_inner(const GrayImage& labels, int column, int row) {
  const auto at = [&](int c, int r) {
    return labels
        .pixels[static_cast<std::size_t>(r) * static_cast<std::size_t>(labels.width) + static_cast<std::size_t>(c)];
  };
  for (int r = std::max(0, row - 1); r <= std::min(labels.height - 1, row + 1); ++r)
    for (int c = std::max(0, column - 1); c <= std::min(labels.width - 1, column + 1); ++c)
      if (at(c, r) != at(column, row)) return false;
  return true;
}

/// `found` null: no_color everywhere.
Confusion compare(const GrayImage& labels, const GrayImage* found) {
  Confusion out{};
  std::size_t i = 0;
  for (int row = 0; row < labels.height; ++row) {
    for (int column = 0; column < labels.width; ++column, ++i) {
      if (labels.pixels[i] == kIgnore || !is_inner(labels, column, row)) continue;
      ++out[labels.pixels[i]][found ? found->pixels[i] : 0];
    }
  }
  return out;
}

void check_labels(const GrayImage& map, bool may_ignore, const std::filesystem::path& file) {
  for (const std::uint8_t label : map.pixels)
    if (label >= kClasses && !(may_ignore && label == kIgnore))
      throw Error(file.string(), "holds the value " + std::to_string(label) + ", must be color classes, 0 to 8");
}

std::string size_text(const GrayImage& image) {
  return std::to_string(image.width) + "x" + std::to_string(image.height);
}

std::vector<std::filesystem::path> png_files(const std::filesystem::path& folder) {
  std::error_code failed;
  std::vector<std::filesystem::path> out;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed))
    if (entry.path().extension() == ".png") out.push_back(entry.path());
  if (failed) throw Error(folder.string(), "is no readable folder, must hold label maps");
  if (out.empty()) throw Error(folder.string(), "holds no PNG files, must hold label maps");
  std::ranges::sort(out);
  return out;
}

}  // namespace

ColorScore color_score(const Confusion& confusion, std::int64_t maps, std::int64_t missing) {
  ColorScore out{.maps = maps,
                 .missing = missing,
                 .accuracy = {},
                 .mean_recall = {},
                 .mean_precision = {},
                 .classes = {},
                 .confusion = confusion};
  Numbers recall, precision;
  std::int64_t all = 0, right = 0;
  for (std::size_t k = 0; k < kClasses; ++k) {
    std::int64_t true_pixels = 0, found_pixels = 0;
    for (std::size_t i = 0; i < kClasses; ++i) {
      true_pixels += confusion[k][i];
      found_pixels += confusion[i][k];
    }
    all += true_pixels;
    right += confusion[k][k];
    ColorScore::Class& score = out.classes[k];
    score = {true_pixels, ratio(confusion[k][k], true_pixels), ratio(confusion[k][k], found_pixels)};
    if (true_pixels == 0) continue;
    recall.push_back(*score.recall);
    precision.push_back(score.precision.value_or(0));
  }
  out.accuracy = ratio(right, all);
  out.mean_recall = mean(recall);
  out.mean_precision = mean(precision);
  out.mean_over = static_cast<std::int64_t>(recall.size());
  return out;
}

ColorScore score_label_maps(const EvaluateOptions::LabelMaps& folders) {
  const auto files = png_files(folders.labels);
  Confusion confusion{};
  std::int64_t missing = 0;
  for (const auto& file : files) {
    const GrayImage labels = read_png_gray(file);
    check_labels(labels, true, file);
    const auto found_file = folders.maps / file.filename();
    if (!std::filesystem::exists(found_file)) {
      ++missing;
      add(confusion, compare(labels, nullptr));
      continue;
    }
    const GrayImage found = read_png_gray(found_file);
    check_labels(found, false, found_file);
    if (found.width != labels.width || found.height != labels.height)
      throw Error(found_file.string(),
                  "is " + size_text(found) + ", must be " + size_text(labels) + " as the true labels");
    add(confusion, compare(labels, &found));
  }
  const auto count = static_cast<std::int64_t>(files.size());
  if (missing == count)
    throw Error(folders.maps.string(), "holds none of the label maps " + files.front().filename().string() + " to " +
                                           files.back().filename().string());
  return color_score(confusion, count, missing);
}

ColorScore pooled(const Named<ColorScore>& sets) {
  Confusion confusion{};
  std::int64_t maps = 0, missing = 0;
  for (const auto& [name, score] : sets) {
    add(confusion, score.confusion);
    maps += score.maps;
    missing += score.missing;
  }
  return color_score(confusion, maps, missing);
}

}  // namespace tassilo
