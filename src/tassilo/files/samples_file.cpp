#include "tassilo/files/samples_file.h"

#include <array>
#include <sstream>

#include "tassilo/files/atomic_file.h"
#include "tassilo/files/internal/color_value.h"
#include "tassilo/files/internal/sample_shape.h"
#include "tassilo/files/internal/yaml_text.h"
#include "tassilo/files/yaml.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxCoordinate = 32000;  // regions are 16 bit
constexpr double kMaxBrush = 1000;     // wider than any picture is meant to be painted with [px]

PixelBox box_of(const Value& value) {
  std::array<int, 4> ends;
  const auto values = value.list(4, 4);
  for (std::size_t i = 0; i < 4; ++i) ends[i] = static_cast<int>(values[i].integer(-kMaxCoordinate, kMaxCoordinate));
  const PixelBox box{ends[0], ends[1], ends[2], ends[3]};
  if (box.empty()) value.fail("is empty, must be [x0, y0, x1, y1] with x0 < x1 and y0 < y1");
  return box;
}

std::vector<PixelPoint> points_of(const Value& value, std::size_t least) {
  std::vector<PixelPoint> points;
  for (const Value& point : value.list(least, 10'000)) {
    const auto c = point.list(2, 2);
    points.push_back({c[0].number(-kMaxCoordinate, kMaxCoordinate), c[1].number(-kMaxCoordinate, kMaxCoordinate)});
  }
  return points;
}

std::string points_yaml(const std::vector<PixelPoint>& points) {
  std::string out = "[";
  for (std::size_t i = 0; i < points.size(); ++i)
    out.append(i > 0 ? ", " : "").append(yaml_numbers(std::array<double, 2>{points[i].x, points[i].y}));
  return out + "]";
}

std::vector<TrainingSample> samples_of(const Value& root, const fs::path& folder) {
  std::vector<TrainingSample> samples;
  for (const Value& entry : root.list()) {
    const Map map = entry.map({"image", "frame", "class", "rectangle", "polygon", "stroke", "radius", "mask", "value"});
    TrainingSample sample;
    sample.image = map.at("image").path(folder);
    if (const auto frame = map.find("frame")) sample.frame = frame->integer(0);
    sample.color = label_of(map.at("class"));
    sample.shape = sample_shape_of(map, folder);
    sample.line = entry.line();
    samples.push_back(std::move(sample));
  }
  return samples;
}

struct ShapeYaml {
  fs::path folder;

  std::string operator()(const PixelBox& box) const {
    const std::array<double, 4> ends{double(box.x0), double(box.y0), double(box.x1), double(box.y1)};
    return "rectangle: " + yaml_numbers(ends);
  }
  std::string operator()(const std::vector<PixelPoint>& corners) const { return "polygon: " + points_yaml(corners); }
  std::string operator()(const SampleStroke& stroke) const {
    return "stroke: " + points_yaml(stroke.way) + ", radius: " + number_text(stroke.radius);
  }
  std::string operator()(const SampleMask& mask) const {
    return "mask: " + yaml_path(mask.path, folder) + ", value: " + std::to_string(mask.value);
  }
};

}  // namespace

SampleShape sample_shape_of(const Map& map, const fs::path& folder) {
  const auto rectangle = map.find("rectangle"), polygon = map.find("polygon"), stroke = map.find("stroke"),
             mask = map.find("mask");
  if ((rectangle ? 1 : 0) + (polygon ? 1 : 0) + (stroke ? 1 : 0) + (mask ? 1 : 0) != 1)
    map.value().fail("must have one of rectangle, polygon, stroke or mask");
  if (const auto value = map.find("value"); value && !mask) value->fail("stands without a mask, must go with one");
  if (const auto radius = map.find("radius"); radius && !stroke)
    radius->fail("stands without a stroke, must go with one");
  if (rectangle) return box_of(*rectangle);
  if (polygon) return points_of(*polygon, 3);
  if (stroke) return SampleStroke{points_of(*stroke, 1), map.at("radius").number(0, kMaxBrush)};
  return SampleMask{mask->path(folder), static_cast<int>(map.at("value").integer(0, 255))};
}

std::vector<TrainingSample> read_samples(const fs::path& file) {
  return samples_of(read_yaml(file), file.parent_path());
}
std::vector<TrainingSample> samples_from_yaml(std::string_view text, const fs::path& file) {
  return samples_of(parse_yaml(text, file.string()), file.parent_path());
}

std::string samples_yaml(const std::vector<TrainingSample>& samples, const fs::path& folder) {
  if (samples.empty()) return "[]\n";
  std::ostringstream out;
  for (const TrainingSample& sample : samples)
    out << "- {image: " << yaml_path(sample.image, folder) << ", frame: " << sample.frame
        << ", class: " << to_string(sample.color) << ", " << std::visit(ShapeYaml{folder}, sample.shape) << "}\n";
  return out.str();
}

void write_samples(const fs::path& file, const std::vector<TrainingSample>& samples) {
  write_atomically(file, samples_yaml(samples, file.parent_path()));
}

}  // namespace tassilo
