// A peer that does everything right: holds a grip, sends poses, and writes down whether the host is there for
// it.
#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <thread>

#include "net/link.h"
#include "net/quic/endpoint.h"
#include "net/wire/stream_splitter.h"

namespace slosh::hostile {

struct HonestFigures {
  bool in = false;
  bool holds = false;        ///< by the newest roster
  std::uint64_t states = 0;  ///< body states that came
  std::uint64_t poses_sent = 0;
  std::uint64_t poses_used = 0;  ///< number of the newest of its poses that the world has used
  double longest_gap = 0.0;      ///< s between states, once it was in
  double gap = 0.0;              ///< s since the newest state
  std::uint64_t came_back = 0;   ///< times that contact was lost and found again
  double longest_away = 0.0;     ///< s
  double away = 0.0;             ///< s since contact was lost; 0 while it is there
  std::string fault;             ///< what the host did that it must not; empty while all is well
};

/// Has a thread and a key of its own. When contact times out it joins again; anything else that ends its
/// connection is a fault.
class HonestPeer {
 public:
  explicit HonestPeer(const JoinLink& link);
  ~HonestPeer();
  HonestPeer(const HonestPeer&) = delete;
  HonestPeer& operator=(const HonestPeer&) = delete;

  HonestFigures figures() const;
  /// Says good-bye and ends.
  void leave();

 private:
  class Line;
  void run();

  JoinLink link_;
  Identity identity_ = Identity::generate();
  mutable std::mutex mutex_;
  HonestFigures figures_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace slosh::hostile
