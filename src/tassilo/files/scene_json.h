#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tassilo/scene/scene.h"

namespace tassilo {

/// One scene as one line of JSON, without the line end, valid by schema/scene.schema.json.
///
/// Deterministic: equal scenes give equal lines. Lengths, angles and times are rounded to 6 decimals, pixels to 3,
/// durations to 4, covariances to 9 significant digits. What is missing is null; a bound `far` of infinity ("no upper
/// bound") is null, too. Several `why` entries of one subject are joined by "; ", several times of one stage are added.
/// A line that was read is written alike. The scene keeps its promises, else the program stops: all other numbers
/// finite, as many free-space states as ranges, a time for the stage "total".
std::string to_json_line(const Scene& scene);

/// The scene of such a line; strict: unknown or missing keys, wrong types and values out of range are refused.
/// Throws Error(place, ...); `place` is how messages call the line.
Scene scene_from_json(std::string_view line, std::string_view place = "scene");

/// All scenes of a file with one line each. Throws Error("file:line", ...).
std::vector<Scene> read_scenes(const std::filesystem::path& file);

}  // namespace tassilo
