// What a host keeps on the disk and what brings it back: recordings that replay, checkpoints that resume at
// every moment, the supervisor that starts a host again.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "hosted_test.h"
#include "process.h"
#include "tests/support/comes.h"

namespace slosh {
namespace {

using nlohmann::json;
using std::filesystem::path;
using test::comes;
using test::Outcome;
using test::Process;
using test::read_text;

/// The number that follows `words` in a text; negative when they are not there.
double number_after(const std::string& text, const std::string& words) {
  const std::size_t at = text.rfind(words);
  return at == std::string::npos ? -1.0 : std::atof(text.c_str() + at + words.size());
}

int times(const std::string& text, const std::string& words) {
  int count = 0;
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) count += 1;
  return count;
}

/// The processes that `parent` started.
std::vector<pid_t> children_of(pid_t parent) {
  std::vector<pid_t> all;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const pid_t pid = std::atoi(entry.path().filename().c_str());
    if (pid <= 0) continue;
    const std::string stat = read_text(entry.path() / "stat");
    const std::size_t name_end = stat.rfind(") ");  // then the state and the parent
    if (name_end != std::string::npos && std::atoi(stat.c_str() + name_end + 4) == parent) all.push_back(pid);
  }
  return all;
}

class KeptHost : public test::HostedTest {
 protected:
  /// A small world on a port of its own, its files in the folder "host".
  std::unique_ptr<Process> host(std::vector<std::string> more) const {
    std::vector<std::string> all{"host", "probe",    "--spacing",   "0.01",    "--threads",
                                 "1",    "--listen", "127.0.0.1:0", "--links", "links.txt"};
    all.insert(all.end(), more.begin(), more.end());
    return run("host", all);
  }
  std::unique_ptr<Process> resume(std::vector<std::string> more = {}) const {
    std::vector<std::string> all{"host", "--resume", "kept", "--threads", "1", "--links", "links.txt"};
    all.insert(all.end(), more.begin(), more.end());
    return run("host", all);
  }
  std::unique_ptr<Process> join(const std::string& name, const std::string& seconds) const {
    return run(name, {"join", link("hold"), "--name", name, "--headless", "--no-render", "--out", "out",
                      "--overwrite", "--key", "../" + name + ".key", "--seconds", seconds});
  }
  std::string links() const { return read_text(folder("host") / "links.txt"); }
  std::string told(const std::string& name) const { return read_text(folder(name) / "stderr.txt"); }
  /// Rows that a peer's hand has felt so far.
  std::uintmax_t felt(const std::string& name) const {
    std::error_code code;
    const std::uintmax_t size = std::filesystem::file_size(folder(name) / "out" / "wrenches.csv", code);
    return code ? 0 : size;
  }
  Outcome replay(const std::string& file) const {
    return run("replay", {"replay", (folder("host") / file).string(), "--threads", "1"})->wait();
  }
};

/// "84 of 84 hashes agree" with some.
testing::AssertionResult all_agree(const Outcome& outcome) {
  const std::size_t at = outcome.out.find(" hashes agree");
  if (outcome.code != 0 || at == std::string::npos)
    return testing::AssertionFailure() << outcome.code << ": " << outcome.err << outcome.out;
  const std::size_t of = outcome.out.rfind(" of ", at);
  const std::size_t begin = outcome.out.find_last_not_of("0123456789", of - 1) + 1;
  const int agree = std::atoi(outcome.out.c_str() + begin);
  const int all = std::atoi(outcome.out.c_str() + of + 4);
  if (agree != all || all < 3) return testing::AssertionFailure() << agree << " of " << all;
  return testing::AssertionSuccess() << all;
}

TEST_F(KeptHost, ItsRecordingReplaysAndSoDoesThatOfItsResumption) {
  auto host = this->host({"--checkpoint", "kept", "--record", "first.rec"});
  ASSERT_TRUE(hosting(*host)) << host->wait().err;
  EXPECT_EQ(join("ana", "1.5")->wait().code, 0) << told("ana");
  host->signal(SIGINT);
  EXPECT_EQ(host->wait().code, 128 + SIGINT);
  EXPECT_TRUE(all_agree(replay("first.rec")));

  std::filesystem::remove(folder("host") / "links.txt");
  host = resume({"--record", "second.rec"});
  ASSERT_TRUE(hosting(*host)) << host->wait().err;
  EXPECT_EQ(join("ana", "1.0")->wait().code, 0) << told("ana");
  host->signal(SIGTERM);
  EXPECT_EQ(host->wait().code, 128 + SIGTERM);
  EXPECT_TRUE(all_agree(replay("second.rec")));
}

TEST_F(KeptHost, ThatDiedLosesAtMostASecondAndItsPeerComesBackByItself) {
  auto host = this->host({"--checkpoint", "kept", "--record", "first.rec"});
  ASSERT_TRUE(hosting(*host)) << host->wait().err;
  const std::string first_links = links();
  const auto ana = join("Ana", "4");
  ASSERT_TRUE(comes([&] { return felt("Ana") > 30'000 || !ana->running(); }));
  host->signal(SIGKILL);
  host->wait();
  std::filesystem::remove(folder("host") / "links.txt");
  host = resume();
  ASSERT_TRUE(hosting(*host)) << host->wait().err;
  // Where it listened and what its links say is what it was.
  EXPECT_EQ(links(), first_links);
  EXPECT_NE(told("host").find("listening at 127.0.0.1:"), std::string::npos) << told("host");
  EXPECT_EQ(ana->wait().code, 0) << told("Ana");
  const json s = json::parse(read_text(folder("Ana") / "out" / "summary.json"));
  EXPECT_GE(s["network"]["reconnects"], 1);
  EXPECT_EQ(s["devices"].size(), 1u) << "the same grip again";
  const double resumed_at = number_after(told("host"), "carries on at ");
  host->signal(SIGINT);
  EXPECT_EQ(host->wait().code, 128 + SIGINT);

  // Its recording, cut off within a quarter of a second of the death, says how far the world was.
  const Outcome again =
      run("replay", {"replay", "../host/first.rec", "--threads", "1", "--no-render", "--out", "."})->wait();
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_NE(again.out.find("cut off"), std::string::npos) << again.out;
  const double died_after = json::parse(read_text(folder("replay") / "summary.json"))["simulated_s"];
  EXPECT_GT(died_after, 0.3);
  EXPECT_GT(resumed_at, died_after - 1.0);
  EXPECT_LT(resumed_at, died_after + 1.0);
  std::printf("died after %.2f s of its world, carried on at %.2f s\n", died_after, resumed_at);
}

TEST_F(KeptHost, ThatIsKilledWithItsFirstCheckpointOnTheDiskIsResumed) {
  const path kept = folder("host") / "kept";
  const auto inode = [&kept] {
    struct stat facts {};
    return ::stat(kept.c_str(), &facts) == 0 ? facts.st_ino : 0;
  };
  // At the very start, and twice right after a resumption put its own first one there.
  for (int round = 0; round < 3; ++round) {
    const ino_t before = inode();
    const auto host = round == 0 ? this->host({"--checkpoint", "kept"}) : resume();
    ASSERT_TRUE(comes([&] { return inode() != before || !host->running(); }));
    host->signal(SIGKILL);
    host->wait();
    ASSERT_NE(inode(), before) << "round " << round << ": " << told("host");
  }
  const auto host = resume();
  ASSERT_TRUE(hosting(*host)) << host->wait().err;
  EXPECT_EQ(told("host").find("damaged"), std::string::npos) << told("host");
  EXPECT_EQ(told("host").find("new key"), std::string::npos) << told("host");
  EXPECT_EQ(join("Ana", "0.3")->wait().code, 0) << told("Ana");
  host->signal(SIGINT);
  host->wait();
}

TEST_F(KeptHost, ADamagedCheckpointFallsBackAndHostingAnewOverwritesNothing) {
  const path kept = folder("host") / "kept";
  auto host = this->host({"--checkpoint", "kept", "--wait", "0"});
  ASSERT_TRUE(hosting(*host)) << host->wait().err;
  const std::string first_links = links();
  ASSERT_TRUE(comes([&] { return std::filesystem::exists(kept.string() + ".previous"); }));
  host->signal(SIGINT);
  host->wait();
  std::filesystem::resize_file(kept, std::filesystem::file_size(kept) / 2);
  std::filesystem::remove(folder("host") / "links.txt");
  host = resume();
  ASSERT_TRUE(hosting(*host)) << host->wait().err;
  EXPECT_EQ(links(), first_links);
  EXPECT_NE(told("host").find("what came after is lost"), std::string::npos) << told("host");
  host->signal(SIGINT);
  host->wait();

  // Damaged beyond help: the advice is to host anew, and doing so loses nothing of what is there.
  for (const char* ending : {"", ".previous"}) std::filesystem::resize_file(kept.string() + ending, 1000);
  const Outcome hopeless = resume()->wait();
  EXPECT_EQ(hopeless.code, 1);
  EXPECT_NE(hopeless.err.find("Host the scene anew"), std::string::npos) << hopeless.err;
  std::filesystem::remove(folder("host") / "links.txt");
  host = this->host({"--checkpoint", "kept"});
  ASSERT_TRUE(hosting(*host)) << host->wait().err;
  EXPECT_NE(told("host").find("--resume kept.1"), std::string::npos) << told("host");
  for (const char* ending : {".1", ".1.previous"})
    EXPECT_EQ(std::filesystem::file_size(kept.string() + ending), 1000u) << ending;
  EXPECT_TRUE(std::filesystem::exists(kept.string() + ".1.secrets"));
  host->signal(SIGINT);
  host->wait();

  // Given away without its secrets, it is the same world for other people.
  std::filesystem::remove(folder("host") / "links.txt");
  std::filesystem::remove(kept.string() + ".secrets");
  std::filesystem::remove(kept.string() + ".secrets.previous");
  host = resume();
  ASSERT_TRUE(hosting(*host)) << host->wait().err;
  EXPECT_NE(told("host").find("new key and new links"), std::string::npos) << told("host");
  EXPECT_NE(links(), first_links);
}

TEST_F(KeptHost, AFullDiskIsToldAtOnceThereAndFromElsewhere) {
  const std::vector<std::string> arguments{"host",     "probe",    "--spacing",    "0.01",    "--threads",
                                           "1",        "--listen", "127.0.0.1:0",  "--links", "links.txt",
                                           "--record", "run.rec",  "--checkpoint", "none"};
  // How much is written before the world starts.
  const path begun = folder("begun") / "run.rec";
  {
    const auto host = run("begun", arguments);
    ASSERT_TRUE(
        comes([&] { return std::filesystem::exists(folder("begun") / "links.txt") || !host->running(); }));
    host->signal(SIGKILL);
    host->wait();
  }
  // No file may grow beyond that and little more: a disk that fills, wherever this test runs.
  const std::string blocks = std::to_string(std::filesystem::file_size(begun) / 1024 + 3);
  std::vector<std::string> limited = command(arguments);
  limited.insert(limited.begin(), {"bash", "-c", "ulimit -f " + blocks + "; exec \"$@\"", "bash"});
  limited.insert(limited.end(), {"--wait", "0"});
  Process host(limited, folder("host"));
  ASSERT_TRUE(hosting(host)) << host.wait().err;
  EXPECT_TRUE(comes([&] { return told("host").find("the recording has ended") != std::string::npos; }))
      << told("host");
  EXPECT_TRUE(host.running()) << "the world goes on";
  EXPECT_NE(told("host").find("File too large"), std::string::npos) << told("host");
  EXPECT_TRUE(comes([&] { return told("host").find("DISK: ") != std::string::npos; }))
      << "in the status line";
  const Outcome asked = run("links", {"links"})->wait();
  EXPECT_NE(asked.out.find("the recording has ended"), std::string::npos) << asked.out << asked.err;
  host.signal(SIGINT);
  host.wait();
  const Outcome again = replay("run.rec");
  EXPECT_EQ(again.code, 0) << again.err << again.out;
  EXPECT_NE(again.out.find("cut off"), std::string::npos) << again.out;
}

TEST_F(KeptHost, IsStartedAgainWhenAFaultEndsItAndWhoHeldHoldsAgain) {
#ifdef SLOSH_SANITIZED
  // A sanitizer takes a fault for a finding and ends the host with a code of its own: not one that is sent.
  setenv("ASAN_OPTIONS", "handle_segv=0", 1);
  setenv("TSAN_OPTIONS", "handle_segv=0", 1);
#endif
  const auto host = this->host({"--checkpoint", "kept", "--record", "run.rec"});
  ASSERT_TRUE(hosting(*host)) << host->wait().err;
  const std::string first_links = links();
  const auto ana = join("Ana", "12");
  double before = 0.0;
  int round = 0;
  for (const int fault : {SIGABRT, SIGSEGV}) {
    round += 1;
    const std::uintmax_t from = felt("Ana");
    ASSERT_TRUE(comes([&] { return felt("Ana") > from + 30'000 || !ana->running(); })) << told("Ana");
    ASSERT_TRUE(ana->running()) << told("Ana");
    const std::vector<pid_t> worlds = children_of(host->pid());
    ASSERT_EQ(worlds.size(), 1u);
    const auto begin = std::chrono::steady_clock::now();
    ASSERT_EQ(::kill(worlds.front(), fault), 0);
    const auto back = [&] { return times(told("Ana"), "back with the host"); };
    EXPECT_TRUE(comes([&] { return back() >= round || !ana->running(); })) << told("Ana") << told("host");
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    const double now = number_after(told("host"), "carries on at ");
    std::printf("after signal %d Ana was back within %.2f s; the world carried on at %.2f s\n", fault,
                took.count(), now);
    EXPECT_GT(now, before) << "it goes on, and does not begin anew";
    before = now;
  }
  EXPECT_EQ(ana->wait().code, 0) << told("Ana");
  const json s = json::parse(read_text(folder("Ana") / "out" / "summary.json"));
  EXPECT_GE(s["network"]["reconnects"], 2);
  EXPECT_EQ(s["devices"].size(), 1u) << "the same grip again";
  EXPECT_EQ(links(), first_links);
  const std::string words = told("host");
  EXPECT_NE(words.find("the host died (Aborted); it is started again from kept"), std::string::npos) << words;
  EXPECT_NE(words.find("the host died (Segmentation fault)"), std::string::npos) << words;
  // Whoever asks for the end gets it, from the world or from its supervisor.
  host->signal(SIGTERM);
  const Outcome ended = host->wait();
  EXPECT_EQ(ended.code, 128 + SIGTERM);
  EXPECT_NE(ended.out.find("carry on with"), std::string::npos) << "in order: " << ended.out;
  for (const char* file : {"run.rec", "run-2.rec", "run-3.rec"}) {
    const Outcome again = replay(file);
    EXPECT_EQ(again.code, 0) << file << again.err;
    EXPECT_NE(again.out.find("hashes agree"), std::string::npos) << file << again.out;
  }
}

TEST_F(KeptHost, ThatDiesAgainAndAgainEndsWithWords) {
  const auto host = this->host({"--checkpoint", "kept"});
  ASSERT_TRUE(hosting(*host)) << host->wait().err;
  for (int deaths = 1; deaths <= 6; ++deaths) {
    ASSERT_TRUE(comes([&] { return times(told("host"), "hosting\n") >= deaths || !host->running(); }))
        << told("host");
    for (const pid_t world : children_of(host->pid())) ::kill(world, SIGABRT);
  }
  const Outcome ended = host->wait();
  EXPECT_EQ(ended.code, 128 + SIGABRT);
  EXPECT_NE(ended.err.find("is not started again"), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("--resume kept"), std::string::npos) << ended.err;
}

TEST_F(KeptHost, LinksEndsByWhatTheHostAnswered) {
  const auto links = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "links");
    return run("links", words)->wait();
  };
  EXPECT_EQ(links({}).code, 1) << "there is nobody to ask";
  const auto host = this->host({"--checkpoint", "none", "--wait", "0"});
  ASSERT_TRUE(hosting(*host)) << host->wait().err;
  EXPECT_EQ(links({}).code, 0);
  const Outcome made = links({"new", "Refused", "--watch"});
  EXPECT_EQ(made.code, 0) << "a name is no verdict: " << made.out << made.err;
  const std::string id = made.out.substr(0, made.out.find(' '));
  EXPECT_EQ(links({"expire", id, "10m"}).code, 0);
  EXPECT_EQ(links({"revoke", id}).code, 0);
  EXPECT_EQ(links({"revoke", "nobody"}).code, 1);
  EXPECT_EQ(links({"expire", "nobody", "10m"}).code, 1);
  EXPECT_EQ(links({"expire", id, "soon"}).code, 2) << "not asked at all";
  EXPECT_EQ(links({"--port", "9"}).code, 1) << "no host there";
  host->signal(SIGTERM);
  host->wait();
  EXPECT_EQ(links({}).code, 1);
}

TEST_F(KeptHost, ARecordingThatIsThereIsNotOverwritten) {
  std::filesystem::create_directories(folder("host"));
  std::ofstream(folder("host") / "run.rec") << "an afternoon's work";
  const Outcome refused = this->host({"--checkpoint", "none", "--record", "run.rec"})->wait();
  EXPECT_EQ(refused.code, 1);
  EXPECT_NE(refused.err.find("is there already"), std::string::npos) << refused.err;
  EXPECT_EQ(read_text(folder("host") / "run.rec"), "an afternoon's work");
}

TEST_F(KeptHost, WithoutASupervisorItIsOneProcess) {
  const auto host = this->host({"--checkpoint", "kept", "--no-supervisor"});
  ASSERT_TRUE(hosting(*host)) << host->wait().err;
  EXPECT_TRUE(children_of(host->pid()).empty());
  host->signal(SIGABRT);
  EXPECT_EQ(host->wait().code, 128 + SIGABRT);
}

TEST_F(KeptHost, WhoseSupervisorIsKilledLeavesNobodyBehind) {
  const auto host = this->host({"--checkpoint", "kept"});
  ASSERT_TRUE(hosting(*host)) << host->wait().err;
  const std::vector<pid_t> worlds = children_of(host->pid());
  ASSERT_EQ(worlds.size(), 1u);
  host->signal(SIGKILL);
  host->wait();
  EXPECT_TRUE(comes([&] {
    // A zombie that nobody reaps is over too.
    const std::string stat = read_text("/proc/" + std::to_string(worlds.front()) + "/stat");
    return stat.empty() || stat.find(") Z") != std::string::npos;
  }));
}

}  // namespace
}  // namespace slosh
