// Where the thread that sends and the thread that codes snapshots meet.
#pragma once

#include <array>
#include <mutex>
#include <utility>
#include <vector>

#include "host/server/tiers.h"
#include "net/codec/snapshot_codec.h"
#include "net/quic/endpoint.h"

namespace slosh {

/// Blocks that one peer lacks.
struct MendOrder {
  ConnectionId peer = 0;
  int tier = 0;
  bool all = false;  ///< it has nothing of this epoch yet
  std::uint32_t epoch = 0;
  std::vector<wire::BlockRange> blocks;
};

/// What the senders want of the next snapshots.
struct SnapshotOrder {
  std::array<bool, kTierCount> watched{};
  std::array<bool, kTierCount> fresh{};  ///< a key frame, please
  std::vector<MendOrder> mends;
};

struct CodedSnapshot {
  int tier = 0;
  EncodedFrame frame;
  std::vector<std::pair<ConnectionId, std::vector<Piece>>> mended;  ///< for one peer each
};

/// Neither side waits for the other.
class SnapshotDesk {
 public:
  /// Sender: what is wanted from now on. `fresh` and `mends` add up until they are taken.
  void order(SnapshotOrder order);
  /// Sender: all that was coded since the last call, oldest first. Old ones are lost when more than a few
  /// wait.
  std::vector<CodedSnapshot> collect();

  /// Coder's side.
  SnapshotOrder take_order();
  /// Does anybody watch?
  bool watched() const;
  void deliver(std::vector<CodedSnapshot> snapshots);

 private:
  mutable std::mutex mutex_;
  SnapshotOrder order_;
  std::vector<CodedSnapshot> coded_;
};

}  // namespace slosh
