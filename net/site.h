// Where somebody is, as far as limits care.
#pragma once

#include <arpa/inet.h>

#include <algorithm>
#include <cstdint>
#include <string>

namespace slosh {

/// What a site is counted by, from "HOST:PORT" as EndpointEvents::on_connected() tells it: the IPv4 address,
/// or the /64 of the IPv6 one, as text; what is neither is its own site.
inline std::string site_of(const std::string& address) {
  std::string host = address.substr(0, address.rfind(':'));
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  in6_addr six{};
  if (inet_pton(AF_INET6, host.substr(0, host.find('%')).c_str(), &six) != 1) return host;
  // An IPv4 address in IPv6's clothes: else all of them were one site.
  if (IN6_IS_ADDR_V4MAPPED(&six)) {
    char four[INET_ADDRSTRLEN] = "";
    inet_ntop(AF_INET, six.s6_addr + 12, four, sizeof(four));
    return four;
  }
  std::fill(six.s6_addr + 8, six.s6_addr + 16, std::uint8_t{0});
  char text[INET6_ADDRSTRLEN] = "";
  inet_ntop(AF_INET6, &six, text, sizeof(text));
  return std::string(text).append("/64");
}

}  // namespace slosh
