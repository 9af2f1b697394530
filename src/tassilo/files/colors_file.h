#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "tassilo/color/color_table.h"

namespace tassilo {

/// Measured on samples that were not used for training; nothing where there was nothing to measure.
struct ClassQuality {
  std::optional<double> precision, recall;  ///< 0..1
  friend bool operator==(const ClassQuality&, const ClassQuality&) = default;
};

/// Where a color table comes from; for people, nothing depends on it.
struct Provenance {
  std::string samples;  ///< The samples file as it was named.
  std::string date;     ///< As written, 2026-11-22.
  std::map<ColorClass, ClassQuality> quality;
  std::string notes;
  std::map<std::string, double, std::less<>> options;   ///< Of the training, by name, where not the default.
  std::map<ColorClass, BrightnessInterval> brightness;  ///< Where it was set by hand. low <= high
  friend bool operator==(const Provenance&, const Provenance&) = default;
};

/// What colors.yaml and its PNG say.
struct ColorsFile {
  ColorTable table;
  std::optional<Provenance> trained_from;
  friend bool operator==(const ColorsFile&, const ColorsFile&) = default;
};

/// Throws Error with file, line and column; also when the PNG has cells of a class without a `brightness` entry.
/// A class without an entry gets an empty interval.
ColorsFile read_colors(const std::filesystem::path& file);
/// The same for a text in place of the content of `file`; the PNG is looked for beside `file`.
ColorsFile colors_from_yaml(std::string_view text, const std::filesystem::path& file);

/// Writes the table beside `file`, then `file`, each atomically. The PNG is STEM.png, or STEM.2.png when `file` now
/// names the former: what is read in between, or after a power cut, is the old table or the new one as a whole.
/// Reading gives the same table; all empty brightness intervals read back as one. Throws Error when it cannot.
void write_colors(const std::filesystem::path& file, const ColorsFile& colors);
/// The PNG that `file` names, empty when there is no such file or it cannot be read; and the one that write_colors
/// would write.
struct TablePaths {
  std::filesystem::path now, next;
};
TablePaths table_paths(const std::filesystem::path& file);

}  // namespace tassilo
