#include "tassilo/team/internal/domain.h"

#include <arpa/inet.h>

#include <algorithm>
#include <deque>
#include <map>
#include <mutex>

#include "tassilo/base/error.h"
#include "tassilo/team/internal/loopback_only.h"

namespace tassilo::internal {
namespace {

constexpr std::size_t kComplaintsKept = 20, kLongest = 500;  // [characters]
constexpr int kFirstPort = 7400, kPortsOfDomain = 250;       // DDSI-RTPS 2.5, 9.6.2.4
constexpr int kSocketsOfDomain = 2;                          // without multicast: for discovery and for messages

/// The middleware prints its warnings unless somebody takes them.
class Complaints {
 public:
  void take() { dds_set_log_sink(&Complaints::add, this); }
  std::vector<std::string> all() {
    const std::lock_guard lock(mutex_);
    return {texts_.begin(), texts_.end()};
  }
  std::string newest() {
    const std::lock_guard lock(mutex_);
    return texts_.empty() ? "" : texts_.back();
  }

 private:
  static void add(void* self, const dds_log_data_t* data) {
    auto& here = *static_cast<Complaints*>(self);
    std::string text(data->message, std::min(data->size, kLongest));
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    // Packets are quoted in them, with whatever bytes they hold.
    std::ranges::replace_if(
        text, [](char c) { return c < ' ' || c > '~'; }, '?');
    const std::lock_guard lock(here.mutex_);
    if (!here.texts_.empty() && here.texts_.back() == text) return;
    here.texts_.push_back(std::move(text));
    if (here.texts_.size() > kComplaintsKept) here.texts_.pop_front();
  }

  std::mutex mutex_;
  std::deque<std::string> texts_;
};

struct Entered {
  BusOptions options;
  dds_entity_t handle = 0;
  int users = 0;
};

/// The domains that this process is in. Never destroyed: threads of the middleware may complain to the very end.
struct Process {
  std::mutex
      mutex;  ///< Held while a domain is entered or left: the same may be entered again only after it has been left.
  std::map<int, Entered> domains;
  Complaints complaints;
};
Process& process() {
  static Process& process = *new Process;
  return process;
}

bool is_loopback(const BusOptions& options) {
  return options.interface == "lo" || options.interface.starts_with("127.");
}

bool is_address(const std::string& text) {
  in_addr address{};
  return inet_pton(AF_INET, text.c_str(), &address) == 1;
}

std::string element(const std::string& name, const std::string& content) {
  return "<" + name + ">" + content + "</" + name + ">";
}

/// What the options are in the middleware's own words; their texts have been checked to be plain.
std::string configuration(const BusOptions& options) {
  const std::string by = is_address(options.interface) ? "address" : "name";
  const std::string interfaces = "<NetworkInterface " + by + "=\"" + options.interface + "\" multicast=\"" +
                                 (options.multicast ? "true" : "false") + "\"/>";
  // Endpoints and messages go to each peer by itself: on a wireless network multicast is slow and not repeated.
  const std::string general =
      element("Interfaces", interfaces) + element("AllowMulticast", options.multicast ? "spdp" : "false");

  std::string peers;
  for (const std::string& peer : options.peers) peers += "<Peer address=\"" + peer + "\"/>";
  if (!options.multicast)
    peers +=
        "<Peer address=\"" + (is_address(options.interface) ? options.interface : std::string("localhost")) + "\"/>";
  const std::string discovery = element("ParticipantIndex", "auto") +
                                element("MaxAutoParticipantIndex", std::to_string(options.max_participants - 1)) +
                                element("Peers", peers) + element("SPDPInterval", "1 s") +
                                element("LeaseDuration", std::to_string(options.lease_s) + " s");

  // A writer of "keep last" holds no more than its depth, and needs no other brake.
  const std::string watermarks =
      element("WhcAdaptive", "false") + element("WhcHigh", "1 GB") + element("WhcHighInit", "1 GB");
  const std::string internals =
      element("MaxSampleSize", std::to_string(options.max_bytes + 3) + " B") + element("Watermarks", watermarks);

  return element("CycloneDDS", "<Domain id=\"any\">" + element("General", general) + element("Discovery", discovery) +
                                   element("Internal", internals) + "</Domain>");
}

}  // namespace

std::vector<std::string> complaints() { return process().complaints.all(); }

void fail(const std::string& what, dds_return_t code) {
  const std::string newest = process().complaints.newest();
  throw Error("bus", what + ": " + dds_strretcode(code) + (newest.empty() ? "" : " (" + newest + ")"));
}

Domain::Domain(const BusOptions& options) : number_(options.domain) {
  Process& here = process();
  const std::lock_guard lock(here.mutex);
  if (const auto found = here.domains.find(number_); found != here.domains.end()) {
    if (found->second.options != options)
      throw Error("bus", "domain " + std::to_string(number_) +
                             " is in use in this process with other options, must be the same");
    ++found->second.users;
    return;
  }
  here.complaints.take();
  const std::set<int> sockets = udp_sockets();
  const dds_entity_t handle = dds_create_domain(static_cast<dds_domainid_t>(number_), configuration(options).c_str());
  if (handle < 0) fail("cannot enter domain " + std::to_string(number_) + " on " + options.interface, handle);
  try {
    const int first_port = kFirstPort + kPortsOfDomain * number_;
    if (is_loopback(options) &&
        accept_loopback_only(sockets, first_port, first_port + kPortsOfDomain) < kSocketsOfDomain)
      throw Error("bus",
                  "cannot find the sockets of domain " + std::to_string(number_) + " to restrict them to loopback");
  } catch (...) {
    dds_delete(handle);
    throw;
  }
  here.domains[number_] = {options, handle, 1};
}

Domain::~Domain() {
  Process& here = process();
  const std::lock_guard lock(here.mutex);
  const auto found = here.domains.find(number_);
  if (--found->second.users > 0) return;
  dds_delete(found->second.handle);
  here.domains.erase(found);
}

}  // namespace tassilo::internal
