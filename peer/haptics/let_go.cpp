#include "peer/haptics/let_go.h"

#include <time.h>

#include <atomic>
#include <cstdlib>
#include <exception>

namespace slosh {
namespace {

std::atomic<bool> asked{false};
std::atomic<int> writers{0};
thread_local WrenchWriter* this_thread = nullptr;
std::terminate_handler before = nullptr;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "a signal's handler uses them");

[[noreturn]] void terminate_without_force() {
  let_go_of_all_hands(kLetGoWithin);
  if (before != nullptr) before();
  std::abort();
}

}  // namespace

WrenchWriter::WrenchWriter(WriteZero write_zero, void* of) noexcept : write_zero_(write_zero), of_(of) {
  writers.fetch_add(1);
  this_thread = this;
}

WrenchWriter::~WrenchWriter() {
  this_thread = nullptr;
  writers.fetch_sub(1);
}

bool asked_to_let_go() noexcept {
  return asked.load(std::memory_order_relaxed);
}

void let_go_of_all_hands(double seconds) noexcept {
  asked.store(true);
  const int own = this_thread == nullptr ? 0 : 1;
  if (this_thread != nullptr) this_thread->write_zero_(this_thread->of_);
  constexpr long kStep_ns = 1'000'000;
  for (long waited = 0; writers.load() > own && static_cast<double>(waited) < seconds * 1e9;
       waited += kStep_ns) {
    const timespec step{0, kStep_ns};
    nanosleep(&step, nullptr);
  }
}

void let_go_before_terminate() noexcept {
  static const bool once = [] {
    before = std::set_terminate(terminate_without_force);
    return true;
  }();
  (void)once;
}

}  // namespace slosh
