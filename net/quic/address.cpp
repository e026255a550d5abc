#include "net/quic/address.h"

#include <arpa/inet.h>
#include <netdb.h>

#include <algorithm>
#include <charconv>
#include <cstring>

#include "sim/math/format.h"

namespace slosh::quic {

Address::Address(const sockaddr* address, socklen_t size) : v6{} {
  length = std::min<socklen_t>(size, sizeof(v6));
  std::memcpy(&v6, address, length);
}

bool Address::operator==(const Address& other) const {
  if (length == 0 || other.length == 0) return length == other.length;
  if (any.sa_family != other.any.sa_family) return false;
  if (any.sa_family == AF_INET)
    return v4.sin_port == other.v4.sin_port && v4.sin_addr.s_addr == other.v4.sin_addr.s_addr;
  return v6.sin6_port == other.v6.sin6_port && v6.sin6_scope_id == other.v6.sin6_scope_id &&
         std::memcmp(&v6.sin6_addr, &other.v6.sin6_addr, sizeof(in6_addr)) == 0;
}

std::uint16_t Address::port() const {
  return ntohs(any.sa_family == AF_INET ? v4.sin_port : v6.sin6_port);
}

void Address::set_port(std::uint16_t port) {
  (any.sa_family == AF_INET ? v4.sin_port : v6.sin6_port) = htons(port);
}

bool Address::is_wildcard() const {
  if (any.sa_family == AF_INET) return v4.sin_addr.s_addr == htonl(INADDR_ANY);
  return IN6_IS_ADDR_UNSPECIFIED(&v6.sin6_addr);
}

std::string Address::text() const {
  if (length == 0) return "nowhere";
  char host[INET6_ADDRSTRLEN] = "?";
  const std::string suffix = format(":%u", port());
  if (any.sa_family == AF_INET) {
    inet_ntop(AF_INET, &v4.sin_addr, host, sizeof(host));
    return host + suffix;
  }
  if (IN6_IS_ADDR_V4MAPPED(&v6.sin6_addr)) {
    inet_ntop(AF_INET, v6.sin6_addr.s6_addr + 12, host, sizeof(host));
    return host + suffix;
  }
  inet_ntop(AF_INET6, &v6.sin6_addr, host, sizeof(host));
  std::string zone;
  if (v6.sin6_scope_id != 0) zone = format("%%%u", v6.sin6_scope_id);
  return format("[%s%s]%s", host, zone.c_str(), suffix.c_str());
}

std::string Address::site() const {
  if (any.sa_family == AF_INET) return {reinterpret_cast<const char*>(&v4.sin_addr), 4};
  const auto* bytes = reinterpret_cast<const char*>(&v6.sin6_addr);
  return IN6_IS_ADDR_V4MAPPED(&v6.sin6_addr) ? std::string(bytes + 12, 4) : std::string(bytes, 8);
}

Address numeric_address(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  std::string host = text.substr(0, colon);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_DGRAM;
  wanted.ai_flags = AI_NUMERICHOST;
  addrinfo* list = nullptr;
  if (host.empty() || getaddrinfo(host.c_str(), nullptr, &wanted, &list) != 0) return {};
  const Address address(list->ai_addr, list->ai_addrlen);
  freeaddrinfo(list);
  return address;
}

Result<std::vector<Address>> resolve(const std::string& text) {
  const auto error = [&](const std::string& what) {
    return Error{"address '" + text + "'", what, "Write HOST:PORT, or [IPv6]:PORT, e.g. 192.168.1.5:4433"};
  };
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return error("it has no port");
  std::string host = text.substr(0, colon);
  const std::string port = text.substr(colon + 1);
  std::uint16_t number = 0;
  const auto [end, fault] = std::from_chars(port.data(), port.data() + port.size(), number);
  if (fault != std::errc() || end != port.data() + port.size())
    return error("'" + port + "' is no port from 0 to 65535");
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != std::string::npos) {
    return error("an IPv6 address needs brackets");
  }
  if (host.empty() || host.size() > 253) return error("it has no host");

  addrinfo wanted{};
  wanted.ai_socktype = SOCK_DGRAM;
  wanted.ai_flags = AI_NUMERICHOST;
  addrinfo* list = nullptr;
  int code = getaddrinfo(host.c_str(), nullptr, &wanted, &list);
  if (code != 0) {
    wanted.ai_flags = AI_ADDRCONFIG;
    code = getaddrinfo(host.c_str(), nullptr, &wanted, &list);
  }
  if (code != 0) return error(gai_strerror(code));
  std::vector<Address> found;
  for (const addrinfo* entry = list; entry && found.size() < 8; entry = entry->ai_next) {
    if (entry->ai_family != AF_INET && entry->ai_family != AF_INET6) continue;
    Address address(entry->ai_addr, entry->ai_addrlen);
    address.set_port(number);
    if (std::find(found.begin(), found.end(), address) == found.end()) found.push_back(address);
  }
  freeaddrinfo(list);
  if (found.empty()) return error("it is neither IPv4 nor IPv6");
  return found;
}

}  // namespace slosh::quic
