#include "tassilo/app/bus_arguments.h"

#include <charconv>
#include <cstdlib>
#include <string_view>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

/// What the environment says; nothing when it is silent. Throws Error when it is no number.
std::optional<int> domain_of_environment() {
  const char* const text = std::getenv("ROS_DOMAIN_ID");
  if (text == nullptr || *text == '\0') return std::nullopt;
  const std::string_view digits = text;
  int domain = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), domain);
  if (error != std::errc{} || end != digits.data() + digits.size())
    throw Error("ROS_DOMAIN_ID", "is '" + std::string(digits) + "', must be a whole number, 0..232");
  return domain;
}

}  // namespace

void BusArguments::add_to(CLI::App& command) {
  command.add_option("--interface", interface,
                     "network interface of the bus, by name or IPv4 address; beyond lo anybody there may listen and "
                     "speak (default: the robot file's, else lo)");
  command.add_option("--domain", domain, "domain of the bus (default: the robot file's, else ROS_DOMAIN_ID, else 0)")
      ->check(CLI::Range(0, 232));
  command
      .add_option("--peer", peers,
                  "host to look for others at, where multicast does not go; may be given several times")
      ->option_text("HOST")
      ->allow_extra_args(false);
  command.add_flag("--multicast", multicast, "look for others by multicast, too, as ROS 2 does; not on lo");
}

BusOptions BusArguments::options(const BusSettings& robot) const {
  BusOptions options;
  options.interface = !interface.empty() ? interface : robot.interface.value_or(options.interface);
  if (domain)
    options.domain = *domain;
  else if (robot.domain)
    options.domain = *robot.domain;
  else
    options.domain = domain_of_environment().value_or(options.domain);
  options.peers = peers.empty() ? robot.peers : peers;
  options.multicast = multicast || robot.multicast;
  options.check();
  return options;
}

}  // namespace tassilo
