// Two people at two sites carry one bucket, a third looks on: programs as users start them, a bad wire
// between.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "hosted_test.h"
#include "peer/output/plot.h"
#include "render/image.h"
#include "tests/lab/coupling/network_sites.h"
#include "tests/support/comes.h"
#include "tests/support/network_here.h"

namespace slosh {
namespace {

using nlohmann::json;
using std::filesystem::path;
using test::comes;
using test::Outcome;
using test::Process;
using test::read_text;

constexpr double kBears = 5.0;  // N: of the 15.6 that each of two carries
// s, simulated, that somebody who came back carries at least: 2 s until the weight is theirs again
// (net/engagement.h), and as much again with it. It takes a busy machine longer: a hand's own time goes on
// where the world is slow, and between them it takes whole seconds of the world to start a program.
constexpr double kCarries = 4.0;

/// Simulated time of the first row of a run's wrenches, -1 without any.
double first_time(const path& folder) {
  const std::string text = read_text(folder / "wrenches.csv");
  const std::size_t begin = text.find('\n');
  if (begin == std::string::npos || text.find('\n', begin + 1) == std::string::npos) return -1.0;
  return std::atof(text.c_str() + begin + 1);
}

/// Simulated time of the last whole row so far, -1 without any.
double last_time(const path& folder) {
  const std::string text = read_text(folder / "wrenches.csv");
  const std::size_t end = text.rfind('\n');
  if (end == std::string::npos || end == 0) return -1.0;
  const std::size_t begin = text.rfind('\n', end - 1);
  if (begin == std::string::npos) return -1.0;
  return std::atof(text.c_str() + begin + 1);
}

/// N, the most that these hands have borne.
double most_borne(const std::vector<WrenchSeries>& series) {
  double most = 0.0;
  for (const WrenchSeries& one : series) {
    for (const Wrench& wrench : one.on_hand) most = std::max(most, -wrench.force.y);
  }
  return most;
}

class NetworkTest : public test::HostedTest {
 protected:
  json summary(const std::string& name) const {
    return json::parse(read_text(folder(name) / "out" / "summary.json"));
  }
};

std::vector<std::string> peer(const std::string& verb, const std::string& link, const std::string& name) {
  return {verb,      link,    "--name", name,    "--headless",         "--out", "out", "--size",
          "320x240", "--fps", "10",     "--key", "../" + name + ".key"};
}

/// Share of the picture's pixels whose colours differ by more than `least` (of 255). The charts and words at
/// the left are each person's own and are left out.
double differing(const Image& a, const Image& b, int least) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  const int from = a.width * 2 / 5;
  int count = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = from; x < a.width; ++x) {
      const std::size_t at = 4 * (static_cast<std::size_t>(y) * a.width + x);
      int most = 0;
      for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(a.rgba[at + c] - b.rgba[at + c]));
      count += most > least ? 1 : 0;
    }
  }
  return static_cast<double>(count) / (static_cast<double>(a.height) * (a.width - from));
}

TEST_F(NetworkTest, TwoPeopleCarryTheBucketOverABadWire) {
  const NetworkSites sites({"host", "ana", "ben", "eve"});
  if (!sites.problem().empty()) GTEST_SKIP() << "no network namespaces here: " << sites.problem();
  const auto start = [&](const std::string& site, const std::string& name,
                         const std::vector<std::string>& with) {
    return std::make_unique<Process>(sites.at(site, command(with)), folder(name));
  };
  const std::string at = sites.address("host") + ":4433";
  std::vector<std::string> arguments{"host",         "bucket", "--spacing", "0.014", "--threads", "1",
                                     "--wait",       "2",      "--listen",  at,      "--links",   "links.txt",
                                     "--checkpoint", "none"};
  for (const char* site : {"ana", "ben", "eve"}) {
    arguments.insert(arguments.end(), {"--address", sites.wire_address(site) + ":5000"});
  }
  const auto host = start("host", "host", arguments);
  ASSERT_TRUE(comes([&] { return !link("watch").empty() || !host->running(); }));
  ASSERT_FALSE(link("hold").empty()) << host->wait().err;

  // 60 ms there and back, 2 % lost each way.
  const Process wire(
      sites.at("wire", {(path(test::program()).parent_path() / "slosh-impair").string(), "--listen",
                        "0.0.0.0:5000", "--to", at, "--delay-ms", "30", "--loss", "0.02", "--seed", "7"}),
      folder("wire"));
  const auto ana = start("ana", "ana", peer("join", link("hold"), "Ana"));
  auto ben = start("ben", "ben", peer("join", link("hold"), "Ben"));
  ASSERT_TRUE(comes([&] { return last_time(folder("ana") / "out") > 2.0; }))
      << read_text(folder("ana") / "stderr.txt");

  // Late, to look on.
  const auto eve = start("eve", "eve", peer("watch", link("watch"), "Eve"));
  ASSERT_TRUE(comes([&] { return last_time(folder("ben") / "out") > 3.0; }));
  ben->signal(SIGKILL);
  EXPECT_EQ(ben->wait().code, 128 + SIGKILL);
  const double killed_at = last_time(folder("ben") / "out");
  ASSERT_TRUE(comes([&] { return last_time(folder("ana") / "out") > killed_at + 0.5; }));
  // The same person again.
  ben = start("ben", "ben_again", peer("join", link("hold"), "Ben"));

  EXPECT_TRUE(comes([&] {
    const path out = folder("ben_again") / "out";
    const double began = first_time(out);
    if (began < 0.0 || last_time(out) <= began + kCarries) return false;
    const Result<std::vector<WrenchSeries>> so_far = read_wrenches(out / "wrenches.csv");
    return so_far && most_borne(so_far.value()) > kBears;
  })) << read_text(folder("ben_again") / "stderr.txt");
  host->signal(SIGINT);
  const Outcome hosted = host->wait();
  EXPECT_EQ(hosted.code, 128 + SIGINT) << hosted.err;
  for (const auto& [name, process] :
       {std::pair{"ana", ana.get()}, {"ben_again", ben.get()}, {"eve", eve.get()}}) {
    const Outcome outcome = process->wait();
    EXPECT_EQ(outcome.code, 0) << name << ": " << outcome.err;
    for (const char* file : {"view.mp4", "final.png", "summary.json"}) {
      EXPECT_TRUE(std::filesystem::is_regular_file(folder(name) / "out" / file)) << name << " " << file;
    }
  }
  for (const char* name : {"ana", "ben_again"}) {
    for (const char* file : {"wrenches.csv", "poses.csv", "wrenches.png"}) {
      EXPECT_TRUE(std::filesystem::is_regular_file(folder(name) / "out" / file)) << name << " " << file;
    }
    const json s = summary(name);
    EXPECT_EQ(s["network"]["role"], "participant");
    EXPECT_EQ(s["devices"].size(), 1u) << "one grip each";
    EXPECT_GT(s["network"]["rtt_ms"], 55.0);
    EXPECT_GT(s["network"]["snapshots"]["complete"], 10);
    const Result<std::vector<WrenchSeries>> series = read_wrenches(folder(name) / "out" / "wrenches.csv");
    ASSERT_TRUE(series) << series.error().text();
    EXPECT_GT(most_borne(series.value()), kBears) << name << " carries";
  }
  EXPECT_NE(summary("ana")["devices"][0]["grip"], summary("ben_again")["devices"][0]["grip"]);
  EXPECT_EQ(summary("eve")["network"]["role"], "spectator");
  EXPECT_TRUE(read_wrenches(folder("ben") / "out" / "wrenches.csv")) << "what was killed left whole rows";
  // Ana was told.
  const std::string told = read_text(folder("ana") / "stderr.txt");
  EXPECT_NE(told.find("Ben"), std::string::npos) << told;
  const std::string kept = read_text(folder("ben_again") / "stderr.txt");
  EXPECT_NE(kept.find("your place was kept"), std::string::npos) << kept;

  // All look at the same world at its end.
  const json last_a = summary("ana")["network"]["picture_time_s"]["last"];
  Result<Image> a = read_png(folder("ana") / "out" / "final.png");
  ASSERT_TRUE(a);
  for (const char* name : {"ben_again", "eve"}) {
    EXPECT_NEAR(summary(name)["network"]["picture_time_s"]["last"], last_a, 0.11) << name;
    Result<Image> b = read_png(folder(name) / "out" / "final.png");
    ASSERT_TRUE(b);
    const double share = differing(a.value(), b.value(), 40);
    std::printf("pictures of ana and %s: %.2f %% of the pixels differ\n", name, 100.0 * share);
    EXPECT_LT(share, 0.03) << name;
  }
}

/// One machine: everything on loopback.
class LoopbackTest : public NetworkTest {};

TEST_F(LoopbackTest, LinksAreMadeAndRevokedWhileTheHostRuns) {
  if (const std::string why = test::no_ipv6(); !why.empty()) GTEST_SKIP() << why;
  const auto host = run("host", {"host", "probe", "--spacing", "0.01", "--threads", "1", "--listen",
                                 "[::1]:0", "--links", "links.txt", "--wait", "0", "--checkpoint", "none"});
  ASSERT_TRUE(hosting(*host)) << host->wait().err;
  const auto links = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "links");
    return run("links", words)->wait();
  };
  const Outcome made = links({"new", "Zoe", "--watch"});
  ASSERT_EQ(made.code, 0) << made.err;
  const std::string id = made.out.substr(0, made.out.find(' '));
  const std::size_t begin = made.out.find("slosh://");
  ASSERT_NE(begin, std::string::npos) << made.out;
  const std::string text = made.out.substr(begin, made.out.find_first_of(" \n", begin) - begin);
  EXPECT_NE(links({}).out.find("Zoe"), std::string::npos);

  const auto watch = [&](const std::string& name, const std::string& with) {
    std::vector<std::string> arguments = peer("watch", with, name);
    arguments.insert(arguments.end(), {"--no-render", "--seconds", "0.3"});
    return run(name, arguments)->wait();
  };
  EXPECT_EQ(watch("zoe", text).code, 0);
  EXPECT_EQ(links({"revoke", id}).code, 0);
  const Outcome refused = watch("zoe", text);
  EXPECT_EQ(refused.code, 1);
  EXPECT_NE(refused.err.find("revoked"), std::string::npos) << refused.err;
  // A wrong character is found before anybody is asked.
  std::string wrong = text;
  wrong[wrong.size() - 3] = wrong[wrong.size() - 3] == 'a' ? 'b' : 'a';
  const Outcome damaged = watch("zoe", wrong);
  EXPECT_EQ(damaged.code, 1);
  EXPECT_NE(damaged.err.find("link"), std::string::npos) << damaged.err;
  EXPECT_NE(links({"revoke", "nobody"}).code, 0);
  host->signal(SIGINT);
  EXPECT_EQ(host->wait().code, 128 + SIGINT);
}

TEST_F(LoopbackTest, ALinkStandsInNoListOfProcessesAndInNoLog) {
  const auto secret_of = [](const std::string& text) { return text.substr(text.rfind('/') + 1); };
  const std::vector<std::string> hosts{"host",   "probe",    "--spacing",    "0.01",    "--threads",
                                       "1",      "--listen", "127.0.0.1:0",  "--links", "links.txt",
                                       "--wait", "0",        "--checkpoint", "none"};
  const auto host = run("host", hosts);
  ASSERT_TRUE(hosting(*host)) << host->wait().err;
  const std::string text = link("hold");
  const auto ana = run("ana", {"join", text, "--name", "Ana", "--headless", "--no-render", "--out", "out"});
  ASSERT_TRUE(comes([&] { return last_time(folder("ana") / "out") > 0.0 || !ana->running(); }));
  const std::string words = read_text("/proc/" + std::to_string(ana->pid()) + "/cmdline");
  EXPECT_NE(words.find("join"), std::string::npos) << words;
  EXPECT_NE(words.find("slosh://***"), std::string::npos) << words;
  EXPECT_EQ(words.find(secret_of(text)), std::string::npos) << words;
  ana->signal(SIGINT);
  EXPECT_EQ(ana->wait().code, 128 + SIGINT);
  const auto mode = std::filesystem::status(folder("host") / "links.txt").permissions();
  EXPECT_EQ(mode, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  host->signal(SIGINT);
  const Outcome log = host->wait();
  EXPECT_EQ((log.out + log.err).find(secret_of(text)), std::string::npos) << log.out;
  EXPECT_NE(log.out.find("--show-links"), std::string::npos) << log.out;

  std::filesystem::remove(folder("host") / "links.txt");
  std::vector<std::string> asked = hosts;
  asked.push_back("--show-links");
  const auto open = run("host", asked);
  ASSERT_TRUE(hosting(*open)) << open->wait().err;
  const std::string whole = link("hold");
  open->signal(SIGINT);
  EXPECT_NE(open->wait().out.find(secret_of(whole)), std::string::npos) << "who asks for it gets it";
}

}  // namespace
}  // namespace slosh
