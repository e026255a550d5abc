#include "peer/haptics/device_port.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>

#include "net/clock.h"
#include "net/triple_buffer.h"
#include "peer/haptics/force_limiter.h"
#include "peer/haptics/freshness.h"
#include "peer/haptics/let_go.h"
#include "peer/haptics/real_time.h"

namespace slosh {
namespace {

constexpr double kPeriod = 0.001;  // s
/// s before the loop's next tick at which a device that does not wait itself is read, so that its answer is
/// there at once; s that the answer is waited for, and s between two looks.
constexpr double kLead = 2e-4;
constexpr double kAnswerWait = 5e-4;
constexpr double kLook = 5e-5;
/// s that a reading takes from which on the device goes at its own pace, and s without an order after which
/// nobody knows when the loop ticks.
constexpr double kOwnPace = 3e-4;
constexpr double kLoopLost = 0.01;

/// What the loop wants written.
struct Order {
  Wrench on_hand;
  std::int64_t stamp_ns = 0;  // 0 = none yet
  double time = 0.0;          // simulated s
  std::uint64_t answers = 0;  // DeviceReading::number that the loop had
};

/// When to read so that the tick that follows is soon: as long after `order` as the loop's period says.
std::int64_t next_reading_ns(const Order& order, std::int64_t now_ns) {
  const std::int64_t period_ns = to_nanoseconds(kPeriod);
  const std::int64_t first_ns = order.stamp_ns + period_ns - to_nanoseconds(kLead);
  return first_ns > now_ns ? first_ns : first_ns + ((now_ns - first_ns) / period_ns + 1) * period_ns;
}

Wrench scaled(double scale, const Wrench& w) {
  return {scale * w.force, scale * w.torque};
}

/// What a device was sent last and when: no thread that stood still, and none that it waits for, makes it
/// jump.
class Slew {
 public:
  explicit Slew(const DeviceLimits& limits) : limits_(limits) {}
  /// As far towards `wanted` as the limits let it go in the shorter of this turn and the one before, a period
  /// at least: what was missed is not made up for at once.
  Wrench toward(const Wrench& wanted, std::int64_t now_ns) {
    const std::int64_t turn_ns = now_ns - now_ns_;
    const double most = std::max(to_seconds(std::min(turn_ns, turn_ns_)), kPeriod);
    turn_ns_ = turn_ns;
    now_ns_ = now_ns;
    bool cut = false;
    at_.force += limit_length(wanted.force - at_.force, most * limits_.max_force_rate, cut);
    at_.torque += limit_length(wanted.torque - at_.torque, most * limits_.max_torque_rate, cut);
    if (!cut) at_ = wanted;  // bitwise
    return at_;
  }

 private:
  DeviceLimits limits_;
  Wrench at_;
  std::int64_t now_ns_ = 0;
  std::int64_t turn_ns_ = 0;
};

/// The words of the exception that is being handled.
std::string words_of_exception() {
  try {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "an exception without words";
  }
}

void write_zero_to(void* device) noexcept {
  try {
    static_cast<Device*>(device)->rest();
  } catch (...) {
    // It was told; there is nobody left to tell that it would not listen.
  }
}

}  // namespace

struct DevicePort::Own {
  std::shared_ptr<Device> device;
  TripleBuffer<DeviceReading> readings;  // device's thread → loop
  TripleBuffer<Order> orders;            // loop → device's thread
  std::atomic<bool> stop{false};
  std::string failure;  // written once, before failed
  std::atomic<bool> failed{false};

  std::mutex end;
  std::condition_variable ended;
  bool over = false;       // the thread has written its last
  bool abandoned = false;  // nobody waits for it any more

  bool ends() const { return stop.load(std::memory_order_relaxed) || asked_to_let_go(); }
  /// Returns when there is an order that answers reading `number`, read at `read_ns`, or after kAnswerWait.
  void wait_for_answer(std::uint64_t number, std::int64_t read_ns) {
    const std::int64_t until_ns = read_ns + to_nanoseconds(kAnswerWait);
    // Nothing comes before the loop's next tick.
    std::int64_t look_ns = orders.front().stamp_ns + to_nanoseconds(kPeriod + 0.5 * kLook);
    while (orders.update(), orders.front().answers < number && !ends()) {
      const std::int64_t now_ns = steady_now_ns();
      if (now_ns >= until_ns) return;
      look_ns = std::min(std::max(look_ns, now_ns + to_nanoseconds(kLook)), until_ns);
      sleep_until_ns(look_ns);
    }
  }
};

DevicePort::DevicePort(std::unique_ptr<Device> device)
    : device_(std::move(device)), limits_(device_->limits()) {
  if (device_->immediate()) return;
  own_ = std::make_shared<Own>();
  own_->device = device_;
  let_go_before_the_end();
  thread_ = std::thread([own = own_] { run(own); });
}

DevicePort::~DevicePort() {
  stop();
}

void DevicePort::run(const std::shared_ptr<Own>& own) {
  become_device_thread("slosh-hand");
  Device& device = *own->device;
  Slew slew(device.limits());
  {
    const WrenchWriter writer(write_zero_to, &device);
    try {
      std::int64_t deadline_ns = steady_now_ns();
      std::uint64_t number = 0;
      while (!own->ends()) {
        own->orders.update();
        const std::int64_t begin_ns = steady_now_ns();
        const double time = own->orders.front().time;
        DeviceReading& reading = own->readings.back();
        reading.report = device.read({time, kPeriod});
        if (reading.report.heard) {
          reading.number = ++number;
          reading.stamp_ns = steady_now_ns();
          reading.time = time;
          own->readings.publish();
        }
        const std::int64_t read_ns = steady_now_ns();
        const bool own_pace = read_ns - begin_ns > to_nanoseconds(kOwnPace);
        const bool loop_ticks = read_ns - own->orders.front().stamp_ns < to_nanoseconds(kLoopLost);
        // Where the device has no pace of its own the loop's tick is near.
        if (reading.report.heard && !own_pace && loop_ticks) own->wait_for_answer(number, read_ns);
        if (own->ends()) break;
        own->orders.update();
        const Order& order = own->orders.front();
        const std::int64_t now_ns = steady_now_ns();
        // It stands until the next: what is left of the force by then.
        const double age = to_seconds(now_ns - order.stamp_ns) + kPeriod;
        const double share = order.stamp_ns == 0 ? 0.0 : freshness(age, kPeriod);
        device.write(slew.toward(scaled(share, order.on_hand), now_ns));
        deadline_ns = std::max(deadline_ns + to_nanoseconds(kPeriod), now_ns - to_nanoseconds(kPeriod));
        if (!own_pace && loop_ticks) deadline_ns = next_reading_ns(order, now_ns);
        sleep_until_ns(deadline_ns);
      }
    } catch (...) {
      own->failure = words_of_exception();
      own->failed.store(true, std::memory_order_release);
    }
    write_zero_to(&device);
  }
  bool abandoned = false;
  {
    const std::lock_guard lock(own->end);
    own->over = true;
    abandoned = own->abandoned;
  }
  own->ended.notify_all();
  if (abandoned) device.close();
}

template <class Do>
void DevicePort::guarded(Do&& act) noexcept {
  if (failed_.load(std::memory_order_relaxed)) return;
  try {
    act();
  } catch (...) {
    failure_ = words_of_exception();
    failed_.store(true, std::memory_order_release);
    write_zero_to(device_.get());
  }
}

const DeviceReading& DevicePort::read(const DeviceMoment& moment, std::int64_t now_ns) noexcept {
  if (own_) {
    own_->readings.update();
    own_->orders.back().time = moment.time;
    own_->orders.back().answers = own_->readings.front().number;
    return own_->readings.front();
  }
  guarded([&] {
    const DeviceReport report = device_->read(moment);
    if (!report.heard) return;
    reading_.report = report;
    reading_.number += 1;
    reading_.stamp_ns = now_ns;
    reading_.time = moment.time;
  });
  return reading_;
}

void DevicePort::write(const Wrench& on_hand) noexcept {
  if (own_) {
    Order& order = own_->orders.back();
    const std::int64_t now_ns = steady_now_ns();  // its thread compares it with the same clock
    left_ = written_ns_ == 0 ? 1.0 : freshness(to_seconds(now_ns - written_ns_), kPeriod);
    written_ns_ = now_ns;
    order.on_hand = scaled(left_, on_hand);
    order.stamp_ns = now_ns;
    own_->orders.publish();
    return;
  }
  guarded([&] { device_->write(on_hand); });
}

void DevicePort::write_zero() noexcept {
  if (stopped_) return;
  if (own_) {
    own_->stop.store(true);
  } else {
    write_zero_to(device_.get());
  }
}

void DevicePort::stop() noexcept {
  if (stopped_) return;
  stopped_ = true;
  if (!own_) {
    write_zero_to(device_.get());
    device_->close();
    return;
  }
  own_->stop.store(true);
  bool over = false;
  {
    std::unique_lock lock(own_->end);
    over =
        own_->ended.wait_for(lock, std::chrono::duration<double>(kStopWait), [this] { return own_->over; });
    own_->abandoned = !over;
  }
  if (over) {
    thread_.join();
    device_->close();
  } else {
    thread_.detach();
  }
}

std::string DevicePort::failure() const {
  if (own_ && own_->failed.load(std::memory_order_acquire)) return own_->failure;
  if (!own_ && failed_.load(std::memory_order_acquire)) return failure_;
  return device_->trouble();
}

}  // namespace slosh
