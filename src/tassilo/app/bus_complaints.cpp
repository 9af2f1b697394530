#include "tassilo/app/bus_complaints.h"

#include <string_view>
#include <utility>

namespace tassilo {
namespace {

/// What it is about, without the bytes and numbers in which one differs from the next.
std::string kind_of(std::string_view line) {
  std::string kind(line.substr(0, line.find('<')));
  std::erase_if(kind, [](char c) { return c >= '0' && c <= '9'; });
  return kind;
}

}  // namespace

std::vector<std::string> BusComplaints::news(const Bus& bus) {
  constexpr std::size_t most = 100;  // anybody on the network can cause more
  std::vector<std::string> news;
  const auto tell = [&](const std::string& line, std::string kind) {
    if (told_.size() < most && told_.insert(std::move(kind)).second) news.push_back(line);
  };
  for (const std::string& line : Bus::complaints()) tell(line, kind_of(line));
  for (const std::string& line : bus.conflicts()) tell(line, line);
  return news;
}

}  // namespace tassilo
