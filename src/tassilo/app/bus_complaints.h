#pragma once

#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tassilo/team/bus.h"

namespace tassilo {

/// What a complaint is about: its words up to the bytes it may quote, but for those with numbers or colons, in which
/// one packet differs from the next. O(its length).
std::string complaint_kind(std::string_view line);

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
  std::set<std::string, std::less<>> conflicts_;
};

}  // namespace tassilo
