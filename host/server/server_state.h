// What the server must keep over a restart of the host: its key, its links, who sat where.
#pragma once

#include <vector>

#include "host/server/bans.h"
#include "host/server/links.h"
#include "host/server/roster.h"
#include "net/wire/fields.h"

namespace slosh {

struct ServerState {
  wire::Bytes private_key;  ///< Identity::private_key(): keep what holds it to its owner (mode 0600)
  std::uint64_t world = 0;  ///< Welcome::world
  std::uint16_t port = 0;   ///< where the host listened, so that the links stay right; 0 = not known
  std::vector<LinkRecord> links;
  std::vector<SeatRecord> seats;
  std::vector<BanRecord> bans;
  std::int64_t seen_ns = 0;  ///< Unix time as the host last saw it: it does not go back over a restart
};
template <class V>
void visit(V& v, ServerState& m) {
  v.bytes("private_key", m.private_key, 0, 1024);
  v.bits64("world", m.world);
  v.natural("port", m.port, 0, 65535);
  v.list("links", m.links, kMaxLinks, [](auto& each, LinkRecord& link) { visit(each, link); });
  v.list("bans", m.bans, kMaxBans, [](auto& each, BanRecord& ban) { visit(each, ban); });
  v.stamp("seen_ns", m.seen_ns);
  v.list("seats", m.seats, wire::kMaxPeers, [](auto& each, SeatRecord& seat) { visit(each, seat); });
}

}  // namespace slosh
