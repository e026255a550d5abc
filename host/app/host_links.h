// The links of a host as people see them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/server/links.h"
#include "net/link.h"

namespace slosh {

/// Where others reach a socket that listens at `local` ("[::]:4433"): the address itself, or for one that
/// means all of them every address of this machine that is not link-local, loopback last; at most
/// kMaxLinkAddresses.
std::vector<std::string> reachable_addresses(const std::string& local);

/// The port of "HOST:PORT"; 0 when there is none.
std::uint16_t port_of(const std::string& address);

/// One link a line for scripts: "hold LINK", "watch LINK", "hold LINK NAME", "run LINK NAME".
std::string links_for_scripts(const std::vector<LinkRecord>& links,
                              const std::function<std::string(const LinkRecord&)>& text);

/// Writes a file that only its owner may read, whole or not at all. Errors: the system's.
Result<bool> write_private(const std::string& file, const std::string& text);

}  // namespace slosh
