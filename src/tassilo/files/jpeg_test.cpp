#include "tassilo/files/jpeg.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

// What decodes them is tested with the program: tests/serve_test.py.

namespace tassilo {
namespace {

/// Height and width as the frame header (SOF0) says.
std::pair<int, int> size_in(const std::string& jpeg) {
  for (std::size_t k = 2; k + 9 < jpeg.size();) {
    const auto byte = [&](std::size_t i) { return static_cast<int>(static_cast<unsigned char>(jpeg[k + i])); };
    if (byte(0) != 0xff) break;
    if (byte(1) == 0xc0) return {256 * byte(5) + byte(6), 256 * byte(7) + byte(8)};
    k += 2 + static_cast<std::size_t>(256 * byte(2) + byte(3));
  }
  return {0, 0};
}

TEST(EncodeJpeg, IsAWholeFileOfTheSize) {
  for (const auto& [width, height] : {std::pair(1, 1), {2, 1}, {17, 33}, {640, 480}}) {
    const std::vector<std::uint8_t> gray(3 * static_cast<std::size_t>(width * height), 128);
    const std::string jpeg = encode_jpeg(gray, width, height, 80);
    EXPECT_EQ(jpeg.substr(0, 2), "\xff\xd8");
    EXPECT_EQ(jpeg.substr(jpeg.size() - 2), "\xff\xd9");
    EXPECT_EQ(size_in(jpeg), std::pair(height, width));
  }
}

TEST(EncodeJpeg, BetterIsLarger) {
  std::vector<std::uint8_t> noise(3 * 64 * 64);
  unsigned state = 1;
  for (std::uint8_t& value : noise) value = static_cast<std::uint8_t>((state = state * 1664525 + 1013904223) >> 24);
  EXPECT_LT(encode_jpeg(noise, 64, 64, 30).size(), encode_jpeg(noise, 64, 64, 90).size());
}

TEST(EncodeJpeg, CarriesAComment) {
  const std::vector<std::uint8_t> gray(3 * 16, 128);
  EXPECT_NE(encode_jpeg(gray, 4, 4, 80, "frame 7").find("frame 7"), std::string::npos);
}

}  // namespace
}  // namespace tassilo
