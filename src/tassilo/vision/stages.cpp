#include "tassilo/vision/stages.h"

#include <algorithm>
#include <set>
#include <utility>

#include "tassilo/base/error.h"
#include "tassilo/localize/boundary_pose.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/raster.h"

namespace tassilo {
namespace {

/// Where wall and field meet (DESIGN 6.8).
Boundary boundary_in(const View& view, const BoundaryOptions& options) {
  const auto& kinds = view.surface.kinds;
  const ByteView pixels{reinterpret_cast<const std::uint8_t*>(kinds.data()), view.surface.width, view.surface.height,
                        view.surface.width};
  constexpr int wall = static_cast<int>(SurfaceKind::wall), carpet = static_cast<int>(SurfaceKind::carpet),
                line = static_cast<int>(SurfaceKind::line);
  return find_boundary(view.frame, region_where(pixels, [](int kind) { return kind == wall; }),
                       region_where(pixels, [](int kind) { return kind == carpet || kind == line; }),
                       view.optics->camera, view.optics->rays, options);
}

auto boundary_by(BoundaryMethod method) {
  return [method](const VisionOptions& options) {
    BoundaryOptions boundary = options.boundary;
    boundary.method = method;
    return [boundary](const View& view) { return boundary_in(view, boundary); };
  };
}

Localizer by_model(const VisionOptions& options) {
  return {.run = [localize_options = options.localize](const LocalizationInput& input) {
    return localize(input.target, input.before, input.motion, input.seen, input.t, localize_options);
  }};
}

Localizer by_boundary(const VisionOptions&) {
  return {.run =
              [](const LocalizationInput& input) {
                RecycledVector<GoalInImage> goals;
                for (const Goal& goal : input.seen.goals) {
                  const ColorClass color = goal.color == GoalColor::yellow ? ColorClass::yellow : ColorClass::blue;
                  goals.push_back({goal.color, clipped(input.view.segmentation.of(color), goal.box)});
                }
                return localize_by_boundary(input.target, input.before, input.motion,
                                            {input.boundary->segments, goals, input.view.optics->camera}, input.t);
              },
          .needs_boundary = true,
          .needs_walls = true};
}

bool is_name(const std::string& text) {
  return !text.empty() &&
         std::ranges::all_of(text, [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; });
}

bool is_there(const Localizer& made) { return static_cast<bool>(made.run); }
template <class Function>
bool is_there(const Function& made) {
  return static_cast<bool>(made);
}

template <class Function>
Function made_by(const Stage<Function>& stage, const Alternative<Function>& alternative, const VisionOptions& options) {
  Function made = alternative.make(options);
  if (!is_there(made)) throw Error("vision." + std::string(stage.key), shown(alternative.name) + " makes no function");
  return made;
}

template <class Function>
Function chosen(const Stage<Function>& stage, const VisionOptions& options) {
  const std::string& name = chosen_name(stage, options);
  const auto found = std::ranges::find(stage.alternatives, name, &Alternative<Function>::name);
  if (found != stage.alternatives.end()) return made_by(stage, *found, options);
  std::vector<std::string_view> names;
  for (const auto& alternative : stage.alternatives) names.push_back(alternative.name);
  throw Error("vision." + std::string(stage.key), "is " + shown(name) + ", must be " + joined(names));
}

}  // namespace

StageRegistry built_in_stages() {
  StageRegistry all;
  all.balls = {"balls",
               "the ball and further hypotheses",
               {{"sphere", "outline of a sphere that rests on the floor", {}, [](const VisionOptions& options) {
                   return [ball = options.ball](const View& view) { return search_balls(view, ball); };
                 }}}};
  all.goals = {"goals",
               "goals and their posts",
               {{"panel", "colored panel between two posts, feet on the floor", {}, [](const VisionOptions& options) {
                   return [goal = options.goal](const View& view) { return search_goals(view, goal); };
                 }}}};
  all.robots = {"robots",
                "other robots",
                {{"body", "black body with a colored marker, by its foot", {}, [](const VisionOptions& options) {
                    return [robot = options.robot](const View& view) { return find_robots(view, robot); };
                  }}}};
  all.lines = {"lines",
               "field lines, feet of walls, centre circle",
               {{"planes", "rays in one plane, by random samples", {}, [](const VisionOptions& options) {
                   return [line = options.line](const View& view) { return find_lines(view, line); };
                 }}}};
  all.free_space = {"free_space",
                    "free motion space",
                    {{"sectors", "lines of sight along the floor", {}, [](const VisionOptions&) {
                        return [](const SectorMap& map, const Surface& surface, std::span<const Ball> balls) {
                          return find_free_space(map, surface, balls);
                        };
                      }}}};
  all.field_boundary = {
      "field_boundary",
      "feet of the walls as straight segments, for `localization: boundary`",
      {{"subpixel", "edges of the brightness where wall and field meet", {}, boundary_by(BoundaryMethod::subpixel)},
       {"skeleton", "skeleton of where wall and field meet", {}, boundary_by(BoundaryMethod::skeleton)}}};
  all.localization = {
      "localization",
      "the robot's own pose",
      {{"model", "all lines, walls, circle and goals fitted to the field; several hypotheses", {}, by_model},
       {"boundary", "at most two walls told apart by goals and odometry", {}, by_boundary}}};
  return all;
}

void check_stages(const StageRegistry& registry, const std::string& source) {
  std::set<std::string, std::less<>> keys;
  for (const OptionInfo& info : vision_option_infos()) keys.insert(info.key);
  registry.for_each([&](const auto& stage) { keys.insert(std::string(stage.key)); });
  registry.for_each([&](const auto& stage) {
    std::set<std::string_view> names;
    for (const auto& alternative : stage.alternatives) {
      const std::string name = std::string(stage.key) + ": " + alternative.name;
      if (!is_name(alternative.name))
        throw Error(source, "alternative " + shown(name) + " must be named by a-z, 0-9 and _");
      if (!names.insert(alternative.name).second) throw Error(source, "alternative " + shown(name) + " exists already");
      if (!alternative.make) throw Error(source, "alternative " + shown(name) + " has no `make`");
      for (const OptionInfo& option : alternative.options) {
        if (!is_name(option.key))
          throw Error(source, "option " + shown(option.key) + " must be named by a-z, 0-9 and _");
        if (!keys.insert(option.key).second) throw Error(source, "option " + shown(option.key) + " exists already");
        constexpr double most = 1e9;  // also as a whole number
        if (!(-most <= option.low && option.low <= option.standard && option.standard <= option.high &&
              option.high <= most))
          throw Error(source, "option " + shown(option.key) + " must have -1e9 <= low <= default <= high <= 1e9");
      }
    }
  });
}

Stages chosen_stages(const StageRegistry& registry, const VisionOptions& options) {
  return {chosen(registry.balls, options),       chosen(registry.goals, options),
          chosen(registry.robots, options),      chosen(registry.lines, options),
          chosen(registry.free_space, options),  chosen(registry.field_boundary, options),
          chosen(registry.localization, options)};
}

std::vector<StageInfo> stage_infos(const StageRegistry& registry) {
  std::vector<StageInfo> infos{{"camera", "what is known of the camera's mount", {}, {}},
                               {"surface", "carpet, line, wall or object for every pixel", {}, {}}};
  registry.for_each([&](const auto& stage) {
    if (stage.key == registry.localization.key)
      infos.push_back({"motion", "how the robot moved since the frame before, by odometry", {}, {}});
    StageInfo info{stage.key, stage.meaning, {}, {}};
    for (const auto& alternative : stage.alternatives)
      info.alternatives.push_back({alternative.name, alternative.meaning, alternative.options});
    infos.push_back(std::move(info));
  });
  infos.push_back({"track", "ball and robots over time", {}, {}});
  for (OptionInfo& option : vision_option_infos())
    std::ranges::find(infos, option.stage, &StageInfo::key)->options.push_back(std::move(option));
  return infos;
}

}  // namespace tassilo
