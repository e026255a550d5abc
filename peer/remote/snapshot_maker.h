// Where snapshots of a remote world are put together, on a thread of their own: pieces in, snapshots out.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "net/histogram.h"
#include "net/quic/endpoint.h"
#include "net/snapshot_queue.h"
#include "peer/remote/body_inbox.h"
#include "peer/remote/film_times.h"
#include "peer/remote/shown_time.h"
#include "peer/remote/snapshot_history.h"
#include "peer/remote/stream_decoders.h"

namespace slosh {

struct SnapshotMakerOptions {
  bool wanted = true;               ///< false: nothing is drawn, and no particles come
  bool film = false;                ///< every snapshot of a film into the queue; else newest() on demand
  double frames_per_second = 30.0;  ///< of the film
  bool has_fluid = true;            ///< the world has particles: a film waits for them
};

struct SnapshotReport {
  Histogram age;                    ///< of what was shown, behind the host's world, s
  std::uint64_t frames = 0;         ///< snapshots decoded
  std::uint64_t whole = 0;          ///< of these, with every particle of their own moment
  std::uint64_t bytes = 0;          ///< of pieces
  std::uint64_t refused = 0;        ///< pieces that were damaged
  std::uint64_t overrun = 0;        ///< pieces that came faster than they could be decoded
  std::uint64_t shown = 0;          ///< made
  double delay = 0.0;               ///< s behind the host, now
  double first_shown_time = -1.0;   ///< simulated s; −1 = none yet
  double last_shown_time = -1.0;    ///< simulated s
  std::int64_t first_shown_ns = 0;  ///< steady clock; 0 = none yet
  std::string last_fault;
};

/// offer(), note_*(), restart(), take_feedback() belong to the network's thread and never wait for decoding;
/// newest() to the window's; the queue to the film's viewer.
class SnapshotMaker {
 public:
  /// `film` must outlive it; it is closed by finish().
  SnapshotMaker(const SnapshotMakerOptions& options, SnapshotQueue& film);
  ~SnapshotMaker();
  SnapshotMaker(const SnapshotMaker&) = delete;
  SnapshotMaker& operator=(const SnapshotMaker&) = delete;

  /// A datagram of the snapshot stream.
  void offer(std::span<const std::uint8_t> datagram);
  void note_bodies(const BodyMessage& bodies);
  /// Another person's hand, as SnapshotHistory::add_hand.
  void note_hand(std::uint32_t run, std::size_t grip, double time, const Pose& pose, bool engaged);
  /// Where the host's world stands, by its clock.
  void note_moment(const WorldMoment& moment);
  void note_clock(const ClockSync& clock);
  /// A new connection: the decoder starts anew.
  void restart();
  /// Feedback for the host when some is due.
  std::vector<SharedBytes> take_feedback();
  /// No more will come: what can be shown goes into the film, and the queue is closed.
  void finish();

  /// What to show at `now_ns`, for a window; null when that is what it was last time.
  SnapshotPointer newest(std::int64_t now_ns);

  SnapshotReport report() const;
  double delay() const;  ///< s that snapshots are behind the host's world, now

 private:
  void run();
  void take_pieces(const std::vector<std::vector<std::uint8_t>>& pieces, bool anew, bool to_the_end);
  void take_frame(DecodedFrame frame);
  void make_film(bool to_the_end);
  std::optional<Between> next_of_film(bool to_the_end);
  void make_feedback();
  double world_time(std::int64_t now_ns) const;

  const SnapshotMakerOptions options_;
  SnapshotQueue& film_;

  mutable std::mutex inbox_mutex_;  // held for moments only
  std::condition_variable changed_;
  std::vector<std::vector<std::uint8_t>> inbox_;
  std::size_t inbox_bytes_ = 0;
  std::uint64_t overrun_ = 0;
  std::vector<SharedBytes> feedback_;
  bool anew_ = false;
  bool finish_ = false;

  mutable std::mutex mutex_;  // what follows; never held while blending or decoding
  SnapshotHistory history_;
  ShownTime shown_;
  WorldMoment moment_;
  ClockSync clock_;
  SnapshotReport report_;
  double last_shown_ = -1e9;
  const DecodedFrame* last_frame_ = nullptr;  // compared only

  // The thread's own.
  StreamDecoders decoders_;
  FilmTimes times_;
  std::uint32_t film_run_ = 0;
  double bodies_received_to_ = 0.0;  // simulated s, when the pieces that are decoded now were taken
  std::int64_t feedback_due_ns_ = 0;
  std::thread thread_;
};

}  // namespace slosh
