// Keeps a host alive: its world runs in a child process, and when a fault ends that one, another carries on
// from the checkpoint, at the same address and with the same links. Peers come back by themselves.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>

#include "peer/verbs/host_options.h"

namespace slosh {

/// What the child tells its supervisor, in a page that both see.
class HostReins {
 public:
  /// From now on the world can be carried on from `checkpoint`.
  void can_carry_on_from(const std::string& checkpoint);
  /// The child was asked to end, and does.
  void ends() { ending_.store(true, std::memory_order_release); }

  std::string checkpoint() const;  ///< empty: it cannot be carried on yet
  bool ending() const { return ending_.load(std::memory_order_acquire); }
  void restart();

 private:
  static constexpr std::size_t kLongestPath = 4095;
  std::atomic<bool> ready_{false};
  std::atomic<bool> ending_{false};
  char checkpoint_[kLongestPath + 1] = {};
};

/// How often a host may die before it stays dead: what dies again and again is not saved by another start.
/// Pure.
class RestartBudget {
 public:
  static constexpr int kMost = 5;
  static constexpr std::int64_t kWithin_ns = 60'000'000'000;
  /// False when there were kMost within the last minute.
  bool take(std::int64_t now_ns);
  int taken() const { return static_cast<int>(taken_.size()); }

 private:
  std::deque<std::int64_t> taken_;
};

/// What to carry on with after the `restarts`-th death: the checkpoint, no choice of address (it is in
/// there), a recording of its own ("pour.rec", "pour-2.rec", …; the next that is not there yet).
HostVerbOptions restarted(const HostVerbOptions& options, const std::string& checkpoint, int restarts);

using HostBody = std::function<int(const HostVerbOptions&, HostReins*)>;

/// Runs `body` in a child process, again and again where a fault ends it. Returns in the parent what the last
/// child came to (128 + signal where one ended it), and in each child what `body` did. Signals that ask for
/// the end are passed on. Before any thread starts.
int supervise_host(const HostVerbOptions& options, const HostBody& body);

}  // namespace slosh
