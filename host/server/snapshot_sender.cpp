#include "host/server/snapshot_sender.h"

#include <algorithm>
#include <utility>

#include "net/clock.h"

namespace slosh {
namespace {

constexpr std::int64_t kJudgeEvery = 100'000'000;  // ns between two looks at a link
constexpr double kFeedbackPatience = 1.5;  // s without feedback after which a watcher counts as silent
constexpr std::size_t kPiecesATurn = 32;   // before the network is looked at again
constexpr std::size_t kMaxLeaving = 12;    // frames on their way; the oldest go when we cannot keep up
constexpr std::size_t kMinRoom = 8;        // pieces that may wait in a queue, however small a frame is

}  // namespace

void SnapshotSender::add(ConnectionId connection, wire::Role role, wire::SnapshotWish wish) {
  const bool film = wish == wire::SnapshotWish::kFilm;
  Sink sink;
  sink.wanted = wish != wire::SnapshotWish::kNone;
  sink.control = role == wire::Role::kParticipant
                     ? TierControl(kAllParticles, film ? kAllParticles : kAllParticles + 1)
                     : TierControl(film ? kAllParticles : kShell, kShell);
  sinks_.insert_or_assign(connection, std::move(sink));
}

void SnapshotSender::watch(ConnectionId connection, std::int64_t now_ns) {
  const auto found = sinks_.find(connection);
  if (found != sinks_.end() && found->second.wanted) watch(*found, now_ns);
}

void SnapshotSender::watch(Sinks::value_type& entry, std::int64_t now_ns) {
  Sink& sink = entry.second;
  const int tier = sink.control.tier();
  const auto i = static_cast<std::size_t>(tier);
  // The first of a tier gets a key frame; who joins others is given the blocks as they are.
  const bool others = std::any_of(sinks_.begin(), sinks_.end(), [&](const Sinks::value_type& other) {
    return other.first != entry.first && other.second.watching && other.second.control.tier() == tier;
  });
  sink.watching = true;
  sink.seen = {};
  sink.judged_ns = sink.feedback_ns = now_ns;
  order_.fresh[i] = order_.fresh[i] || !others;
  MendOrder mend;
  mend.peer = entry.first;
  mend.tier = tier;
  mend.all = true;
  order_.mends.push_back(std::move(mend));
  judged_ns_ = 0;  // the order goes out with this turn
}

bool SnapshotSender::has_room(ConnectionId connection, Sink& sink, std::size_t pieces) {
  constexpr auto kLane = static_cast<std::size_t>(Priority::kSnapshot);
  const ConnectionStats stats = endpoint_->stats(connection);
  const std::uint64_t done = stats.datagrams_sent[kLane] + stats.datagrams_dropped[kLane];
  if (stats.datagrams_dropped[kLane] > sink.dropped) sink.seen.datagrams_dropped = true;
  sink.dropped = stats.datagrams_dropped[kLane];
  const std::uint64_t waiting = sink.offered > done ? sink.offered - done : 0;
  return waiting <= std::max<std::size_t>(pieces, kMinRoom);
}

void SnapshotSender::send_piece(ConnectionId connection, Sink& sink, const Piece& piece) {
  if (endpoint_->send_datagram(connection, Priority::kSnapshot, piece.bytes)) sink.offered += 1;
}

// A hundred watchers' pieces take milliseconds to encrypt: a few at a time, so that poses that come meanwhile
// do not wait for all of them.
void SnapshotSender::send(std::int64_t now_ns) {
  for (CodedSnapshot& snapshot : desk_->collect()) leaving_.push_back({std::move(snapshot), 0});
  while (leaving_.size() > kMaxLeaving) leaving_.pop_front();
  std::size_t room = kPiecesATurn;
  while (!leaving_.empty() && room > 0) {
    Leaving& leaving = leaving_.front();
    const auto next = sinks_.upper_bound(leaving.last);
    if (next == sinks_.end()) {
      send_mended(leaving.snapshot, now_ns);
      leaving_.pop_front();
      continue;
    }
    leaving.last = next->first;
    const std::size_t sent = send_frame(next->first, next->second, leaving.snapshot);
    room -= std::min(room, sent);
  }
}

std::size_t SnapshotSender::send_frame(ConnectionId connection, Sink& sink, const CodedSnapshot& snapshot) {
  if (!sink.watching || sink.control.tier() != snapshot.tier) return 0;
  sink.seen.frames += 1;
  if (!has_room(connection, sink, snapshot.frame.pieces.size())) {
    sink.seen.frames_withheld += 1;
    frames_withheld_ += 1;
    return 0;
  }
  frames_sent_ += 1;
  sink.pieces_now += static_cast<std::uint32_t>(snapshot.frame.pieces.size());
  for (const Piece& piece : snapshot.frame.pieces) send_piece(connection, sink, piece);
  return snapshot.frame.pieces.size();
}

void SnapshotSender::send_mended(const CodedSnapshot& snapshot, std::int64_t now_ns) {
  for (const auto& [connection, pieces] : snapshot.mended) {
    const auto found = sinks_.find(connection);
    if (found == sinks_.end()) continue;
    Sink& sink = found->second;
    if (!sink.watching || sink.control.tier() != snapshot.tier) continue;
    std::size_t bytes = 0;
    for (const Piece& piece : pieces) bytes += piece.bytes->size();
    if (!sink.mend_bytes.take(now_ns, static_cast<double>(bytes))) continue;
    for (const Piece& piece : pieces) send_piece(connection, sink, piece);
  }
}

void SnapshotSender::note(ConnectionId connection, const wire::SnapshotFeedback& feedback,
                          std::int64_t now_ns) {
  const auto found = sinks_.find(connection);
  if (found == sinks_.end()) return;
  Sink& sink = found->second;
  if (!sink.watching || static_cast<int>(feedback.stream) != sink.control.tier()) return;
  sink.feedback_ns = now_ns;
  // A peer reckons what was sent from what came, and around a key frame it may reckon far too much.
  const std::uint32_t most = sink.pieces_now + sink.pieces_before;
  if (feedback.pieces_sent <= most) {
    sink.seen.pieces_came += std::min(feedback.pieces, feedback.pieces_sent);
    sink.seen.pieces_sent += feedback.pieces_sent;
  }
  sink.pieces_before = std::exchange(sink.pieces_now, 0);
  if (feedback.missing.empty() || !sink.mends.take(now_ns)) return;
  MendOrder mend;
  mend.peer = connection;
  mend.tier = sink.control.tier();
  mend.epoch = feedback.epoch;
  mend.blocks = feedback.missing;
  order_.mends.push_back(std::move(mend));
}

void SnapshotSender::judge(std::int64_t now_ns) {
  const bool due = now_ns - judged_ns_ >= kJudgeEvery;
  if (!due && order_.mends.empty()) return;
  if (due) judged_ns_ = now_ns;
  order_.watched.fill(false);
  for (auto& entry : sinks_) {
    Sink& sink = entry.second;
    if (!sink.watching) continue;
    if (now_ns - sink.judged_ns >= kJudgeEvery) {
      sink.judged_ns = now_ns;
      const ConnectionStats stats = endpoint_->stats(entry.first);
      sink.seen.rtt = stats.smoothed_rtt;
      sink.seen.min_rtt = stats.min_rtt;
      sink.seen.silent = now_ns - sink.feedback_ns > to_nanoseconds(kFeedbackPatience);
      if (sink.control.note(sink.seen, now_ns)) watch(entry, now_ns);
      sink.seen = {};
    }
    order_.watched[static_cast<std::size_t>(sink.control.tier())] = true;
  }
  desk_->order(std::exchange(order_, {}));
}

int SnapshotSender::tier_of(ConnectionId connection) const {
  const auto found = sinks_.find(connection);
  return found == sinks_.end() || !found->second.watching ? -1 : found->second.control.tier();
}

const char* SnapshotSender::words_of(ConnectionId connection) const {
  const auto found = sinks_.find(connection);
  if (found == sinks_.end() || !found->second.wanted) return "no particles";
  return kTiers[static_cast<std::size_t>(found->second.control.tier())].words;
}

}  // namespace slosh
