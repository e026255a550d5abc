#include "host/app/host_links.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>

#include "host/keep/file.h"

namespace slosh {
namespace {

struct FreeAddresses {
  void operator()(ifaddrs* list) const { freeifaddrs(list); }
};

std::vector<std::string> own_addresses(bool with_ipv6) {
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return {};
  const std::unique_ptr<ifaddrs, FreeAddresses> list(first);
  std::vector<std::string> far;
  std::vector<std::string> near;
  for (const ifaddrs* each = first; each; each = each->ifa_next) {
    if (!each->ifa_addr || !(each->ifa_flags & IFF_UP)) continue;
    char text[INET6_ADDRSTRLEN] = {};
    if (each->ifa_addr->sa_family == AF_INET) {
      const auto* v4 = reinterpret_cast<const sockaddr_in*>(each->ifa_addr);
      if ((ntohl(v4->sin_addr.s_addr) >> 16) == 0xa9fe) continue;  // 169.254.0.0/16
      inet_ntop(AF_INET, &v4->sin_addr, text, sizeof text);
    } else if (each->ifa_addr->sa_family == AF_INET6 && with_ipv6) {
      const auto* v6 = reinterpret_cast<const sockaddr_in6*>(each->ifa_addr);
      if (IN6_IS_ADDR_LINKLOCAL(&v6->sin6_addr)) continue;
      inet_ntop(AF_INET6, &v6->sin6_addr, text, sizeof text);
    } else {
      continue;
    }
    const std::string host = each->ifa_addr->sa_family == AF_INET6 ? std::string("[") + text + "]" : text;
    (each->ifa_flags & IFF_LOOPBACK ? near : far).push_back(host);
  }
  far.insert(far.end(), near.begin(), near.end());
  return far;
}

}  // namespace

std::uint16_t port_of(const std::string& address) {
  const std::size_t colon = address.rfind(':');
  if (colon == std::string::npos) return 0;
  std::uint16_t port = 0;
  const char* end = address.data() + address.size();
  const auto [at, code] = std::from_chars(address.data() + colon + 1, end, port);
  return code == std::errc() && at == end ? port : 0;
}

std::vector<std::string> reachable_addresses(const std::string& local) {
  const std::string host = local.substr(0, local.rfind(':'));
  const std::string port = std::to_string(port_of(local));
  if (host != "[::]" && host != "0.0.0.0") return {local};
  std::vector<std::string> all = own_addresses(host == "[::]");
  // The last one, loopback, stays in any case: it is what works on this machine alone.
  if (all.size() > kMaxLinkAddresses) all.erase(all.begin() + kMaxLinkAddresses - 1, all.end() - 1);
  if (all.empty()) all.emplace_back("127.0.0.1");
  for (std::string& each : all) each += ":" + port;
  return all;
}

std::string links_for_scripts(const std::vector<LinkRecord>& links,
                              const std::function<std::string(const LinkRecord&)>& text) {
  std::string lines;
  for (const LinkRecord& link : links) {
    if (link.revoked) continue;
    lines.append(kLinkRoleNames[static_cast<std::size_t>(link.role)]).append(" ").append(text(link));
    if (!link.name.empty()) lines.append(" ").append(link.name);
    lines.append("\n");
  }
  return lines;
}

Result<bool> write_private(const std::string& file, const std::string& text) {
  const std::string whole = file + ".new";
  Result<keep::File> opened = keep::open_fresh_file(whole);
  if (!opened) return opened.error();
  const bool written = std::fwrite(text.data(), 1, text.size(), opened.value().get()) == text.size() &&
                       std::fflush(opened.value().get()) == 0;
  std::error_code code;
  if (written) std::filesystem::rename(whole, file, code);
  if (!written || code)
    return Error{file, "cannot be written" + (code ? ": " + code.message() : std::string()), ""};
  return true;
}

}  // namespace slosh
