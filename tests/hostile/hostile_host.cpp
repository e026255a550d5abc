// A hostile host against real peers, over real QUIC on loopback: `slosh join` again and again, each time with
// another trick played on it. Fails when a peer falls, does not end, feels what is no force, holds too much
// memory, writes to its terminal what the host sent, or cannot join an honest host afterwards.
#include <signal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "net/clock.h"
#include "scenes/load.h"
#include "tests/hostile/evil_host.h"
#include "tests/hostile/report.h"

namespace slosh::hostile {
namespace {

constexpr std::size_t kAtOnce = 2;          // peers
constexpr std::uint64_t kHonestEvery = 12;  // visits, after which the same person joins an honest host
constexpr double kVisit = 8.0;              // s, then the person ends it (Ctrl-C)
constexpr double kPatience = 120.0;   // s until an end that was asked for; reached only when something hangs
constexpr double kMaxForce = 1000.0;  // N, N·m: no device that slosh knows takes more

/// What is wrong with the forces that were felt; empty when nothing. `most` rises to the greatest.
std::string bad_force(const std::filesystem::path& file, double& most) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);  // the header: time_s, device, …
  for (int row = 2; std::getline(in, line); ++row) {
    std::istringstream fields(line);
    std::string field;
    for (int column = 0; std::getline(fields, field, ','); ++column) {
      char* end = nullptr;
      const double value = std::strtod(field.c_str(), &end);
      const bool force = column >= 2 && column < 8;
      if (force && std::isfinite(value)) most = std::max(most, std::abs(value));
      if (field.empty() || *end != '\0' || !std::isfinite(value) || (force && std::abs(value) > kMaxForce))
        return "'" + field + "' in line " + std::to_string(row) + ", column " + std::to_string(column + 1);
    }
  }
  return {};
}

class Run {
 public:
  Run(const RunOptions& options, const Scene& scene)
      : options_(options), log_(options.folder / "visits.log"), evil_(scene, options.seed) {
    std::string pattern = (std::filesystem::temp_directory_path() / "slosh-XXXXXX").string();
    if (mkdtemp(pattern.data())) home_ = pattern;
  }
  ~Run() { std::filesystem::remove_all(home_); }

  int go() {
    if (!evil_.problem().empty()) {
      std::printf("the hostile host cannot listen: %s\n", evil_.problem().c_str());
      return 1;
    }
    test::Process honest(
        slosh({"host", "probe", "--spacing", "0.01", "--threads", "1", "--listen", "127.0.0.1:0", "--links",
               "links.txt", "--wait", "0", "--checkpoint", "none"}),
        options_.folder / "honest_host");
    const std::int64_t begin_ns = steady_now_ns();
    const std::int64_t end_ns = begin_ns + to_nanoseconds(options_.seconds);
    std::int64_t say_ns = begin_ns + 10'000'000'000;
    std::array<Visit, kAtOnce> visits;
    while (steady_now_ns() < end_ns && begun_ < options_.most) {
      for (std::size_t i = 0; i < visits.size(); ++i) {
        if (!visits[i].peer) begin(visits[i], i);
        follow(visits[i]);
      }
      evil_.turn();
      if (steady_now_ns() < say_ns) continue;
      say_ns += 10'000'000'000;
      std::printf("%4.0f s: %llu visits, %llu messages; joined an honest host %llu times\n",
                  to_seconds(steady_now_ns() - begin_ns), number(visits_), number(evil_.messages()),
                  number(honest_));
      std::fflush(stdout);
    }
    const double attacked = to_seconds(steady_now_ns() - begin_ns);
    for (Visit& visit : visits) {
      if (visit.peer) visit.due_ns = 0;
      while (visit.peer) {
        evil_.turn();
        follow(visit);
      }
    }
    join_an_honest_host(0);
    honest.signal(SIGINT);
    for (const std::string& fault : faults_of(honest.wait(), {128 + SIGINT}))
      finding("the honest host " + fault, 0);
    std::printf(
        "hostile host: %llu visits by real peers in %.0f s (%llu said Hello), %llu messages; peers held at "
        "most "
        "%ld MB and felt at most %.0f N; joined an honest host %llu times; %zu findings; seed %llu\n",
        number(visits_), attacked, number(evil_.guests()), number(evil_.messages()), peak_kb_ / 1000,
        most_force_, number(honest_), findings_, number(options_.seed));
    return findings_ == 0 ? 0 : 1;
  }

 private:
  struct Visit {
    std::unique_ptr<test::Process> peer;
    std::filesystem::path folder;
    std::uint64_t guest = 0;
    std::size_t person = 0;
    std::int64_t due_ns = 0;  // when it is asked to end
    bool asked = false;
  };
  static unsigned long long number(std::uint64_t value) { return value; }

  std::vector<std::string> slosh(const std::vector<std::string>& arguments) const {
    std::vector<std::string> all{"env", "XDG_STATE_HOME=" + home_, "XDG_DATA_HOME=" + home_,
                                 "XDG_RUNTIME_DIR=" + home_, slosh_program()};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return all;
  }
  std::string key(std::size_t person) const {
    return (options_.folder / ("person" + std::to_string(person) + ".key")).string();
  }

  void finding(const std::string& what, std::uint64_t guest) {
    findings_ += 1;
    std::printf("FINDING: %s\n  see %s; again with --seed %llu --first %llu --most 1\n", what.c_str(),
                options_.folder.c_str(), number(options_.seed), number(guest));
    std::fflush(stdout);
    log_ << "FINDING: " << what << std::endl;
  }

  void begin(Visit& visit, std::size_t person) {
    visit.guest = options_.first + begun_++;
    visit.person = person;
    visit.folder = options_.folder / ("person" + std::to_string(person));
    std::filesystem::remove_all(visit.folder);
    visit.asked = false;
    visit.due_ns = steady_now_ns() + to_nanoseconds(kVisit);
    log_ << "visit " << visit.guest << ", " << name_of(evil_.trick(visit.guest)) << std::endl;
    visit.peer = std::make_unique<test::Process>(
        slosh({"join", evil_.link(visit.guest), "--name", "Ana", "--headless", "--no-render", "--key",
               key(person), "--out", "out", "--seconds", "3"}),
        visit.folder);
  }

  void follow(Visit& visit) {
    if (!visit.peer) return;
    if (visit.peer->running()) {
      const std::int64_t now = steady_now_ns();
      if (!visit.asked && now > visit.due_ns) {
        visit.asked = true;
        visit.due_ns = now + to_nanoseconds(kPatience);
        visit.peer->signal(SIGINT);
      } else if (visit.asked && now > visit.due_ns) {
        finding("a peer did not end when it was asked to", visit.guest);
        visit.peer->signal(SIGKILL);
        visit.due_ns = now + to_nanoseconds(kPatience);
      }
      return;
    }
    const test::Outcome outcome = visit.peer->wait();
    visit.peer.reset();
    visits_ += 1;
    peak_kb_ = std::max(peak_kb_, outcome.peak_kb);
    std::vector<std::string> faults = faults_of(outcome, {0, 1, 128 + SIGINT});
    const std::string force = bad_force(visit.folder / "out" / "wrenches.csv", most_force_);
    if (!force.empty()) faults.push_back("felt " + force + " of wrenches.csv");
    for (const std::string& fault : faults)
      finding("a peer (" + std::string(name_of(evil_.trick(visit.guest))) + ") " + fault, visit.guest);
    if (!faults.empty())
      std::filesystem::rename(visit.folder, options_.folder / ("finding" + std::to_string(visit.guest)));
    if (visits_ % kHonestEvery == 0) join_an_honest_host(visit.person);
  }

  /// The same person, with the same key, where all is well.
  void join_an_honest_host(std::size_t person) {
    std::string hold;
    const std::int64_t give_up = steady_now_ns() + to_nanoseconds(kPatience);
    while (hold.empty() && steady_now_ns() < give_up) {
      std::istringstream lines(test::read_text(options_.folder / "honest_host" / "links.txt"));
      for (std::string word, text, rest; lines >> word >> text && std::getline(lines, rest);) {
        if (word == "hold") hold = text;
      }
      evil_.turn();
    }
    const std::filesystem::path folder = options_.folder / "joins_honest";
    std::filesystem::remove_all(folder);
    test::Process peer(slosh({"join", hold, "--name", "Ana", "--headless", "--no-render", "--key",
                              key(person), "--out", "out", "--seconds", "0.3"}),
                       folder);
    while (peer.running() && steady_now_ns() < give_up) evil_.turn();
    if (peer.running()) peer.signal(SIGKILL);
    const test::Outcome outcome = peer.wait();
    std::vector<std::string> faults = faults_of(outcome, {0});
    if (std::string force = bad_force(folder / "out" / "wrenches.csv", most_force_); !force.empty())
      faults.push_back(force);
    for (const std::string& fault : faults)
      finding("joining an honest host afterwards: " + fault + " (" + outcome.err + ")", 0);
    honest_ += faults.empty() ? 1 : 0;
  }

  const RunOptions options_;
  std::ofstream log_;
  EvilHost evil_;
  std::string home_;
  std::uint64_t begun_ = 0;
  std::uint64_t visits_ = 0;
  std::uint64_t honest_ = 0;
  long peak_kb_ = 0;
  double most_force_ = 0.0;
  std::size_t findings_ = 0;
};

}  // namespace
}  // namespace slosh::hostile

int main(int count, char** arguments) {
  using namespace slosh;
  const hostile::RunOptions options =
      hostile::run_options(count, arguments, "A hostile host against real peers.");
  const Result<std::filesystem::path> file = find_scene("probe");
  const Result<Scene> scene = file ? load_scene(file.value()) : Result<Scene>(file.error());
  if (!scene) {
    std::printf("%s\n", scene.error().text().c_str());
    return 1;
  }
  hostile::Run run(options, scene.value());
  return run.go();
}
