#include "tassilo/files/odometry_file.h"

#include <cmath>

#include "tassilo/base/contract.h"
#include "tassilo/files/document.h"
#include "tassilo/files/internal/exact_number.h"
#include "tassilo/files/json.h"
#include "tassilo/files/text.h"

namespace tassilo {

OdometryLine read_odometry_line(std::string_view line, std::string_view place) {
  const Map map = parse_json(line, place).map({"t", "x", "y", "theta", "frame"});
  OdometryLine out{{map.at("t").number(), map.at("x").number(), map.at("y").number(), map.at("theta").number()},
                   std::nullopt};
  if (const auto frame = map.find("frame")) out.frame = frame->integer(0, std::int64_t{1} << 53);
  return out;
}

std::vector<OdometryLine> read_odometry_lines(const std::filesystem::path& file) {
  constexpr std::size_t kMaxLine = 4096;
  std::vector<OdometryLine> all;
  LineReader lines(file, kMaxLine);
  while (const auto line = lines.next()) all.push_back(read_odometry_line(*line, lines.place()));
  return all;
}

std::vector<OdometrySample> read_odometry(const std::filesystem::path& file) {
  std::vector<OdometrySample> samples;
  for (const OdometryLine& line : read_odometry_lines(file)) samples.push_back(line.sample);
  return samples;
}

std::string odometry_line(const OdometryLine& line) {
  const OdometrySample& s = line.sample;
  for (const double value : {s.t, s.x, s.y, s.theta}) expects(std::isfinite(value), "odometry is finite");
  std::string text = "{\"t\": " + exact_number(s.t) + ", \"x\": " + exact_number(s.x) +
                     ", \"y\": " + exact_number(s.y) + ", \"theta\": " + exact_number(s.theta);
  if (line.frame) text += ", \"frame\": " + std::to_string(*line.frame);
  return text + "}";
}

}  // namespace tassilo
