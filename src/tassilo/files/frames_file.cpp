#include "tassilo/files/frames_file.h"

#include <cmath>

#include "tassilo/base/contract.h"
#include "tassilo/files/document.h"
#include "tassilo/files/internal/exact_number.h"
#include "tassilo/files/internal/json_text.h"
#include "tassilo/files/json.h"

namespace tassilo {

std::filesystem::path stamps_file_of(const std::filesystem::path& video) { return video.string() + ".frames.jsonl"; }

std::string frame_stamp_line(const FrameStamp& stamp) {
  expects(std::isfinite(stamp.t) && stamp.index >= 0, "a frame has an index and a finite time");
  std::string line = "{\"frame\": " + std::to_string(stamp.index) + ", \"t\": " + exact_number(stamp.t);
  if (!stamp.image.empty()) line += ", \"image\": " + json_text(stamp.image);
  return line + "}";
}

std::optional<FrameStamp> FrameStampReader::next() {
  const auto line = lines_.next();
  if (!line) return std::nullopt;
  const Map map = parse_json(*line, lines_.place()).map({"frame", "t", "image"});
  FrameStamp stamp{map.at("frame").integer(0, std::int64_t{1} << 53), map.at("t").number(), ""};
  if (const auto image = map.find("image")) stamp.image = image->string();
  return stamp;
}

}  // namespace tassilo
