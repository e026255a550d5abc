// Ctrl-C in long calls: asked for now and then, where Python's lock is not held.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <cstdint>
#include <exception>
#include <future>
#include <memory>
#include <thread>

#include "net/clock.h"

namespace slosh::python {

/// One long call. Made and asked by one thread that has let go of Python's lock.
class Interrupts {
 public:
  /// What check() throws, so that no catch of std::exception on the way takes it for an error of its own.
  struct Stop {};

  /// Whether Python has something to raise; looks every 20 ms at most. Then rethrow() raises it.
  bool pending() {
    if (raised_) return true;
    const std::int64_t now = steady_now_ns();
    if (now < due_ns_) return false;
    due_ns_ = now + 20'000'000;
    const pybind11::gil_scoped_acquire held;
    if (PyErr_CheckSignals() == 0) return false;
    raised_ = std::make_exception_ptr(pybind11::error_already_set());
    return true;
  }
  void check() {
    if (pending()) throw Stop{};
  }
  /// Does nothing where nothing is pending.
  void rethrow() const {
    if (raised_) std::rethrow_exception(raised_);
  }

 private:
  std::int64_t due_ns_ = 0;
  std::exception_ptr raised_;
};

/// Runs `work`, which may call interrupts.check(), without Python's lock.
template <class Work>
auto without_lock(Interrupts& interrupts, Work&& work) {
  const pybind11::gil_scoped_release released;
  try {
    return work();
  } catch (const Interrupts::Stop&) {
    interrupts.rethrow();
    throw;  // not reached: Stop is thrown only where there is something to raise
  }
}

/// Runs `work`, which cannot be asked to stop, on a thread of its own that Ctrl-C leaves behind. So `work`
/// must own all that it looks at, and touch nothing of Python's.
template <class Work>
auto on_a_thread_left_behind(Work work) -> decltype(work()) {
  auto task = std::make_shared<std::packaged_task<decltype(work())()>>(std::move(work));
  std::future<decltype(work())> answer = task->get_future();
  std::thread([task] { (*task)(); }).detach();
  Interrupts interrupts;
  return without_lock(interrupts, [&] {
    while (answer.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) interrupts.check();
    return answer.get();
  });
}

}  // namespace slosh::python
