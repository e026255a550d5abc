// From the world's snapshots to coded ones, on a thread of its own, once for each tier that somebody watches.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "host/server/snapshot_desk.h"
#include "host/snapshot_demand.h"
#include "net/snapshot_queue.h"

namespace slosh {

/// Owns the encoders. One thread.
class SnapshotCoder {
 public:
  /// `spacing` in m; `run` is BodyMessage::run of the first snapshot.
  explicit SnapshotCoder(double spacing, std::uint32_t run = 0);

  /// Every snapshot of the world in order, also one that is not coded. `newest_run` (BodyMessage::run) is
  /// that of the newest snapshot made; this one is of it when its tick is not above the last one's, else of
  /// the run before: a world that stands shows the same tick again, and a reset may come while older
  /// snapshots wait.
  void see(const Snapshot& snapshot, std::uint32_t newest_run);
  /// Codes one snapshot for the tiers whose turn it is; for all that are watched when it is shown `again`.
  void code(const Snapshot& snapshot, SnapshotOrder order, std::vector<CodedSnapshot>& out,
            bool again = false);

  double seconds() const { return seconds_; }  ///< spent coding

 private:
  /// Two frames on end are mended: the codec predicts from two.
  struct Mending {
    MendOrder order;
    int frames_left = 2;
  };
  void mend(int tier, const EncodedFrame& frame, CodedSnapshot& out);

  double spacing_;
  std::uint32_t run_;
  std::optional<std::uint64_t> last_tick_;
  std::uint64_t count_ = 0;
  std::array<std::optional<SnapshotEncoder>, kTierCount> encoders_;
  std::array<double, kTierCount> last_key_{};  // simulated s
  std::array<bool, kTierCount> was_watched_{};
  std::map<std::pair<ConnectionId, int>, Mending> mending_;
  std::vector<Piece> pieces_;
  double seconds_ = 0.0;
};

/// Takes every snapshot from a queue, codes it, lays it on the desk and calls `wake`. Leaves snapshots out
/// when it falls behind. While the world stands it shows the last one again ten times a second, for who comes
/// late.
class SnapshotThread {
 public:
  SnapshotThread(SnapshotQueue& snapshots, SnapshotDesk& desk, SnapshotDemand& demand, double spacing,
                 std::uint32_t run, std::function<void()> wake);
  ~SnapshotThread();  ///< waits; the queue must be closed
  SnapshotThread(const SnapshotThread&) = delete;
  SnapshotThread& operator=(const SnapshotThread&) = delete;

  double seconds() const { return seconds_.load(std::memory_order_relaxed); }

 private:
  void run();
  SnapshotQueue& snapshots_;
  SnapshotDesk& desk_;
  SnapshotDemand& demand_;
  SnapshotCoder coder_;
  std::function<void()> wake_;
  std::atomic<double> seconds_{0.0};
  std::thread thread_;
};

}  // namespace slosh
