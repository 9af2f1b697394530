#pragma once

#include <filesystem>
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

/// Writes the table beside `file` as STEM.png, then `file`, each atomically. Whoever watches `file` finds the PNG
/// complete. Reading gives the same table; all empty brightness intervals read back as one.
void write_colors(const std::filesystem::path& file, const ColorsFile& colors);

}  // namespace tassilo
