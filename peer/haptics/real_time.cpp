#include "peer/haptics/real_time.h"

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>

#include <cstddef>
#include <initializer_list>

namespace slosh {
namespace {

constexpr int kPriority = 20;
constexpr std::size_t kStackBytes = 128 * 1024;

/// Touches the stack that the thread may come to use, so that no tick pays for a page.
void prefault_stack() {
  unsigned char stack[kStackBytes];
  volatile unsigned char* touch = stack;
  for (std::size_t i = 0; i < kStackBytes; i += 4096) touch[i] = 0;
}

}  // namespace

bool become_device_thread(const char* name) noexcept {
  pthread_setname_np(pthread_self(), name);
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);  // the default lets a wake-up be 50 µs late
  sigset_t all;
  sigfillset(&all);
  for (const int own : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP}) sigdelset(&all, own);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
  prefault_stack();
  sched_param parameters{};
  parameters.sched_priority = kPriority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

bool lock_memory() noexcept {
  return mlockall(MCL_CURRENT | MCL_ONFAULT) == 0;
}

}  // namespace slosh
