#include "tassilo/files/odometry_file.h"

#include "tassilo/base/error.h"
#include "tassilo/files/json.h"
#include "tassilo/files/setting.h"
#include "tassilo/files/text.h"

namespace tassilo {

std::vector<OdometrySample> read_odometry(const std::filesystem::path& file) {
  constexpr std::size_t kMaxLine = 4096;
  std::vector<OdometrySample> samples;
  LineReader lines(file, kMaxLine);
  while (const auto line = lines.next()) {
    const Map map = parse_json(*line, lines.place()).map({"t", "x", "y", "theta"});
    const OdometrySample sample{map.at("t").number(), map.at("x").number(), map.at("y").number(),
                                map.at("theta").number()};
    if (!samples.empty() && !(sample.t > samples.back().t))
      throw Error(lines.place(), "t is " + number_text(sample.t) + ", which goes back in time, must be > " +
                                     number_text(samples.back().t) + " of the line before");
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace tassilo
