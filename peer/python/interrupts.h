// Ctrl-C in long calls: asked for now and then, where Python's lock is not held.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <exception>

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

}  // namespace slosh::python
