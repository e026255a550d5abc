#include "peer/haptics/real_time.h"

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <initializer_list>

namespace slosh {
namespace {

constexpr int kPriority = 20;
constexpr std::size_t kStackBytes = 128 * 1024;

/// The kernel's sched_attr (sched_setattr(2)), which glibc 2.36 does not know.
struct SchedAttributes {
  std::uint32_t size = sizeof(SchedAttributes);
  std::uint32_t policy = SCHED_OTHER;
  std::uint64_t flags = 0;
  std::int32_t nice = 0;
  std::uint32_t priority = 0;
  std::uint64_t runtime = 0;
  std::uint64_t deadline = 0;
  std::uint64_t period = 0;
};

constexpr std::uint64_t kSlice_ns = 100'000;  // the least that is taken; a tick needs a tenth

/// A thread that asks for little at a time has its turn sooner than those that go on for as long as they may:
/// it waits for the end of nobody's slice. Anybody may; Linux 6.12 or newer, older ones pass over it.
void ask_for_short_slice() {
  SchedAttributes attributes;
  attributes.nice = getpriority(PRIO_PROCESS, 0);  // of this thread, as it is
  attributes.runtime = kSlice_ns;
  (void)syscall(SYS_sched_setattr, 0, &attributes, 0u);
}

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
  if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0) return true;
  ask_for_short_slice();
  return false;
}

bool lock_memory() noexcept {
  return mlockall(MCL_CURRENT | MCL_ONFAULT) == 0;
}

}  // namespace slosh
