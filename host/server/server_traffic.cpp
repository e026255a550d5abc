// Datagrams: poses in, hands, bodies and pictures out.
#include <algorithm>
#include <utility>

#include "host/server/server.h"
#include "host/server/server_send.h"
#include "net/clock.h"
#include "net/wire/all_messages.h"

namespace slosh {
namespace {

constexpr std::int64_t kHandsEvery = 1'900'000;  // ns: a hand is passed on at most about 500 times a second
constexpr std::int64_t kStandingEvery = 100'000'000;  // ns between two sendings of bodies that stand still
constexpr std::int64_t kJudgeEvery = 100'000'000;     // ns between two looks at a link
constexpr double kFeedbackPatience = 1.5;  // s without feedback after which a watcher counts as silent
constexpr std::size_t kPiecesATurn = 32;   // of pictures, before the network is looked at again
constexpr std::size_t kMostLeaving = 12;   // pictures on their way; the oldest go when we cannot keep up
constexpr std::size_t kLeastRoom = 8;      // pieces that may wait in a queue, however small a frame is

SharedBytes shared(wire::Bytes bytes) {
  return std::make_shared<const wire::Bytes>(std::move(bytes));
}

}  // namespace

void Server::on_datagram(ConnectionId connection, std::span<const std::uint8_t> bytes) {
  Peer* peer = find(connection);
  if (!peer) return;
  if (!peer->limits.datagrams.take(now())) {
    past_.datagrams_ignored += 1;
    if (!peer->limits.flood.take(now()))
      refuse(*peer, wire::RefusalCode::kTooMuch, "you sent more than any device could");
    return;
  }
  // Datagrams may overtake the Hello.
  if (!peer->in) return;
  peer->heard_ns = now();
  const wire::Fault fault = wire::dispatch_datagram(wire::PeerDatagrams{}, bytes,
                                                    [&](const auto& message) { handle(*peer, message); });
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
    } else if (hands_.sample(*sample, now())) {
      std::erase_if(newest, [&](const wire::PoseSample* other) { return other->grip == sample->grip; });
      newest.push_back(&*sample);
    }
  }
  for (const wire::PoseSample* sample : newest) forward(peer, *sample);
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

void Server::forward(Peer& from, const wire::PoseSample& sample) {
  std::int64_t& next = next_hands_ns_[sample.grip];
  if (now() < next) return;
  next = std::max(next, now() - kHandsEvery) + kHandsEvery;
  wire::Hands hands;
  hands.hands.push_back({sample.grip, now(), sample.pose, sample.twist, sample.engaged});
  SharedBytes bytes;
  for (auto& [id, other] : peers_) {
    if (!other->in || other->gone || !other->participant || other.get() == &from) continue;
    if (!bytes) bytes = shared(wire::datagram(hands));
    endpoint_->send_datagram(id, Priority::kPose, bytes);
  }
}

void Server::send_bodies() {
  const bool fresh = world_.channel->bodies().update();
  bodies_stale_ = bodies_stale_ || fresh;
  if (by_seat_.empty()) return;
  const BodyMessage& message = world_.channel->bodies().front();
  const bool standing = !fresh && now() - bodies_sent_ns_ >= kStandingEvery;
  if (!fresh && !standing) return;
  if (bodies_stale_) bodies_.set(message);
  bodies_stale_ = false;
  bodies_sent_ns_ = now();
  for (auto& [id, peer] : peers_) {
    if (!peer->in || peer->gone) continue;
    const double rate = peer->participant ? options_.participant_bodies : options_.spectator_bodies;
    const std::int64_t every = to_nanoseconds(1.0 / rate);
    if (!standing && message.rate > 0.0 && now() < peer->next_bodies_ns) continue;
    peer->next_bodies_ns = std::max(peer->next_bodies_ns, now() - every) + every;
    std::uint64_t number = 0;
    std::int64_t stamp = 0;
    for (const std::uint32_t grip : seats_.by_number(peer->seat)->grips) {
      if (grip >= message.pose_numbers.size()) continue;
      const HandTable::Used used = hands_.used(grip, message.pose_numbers[grip]);
      if (used.number == 0 || (number != 0 && used.stamp_ns <= stamp)) continue;
      number = used.number;
      stamp = used.stamp_ns;
    }
    for (const SharedBytes& bytes : bodies_.to(number, stamp))
      endpoint_->send_datagram(id, Priority::kState, bytes);
  }
}

void Server::watch(Peer& peer, int tier) {
  PictureSink& sink = peer.pictures;
  const auto i = static_cast<std::size_t>(tier);
  // The first of a tier gets a key frame; who joins others is given the blocks as they are.
  bool others = false;
  for (const auto& [id, other] : peers_) {
    others = others || (!other->gone && other.get() != &peer && other->pictures.watching &&
                        other->pictures.control.tier() == tier);
  }
  sink.watching = true;
  sink.seen = {};
  sink.judged_ns = sink.feedback_ns = now();
  order_.fresh[i] = order_.fresh[i] || !others;
  MendOrder mend;
  mend.peer = peer.id;
  mend.tier = tier;
  mend.all = true;
  order_.mends.push_back(std::move(mend));
  judged_ns_ = 0;  // the order goes out with this turn
}

bool Server::has_room(Peer& peer, std::size_t pieces) {
  constexpr auto kLane = static_cast<std::size_t>(Priority::kSnapshot);
  PictureSink& sink = peer.pictures;
  const ConnectionStats stats = endpoint_->stats(peer.id);
  const std::uint64_t done = stats.datagrams_sent[kLane] + stats.datagrams_dropped[kLane];
  if (stats.datagrams_dropped[kLane] > sink.dropped) sink.seen.datagrams_dropped = true;
  sink.dropped = stats.datagrams_dropped[kLane];
  const std::uint64_t waiting = sink.offered > done ? sink.offered - done : 0;
  return waiting <= std::max<std::size_t>(pieces, kLeastRoom);
}

void Server::send_piece(Peer& peer, const Piece& piece) {
  if (endpoint_->send_datagram(peer.id, Priority::kSnapshot, piece.bytes)) peer.pictures.offered += 1;
}

// A hundred watchers' pieces take milliseconds to encrypt: a few at a time, so that poses that come meanwhile
// do not wait for all of them.
void Server::send_pictures() {
  for (CodedPicture& picture : world_.desk->collect()) leaving_.push_back({std::move(picture), 0});
  while (leaving_.size() > kMostLeaving) leaving_.pop_front();
  std::size_t room = kPiecesATurn;
  while (!leaving_.empty() && room > 0) {
    LeavingPicture& leaving = leaving_.front();
    const auto next = peers_.upper_bound(leaving.last);
    if (next == peers_.end()) {
      send_mended(leaving.picture);
      leaving_.pop_front();
      continue;
    }
    leaving.last = next->first;
    const std::size_t sent = send_picture(*next->second, leaving.picture);
    room -= std::min(room, sent);
  }
}

std::size_t Server::send_picture(Peer& peer, const CodedPicture& picture) {
  PictureSink& sink = peer.pictures;
  if (peer.gone || !sink.watching || sink.control.tier() != picture.tier) return 0;
  sink.seen.frames += 1;
  if (!has_room(peer, picture.frame.pieces.size())) {
    sink.seen.frames_withheld += 1;
    past_.frames_withheld += 1;
    return 0;
  }
  past_.frames_sent += 1;
  sink.pieces_now += static_cast<std::uint32_t>(picture.frame.pieces.size());
  for (const Piece& piece : picture.frame.pieces) send_piece(peer, piece);
  return picture.frame.pieces.size();
}

void Server::send_mended(const CodedPicture& picture) {
  for (const auto& [id, pieces] : picture.mended) {
    Peer* peer = find(id);
    if (!peer || !peer->pictures.watching || peer->pictures.control.tier() != picture.tier) continue;
    std::size_t bytes = 0;
    for (const Piece& piece : pieces) bytes += piece.bytes->size();
    if (!peer->limits.mend_bytes.take(now(), static_cast<double>(bytes))) continue;
    for (const Piece& piece : pieces) send_piece(*peer, piece);
  }
}

void Server::handle(Peer& peer, const wire::SnapshotFeedback& feedback) {
  PictureSink& sink = peer.pictures;
  if (!sink.watching || static_cast<int>(feedback.stream) != sink.control.tier()) return;
  sink.feedback_ns = now();
  // A peer reckons what was sent from what came, and around a key frame it may reckon far too much.
  const std::uint32_t most = sink.pieces_now + sink.pieces_before;
  if (feedback.pieces_sent <= most) {
    sink.seen.pieces_came += std::min(feedback.pieces, feedback.pieces_sent);
    sink.seen.pieces_sent += feedback.pieces_sent;
  }
  sink.pieces_before = std::exchange(sink.pieces_now, 0);
  if (feedback.missing.empty() || !peer.limits.mends.take(now())) return;
  MendOrder mend;
  mend.peer = peer.id;
  mend.tier = sink.control.tier();
  mend.epoch = feedback.epoch;
  mend.blocks = feedback.missing;
  order_.mends.push_back(std::move(mend));
}

void Server::judge_links() {
  const bool due = now() - judged_ns_ >= kJudgeEvery;
  if (!due && order_.mends.empty()) return;
  if (due) judged_ns_ = now();
  order_.watched.fill(false);
  for (auto& [id, peer] : peers_) {
    PictureSink& sink = peer->pictures;
    if (peer->gone || !sink.watching) continue;
    if (now() - sink.judged_ns >= kJudgeEvery) {
      sink.judged_ns = now();
      const ConnectionStats stats = endpoint_->stats(id);
      sink.seen.rtt = stats.smoothed_rtt;
      sink.seen.min_rtt = stats.min_rtt;
      sink.seen.silent = now() - sink.feedback_ns > to_nanoseconds(kFeedbackPatience);
      if (sink.control.note(sink.seen, now())) watch(*peer, sink.control.tier());
      sink.seen = {};
    }
    order_.watched[static_cast<std::size_t>(sink.control.tier())] = true;
  }
  world_.desk->order(std::exchange(order_, {}));
}

int Server::tier_of(std::uint32_t seat) const {
  const auto found = by_seat_.find(seat);
  if (found == by_seat_.end()) return -1;
  const auto peer = peers_.find(found->second);
  if (peer == peers_.end() || !peer->second->pictures.watching) return -1;
  return peer->second->pictures.control.tier();
}

}  // namespace slosh
