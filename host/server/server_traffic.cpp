// Datagrams that come in.
#include <algorithm>

#include "host/server/server.h"
#include "host/server/server_send.h"
#include "net/clock.h"
#include "net/wire/all_messages.h"

namespace slosh {
namespace {

SharedBytes shared(wire::Bytes bytes) {
  return std::make_shared<const wire::Bytes>(std::move(bytes));
}

}  // namespace

void Server::on_datagram(ConnectionId connection, std::span<const std::uint8_t> bytes) {
  Peer* peer = peers_.find(connection);
  if (!peer) return;
  if (!peer->limits.datagrams.take(now())) {
    past_.datagrams_ignored += 1;
    if (!peer->limits.flood.take(now()))
      refuse(*peer, wire::RefusalCode::kTooMuch, "you sent more than any device could");
    return;
  }
  // Datagrams may overtake the Hello.
  if (!peer->in) return;
  peer->received_ns = now();
  const wire::Fault fault = wire::dispatch_datagram(
      wire::PeerDatagrams{}, bytes, [&](const auto& message) { handle(*peer, message); }, peer->agreed);
  if (!fault) return;
  past_.datagram_faults += 1;
  if (!peer->limits.faults.take(now()))
    refuse(*peer, wire::RefusalCode::kBadMessage,
           "too many datagrams were damaged, the last one: " + fault.text());
}

void Server::handle(Peer& peer, const wire::ClockPing& ping) {
  const std::int64_t received = now();
  endpoint_->send_datagram(
      peer.id, Priority::kPose,
      shared(wire::datagram(wire::ClockPong{ping.number, ping.sent_ns, received, now()})));
}

void Server::handle(Peer& peer, const wire::Poses& poses) {
  const Seat& seat = *seats_.by_number(peer.seat);
  bool stray = false;
  std::uint32_t stray_grip = 0;
  std::vector<const wire::PoseSample*> newest;  // at most one a grip
  // Oldest first: only then every sample that is new counts as one that came.
  for (auto sample = poses.samples.rbegin(); sample != poses.samples.rend(); ++sample) {
    if (std::find(seat.grips.begin(), seat.grips.end(), sample->grip) == seat.grips.end()) {
      stray = true;
      stray_grip = sample->grip;
    } else if (hands_.sample(*sample, now(), (peer.agreed & wire::kCouplings) != 0)) {
      std::erase_if(newest, [&](const wire::PoseSample* other) { return other->grip == sample->grip; });
      newest.push_back(&*sample);
    }
  }
  for (const wire::PoseSample* sample : newest) states_.forward(peer, *sample, now());
  if (stray) claimed(peer, stray_grip);
}

void Server::claimed(Peer& peer, std::uint32_t grip) {
  if (!peer.warned_claim) {
    peer.warned_claim = true;
    const Seat* holder = seats_.holder(grip);
    send(peer, wire::Notice{"your poses for " + seats_.grip_name(grip) + " are not used: " +
                            (holder ? "it is held by " + holder->name : std::string("take it first"))});
  }
  if (!peer.limits.claims.take(now())) {
    refuse(peer, wire::RefusalCode::kTooMuch,
           "you keep sending poses for " + seats_.grip_name(grip) + ", which is not yours");
  }
}

void Server::handle(Peer& peer, const wire::SnapshotFeedback& feedback) {
  snapshots_.note(peer.id, feedback, now());
}

}  // namespace slosh
