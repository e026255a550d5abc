// The device loop's period: quiet and beside busy processes, with real-time priority and without.
#include <linux/capability.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "peer/haptics/device_loop.h"
#include "tests/peer/noted_writes.h"
#include "tests/peer/servo_kit.h"

namespace slosh {
namespace {

/// Endless loops, as other programs: each in a session of its own, or in this one's.
class BusyProcesses {
 public:
  BusyProcesses(int count, bool own_sessions) {
    for (int i = 0; i < count; ++i) {
      const pid_t child = fork();
      if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (own_sessions) setsid();
        for (;;) asm volatile("");
      }
      children_.push_back(child);
    }
  }
  ~BusyProcesses() {
    for (const pid_t child : children_) {
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
    }
  }
  BusyProcesses(const BusyProcesses&) = delete;
  BusyProcesses& operator=(const BusyProcesses&) = delete;

 private:
  std::vector<pid_t> children_;
};

/// From here on this process is granted no priority, as most users are.
bool give_up_priority() {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct data[2] = {};
  if (syscall(SYS_capget, &header, data) != 0) return false;
  data[0].effective &= ~(1u << CAP_SYS_NICE);
  data[0].permitted &= ~(1u << CAP_SYS_NICE);
  return syscall(SYS_capset, &header, data) == 0;
}

/// Reads nothing and writes nothing, on the loop itself: and says that the world goes on.
class World final : public Device {
 public:
  explicit World(Channel& channel) : channel_(channel) {}
  DeviceReport read(const DeviceMoment&) override {
    test::publish_ahead(channel_, ++reads_);
    return {};
  }
  DeviceLimits limits() const override { return limits_without_a_hand(); }
  bool immediate() const override { return true; }
  std::string kind() const override { return "world"; }

 private:
  Channel& channel_;
  int reads_ = 0;
};

/// A hand whose device has a thread of its own, and one on the loop, for `seconds`.
DeviceLoopReport looped(double seconds) {
  Scene scene = test::one_grip_scene();
  scene.grips.push_back(scene.grips[0]);
  BodyMessage first = test::ServoKit::first();
  first.bodies.grips.resize(2);
  Channel channel(2, first, 1000);
  std::vector<std::unique_ptr<Device>> devices;
  devices.push_back(std::make_unique<test::NotingDevice>(std::make_shared<test::NotedWrites>()));
  devices.push_back(std::make_unique<World>(channel));
  Servo servo(scene, std::move(devices), channel, ServoOptions{});
  DeviceLoop loop(servo);
  loop.start();
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  loop.stop();
  return loop.report();
}

void measure(int busy, bool own_sessions, double seconds, int times, const std::string& csv) {
  for (int i = 0; i < times; ++i) {
    const BusyProcesses others(busy, own_sessions);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    const DeviceLoopReport report = looped(seconds);
    char row[200];
    std::snprintf(row, sizeof row, "%d,%s,%s,%llu,%.3f,%.3f,%.3f,%.3f,%llu", busy,
                  busy == 0      ? "none"
                  : own_sessions ? "own"
                                 : "one",
                  report.scheduler().c_str(), static_cast<unsigned long long>(report.ticks),
                  1e3 * report.period.percentile(0.5), 1e3 * report.period.percentile(0.99),
                  1e3 * report.period.percentile(0.999), 1e3 * report.period.max(),
                  static_cast<unsigned long long>(report.missed));
    std::puts(row);
    std::fflush(stdout);
    if (!csv.empty()) std::ofstream(csv, std::ios::app) << row << '\n';
  }
}

int run(int argc, char** argv) {
  CLI::App app("The device loop's period, from wake to wake");
  double seconds = 10.0;
  int times = 3;
  std::vector<int> busy{0, 2, 4};
  std::string csv;
  app.add_option("--seconds", seconds, "of each run")->check(CLI::Range(0.1, 1e4))->capture_default_str();
  app.add_option("--times", times, "each")->check(CLI::Range(1, 1000))->capture_default_str();
  app.add_option("--busy", busy, "endless loops beside it, with commas between")
      ->delimiter(',')
      ->capture_default_str();
  bool without = false;
  app.add_flag("--without-priority", without, "only without priority");
  app.add_option("--csv", csv, "a file for the rows, anew");
  CLI11_PARSE(app, argc, argv);
  const char* const header =
      "busy,sessions,scheduler,ticks,period_p50_ms,period_p99_ms,period_p999_ms,period_max_ms,missed";
  std::puts(header);
  if (!csv.empty()) std::ofstream(csv) << header << '\n';
  // With what is granted, then without.
  for (const bool granted : {true, false}) {
    if (granted && without) continue;
    if (!granted && !give_up_priority()) {
      std::fprintf(stderr, "bench_loop: cannot give up priority\n");
      return 1;
    }
    for (const int count : busy)
      for (const bool own_sessions : {false, true})
        if (count > 0 || !own_sessions) measure(count, own_sessions, seconds, times, csv);
  }
  return 0;
}

}  // namespace
}  // namespace slosh

int main(int argc, char** argv) {
  return slosh::run(argc, argv);
}
