// From own motion to the force that answers, through everything: programs as users start them, and a plug-in
// that moves a handle at known instants. Times are told and not asserted; how often the device is written
// until it is answered is: over a distance, what went to the host and back would be a hundred writes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "hosted_test.h"

namespace slosh {
namespace {

using std::filesystem::path;
using test::Outcome;
using test::Process;
using test::read_text;

constexpr double kWays = 40.0;            // at least, in the seconds that follow
constexpr int kMaxWrites = 3;             // 1 where the machine keeps up: the first write after the reading
const char* const kMotionSeconds = "13";  // 6 of them until the plug-in begins

/// "plugin:FILE:ANSWERS"
std::string handle() {
  const path library =
      path(test::program()).parent_path().parent_path() / "lib" / "slosh_motion_to_force_device.so";
  return "plugin:" + library.string() + ":ways.csv";
}

class MotionToForce : public test::HostedTest {
 protected:
  /// Of what the program of that name wrote down.
  void answered_at_once(const std::string& name, const std::string& said) const {
    const std::size_t told = said.find("motion_to_force: ");
    ASSERT_NE(told, std::string::npos) << said;
    std::printf("%s, %s\n", name.c_str(), said.substr(told, said.find('\n', told) - told).c_str());
    std::vector<int> writes;
    const std::string text = read_text(folder(name) / "ways.csv");
    for (std::size_t line = text.find('\n'); line + 1 < text.size(); line = text.find('\n', line + 1)) {
      double instant = 0.0, motion = 0.0, reading = 0.0;
      int count = 0;
      if (std::sscanf(text.c_str() + line + 1, "%lf,%lf,%lf,%d", &instant, &motion, &reading, &count) == 4)
        writes.push_back(count);
      if (text.find('\n', line + 1) == std::string::npos) break;
    }
    ASSERT_GT(static_cast<double>(writes.size()), 0.5 * kWays) << "most are answered";
    std::nth_element(writes.begin(), writes.begin() + writes.size() / 2, writes.end());
    EXPECT_LE(writes[writes.size() / 2], kMaxWrites) << "median";
  }
};

TEST_F(MotionToForce, WhereTheWorldIsInTheSameProcess) {
  const Outcome outcome =
      run("play", {"play", "spoon", "--headless", "--no-render", "--spacing", "0.012", "--threads", "1",
                   "--seconds", kMotionSeconds, "--device", handle(), "--out", "out"})
          ->wait();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  answered_at_once("play", outcome.err);
}

TEST_F(MotionToForce, WhereTheHostIs100And300MillisecondsAway) {
  for (const int one_way : {50, 150}) {
    std::filesystem::remove_all(folder("host"));
    const std::string host_at = "127.0.0.1:" + std::to_string(test::free_port());
    const std::string wire_at = "127.0.0.1:" + std::to_string(test::free_port());
    const std::unique_ptr<Process> host =
        run("host", {"host", "spoon", "--spacing", "0.012", "--threads", "1", "--wait", "1", "--listen",
                     host_at, "--address", wire_at, "--links", "links.txt", "--seconds", kMotionSeconds,
                     "--checkpoint", "none"});
    ASSERT_TRUE(hosting(*host));
    const path impair = path(test::program()).parent_path() / "slosh-impair";
    const Process wire(
        {impair.string(), "--listen", wire_at, "--to", host_at, "--delay-ms", std::to_string(one_way)},
        folder("wire"));
    const std::string name = "over " + std::to_string(2 * one_way) + " ms";
    const Outcome outcome = run(name, {"join", link("hold"), "--name", "ana", "--headless", "--no-render",
                                       "--device", handle(), "--out", "out", "--key", "ana.key"})
                                ->wait();
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(host->wait().code, 0);
    answered_at_once(name, outcome.err);
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace slosh
