#include "tassilo/files/odometry_file.h"

#include "tassilo/files/document.h"
#include "tassilo/files/json.h"
#include "tassilo/files/text.h"

namespace tassilo {

std::vector<OdometrySample> read_odometry(const std::filesystem::path& file) {
  constexpr std::size_t kMaxLine = 4096;
  std::vector<OdometrySample> samples;
  LineReader lines(file, kMaxLine);
  while (const auto line = lines.next()) {
    const Map map = parse_json(*line, lines.place()).map({"t", "x", "y", "theta"});
    samples.push_back({map.at("t").number(), map.at("x").number(), map.at("y").number(), map.at("theta").number()});
  }
  return samples;
}

}  // namespace tassilo
