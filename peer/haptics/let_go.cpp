#include "peer/haptics/let_go.h"

#include <signal.h>
#include <time.h>

#include <atomic>
#include <cstdlib>
#include <exception>
#include <initializer_list>

namespace slosh {
namespace {

std::atomic<bool> asked{false};
std::atomic<int> writers{0};
thread_local WrenchWriter* this_thread = nullptr;
std::terminate_handler before = nullptr;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "a signal's handler uses them");

void write_own_zero() noexcept {
  if (this_thread != nullptr) this_thread->zero();
}

/// Returns when all writers but this thread have ended, or after `seconds`.
void wait_for_others(double seconds) noexcept {
  asked.store(true);
  const int own = this_thread == nullptr ? 0 : 1;
  constexpr long kStep_ns = 1'000'000;
  for (long waited = 0; writers.load() > own && static_cast<double>(waited) < seconds * 1e9;
       waited += kStep_ns) {
    const timespec step{0, kStep_ns};
    nanosleep(&step, nullptr);
  }
}

/// The default is back when this runs, and comes with the return: the fault happens again, or abort() goes
/// on.
extern "C" void crash_without_force(int) {
  // This thread last: what it writes with may be what is broken, and a second fault ends the process.
  wait_for_others(kLetGoWithin);
  write_own_zero();
}

/// Whoever handles a crash already (a sanitizer, Python's faulthandler) goes on to.
void let_go_before_crash() noexcept {
  struct sigaction action = {};
  action.sa_handler = crash_without_force;
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_NODEFER;
  sigemptyset(&action.sa_mask);
  for (const int signal_number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) {
    struct sigaction now = {};
    if (sigaction(signal_number, nullptr, &now) == 0 && now.sa_handler == SIG_DFL)
      sigaction(signal_number, &action, nullptr);
  }
}

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
  write_own_zero();
  wait_for_others(seconds);
}

void let_go_before_the_end() noexcept {
  static const bool once = [] {
    before = std::set_terminate(terminate_without_force);
    let_go_before_crash();
    return true;
  }();
  (void)once;
}

}  // namespace slosh
