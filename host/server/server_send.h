// Sending control messages, for the server's own sources.
#pragma once

#include <map>
#include <vector>

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
  if (send_bytes(*endpoint_, peer, wire::control(message, nullptr, peer.agreed))) return;
  // It reads nothing: what we would keep for it has an end.
  lose(peer, Parting::kPutOut);
  endpoint_->close(peer.id, close_code(wire::RefusalCode::kTooMuch), "you read too slowly");
}

inline wire::Task task_message(const TaskLines& lines) {
  return {lines.title, lines.say, lines.now, lines.hint, lines.hands, lines.done};
}

template <class M>
void Server::send_all(const M& message, bool participants_only, const Peer* but, wire::Capabilities behind) {
  std::map<wire::Capabilities, wire::Bytes> coded;  // once for all that have agreed to the same
  std::vector<Peer*> deaf;
  peers_.each_in([&](Peer& peer) {
    if (&peer == but || (participants_only && !peer.participant) || (peer.agreed & behind) != behind) return;
    auto [bytes, fresh] = coded.try_emplace(peer.agreed);
    if (fresh) bytes->second = wire::control(message, nullptr, peer.agreed);
    if (!send_bytes(*endpoint_, peer, bytes->second)) deaf.push_back(&peer);
  });
  for (Peer* peer : deaf) {
    lose(*peer, Parting::kPutOut);
    endpoint_->close(peer->id, close_code(wire::RefusalCode::kTooMuch), "you read too slowly");
  }
}

}  // namespace slosh
