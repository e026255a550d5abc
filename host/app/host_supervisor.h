// Keeps a host alive: its world runs in a child process, and when a fault ends that one, another carries on
// from the checkpoint, at the same address and with the same links. Peers come back by themselves.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "host/app/host_options.h"

namespace slosh {

/// What a host's process and its supervisor tell each other, in a page that both see.
class SupervisorControl {
 public:
  /// Another is about to run: it has told nothing yet, and is to do what `next` asks for.
  void restart(const HostVerbOptions& next);
  /// What the process that was started is to run: what was typed, or what carries it on.
  HostVerbOptions to_run(const HostVerbOptions& typed) const;

  /// From now on the world can be carried on from `checkpoint`.
  void can_carry_on_from(const std::string& checkpoint);
  /// The child was asked to end, and does.
  void ends() { ending_.store(true, std::memory_order_release); }
  /// For HostOptions::pulse.
  std::atomic<std::uint64_t>& pulse() { return pulse_; }

  /// For NetLoop.
  std::atomic<std::uint64_t>& network_pulse() { return network_pulse_; }

  std::uint64_t pulse() const { return pulse_.load(std::memory_order_relaxed); }
  std::uint64_t network_pulse() const { return network_pulse_.load(std::memory_order_relaxed); }
  std::string checkpoint() const;  ///< empty: it cannot be carried on yet
  bool ending() const { return ending_.load(std::memory_order_acquire); }

 private:
  static constexpr std::size_t kLongestPath = 4095;
  std::atomic<bool> ready_{false};
  std::atomic<bool> ending_{false};
  std::atomic<std::uint64_t> pulse_{0};
  std::atomic<std::uint64_t> network_pulse_{0};
  char checkpoint_[kLongestPath + 1] = {};
  // Of restart(): how often, from what and into which recording it is carried on.
  int restarts_ = 0;
  char resume_[kLongestPath + 1] = {};
  char record_[kLongestPath + 1] = {};
};

/// The page that the process which started this one keeps, where it is supervised; else empty. For once: it
/// is not passed on to what this process starts.
std::unique_ptr<SupervisorControl, void (*)(SupervisorControl*)> inherited_supervisor_control();

/// A thread that lives and does nothing: its pulse stood for so many looks, one a second. Looks are counted
/// in place of a clock, so that whoever was stopped together with it, or slept with the machine, blames
/// nobody. Pure.
class HangWatch {
 public:
  explicit HangWatch(int most) : most_(most) {}
  /// True when it hangs. A pulse of 0 is of a thread that does not run: the host is loading, or at its end.
  bool look(std::uint64_t pulse) {
    looks_ = pulse == last_ && pulse != 0 ? looks_ + 1 : 0;
    last_ = pulse;
    return looks_ >= most_;
  }
  /// It is held up from outside: by a debugger, or SIGSTOP.
  void pass_over() { looks_ = 0; }

 private:
  int most_;
  int looks_ = 0;
  std::uint64_t last_ = 0;
};

/// Looks, one a second, after which a host's threads count as hung.
struct HangLimits {
  int world = 60;    ///< a reset settles the world again, within one turn of its loop
  int network = 20;  ///< nothing that it does takes a second
};

/// How often a host may die before it stays dead: what dies again and again is not saved by another start.
/// Pure.
class RestartBudget {
 public:
  static constexpr int kMax = 5;
  static constexpr std::int64_t kWithin_ns = 60'000'000'000;
  /// False when there were kMax within the last minute.
  bool take(std::int64_t now_ns);
  int taken() const { return static_cast<int>(taken_.size()); }

 private:
  std::deque<std::int64_t> taken_;
};

/// What to carry on with after the `restarts`-th death: the checkpoint, no choice of address (it is in
/// there), a recording of its own ("pour.rec", "pour-2.rec", …; the next that is not there yet).
HostVerbOptions restarted(const HostVerbOptions& options, const std::string& checkpoint, int restarts);

using HostBody = std::function<int(const HostVerbOptions&, SupervisorControl*)>;

/// Runs `body` in a child process, again and again where a fault ends it, or where its world or its network
/// hangs. Returns what the last child came to (128 + signal where one ended it); a child ends with what
/// `body` did, without exit()'s handlers. Signals that ask for the end are passed on.
///
/// The child is a fork, and a library may have threads from before main (log4cplus, which OpenVDB brings
/// along, has), which a fork leaves behind. So a body that does more than to wait or to die is
/// again_from_the_start().
int supervise_host(const HostVerbOptions& options, const HostBody& body, const HangLimits& limits = {});

/// A body that begins this very program anew with the command line that it has: it finds
/// inherited_supervisor_control(). Returns only where that fails, with words on stderr.
HostBody again_from_the_start();

}  // namespace slosh
