// A remote world as the rest of a peer sees it: a scene, a channel, snapshots, and who is here.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "peer/remote/remote_link.h"

namespace slosh {

/// Runs a RemoteLink on a thread of its own. Any one thread may use the rest.
class RemoteVisit {
 public:
  /// Starts to join at once.
  RemoteVisit(RemoteOptions options, Connect connect);
  ~RemoteVisit();
  RemoteVisit(const RemoteVisit&) = delete;
  RemoteVisit& operator=(const RemoteVisit&) = delete;

  RemoteStatus status() const;
  /// Waits until the visit is live or ended, at most `patience`; tells which it is now.
  LinkState wait_until_live(std::chrono::milliseconds patience);
  /// What a person should read, oldest first; each once.
  std::vector<std::string> take_notices();
  /// Done on the network's thread; refusals come as notices.
  void ask(const RemoteCommand& command);
  /// Says good-bye, ends, and finishes the film's queue. May be called again.
  void stop();

  /// From kLive on.
  RemoteWorld& world() { return link_.world(); }

 private:
  RemoteShared shared_;
  RemoteLink link_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// connect_quic to the addresses of a link, with the host's key pinned.
Connect connect_by(const JoinLink& link, const Identity& identity);

}  // namespace slosh
