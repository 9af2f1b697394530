#pragma once

#include <span>
#include <string>

#include "tassilo/app/team_trails.h"
#include "tassilo/fusion/team_fusion.h"
#include "tassilo/team/team_view.h"

// What the monitor tells browsers: webui/public/monitor_openapi.yaml.

namespace tassilo {

/// world   of the picture's time
/// news    number of the last one
/// with_pictures  robots whose annotated picture can be had, rising
std::string team_picture_json(const TeamPicture& picture, const TeamWorld& world, std::int64_t news,
                              std::span<const int> with_pictures);
std::string team_news_json(std::span<const TeamNews> news);
std::string team_trails_json(std::span<const TeamTrail> trails);

}  // namespace tassilo
