// Who looks after a host: what it starts again, with what, how often, and what it passes on.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "host/app/host_supervisor.h"

namespace slosh {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

TEST(Supervisor, StartsAgainFiveTimesAMinuteAtMost) {
  RestartBudget budget;
  for (int i = 0; i < RestartBudget::kMax; ++i) EXPECT_TRUE(budget.take(i * kSecond)) << i;
  EXPECT_FALSE(budget.take(5 * kSecond));
  EXPECT_FALSE(budget.take(60 * kSecond - 1));
  EXPECT_TRUE(budget.take(60 * kSecond)) << "the first is a minute ago";
  EXPECT_FALSE(budget.take(60 * kSecond));
}

TEST(Supervisor, CarriesOnFromTheCheckpointAtItsAddressWithARecordingOfItsOwn) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "slosh_supervisor_test";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  HostVerbOptions options;
  options.scene = "bucket";
  options.listen = "127.0.0.1:0";
  options.addresses = {"203.0.113.7:4433"};
  options.record = (folder / "run.rec").string();
  options.wait = 2;
  HostVerbOptions next = restarted(options, "kept", 1);
  EXPECT_EQ(next.resume, "kept");
  EXPECT_EQ(next.checkpoint, "kept");
  EXPECT_EQ(next.listen, "") << "the checkpoint knows which port it was";
  EXPECT_EQ(next.addresses, options.addresses);
  EXPECT_EQ(next.wait, 2);
  EXPECT_EQ(next.restarts, 1);
  EXPECT_EQ(next.record, (folder / "run-2.rec").string());
  std::ofstream(folder / "run-3.rec") << "somebody's";
  EXPECT_EQ(restarted(options, "kept", 2).record, (folder / "run-4.rec").string())
      << "nothing is overwritten";
  options.record.clear();
  EXPECT_EQ(restarted(options, "kept", 1).record, "");
}

TEST(Supervisor, GivesOnWhatTheHostEndsWith) {
  EXPECT_EQ(supervise_host({}, [](const HostVerbOptions&, SupervisorControl*) -> int { _exit(7); }), 7);
}

TEST(Supervisor, StartsAgainWhatCanCarryOnAndNothingElse) {
  void* page = mmap(nullptr, sizeof(int), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(page, MAP_FAILED);
  int& starts = *static_cast<int*>(page);
  const auto dies = [&](const HostVerbOptions& options, SupervisorControl* supervision) -> int {
    starts += 1;
    if (options.restarts == 2) _exit(options.resume == "kept" ? 3 : 4);
    supervision->can_carry_on_from("kept");
    ::signal(SIGSEGV, SIG_DFL);  // a sanitizer would take it
    ::kill(getpid(), options.restarts == 0 ? SIGSEGV : SIGKILL);
    _exit(5);
  };
  EXPECT_EQ(supervise_host({}, dies), 3);
  EXPECT_EQ(starts, 3);
  starts = 0;
  EXPECT_EQ(supervise_host({},
                           [&](const HostVerbOptions&, SupervisorControl*) -> int {
                             starts += 1;
                             ::kill(getpid(), SIGKILL);
                             _exit(5);
                           }),
            128 + SIGKILL);
  EXPECT_EQ(starts, 1) << "before it has a checkpoint there is nothing to go on from";
  starts = 0;
  EXPECT_EQ(supervise_host({},
                           [&](const HostVerbOptions&, SupervisorControl* supervision) -> int {
                             starts += 1;
                             supervision->can_carry_on_from("kept");
                             ::kill(getpid(), SIGKILL);
                             _exit(5);
                           }),
            128 + SIGKILL);
  EXPECT_EQ(starts, 1 + RestartBudget::kMax);
  munmap(page, sizeof(int));
}

TEST(Supervisor, AWorldHangsWhosePulseStands) {
  HangWatch watch(3);
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(watch.look(0)) << "it loads";
  for (std::uint64_t i = 1; i < 10; ++i) EXPECT_FALSE(watch.look(i));
  EXPECT_FALSE(watch.look(9));
  EXPECT_FALSE(watch.look(9));
  watch.pass_over();
  EXPECT_FALSE(watch.look(9));
  EXPECT_FALSE(watch.look(9));
  EXPECT_TRUE(watch.look(9));
}

TEST(Supervisor, StartsAgainAWorldThatHangsAndNoneThatIsStoppedOrEnds) {
  // Beats twice, then lives on without a pulse.
  const auto hangs = [](const HostVerbOptions& options, SupervisorControl* supervision) -> int {
    if (options.restarts == 1) _exit(options.resume == "kept" ? 3 : 4);
    supervision->can_carry_on_from("kept");
    supervision->pulse() = 2;
    while (true) pause();
  };
  EXPECT_EQ(supervise_host({}, hangs, {2, 60}), 3);
  // Its world goes on, and nobody hears of it.
  const auto mute = [](const HostVerbOptions& options, SupervisorControl* supervision) -> int {
    if (options.restarts == 1) _exit(options.resume == "kept" ? 3 : 4);
    supervision->can_carry_on_from("kept");
    supervision->network_pulse() = 2;
    while (true) {
      supervision->pulse() += 1;
      usleep(10'000);
    }
  };
  EXPECT_EQ(supervise_host({}, mute, {60, 2}), 3);
  // One that somebody stopped is let be, and so is one whose run is over.
  const auto stopped = [](const HostVerbOptions& options, SupervisorControl* supervision) -> int {
    if (options.restarts == 1) _exit(4);
    supervision->can_carry_on_from("kept");
    supervision->pulse() = supervision->network_pulse() = 2;
    const pid_t self = getpid();
    if (fork() == 0) {
      usleep(3'500'000);
      ::kill(self, SIGCONT);
      _exit(0);
    }
    raise(SIGSTOP);
    supervision->pulse() = supervision->network_pulse() = 0;
    usleep(3'500'000);
    _exit(7);
  };
  EXPECT_EQ(supervise_host({}, stopped, {2, 2}), 7);
}

TEST(Supervisor, PassesOnWhoAsksForTheEndOnce) {
  // The child was not signalled itself: it gets what its supervisor got.
  EXPECT_EQ(supervise_host({},
                           [](const HostVerbOptions&, SupervisorControl* supervision) -> int {
                             supervision->can_carry_on_from("kept");
                             signal(SIGTERM, SIG_DFL);
                             ::kill(getppid(), SIGTERM);
                             while (true) pause();
                           }),
            128 + SIGTERM);
  // It was, and says so: a second one would end it at once.
  EXPECT_EQ(supervise_host({},
                           [](const HostVerbOptions&, SupervisorControl* supervision) -> int {
                             signal(SIGTERM, SIG_DFL);
                             supervision->can_carry_on_from("kept");
                             ::kill(getppid(), SIGTERM);
                             usleep(50'000);
                             supervision->ends();
                             usleep(700'000);
                             _exit(11);
                           }),
            11);
}

}  // namespace
}  // namespace slosh
