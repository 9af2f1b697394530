#include "tassilo/files/odometry_file.h"

#include "tassilo/files/document.h"
#include "tassilo/files/json.h"
#include "tassilo/files/text.h"

namespace tassilo {

OdometrySample read_odometry_line(std::string_view line, std::string_view place) {
  const Map map = parse_json(line, place).map({"t", "x", "y", "theta"});
  return {map.at("t").number(), map.at("x").number(), map.at("y").number(), map.at("theta").number()};
}

std::vector<OdometrySample> read_odometry(const std::filesystem::path& file) {
  constexpr std::size_t kMaxLine = 4096;
  std::vector<OdometrySample> samples;
  LineReader lines(file, kMaxLine);
  while (const auto line = lines.next()) samples.push_back(read_odometry_line(*line, lines.place()));
  return samples;
}

}  // namespace tassilo
