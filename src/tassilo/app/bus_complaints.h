#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "tassilo/team/bus.h"

namespace tassilo {

/// What the middleware complains of, and who cannot hear whom, each kind told once:
/// the first of it.
///
/// threads  one at a time
class BusComplaints {
 public:
  /// Those that were not there the last time. Of very many different ones, only the first are told.
  std::vector<std::string> news(const Bus& bus);

 private:
  std::set<std::string, std::less<>> told_;  ///< Kinds.
};

}  // namespace tassilo
