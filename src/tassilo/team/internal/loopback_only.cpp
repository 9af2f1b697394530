#include "tassilo/team/internal/loopback_only.h"

#include <linux/filter.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>

#include "tassilo/base/error.h"

namespace tassilo::internal {
namespace {

/// The port of a UDP socket of IPv4; 0: it is none.
int udp_port(int descriptor) {
  int kind = 0;
  socklen_t size = sizeof kind;
  if (getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &kind, &size) != 0 || kind != SOCK_DGRAM) return 0;
  sockaddr_in address{};
  size = sizeof address;
  if (getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size) != 0 || address.sin_family != AF_INET)
    return 0;
  return ntohs(address.sin_port);
}

}  // namespace

std::set<int> udp_sockets() {
  std::set<int> open;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", failed)) {
    const std::string name = entry.path().filename().string();
    int descriptor = -1;
    std::from_chars(name.data(), name.data() + name.size(), descriptor);
    open.insert(descriptor);
  }
  if (failed) throw Error("/proc/self/fd", failed.message());
  // Asked of after the folder is closed, whose own descriptor is one of them.
  std::erase_if(open, [](int descriptor) { return udp_port(descriptor) == 0; });
  return open;
}

int accept_loopback_only(const std::set<int>& before, int first_port, int end_port) {
  // The packet's source address stands 12 bytes into the network header.
  std::array<sock_filter, 5> program = {{
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<unsigned>(SKF_NET_OFF + 12)),
      BPF_STMT(BPF_ALU | BPF_AND | BPF_K, 0xff000000u),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, 0x7f000000u, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, 0xffffffffu),
      BPF_STMT(BPF_RET | BPF_K, 0),
  }};
  const sock_fprog filter{program.size(), program.data()};
  int count = 0;
  for (const int descriptor : udp_sockets()) {
    if (before.contains(descriptor)) continue;
    const int port = udp_port(descriptor);
    if (port < first_port || port >= end_port) continue;
    if (setsockopt(descriptor, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter) != 0)
      throw Error("bus", "cannot restrict UDP port " + std::to_string(port) + " to loopback: " + std::strerror(errno));
    ++count;
  }
  return count;
}

}  // namespace tassilo::internal
