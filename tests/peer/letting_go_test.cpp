// However a process with hands on its devices ends, the last that a device is sent is zero. Each way is taken
// by a process of its own, whose device writes into memory that the test can see.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <functional>
#include <new>
#include <optional>
#include <stdexcept>
#include <thread>

#include "peer/haptics/device_loop.h"
#include "peer/app/interrupt.h"
#include "servo_kit.h"

namespace slosh {
namespace {

using test::ServoKit;

/// Seen by both processes.
struct Felt {
  std::atomic<double> last{0.0};  // N
  std::atomic<int> writes{0};
  std::atomic<bool> caught{false};
};

constexpr double kFull = -10.0;  // N, of a spring of 1000 N/m and SeenDevice's way

/// Takes hold of the grip and goes away from it, until it is pulled at full force. A machine that keeps its
/// thread, or the loop's, for longer than the watchdog makes the hand take hold where it is by then, rightly
/// without a force, and in a world that waits for ever: so whoever is not pulled lets go and begins again.
class SeenDevice final : public Device {
 public:
  SeenDevice(Felt& felt, bool immediate) : felt_(felt), immediate_(immediate) {}
  DeviceReport read(const DeviceMoment&) override {
    if (!pulled_) at_ = (at_ + 1) % (kLetGo + kHold + kPull);
    DeviceReport report;
    report.engaged = at_ >= kLetGo;
    report.pose.position.x = at_ >= kLetGo + kHold ? kAway : 0.0;
    return report;
  }
  void write(const Wrench& on_hand) override {
    pulled_ = on_hand.force.x == kFull;
    felt_.last = on_hand.force.x;
    felt_.writes += 1;
  }
  DeviceLimits limits() const override { return limits_without_a_hand(); }
  bool immediate() const override { return immediate_; }
  std::string kind() const override { return "seen"; }

 private:
  Felt& felt_;
  bool immediate_;
  bool pulled_ = false;
  int at_ = 0;
  static constexpr int kLetGo = 20, kHold = 300, kPull = 200;  // readings
  static constexpr double kAway = 0.01;                        // m
};

[[gnu::noinline]] void break_promise() {
  throw std::runtime_error("promised not to");
}

int* volatile nowhere = nullptr;

/// Promises not to throw and does.
class LyingDevice final : public Device {
 public:
  explicit LyingDevice(Felt& felt) : seen_(felt, true) {}
  DeviceReport read(const DeviceMoment& moment) noexcept override {
    if (++reads_ > 600) break_promise();
    return seen_.read(moment);
  }
  void write(const Wrench& on_hand) override { seen_.write(on_hand); }
  DeviceLimits limits() const override { return limits_without_a_hand(); }
  bool immediate() const override { return true; }
  std::string kind() const override { return "lying"; }

 private:
  SeenDevice seen_;
  int reads_ = 0;
};

/// Holds on to a waiting world, which says that it is there.
struct HeldRun {
  Scene scene = test::one_grip_scene();
  Channel channel{1, ServoKit::first(), 1000};
  std::optional<Servo> servo;
  std::optional<DeviceLoop> loop;

  explicit HeldRun(std::unique_ptr<Device> device) {
    std::vector<std::unique_ptr<Device>> devices;
    devices.push_back(std::move(device));
    servo.emplace(scene, std::move(devices), channel, ServoOptions{});
    loop.emplace(*servo);
    loop->start();
  }
  void go_on_while(const std::function<bool()>& more) {
    while (more()) {
      channel.bodies().back() = ServoKit::first();
      channel.bodies().publish();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }
};

class LettingGo : public ::testing::TestWithParam<bool> {
 protected:
  Felt* felt = nullptr;

  void SetUp() override {
    void* const memory =
        mmap(nullptr, sizeof(Felt), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(memory, MAP_FAILED);
    felt = new (memory) Felt;
  }
  void TearDown() override { munmap(felt, sizeof(Felt)); }
  std::unique_ptr<Device> device() { return std::make_unique<SeenDevice>(*felt, GetParam()); }

  /// Runs `life` in a process of its own; sends it `signals`, the first when its hand is pulled at full
  /// force, each next one when it has noted the one before. Returns what waitpid says.
  int process(const std::function<void()>& life, const std::vector<int>& signals) {
    const pid_t child = fork();
    if (child == 0) {
      life();
      _exit(0);
    }
    int status = 0;
    for (std::size_t i = 0; i < signals.size(); ++i) {
      for (int waited_ms = 0; i == 0 ? felt->last != kFull : !felt->caught; ++waited_ms) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        if (waitpid(child, &status, WNOHANG) == child) return status;  // it ended too early
        if (waited_ms < 60000) continue;
        kill(child, SIGKILL);
        waitpid(child, &status, 0);
        ADD_FAILURE() << (i == 0 ? "the hand is never pulled" : "a signal is never noted");
        return status;
      }
      kill(child, signals[i]);
    }
    waitpid(child, &status, 0);
    return status;
  }
};

TEST_P(LettingGo, ASignalEndsTheRunInOrderAndZeroIsWrittenLast) {
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) {
    felt->last = 0.0;
    const int status = process(
        [&] {
          catch_interrupts();
          HeldRun run(device());
          run.go_on_while([] { return interrupted_by() == 0; });
          run.loop->stop();
        },
        {signal_number});
    ASSERT_TRUE(WIFEXITED(status)) << signal_number;
    EXPECT_EQ(WEXITSTATUS(status), 0);
    EXPECT_GT(felt->writes, 0);
    EXPECT_EQ(felt->last, 0.0) << "signal " << signal_number;
  }
}

TEST_P(LettingGo, ASecondSignalEndsAProgramThatHangsAndZeroIsWrittenLast) {
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) {
    felt->last = 0.0;
    felt->caught = false;
    const int status = process(
        [&] {
          catch_interrupts();
          HeldRun run(device());
          run.go_on_while([&] {
            felt->caught = interrupted_by() != 0;
            return true;  // it does not heed the first
          });
        },
        {signal_number, signal_number});
    ASSERT_TRUE(WIFSIGNALED(status)) << signal_number;
    EXPECT_EQ(WTERMSIG(status), signal_number);
    EXPECT_EQ(felt->last, 0.0) << "signal " << signal_number;
  }
}

TEST_P(LettingGo, AnExceptionThatNobodyCatchesEndsTheProcessWithoutAForce) {
  const int status = process(
      [&] {
        HeldRun run(device());
        run.go_on_while([&] { return felt->last != kFull; });
        std::thread([] { throw std::runtime_error("somewhere else"); }).join();
      },
      {});
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGABRT);
  EXPECT_GT(felt->writes, 0);
  EXPECT_EQ(felt->last, 0.0);
}

/// A fault in a thread that has nothing to do with hands, or in a library of someone else's that gives up.
TEST_P(LettingGo, ACrashEndsTheProcessWithoutAForce) {
#ifdef SLOSH_SANITIZED
  const std::vector<int> signals{SIGABRT};  // it handles faults itself
#else
  const std::vector<int> signals{SIGSEGV, SIGABRT};
#endif
  for (const int signal_number : signals) {
    felt->last = 0.0;
    const int status = process(
        [&] {
          HeldRun run(device());
          run.go_on_while([&] { return felt->last != kFull; });
          std::thread([&] {
            if (signal_number == SIGABRT) std::abort();
            *const_cast<int volatile*>(nowhere) = 1;
          }).join();
        },
        {});
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), signal_number) << "it dies of what it would have died of";
    EXPECT_GT(felt->writes, 0);
    EXPECT_EQ(felt->last, 0.0) << "signal " << signal_number;
  }
}

TEST_P(LettingGo, WhoDestroysTheLoopLetsGo) {
  {
    HeldRun run(device());
    run.go_on_while([&] { return felt->last != kFull; });
  }
  EXPECT_EQ(felt->last, 0.0);
}

TEST_P(LettingGo, ADeviceThatIsTakenAwayIsLetGoOf) {
  HeldRun run(device());
  run.go_on_while([&] { return felt->last != kFull; });
  ASSERT_TRUE(run.servo->set_device(0, nullptr));
  run.go_on_while([&] { return felt->last != 0.0; });
  const int writes = felt->writes;
  run.loop->stop();
  EXPECT_LE(felt->writes, writes + 2) << "and nothing but zero after that";
  EXPECT_EQ(felt->last, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Device, LettingGo, ::testing::Bool(),
                         [](const auto& test) { return test.param ? "OnTheLoop" : "OnAThreadOfItsOwn"; });

using LettingGoOfALiar = LettingGo;
TEST_P(LettingGoOfALiar, AnExceptionInTheLoopItselfEndsTheProcessWithoutAForce) {
  const int status = process(
      [&] {
        HeldRun run(std::make_unique<LyingDevice>(*felt));
        run.go_on_while([] { return true; });
      },
      {});
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGABRT);
  EXPECT_GT(felt->writes, 100);
  EXPECT_EQ(felt->last, 0.0);
}
INSTANTIATE_TEST_SUITE_P(Device, LettingGoOfALiar, ::testing::Values(true),
                         [](const auto&) { return "OnTheLoop"; });

}  // namespace
}  // namespace slosh
