#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tassilo/files/png.h"
#include "tassilo/overlay/picture.h"

namespace tassilo {

/// PNG files numbered by frame, NNNN.png with at least four digits: label maps, annotated pictures.
///
/// Each is written as a whole or not at all; files of other frames stay. One thread at a time.
class ImageFolder {
 public:
  /// Makes the folder, and those above it, where they are missing. Throws Error when that cannot be.
  explicit ImageFolder(const std::string& folder);

  /// Where frame `index` goes; index >= 0.
  std::filesystem::path file_of(std::int64_t index) const;

  /// Throw Error naming the file when it cannot be written.
  void write(const GrayImage& image, std::int64_t index) const;
  void write(const Picture& picture, std::int64_t index) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace tassilo
