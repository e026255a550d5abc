#include "peer/haptics/device_loop.h"

#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>

#include <algorithm>

#include "net/clock.h"

namespace slosh {
namespace {

constexpr int kPriority = 20;
constexpr std::size_t kStackBytes = 128 * 1024;

/// Touches the stack that the loop may come to use, so that no tick pays for a page.
void prefault_stack() {
  unsigned char stack[kStackBytes];
  volatile unsigned char* touch = stack;
  for (std::size_t i = 0; i < kStackBytes; i += 4096) touch[i] = 0;
}

bool ask_for_real_time() {
  sched_param parameters{};
  parameters.sched_priority = kPriority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

}  // namespace

DeviceLoop::DeviceLoop(Servo& servo, double period) : servo_(servo), period_ns_(to_nanoseconds(period)) {}

DeviceLoop::~DeviceLoop() {
  stop();
}

void DeviceLoop::start() {
  if (thread_.joinable()) return;
  thread_ = std::thread([this] { run(); });
  primed_.wait(false);
}

void DeviceLoop::stop() {
  stop_.store(true, std::memory_order_relaxed);
  if (thread_.joinable()) thread_.join();
}

void DeviceLoop::run() {
  pthread_setname_np(pthread_self(), "slosh-device");
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);  // the default lets a wake-up be 50 µs late
  report_.real_time = ask_for_real_time();
  prefault_stack();

  servo_.tick(steady_now_ns());
  primed_.store(true);
  primed_.notify_all();

  std::int64_t deadline = steady_now_ns() + period_ns_;
  std::int64_t last_wake = 0;
  std::int64_t window_begin = steady_now_ns();
  std::uint64_t window_ticks = 0;
  while (!stop_.load(std::memory_order_relaxed)) {
    sleep_until_ns(deadline);
    const std::int64_t wake = steady_now_ns();
    servo_.tick(wake);
    if (last_wake != 0) report_.period.add(to_seconds(wake - last_wake));
    last_wake = wake;
    report_.ticks += 1;

    const std::int64_t done = steady_now_ns();
    report_.busy.add(to_seconds(done - wake));
    deadline += period_ns_;
    if (done > deadline) {
      // Ticks that are past are not made up for: two readings in a row would tell nothing new.
      const std::int64_t late = (done - deadline) / period_ns_ + 1;
      report_.missed += static_cast<std::uint64_t>(late);
      deadline += late * period_ns_;
    }
    window_ticks += 1;
    if (done - window_begin > kNanosecondsPerSecond / 4) {
      rate_.store(static_cast<double>(window_ticks) / to_seconds(done - window_begin),
                  std::memory_order_relaxed);
      window_begin = done;
      window_ticks = 0;
    }
  }
}

}  // namespace slosh
