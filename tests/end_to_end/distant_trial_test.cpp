// Two simulated people carry the bucket over 200 ms: programs as users start them, QUIC between them and the
// impairment relay on its way. Needs nothing of the machine but loopback, so it is never left out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "hosted_test.h"
#include "peer/output/plot.h"

namespace slosh {
namespace {

using test::Outcome;
using test::Process;
using test::read_text;

constexpr double kSeconds = 9.0;  // simulated; the bucket is tilted to both sides in it
constexpr double kWeight = 31.2;  // N, bucket and water

/// What one person felt and did.
struct Felt {
  double peak = 0.0;    // N
  double mean_y = 0.0;  // N, of the last 4 s
  double put_in = 0.0;  // J, by forces
  double rest = 0.0;    // N, the mean step from row to row in the last 2 s, 2 ms apart
};

class DistantTrial : public test::HostedTest {
 protected:
  void felt_by(const std::string& name, Felt& felt) const {
    const std::filesystem::path out = folder(name) / "out";
    const Result<std::vector<WrenchSeries>> series = read_wrenches(out / "wrenches.csv");
    ASSERT_TRUE(series) << series.error().text();
    // One hand each; what the other one holds has no rows.
    const auto held = std::max_element(
        series.value().begin(), series.value().end(),
        [](const WrenchSeries& a, const WrenchSeries& b) { return a.time.size() < b.time.size(); });
    ASSERT_NE(held, series.value().end());
    ASSERT_GT(held->time.size(), 1000u);
    const WrenchSeries& s = *held;
    std::vector<glm::dvec3> places;
    const std::string poses = read_text(out / "poses.csv");
    for (std::size_t line = poses.find('\n'); line + 1 < poses.size(); line = poses.find('\n', line + 1)) {
      double t = 0.0;
      int device = 0;
      glm::dvec3& p = places.emplace_back();
      if (std::sscanf(poses.c_str() + line + 1, "%lf,%d,%lf,%lf,%lf", &t, &device, &p.x, &p.y, &p.z) != 5)
        places.pop_back();
      if (poses.find('\n', line + 1) == std::string::npos) break;
    }
    ASSERT_NEAR(static_cast<double>(places.size()), static_cast<double>(s.time.size()), 2.0);
    int late = 0, last = 0;
    for (std::size_t i = 0; i < s.time.size(); ++i) {
      felt.peak = std::max(felt.peak, glm::length(s.on_hand[i].force));
      if (s.time[i] > kSeconds - 4.0) {
        felt.mean_y += s.on_hand[i].force.y;
        late += 1;
      }
      if (i > 0 && i < places.size())
        felt.put_in -= glm::dot(s.on_hand[i - 1].force, places[i] - places[i - 1]);
      if (i > 0 && s.time[i] > kSeconds - 2.0) {
        felt.rest += glm::length(s.on_hand[i].force - s.on_hand[i - 1].force);
        last += 1;
      }
    }
    felt.mean_y /= std::max(late, 1);
    felt.rest /= std::max(last, 1);
  }
};

TEST_F(DistantTrial, TwoSimulatedPeopleCarryTheBucketOver200Milliseconds) {
  const std::string host_at = "127.0.0.1:" + std::to_string(test::free_port());
  const std::string wire_at = "127.0.0.1:" + std::to_string(test::free_port());
  const std::unique_ptr<Process> host =
      run("host", {"host", "bucket", "--spacing", "0.014", "--threads", "1", "--wait", "2", "--listen",
                   host_at, "--address", wire_at, "--links", "links.txt", "--seconds",
                   std::to_string(kSeconds), "--checkpoint", "none"});
  ASSERT_TRUE(hosting(*host));
  const std::filesystem::path impair = std::filesystem::path(test::program()).parent_path() / "slosh-impair";
  const Process wire({impair.string(), "--listen", wire_at, "--to", host_at, "--delay-ms", "100", "--loss",
                      "0.01", "--seed", "7"},
                     folder("wire"));
  std::vector<std::unique_ptr<Process>> people;
  for (const char* name : {"ana", "ben"}) {
    people.push_back(run(
        name, {"join", link("hold"), "--name", name, "--headless", "--no-render", "--coupling", "replica",
               "--device", "operator:tight", "--out", "out", "--key", std::string("../") + name + ".key"}));
  }
  EXPECT_EQ(host->wait().code, 0);
  double carried = 0.0, put_in = 0.0;
  for (std::size_t i = 0; i < people.size(); ++i) {
    const char* name = i == 0 ? "ana" : "ben";
    const Outcome outcome = people[i]->wait();
    ASSERT_EQ(outcome.code, 0) << name << ": " << outcome.err;
    const nlohmann::json summary = nlohmann::json::parse(read_text(folder(name) / "out" / "summary.json"));
    EXPECT_GT(summary["network"]["rtt_ms"], 195.0) << "the delay was there";
    Felt felt;
    felt_by(name, felt);
    if (HasFatalFailure()) return;
    std::printf(
        "%s: peak %.1f N, %.1f N carried in the last 4 s, %.2f J put in, %.3f N from row to row at the end\n",
        name, felt.peak, -felt.mean_y, felt.put_in, felt.rest);
    // 20 to 33 N are usual. A spring to the host's body as it comes: 1000 N, where its limits are, 26 N a
    // row, and 2300 to 3900 J come out.
    EXPECT_LT(felt.peak, 2.0 * kWeight) << name;
    EXPECT_LT(felt.rest, 1.0) << name << ": nothing hums";
    carried -= felt.mean_y;
    put_in += felt.put_in;
  }
  EXPECT_GT(carried, 0.3 * kWeight) << "some water is spilled";
  EXPECT_LT(carried, 1.3 * kWeight);
  EXPECT_GT(put_in, -0.2 * kWeight) << "no more than the bucket gives by sinking 0.2 m";
}

/// A world six times slower than real time at a host of one thread, a person in another process who stirs in
/// it over 100 ms: what is felt is what `play` gives there, up to 1.05 N in 99 % of the rows and 1.1 N in all
/// (7 mm). Where the pace was not told and velocities were not converted it was 4 to 18 N.
TEST_F(DistantTrial, WhoStirsInASlowWorldFarAwayFeelsWhatTheyWouldThere) {
  const std::string host_at = "127.0.0.1:" + std::to_string(test::free_port());
  const std::string wire_at = "127.0.0.1:" + std::to_string(test::free_port());
  const std::unique_ptr<Process> host = run(
      "host", {"host", "spoon", "--spacing", "0.007", "--threads", "1", "--wait", "1", "--listen", host_at,
               "--address", wire_at, "--links", "links.txt", "--seconds", "3", "--checkpoint", "none"});
  ASSERT_TRUE(hosting(*host));
  const std::filesystem::path impair = std::filesystem::path(test::program()).parent_path() / "slosh-impair";
  const Process wire({impair.string(), "--listen", wire_at, "--to", host_at, "--delay-ms", "50"},
                     folder("wire"));
  const Outcome outcome = run("ana", {"join", link("hold"), "--name", "ana", "--headless", "--no-render",
                                      "--device", "operator:tight", "--out", "out", "--key", "ana.key"})
                              ->wait();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(host->wait().code, 0);
  const Result<std::vector<WrenchSeries>> series = read_wrenches(folder("ana") / "out" / "wrenches.csv");
  ASSERT_TRUE(series) << series.error().text();
  ASSERT_EQ(series.value().size(), 1u);
  std::vector<double> forces;
  for (const Wrench& w : series.value()[0].on_hand) forces.push_back(glm::length(w.force));
  ASSERT_GT(forces.size(), 500u);
  std::sort(forces.begin(), forces.end());
  const double most = forces[forces.size() * 99 / 100];
  std::printf("%zu rows, %.2f N in 99 %% of them, %.2f N at most\n", forces.size(), most, forces.back());
  // One row in a hundred is left to a machine that stands still for a moment.
  EXPECT_LT(most, 1.3);
  EXPECT_GT(most, 0.8);
}

}  // namespace
}  // namespace slosh
