#include "tassilo/files/training_draft.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tassilo/base/error.h"
#include "tassilo/files/internal/color_value.h"
#include "tassilo/files/internal/sample_shape.h"
#include "tassilo/files/json.h"

namespace tassilo {
namespace {

using nlohmann::json;

constexpr std::size_t kMostSamples = 1'000;

void read_options(const Map& map, TrainingOptions& options) {
  const auto numbers = training_numbers();
  for (const auto& [key, value] : map.entries()) {
    const auto number = std::ranges::find(numbers, key, &TrainingNumber::key);
    if (number == numbers.end()) value.fail("is no parameter of the training");
    number->set(options, value.number());
  }
}

void read_brightness(const Map& map, TrainingOptions& options) {
  for (const auto& [key, value] : map.entries()) {
    const auto color = color_class_from(key);
    if (!color || *color == ColorClass::no_color) value.fail("is no class that has a brightness");
    const auto ends = value.list(2, 2);
    options.brightness[static_cast<std::size_t>(class_index(*color))] = {static_cast<int>(ends[0].integer(0, 255)),
                                                                         static_cast<int>(ends[1].integer(0, 255))};
  }
}

json points_json(const std::vector<PixelPoint>& points) {
  json list = json::array();
  for (const PixelPoint& point : points) list.push_back({point.x, point.y});
  return list;
}

struct ShapeJson {
  json& sample;

  void operator()(const PixelBox& box) const { sample["rectangle"] = {box.x0, box.y0, box.x1, box.y1}; }
  void operator()(const std::vector<PixelPoint>& corners) const { sample["polygon"] = points_json(corners); }
  void operator()(const SampleStroke& stroke) const {
    sample["stroke"] = points_json(stroke.way);
    sample["radius"] = stroke.radius;
  }
  void operator()(const SampleMask& mask) const {
    sample["mask"] = mask.path.string();
    sample["value"] = mask.value;
  }
};

}  // namespace

TrainingDraft draft_from_json(std::string_view text, std::string_view place) {
  const Map map = parse_json(text, place).map({"version", "samples", "options", "brightness"});
  TrainingDraft draft;
  draft.version = map.at("version").integer(0);
  for (const Value& entry : map.at("samples").list(0, kMostSamples)) {
    const Map sample = entry.map({"image", "class", "rectangle", "polygon", "stroke", "radius", "mask", "value"});
    draft.samples.push_back({sample.at("image").string(), label_of(sample.at("class")), sample_shape_of(sample, {})});
  }
  read_options(map.at("options").any_map(), draft.options);
  read_brightness(map.at("brightness").any_map(), draft.options);
  draft.options.check();
  return draft;
}

std::string draft_sample_json(const DraftSample& sample) {
  json out{{"image", sample.image}, {"class", to_string(sample.color)}};
  std::visit(ShapeJson{out}, sample.shape);
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace tassilo
