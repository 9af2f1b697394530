#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "tassilo/evaluate/evaluate.h"

// Figures as JSON; null where nothing could be counted.

namespace tassilo {

nlohmann::ordered_json json_of(const std::optional<double>& value);
nlohmann::ordered_json json_of(const Spread& spread);
nlohmann::ordered_json json_of(const std::map<std::string, StageTimes>& timing_ms);
nlohmann::ordered_json json_of(const Evaluation& evaluation);

}  // namespace tassilo
