#include "tassilo/files/colors_file.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "tassilo/base/error.h"
#include "tassilo/files/atomic_file.h"
#include "tassilo/files/internal/checked.h"
#include "tassilo/files/internal/color_value.h"
#include "tassilo/files/internal/yaml_text.h"
#include "tassilo/files/png.h"
#include "tassilo/files/yaml.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

constexpr BrightnessInterval kNoBrightness{1, 0};
constexpr std::array<std::string_view, 2> kRanges{"limited", "full"};

std::size_t index_of(ColorClass color) { return static_cast<std::size_t>(class_index(color)); }

/// One value for each key, which must be a color class.
template <class Read>
void for_each_color(const Value& value, Read read) {
  const Map map = value.map({"black", "white", "green", "blue", "cyan", "magenta", "red", "yellow"});
  for (const ColorClass color : kColorClasses)
    if (const auto entry = map.find(to_string(color))) read(color, *entry);
}

BrightnessInterval interval_of(const Value& value) {
  const auto ends = value.list(2, 2);
  const BrightnessInterval interval{static_cast<int>(ends[0].integer(0, 255)),
                                    static_cast<int>(ends[1].integer(0, 255))};
  if (interval.low > interval.high)
    value.fail("is [" + std::to_string(interval.low) + ", " + std::to_string(interval.high) + "], must be [low, high]");
  return interval;
}

std::string interval_yaml(const BrightnessInterval& interval) {
  const std::array<double, 2> ends{double(interval.low), double(interval.high)};
  return yaml_numbers(ends);
}

void read_brightness(const Value& value, ColorTable& table) {
  table.brightness.fill(kNoBrightness);
  for_each_color(value,
                 [&](ColorClass color, const Value& entry) { table.brightness[index_of(color)] = interval_of(entry); });
}

void read_chroma(const Value& value, const fs::path& folder, ColorTable& table) {
  const fs::path png = value.path(folder);
  const GrayImage image = read_png_gray(png);
  if (image.width != 256 || image.height != 256)
    throw Error(png.string(), "has " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                                  " pixels, must have 256x256");
  std::ranges::copy(image.pixels, table.chroma.begin());
  ClassBits used = 0;
  for (const ClassBits bits : table.chroma) used |= bits;
  for (const ColorClass color : kColorClasses)
    if ((used & class_bit(color)) && table.brightness[index_of(color)] == kNoBrightness)
      value.fail("has cells of " + std::string(to_string(color)) + ", but brightness." + std::string(to_string(color)) +
                 " is missing");
}

void read_priority(const Value& value, ColorTable& table) {
  const auto names = value.list(kColorClassCount, kColorClassCount);
  for (std::size_t i = 0; i < names.size(); ++i) {
    table.priority[i] = color_of(names[i]);
    if (std::find(table.priority.begin(), table.priority.begin() + static_cast<std::ptrdiff_t>(i), table.priority[i]) !=
        table.priority.begin() + static_cast<std::ptrdiff_t>(i))
      names[i].fail("is a second " + std::string(to_string(table.priority[i])) + ", must name each class once");
  }
}

Provenance provenance_of(const Value& value) {
  const Map map = value.map({"samples", "date", "quality", "notes", "options", "brightness"});
  Provenance provenance;
  if (const auto samples = map.find("samples")) provenance.samples = samples->string();
  if (const auto date = map.find("date")) provenance.date = date->string();
  if (const auto notes = map.find("notes")) provenance.notes = notes->string();
  if (const auto options = map.find("options"))
    for (const auto& [name, option] : options->any_map().entries()) provenance.options[name] = option.number();
  if (const auto brightness = map.find("brightness"))
    for_each_color(*brightness,
                   [&](ColorClass color, const Value& entry) { provenance.brightness[color] = interval_of(entry); });
  if (const auto quality = map.find("quality"))
    for_each_color(*quality, [&](ColorClass color, const Value& entry) {
      const Map numbers = entry.map({"precision", "recall"});
      ClassQuality& of_class = provenance.quality[color];
      if (const auto precision = numbers.find("precision")) of_class.precision = precision->number(0, 1);
      if (const auto recall = numbers.find("recall")) of_class.recall = recall->number(0, 1);
    });
  return provenance;
}

std::string quality_yaml(const ClassQuality& quality) {
  std::string out = "{";
  if (quality.precision) out += "precision: " + number_text(*quality.precision);
  if (quality.precision && quality.recall) out += ", ";
  if (quality.recall) out += "recall: " + number_text(*quality.recall);
  return out + "}";
}

std::string provenance_yaml(const Provenance& provenance) {
  std::ostringstream out;
  out << "trained_from:\n";
  if (!provenance.samples.empty()) out << "  samples: " << yaml_text(provenance.samples) << "\n";
  if (!provenance.date.empty()) out << "  date: " << yaml_text(provenance.date) << "\n";
  if (!provenance.notes.empty()) out << "  notes: " << yaml_text(provenance.notes) << "\n";
  if (!provenance.options.empty()) out << "  options:\n";
  for (const auto& [name, value] : provenance.options)
    out << "    " << yaml_text(name) << ": " << number_text(value) << "\n";
  if (!provenance.brightness.empty()) out << "  brightness:\n";
  for (const auto& [color, interval] : provenance.brightness)
    out << "    " << to_string(color) << ": " << interval_yaml(interval) << "\n";
  out << "  quality:" << (provenance.quality.empty() ? " {}" : "") << "\n";
  for (const auto& [color, quality] : provenance.quality)
    out << "    " << to_string(color) << ": " << quality_yaml(quality) << "\n";
  return out.str();
}

std::string colors_yaml(const ColorsFile& colors, const std::string& png_name) {
  const ColorTable& table = colors.table;
  std::ostringstream out;
  out << "table: " << yaml_text(png_name) << "\nrange: " << to_string(table.range) << "\nbrightness:";
  bool any = false;
  for (const ColorClass color : kColorClasses) {
    const BrightnessInterval& interval = table.brightness[index_of(color)];
    if (interval.low > interval.high) continue;
    out << "\n  " << to_string(color) << ": " << interval_yaml(interval);
    any = true;
  }
  out << (any ? "\n" : " {}\n");
  if (table.priority != kDefaultPriority) {
    out << "priority: [";
    for (std::size_t i = 0; i < table.priority.size(); ++i) out << (i > 0 ? ", " : "") << to_string(table.priority[i]);
    out << "]\n";
  }
  if (colors.trained_from) out << provenance_yaml(*colors.trained_from);
  return out.str();
}

ColorsFile colors_of(const Value& root, const fs::path& file) {
  const Map map = root.map({"table", "range", "brightness", "priority", "trained_from"});
  ColorsFile colors;
  colors.table.range = map.at("range").choice(kRanges) == 0 ? ColorRange::limited : ColorRange::full;
  read_brightness(map.at("brightness"), colors.table);
  if (const auto priority = map.find("priority")) read_priority(*priority, colors.table);
  if (const auto provenance = map.find("trained_from")) colors.trained_from = provenance_of(*provenance);
  read_chroma(map.at("table"), file.parent_path(), colors.table);
  colors.table = checked(std::move(colors.table), file.string());
  return colors;
}

}  // namespace

ColorsFile read_colors(const fs::path& file) { return colors_of(read_yaml(file), file); }
ColorsFile colors_from_yaml(std::string_view text, const fs::path& file) {
  return colors_of(parse_yaml(text, file.string()), file);
}

TablePaths table_paths(const fs::path& file) {
  const fs::path first = fs::path(file).replace_extension(".png");
  TablePaths paths{{}, first};
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return paths;
  try {
    paths.now = read_yaml(file).any_map().at("table").path(file.parent_path());
  } catch (const Error&) {  // what cannot be read names nothing that must be kept
  }
  if (paths.now.lexically_normal() == first.lexically_normal()) paths.next = fs::path(file).replace_extension(".2.png");
  return paths;
}

void write_colors(const fs::path& file, const ColorsFile& colors) {
  colors.table.check();
  // An empty interval holds no pixel, so its cells mean nothing and would be refused on reading.
  ClassBits kept = 0;
  for (const ColorClass color : kColorClasses) {
    const BrightnessInterval& interval = colors.table.brightness[index_of(color)];
    if (interval.low <= interval.high) kept |= class_bit(color);
  }
  GrayImage image{256, 256, {colors.table.chroma.begin(), colors.table.chroma.end()}};
  for (std::uint8_t& bits : image.pixels) bits &= kept;
  const fs::path png = table_paths(file).next;
  write_png_gray(png, image);
  write_atomically(file, colors_yaml(colors, png.filename().string()));
}

}  // namespace tassilo
