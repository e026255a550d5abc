// Where a UDP packet comes from or goes to.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdint>
#include <string>
#include <vector>

#include "sim/math/result.h"

namespace slosh::quic {

struct Address {
  union {
    sockaddr any;
    sockaddr_in v4;
    sockaddr_in6 v6;
  };
  socklen_t length = 0;  ///< 0 = none

  Address() : v6{} {}
  Address(const sockaddr* address, socklen_t size);

  bool operator==(const Address& other) const;
  std::uint16_t port() const;
  void set_port(std::uint16_t port);
  bool is_wildcard() const;
  /// "127.0.0.1:4433", "[::1]:4433"; an IPv4 address within IPv6 is shown as IPv4.
  std::string text() const;
  /// What one site is counted by: the IPv4 address, or the first 64 bits of the IPv6 one.
  std::string site() const;
};

/// The address that a number stands for, without asking anybody; length 0 when it is none.
Address numeric_address(const std::string& text);

/// What "HOST:PORT" or "[IPv6]:PORT" stands for, at most 8. Asks the name service only when HOST is no
/// number. Errors: no port, not an address, unknown name.
Result<std::vector<Address>> resolve(const std::string& text);

}  // namespace slosh::quic
