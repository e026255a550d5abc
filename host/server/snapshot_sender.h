// Snapshots on their way to the peers: who is sent which quality, and how much of it now.
#pragma once

#include <deque>
#include <map>

#include "host/server/snapshot_desk.h"
#include "host/server/tiers.h"
#include "host/server/token_bucket.h"
#include "net/quic/endpoint.h"
#include "net/wire/messages.h"

namespace slosh {

/// One thread, the network's. Knows connections by their number alone: who somebody is, is not its business.
class SnapshotSender {
 public:
  explicit SnapshotSender(SnapshotDesk* desk) : desk_(desk) {}
  void use(Endpoint& endpoint) { endpoint_ = &endpoint; }

  /// Somebody who may have snapshots; none are sent before watch().
  void add(ConnectionId connection, wire::Role role, wire::SnapshotWish wish);
  /// Begins to send, when they are wanted at all.
  void watch(ConnectionId connection, std::int64_t now_ns);
  void forget(ConnectionId connection) { sinks_.erase(connection); }
  void note(ConnectionId connection, const wire::SnapshotFeedback& feedback, std::int64_t now_ns);

  /// A few pieces of what was coded; the rest with the next call.
  void send(std::int64_t now_ns);
  /// Looks at the links, changes tiers, orders what is wanted of the next snapshots.
  void judge(std::int64_t now_ns);
  /// Something is on its way: call send() again soon.
  bool sending() const { return !leaving_.empty(); }

  int tier_of(ConnectionId connection) const;           ///< −1: gets none
  const char* words_of(ConnectionId connection) const;  ///< its tier, for people
  std::uint64_t frames_sent() const { return frames_sent_; }
  std::uint64_t frames_withheld() const { return frames_withheld_; }

 private:
  /// One peer's.
  struct Sink {
    TierControl control{kShell, kShell};
    bool wanted = true;  // false: the peer draws nothing and is sent none
    bool watching = false;
    LinkEvidence seen;
    std::uint64_t offered = 0;        // snapshot datagrams given to the endpoint
    std::uint64_t dropped = 0;        // of those, by the endpoint, when last looked
    std::uint32_t pieces_now = 0;     // of frames, sent since the last feedback
    std::uint32_t pieces_before = 0;  // and between the two before
    std::int64_t judged_ns = 0;
    std::int64_t feedback_ns = 0;
    TokenBucket mends{20.0, 20.0};     // requests for blocks that are answered
    TokenBucket mend_bytes{1e6, 8e6};  // of intra pieces for this peer alone
  };
  using Sinks = std::map<ConnectionId, Sink>;
  void watch(Sinks::value_type& entry, std::int64_t now_ns);
  bool has_room(ConnectionId connection, Sink& sink, std::size_t pieces);
  void send_piece(ConnectionId connection, Sink& sink, const Piece& piece);
  std::size_t send_frame(ConnectionId connection, Sink& sink, const CodedSnapshot& snapshot);
  void send_mended(const CodedSnapshot& snapshot, std::int64_t now_ns);

  SnapshotDesk* desk_;
  Endpoint* endpoint_ = nullptr;
  Sinks sinks_;
  SnapshotOrder order_;
  struct Leaving {
    CodedSnapshot snapshot;
    ConnectionId last = 0;  // the last one that got it
  };
  std::deque<Leaving> leaving_;
  std::int64_t judged_ns_ = 0;
  std::uint64_t frames_sent_ = 0;
  std::uint64_t frames_withheld_ = 0;
};

}  // namespace slosh
