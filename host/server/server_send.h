// Sending control messages, for the server's own sources.
#pragma once

#include "host/server/server.h"

namespace slosh {

/// The application error code of a connection closed for this reason.
inline std::uint64_t close_code(wire::RefusalCode code) {
  return static_cast<std::uint64_t>(code) + 1;
}

inline bool send_bytes(Endpoint& endpoint, Peer& peer, const wire::Bytes& bytes) {
  return endpoint.send_stream(peer.id, peer.control_stream, bytes, false);
}

template <class M>
void Server::send(Peer& peer, const M& message) {
  if (peer.gone || peer.control_stream < 0) return;
  if (send_bytes(*endpoint_, peer, wire::control(message))) return;
  // It reads nothing: what we would keep for it has an end.
  lose(peer, Parting::kPutOut);
  endpoint_->close(peer.id, close_code(wire::RefusalCode::kTooMuch), "you read too slowly");
}

template <class M>
void Server::send_all(const M& message, bool participants_only, const Peer* but) {
  const wire::Bytes bytes = wire::control(message);
  std::vector<Peer*> deaf;
  for (auto& [id, peer] : peers_) {
    if (!peer->in || peer->gone || peer.get() == but || (participants_only && !peer->participant)) continue;
    if (!send_bytes(*endpoint_, *peer, bytes)) deaf.push_back(peer.get());
  }
  for (Peer* peer : deaf) {
    lose(*peer, Parting::kPutOut);
    endpoint_->close(peer->id, close_code(wire::RefusalCode::kTooMuch), "you read too slowly");
  }
}

}  // namespace slosh
