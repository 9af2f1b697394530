#include "tassilo/app/bus_complaints.h"

namespace tassilo {

std::vector<std::string> BusComplaints::news(const Bus& bus) {
  constexpr std::size_t most = 100;  // anybody on the network can cause more
  std::vector<std::string> news;
  for (const auto& list : {Bus::complaints(), bus.conflicts()})
    for (const std::string& line : list)
      if (told_.size() < most && told_.insert(line).second) news.push_back(line);
  return news;
}

}  // namespace tassilo
