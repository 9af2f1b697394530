#include "tassilo/app/bus_arguments.h"

#include <charconv>
#include <cstdlib>
#include <string_view>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

/// 0 without one, as ROS 2 has it.
int domain_of_environment() {
  const char* const variable = std::getenv("ROS_DOMAIN_ID");
  const std::string_view text = variable != nullptr ? variable : "";
  if (text.empty()) return 0;
  int domain = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), domain);
  if (error != std::errc{} || rest != text.data() + text.size())
    throw Error("ROS_DOMAIN_ID", "is " + std::string(text) + ", must be a number in 0..232");
  return domain;
}

}  // namespace

void BusArguments::add_to(CLI::App& command) {
  command
      .add_option("--bus-interface", interface,
                  "topics: name or IPv4 address of the network interface; lo: this machine alone")
      ->capture_default_str();
  command.add_option("--domain", domain, "topics: DDS domain, instead of ROS_DOMAIN_ID, else 0")
      ->check(CLI::Range(0, 232));
  command.add_option("--peer", peers, "topics: a host to look for others at, where multicast does not go; repeatable");
  command.add_flag("--multicast", multicast, "topics: look for others by multicast, as ROS 2 does; not on lo");
}

BusOptions BusArguments::options() const {
  BusOptions options;
  options.domain = domain ? *domain : domain_of_environment();
  options.interface = interface;
  options.peers = peers;
  options.multicast = multicast;
  options.max_bytes = 16 << 20;  // 1920 x 1080 pixels of RGB, twice
  options.check();
  return options;
}

}  // namespace tassilo
