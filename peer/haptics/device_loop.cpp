#include "peer/haptics/device_loop.h"

#include "net/clock.h"
#include "peer/haptics/let_go.h"
#include "peer/haptics/real_time.h"

namespace slosh {

DeviceLoop::DeviceLoop(Servo& servo, double period) : servo_(servo), period_ns_(to_nanoseconds(period)) {}

DeviceLoop::~DeviceLoop() {
  stop();
}

void DeviceLoop::start() {
  if (thread_.joinable()) return;
  let_go_before_the_end();
  report_.memory_locked = lock_memory();
  thread_ = std::thread([this] { run(); });
  primed_.wait(false);
}

void DeviceLoop::stop() {
  stop_.store(true, std::memory_order_relaxed);
  if (thread_.joinable()) thread_.join();
}

void DeviceLoop::run() {
  report_.real_time = become_device_thread("slosh-device");
  const WrenchWriter writer([](void* servo) noexcept { static_cast<Servo*>(servo)->let_go(); }, &servo_);

  servo_.tick(steady_now_ns());
  primed_.store(true);
  primed_.notify_all();

  std::int64_t deadline = steady_now_ns() + period_ns_;
  std::int64_t last_wake = 0;
  std::int64_t window_begin = steady_now_ns();
  std::uint64_t window_ticks = 0;
  while (!stop_.load(std::memory_order_relaxed) && !asked_to_let_go()) {
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
  servo_.let_go();
}

}  // namespace slosh
