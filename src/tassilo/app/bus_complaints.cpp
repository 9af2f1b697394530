#include "tassilo/app/bus_complaints.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace tassilo {
namespace {

/// Anybody on the network can cause more. Of conflicts there are fewer, and complaints do not crowd them out.
constexpr std::size_t kMost = 100;

}  // namespace

std::string complaint_kind(std::string_view line) {
  std::string kind;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t end = std::min(line.find(' ', at), line.size());
    const std::string_view word = line.substr(at, end - at);
    if (word.starts_with('<')) break;
    if (word.find_first_of("0123456789:") == std::string_view::npos) kind.append(word).append(" ");
    at = end + 1;
  }
  return kind;
}

std::vector<std::string> BusComplaints::news(const Bus& bus) {
  std::vector<std::string> news;
  const auto tell = [&](auto& told, const std::string& line, std::string kind) {
    if (told.size() < kMost && told.insert(std::move(kind)).second) news.push_back(line);
  };
  for (const std::string& line : Bus::complaints()) tell(told_, line, complaint_kind(line));
  for (const std::string& line : bus.conflicts()) tell(conflicts_, line, line);
  return news;
}

}  // namespace tassilo
