#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace tassilo {

/// A domain that no other test of this machine uses while this process lives: whoever has bound the domain's name has
/// it. The tests in Python do the same. Ports of domains beyond 100 may be taken by any socket.
inline int free_domain() {
  for (int domain = 1; domain <= 100; ++domain) {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    const std::string text = "tassilo bus test " + std::to_string(domain);
    std::ranges::copy(text, name.sun_path + 1);  // a leading zero: of no file, gone with the process
    const int holder = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + text.size());
    if (bind(holder, reinterpret_cast<sockaddr*>(&name), size) == 0) return domain;
    close(holder);
  }
  throw std::runtime_error("all domains are in use");
}

}  // namespace tassilo
