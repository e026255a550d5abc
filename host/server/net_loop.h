// The network's thread.
#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "host/server/server.h"

namespace slosh {

/// Runs a server and its endpoint, from start() to stop(). Made and ended by one thread.
class NetLoop {
 public:
  /// Both must outlive it. So must `pulse`, which rises with every turn and is 0 while the thread does not
  /// run; null = nobody looks.
  NetLoop(Server& server, Endpoint& endpoint, std::atomic<std::uint64_t>* pulse = nullptr)
      : server_(server), endpoint_(endpoint), pulse_(pulse) {}
  ~NetLoop() { stop("the host ends"); }
  NetLoop(const NetLoop&) = delete;
  NetLoop& operator=(const NetLoop&) = delete;

  void start();
  /// Tells everybody why, lets that out, ends the thread. May be called again.
  void stop(const std::string& why);

  /// One console line to its answer; waits for it. Any thread but this one.
  Outcome ask(const std::string& line);
  ServerFigures figures();
  bool quit_asked() const { return quit_.load(std::memory_order_relaxed); }
  /// s of processor time that the thread has taken.
  double cpu_seconds() const { return cpu_seconds_.load(std::memory_order_relaxed); }

 private:
  template <class T, class Work>
  T on_thread(Work work);
  void run();

  Server& server_;
  Endpoint& endpoint_;
  std::atomic<std::uint64_t>* pulse_;
  std::thread thread_;
  std::atomic<bool> stop_{false};
  std::atomic<bool> quit_{false};
  std::atomic<double> cpu_seconds_{0.0};
};

}  // namespace slosh
