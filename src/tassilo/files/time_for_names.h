#pragma once

#include <string>

namespace tassilo {

/// The present time as file names have it, UTC: "2026-11-28T01-02-03Z". Names sort as times do.
std::string time_for_names();

}  // namespace tassilo
