// What of the network this machine has, asked without anything of ours, so that a fault of ours is no reason
// to skip.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace slosh::test {

/// Why nobody can listen on [::1] here; empty when one can.
inline std::string no_ipv6() {
  const int socket = ::socket(AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return std::string("no IPv6 here: ") + std::strerror(errno);
  sockaddr_in6 loopback{};
  loopback.sin6_family = AF_INET6;
  loopback.sin6_addr = in6addr_loopback;
  const bool bound = bind(socket, reinterpret_cast<const sockaddr*>(&loopback), sizeof loopback) == 0;
  const std::string why = bound ? "" : std::string("no IPv6 here: ") + std::strerror(errno);
  close(socket);
  return why;
}

}  // namespace slosh::test
