#pragma once

#include <set>

namespace tassilo::internal {

/// The descriptors of this process that are UDP sockets of IPv4 with a port, now.
std::set<int> udp_sockets();

/// Tells the kernel to pass on to sockets of this process only what comes from 127.0.0.0/8, which no other machine
/// can send: to those with a descriptor that is not in `before` and a port from `first_port` to below `end_port`.
/// Returns how many.
///
/// The middleware binds its sockets to 0.0.0.0 whatever network interface it is told to use. Throws Error when the
/// kernel refuses.
int accept_loopback_only(const std::set<int>& before, int first_port, int end_port);

}  // namespace tassilo::internal
