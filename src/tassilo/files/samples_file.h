#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tassilo/color/color_class.h"
#include "tassilo/geometry/box.h"
#include "tassilo/geometry/point.h"

namespace tassilo {

/// All pixels with one value in an 8-bit gray PNG of the image's size.
struct SampleMask {
  std::filesystem::path path;
  int value = 0;  ///< 0..255
  friend bool operator==(const SampleMask&, const SampleMask&) = default;
};

/// The way of a round brush: pixels whose centre is at most `radius` from it.
struct SampleStroke {
  std::vector<PixelPoint> way;  ///< At least one point.
  double radius = 0;            ///< [px], >= 0
  friend bool operator==(const SampleStroke&, const SampleStroke&) = default;
};

/// A box, the corners of a polygon (at least three), a stroke, or a mask. May leave the image.
using SampleShape = std::variant<PixelBox, std::vector<PixelPoint>, SampleStroke, SampleMask>;

/// One labelled region of one image.
struct TrainingSample {
  std::filesystem::path image;              ///< PNG, JPEG or a video; resolved: relative ones are relative to the file.
  std::int64_t frame = 0;                   ///< 0-based frame of a video.
  ColorClass color = ColorClass::no_color;  ///< no_color: whatever this is, it is none of the classes.
  SampleShape shape;
  int line = 0;  ///< Where it stands in the file, for messages; not written.
};

/// In the order of the file. Does not open the images. Throws Error with file, line and column.
std::vector<TrainingSample> read_samples(const std::filesystem::path& file);
std::vector<TrainingSample> samples_from_yaml(std::string_view text, const std::filesystem::path& file);
/// The text of such a file in `folder`; paths in it are relative to the folder.
std::string samples_yaml(const std::vector<TrainingSample>& samples, const std::filesystem::path& folder);
/// Written atomically, paths relative to the file's folder.
void write_samples(const std::filesystem::path& file, const std::vector<TrainingSample>& samples);

}  // namespace tassilo
