#include "tassilo/record/image_folder.h"

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"

namespace tassilo {

ImageFolder::ImageFolder(const std::string& folder) : folder_(folder) {
  std::error_code problem;
  std::filesystem::create_directories(folder_, problem);
  if (problem) throw Error(folder, "cannot be made a folder: " + problem.message());
}

std::filesystem::path ImageFolder::file_of(std::int64_t index) const {
  expects(index >= 0, "ImageFolder: frame index >= 0");
  constexpr std::size_t kDigits = 4;
  const std::string number = std::to_string(index);
  return folder_ / (std::string(kDigits - std::min(kDigits, number.size()), '0') + number + ".png");
}

void ImageFolder::write(const GrayImage& image, std::int64_t index) const { write_png_gray(file_of(index), image); }

void ImageFolder::write(const Picture& picture, std::int64_t index) const {
  write_png_rgb(file_of(index), {picture.width, picture.height, picture.pixels});
}

}  // namespace tassilo
