#include "tassilo/files/field_file.h"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>

#include "tassilo/base/error.h"
#include "tassilo/files/internal/checked.h"
#include "tassilo/files/internal/color_value.h"
#include "tassilo/files/internal/yaml_text.h"
#include "tassilo/files/nearest_name.h"
#include "tassilo/files/yaml.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

Interval interval_of(const Value& value) {
  const auto ends = value.numbers(2);
  return {ends[0], ends[1]};
}

std::string color_name_of(const Value& value) { return std::string(to_string(color_of(value))); }

FieldModel::Area area_of(const Value& value) {
  const Map map = value.map({"depth", "width"});
  return {map.at("depth").number(), map.at("width").number()};
}

FieldModel::Segment segment_of(const Value& value) {
  const auto n = value.numbers(4);
  return {n[0], n[1], n[2], n[3]};
}

FieldModel::Arc arc_of(const Value& value) {
  const auto n = value.numbers(5);
  return {n[0], n[1], n[2], n[3], n[4]};
}

FieldModel::Goal goal_of(const Value& value) {
  constexpr std::array<std::string_view, 2> kSides{"+x", "-x"}, kColors{"yellow", "blue"};
  const Map map = value.map({"side", "color", "width", "height", "depth"});
  FieldModel::Goal goal;
  goal.side = map.at("side").choice(kSides) == 0 ? GoalSide::plus_x : GoalSide::minus_x;
  goal.color = map.at("color").choice(kColors) == 0 ? GoalColor::yellow : GoalColor::blue;
  goal.width = map.at("width").number();
  goal.height = map.at("height").number();
  if (const auto depth = map.find("depth")) goal.depth = depth->number();
  return goal;
}

FieldModel::Walls walls_of(const Value& value) {
  const Map map = value.map({"color", "height", "x", "y"});
  FieldModel::Walls walls;
  if (const auto color = map.find("color")) walls.color = color_name_of(*color);
  walls.height = map.at("height").number();
  walls.x = interval_of(map.at("x"));
  walls.y = interval_of(map.at("y"));
  return walls;
}

FieldModel::Ball ball_of(const Value& value) {
  const Map map = value.map({"color", "radius"});
  FieldModel::Ball ball;
  if (const auto color = map.find("color")) ball.color = color_name_of(*color);
  if (const auto radius = map.find("radius")) ball.radius = interval_of(*radius);
  return ball;
}

FieldModel::Robots robots_of(const Value& value) {
  const Map map = value.map({"width", "height", "body", "markers"});
  FieldModel::Robots robots;
  if (const auto width = map.find("width")) robots.width = interval_of(*width);
  if (const auto height = map.find("height")) robots.height = interval_of(*height);
  if (const auto body = map.find("body")) robots.body = color_name_of(*body);
  if (const auto markers = map.find("markers")) {
    robots.markers.clear();
    for (const Value& marker : markers->list(0, kColorClassCount)) robots.markers.push_back(color_name_of(marker));
  }
  return robots;
}

template <class T>
std::vector<T> list_of(const std::optional<Value>& value, T (*item_of)(const Value&)) {
  constexpr std::size_t kMaxItems = 10'000;
  std::vector<T> items;
  if (value)
    for (const Value& item : value->list(0, kMaxItems)) items.push_back(item_of(item));
  return items;
}

FieldModel field_of(const Value& root, const fs::path& file) {
  const Map map = root.map({"length", "width", "line_width", "halfway_line", "touchlines", "circle_radius", "areas",
                            "segments", "arcs", "goals", "walls", "ball", "robots"});
  FieldModel field;
  field.name = file.stem().string();
  field.length = map.at("length").number();
  field.width = map.at("width").number();
  if (const auto value = map.find("line_width")) field.line_width = value->number();
  if (const auto value = map.find("halfway_line")) field.halfway_line = value->boolean();
  if (const auto value = map.find("touchlines")) field.touchlines = value->boolean();
  if (const auto value = map.find("circle_radius")) field.circle_radius = value->number();
  field.areas = list_of(map.find("areas"), area_of);
  field.segments = list_of(map.find("segments"), segment_of);
  field.arcs = list_of(map.find("arcs"), arc_of);
  field.goals = list_of(map.find("goals"), goal_of);
  if (const auto value = map.find("walls")) field.walls = walls_of(*value);
  if (const auto value = map.find("ball")) field.ball = ball_of(*value);
  if (const auto value = map.find("robots")) field.robots = robots_of(*value);
  return checked(std::move(field), file.string());
}

std::string interval_yaml(const Interval& interval) { return yaml_numbers(std::array{interval.low, interval.high}); }

template <class T, class Text>
void write_list(std::ostringstream& out, const char* key, const std::vector<T>& items, Text text_of) {
  if (items.empty()) return;
  out << key << ":\n";
  for (const T& item : items) out << "  - " << text_of(item) << "\n";
}

std::vector<std::string> shipped_names(std::span<const fs::path> folders) {
  std::vector<std::string> names;
  for (const fs::path& folder : folders) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder / "fields", error))
      if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

}  // namespace

std::vector<fs::path> config_folders() {
  std::vector<fs::path> folders;
  std::error_code error;
  // The installed program is beside its own prefix, above its own code and in the prefix it was built for: one folder.
  const auto add = [&](const fs::path& folder) {
    const auto is_same = [&](const fs::path& other) {
      return folder == other || fs::weakly_canonical(folder, error) == fs::weakly_canonical(other, error);
    };
    if (std::ranges::none_of(folders, is_same)) folders.push_back(folder);
  };
  if (const char* chosen = std::getenv("TASSILO_CONFIG_DIR"); chosen && *chosen) add(chosen);
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) add(program.parent_path().parent_path() / "share/tassilo/config");
  // A library or Python module knows its own place, PREFIX/lib/.../it.so, wherever the prefix was moved.
  if (Dl_info code; dladdr(reinterpret_cast<void*>(&is_field_path), &code) != 0 && code.dli_fname != nullptr)
    for (fs::path folder = code.dli_fname; folder.is_absolute() && folder != folder.root_path();) {
      folder = folder.parent_path();
      if (fs::exists(folder / "share/tassilo/config", error)) add(folder / "share/tassilo/config");
    }
  add(TASSILO_INSTALLED_CONFIG);
  add(TASSILO_SOURCE_CONFIG);
  return folders;
}

bool is_field_path(std::string_view name) {
  return name.find('/') != std::string_view::npos || name.ends_with(".yaml") || name.ends_with(".yml");
}

FieldModel read_field(const std::string& name, std::span<const fs::path> folders) {
  if (is_field_path(name)) return field_of(read_yaml(name), name);
  for (const fs::path& folder : folders) {
    const fs::path file = folder / "fields" / (name + ".yaml");
    if (fs::exists(file)) return field_of(read_yaml(file), file);
  }
  const auto names = shipped_names(folders);
  const std::vector<std::string_view> views(names.begin(), names.end());
  const auto near = nearest_name(name, views);
  throw Error("field " + shown(name), "is no shipped field, must be " + (views.empty() ? "" : joined(views) + ", or ") +
                                          "a path that ends in .yaml" +
                                          (near ? "; did you mean " + std::string(*near) + "?" : ""));
}

FieldModel read_field(const std::string& name) { return read_field(name, config_folders()); }

std::string field_yaml(const FieldModel& field) {
  const auto number = [](double value) { return number_text(value); };
  std::ostringstream out;
  out << "length: " << number(field.length) << "\nwidth: " << number(field.width)
      << "\nline_width: " << number(field.line_width) << "\nhalfway_line: " << (field.halfway_line ? "true" : "false")
      << "\ntouchlines: " << (field.touchlines ? "true" : "false") << "\ncircle_radius: " << number(field.circle_radius)
      << "\n";
  write_list(out, "areas", field.areas, [&](const FieldModel::Area& area) {
    return "{depth: " + number(area.depth) + ", width: " + number(area.width) + "}";
  });
  write_list(out, "segments", field.segments, [](const FieldModel::Segment& s) {
    return yaml_numbers(std::array{s.x0, s.y0, s.x1, s.y1});
  });
  write_list(out, "arcs", field.arcs, [](const FieldModel::Arc& arc) {
    return yaml_numbers(std::array{arc.cx, arc.cy, arc.radius, arc.from, arc.to});
  });
  write_list(out, "goals", field.goals, [&](const FieldModel::Goal& goal) {
    return std::string("{side: ") + (goal.side == GoalSide::plus_x ? "+x" : "-x") +
           ", color: " + (goal.color == GoalColor::yellow ? "yellow" : "blue") + ", width: " + number(goal.width) +
           ", height: " + number(goal.height) + ", depth: " + number(goal.depth) + "}";
  });
  if (const auto& walls = field.walls)
    out << "walls: {color: " << yaml_text(walls->color) << ", height: " << number(walls->height)
        << ", x: " << interval_yaml(walls->x) << ", y: " << interval_yaml(walls->y) << "}\n";
  out << "ball: {color: " << yaml_text(field.ball.color) << ", radius: " << interval_yaml(field.ball.radius) << "}\n"
      << "robots: {width: " << interval_yaml(field.robots.width) << ", height: " << interval_yaml(field.robots.height)
      << ", body: " << yaml_text(field.robots.body) << ", markers: [";
  for (std::size_t i = 0; i < field.robots.markers.size(); ++i)
    out << (i > 0 ? ", " : "") << yaml_text(field.robots.markers[i]);
  out << "]}\n";
  return out.str();
}

FieldModel field_from_yaml(std::string_view text, const fs::path& file) {
  return field_of(parse_yaml(text, file.string()), file);
}

}  // namespace tassilo
