// Every connection, by its number and by the seat of who came in by it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>

#include "host/server/peer.h"

namespace slosh {

/// One thread. A Peer stays where it is until sweep(): nobody's ground goes while he stands on it.
class PeerTable {
 public:
  using Map = std::map<ConnectionId, std::unique_ptr<Peer>>;

  Peer& add(std::unique_ptr<Peer> peer) { return *(peers_[peer->id] = std::move(peer)); }
  /// Null when there is none, or it is gone.
  Peer* find(ConnectionId connection) const {
    const auto found = peers_.find(connection);
    return found == peers_.end() || found->second->gone ? nullptr : found->second.get();
  }
  Peer* of_seat(std::uint32_t seat) const {
    const auto found = by_seat_.find(seat);
    return found == by_seat_.end() ? nullptr : find(found->second);
  }
  void sit(Peer& peer, std::uint32_t seat) {
    peer.seat = seat;
    by_seat_[seat] = peer.id;
  }
  void stand_up(std::uint32_t seat) { by_seat_.erase(seat); }
  void all_stand_up() { by_seat_.clear(); }
  bool nobody_sits() const { return by_seat_.empty(); }

  /// Calls `each(Peer&)` for everybody who is in, in the order in which they connected.
  template <class Each>
  void each_in(Each&& each) const {
    for (const auto& [id, peer] : peers_) {
      if (peer->in && !peer->gone) each(*peer);
    }
  }
  /// Forgets those that are gone.
  void sweep() {
    std::erase_if(peers_, [](const auto& entry) { return entry.second->gone; });
  }
  const Map& all() const { return peers_; }
  bool empty() const { return peers_.empty(); }

 private:
  Map peers_;
  std::map<std::uint32_t, ConnectionId> by_seat_;
};

}  // namespace slosh
