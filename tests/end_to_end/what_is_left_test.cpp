// Nobody is left behind: programs that `slosh report coupling --link` started, and peers of a host that
// ended.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>

#include "hosted_test.h"
#include "net/clock.h"
#include "net/impair/relay.h"
#include "tests/lab/coupling/network_sites.h"
#include "tests/support/comes.h"

namespace slosh {
namespace {

using test::comes;
using test::Outcome;
using test::Process;
using test::read_text;

/// Command lines of what runs with `mark` in its environment, which children inherit.
std::vector<std::string> running_with(const std::string& mark) {
  std::vector<std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    if (read_text(entry.path() / "environ").find(mark) == std::string::npos) continue;
    std::string line = read_text(entry.path() / "cmdline");
    std::replace(line.begin(), line.end(), '\0', ' ');
    if (!line.empty()) all.push_back(line.substr(0, 80));  // empty: it has ended, and waits to be reaped
  }
  return all;
}

class WhatIsLeft : public ::testing::TestWithParam<int> {};

// While both people carry, so that a host, a wire and two people run.
TEST_P(WhatIsLeft, OfAReportOverTheRealLinkThatIsEndedIsNothing) {
  if (const NetworkSites sites({"a"}); !sites.problem().empty())
    GTEST_SKIP() << "no network namespaces here: " << sites.problem();
  std::filesystem::remove_all(test::test_folder());
  const std::string mark = "SLOSH_TEST_MARK=" + std::to_string(getpid()) + "." + std::to_string(GetParam());
  Process report({"env", mark, test::program(), "report", "coupling", "--link", "--quick", "--out", "link"},
                 test::test_folder());
  const auto begun = [](const char* person) {
    return read_text(test::test_folder() / "link" / "link_0" / person / "wrenches.csv").size() > 2000;
  };
  ASSERT_TRUE(comes([&] { return (begun("ana") && begun("ben")) || !report.running(); }));
  ASSERT_TRUE(report.running()) << report.wait().err;
  EXPECT_GE(running_with(mark).size(), 5u) << "the report, a host, a wire, two people";
  report.signal(GetParam());
  const Outcome ended = report.wait();
  EXPECT_EQ(ended.code, 128 + GetParam());
  // Who was killed leaves its programs to the kernel, which asks them to end: they do so in their own time.
  std::vector<std::string> left;
  EXPECT_TRUE(comes([&] { return left = running_with(mark), left.empty(); }))
      << left.size() << " programs run on, the first: " << left[0];
  if (GetParam() != SIGKILL) {
    EXPECT_NE(ended.err.find("interrupted before a case was whole"), std::string::npos) << ended.err;
    EXPECT_FALSE(std::filesystem::exists(test::test_folder() / "link" / "coupling_link.csv"));
  }
}

INSTANTIATE_TEST_SUITE_P(Signals, WhatIsLeft, ::testing::Values(SIGTERM, SIGINT, SIGKILL),
                         [](const auto& with) { return std::to_string(with.param); });

// Everything that a host says in the first 0.6 s of its end is lost. It goes on saying so for a second, and a
// peer that never heard it would try to come back for five minutes.
class LostGoodbye : public test::HostedTest {};

TEST_F(LostGoodbye, IsSaidAgain) {
  const int port = test::free_port();
  ASSERT_NE(port, 0);
  RelayOptions options;
  options.to = "127.0.0.1:" + std::to_string(port);
  options.up.delay = options.down.delay = 0.1;
  Result<std::unique_ptr<Relay>> relay = Relay::start(options);
  ASSERT_TRUE(relay) << relay.error().text();
  std::atomic<std::int64_t> ends_ns{0};
  std::atomic<int> lost{0};
  relay.value()->tamper([&](Relay::Way way, Relay::Packet& packet) {
    const std::int64_t from = ends_ns;
    if (way != Relay::Way::kDown || from == 0 || steady_now_ns() > from + to_nanoseconds(0.6)) return;
    packet.clear();
    lost += 1;
  });
  const auto host = run("host", {"host", "probe", "--spacing", "0.012", "--wait", "1", "--listen", options.to,
                                 "--links", "links.txt", "--checkpoint", "none", "--no-supervisor",
                                 "--address", relay.value()->address()});
  ASSERT_TRUE(hosting(*host)) << host->wait().err;
  const auto join = run("join", {"join", link("hold"), "--headless", "--no-render", "--out", "out"});
  ASSERT_TRUE(comes(
      [&] { return read_text(folder("join") / "out" / "wrenches.csv").size() > 2000 || !join->running(); }));
  ASSERT_TRUE(join->running()) << join->wait().err;
  ends_ns = steady_now_ns();
  host->signal(SIGTERM);
  EXPECT_EQ(host->wait().code, 128 + SIGTERM);
  const Outcome left = join->wait();
  EXPECT_EQ(left.code, 0) << left.err;
  EXPECT_EQ(left.err.find("contact was lost and did not come back"), std::string::npos) << left.err;
  EXPECT_GT(lost, 0);
}

}  // namespace
}  // namespace slosh
