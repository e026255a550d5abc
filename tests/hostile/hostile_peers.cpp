// Hostile peers against a real host, over real QUIC on loopback: `slosh host` in one process, an honest peer
// that holds a grip on a thread of this one, and attacker after attacker. Fails when the host falls, when a
// sanitizer has a word to say, when what somebody sent reaches the host's terminal, or when the honest peer
// loses what it had.
#include <signal.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <thread>

#include "net/clock.h"
#include "tests/hostile/attacker.h"
#include "tests/hostile/honest_peer.h"
#include "tests/hostile/report.h"
#include "tests/hostile/stranger.h"

namespace slosh::hostile {
namespace {

constexpr std::size_t kPeersAtOnce = 12;  // attackers
// A seat is kept for a minute: with a key of its own each, attackers would soon find no seat and be turned
// away.
constexpr std::size_t kKeys = 10;
// Under a sanitizer on a busy machine a state may be late; this is when it counts as not coming.
constexpr double kLongestGap = 10.0;   // s without a state
constexpr double kLongestAway = 30.0;  // s that coming back may take

class PeersRun {
 public:
  explicit PeersRun(const RunOptions& options)
      : options_(options),
        log_(options.folder / "attacks.log"),
        mischief_(options.seed),
        home_(short_folder()),
        host_(host_command(), options.folder / "host") {
    for (std::size_t i = 0; i < kKeys; ++i) keys_.push_back(Identity::generate());
  }

  ~PeersRun() {
    if (home_ != "/tmp") std::filesystem::remove_all(home_);
  }

  int go() {
    if (!find_links()) return 1;
    HonestPeer honest(target_.hold);
    if (!wait_for("the honest peer to come in and hold its grip", [&] {
          const HonestFigures f = honest.figures();
          return f.holds && f.poses_used > 0;
        })) {
      return 1;
    }
    begin_ns_ = steady_now_ns();
    attack(honest);
    const double held = to_seconds(steady_now_ns() - begin_ns_);
    // Nobody attacks any more: all that the honest peer had is there.
    const std::uint64_t used = honest.figures().poses_used;
    wait_for("the honest peer's poses to be used after the attack", [&] {
      const HonestFigures f = honest.figures();
      return f.in && f.holds && f.poses_used > 0 && f.poses_used != used;
    });
    const HonestFigures f = honest.figures();
    honest.leave();
    host_.signal(SIGINT);
    if (!wait_for("the host to end", [&] { return !host_.running(); })) host_.signal(SIGKILL);
    const test::Outcome outcome = host_.wait();
    for (const std::string& fault : faults_of(outcome, {128 + SIGINT})) finding("the host " + fault);
    std::printf(
        "hostile peers: %llu connections (%llu let in), %llu messages, %llu packets of noise; honest peer "
        "held %.0f s "
        "(%llu of %llu poses used, %llu states, longest gap %.2f s, away %llu times, at most %.1f s); host "
        "at most "
        "%ld MB; %zu findings; seed %llu\n",
        number(count_), number(ramp_), number(messages_), number(noise_), held, number(f.poses_used),
        number(f.poses_sent), number(f.states), f.longest_gap, number(f.came_back), f.longest_away,
        outcome.peak_kb / 1000, findings_, number(options_.seed));
    return findings_ == 0 ? 0 : 1;
  }

 private:
  static unsigned long long number(std::uint64_t value) { return value; }
  /// One process, so that a fault ends it: a supervisor would start it again from its checkpoint.
  std::vector<std::string> host_command() const {
    std::vector<std::string> words{"env", "XDG_STATE_HOME=" + home_, "XDG_DATA_HOME=" + home_,
                                   "XDG_RUNTIME_DIR=" + home_, slosh_program()};
    std::istringstream rest(
        "host probe --spacing 0.01 --threads 1 --listen 127.0.0.1:0 --links links.txt --wait 0 --checkpoint "
        "kept "
        "--no-supervisor --record run.rec");
    for (std::string word; rest >> word;) words.push_back(word);
    return words;
  }
  /// Short, for a socket's name has to fit into 108 bytes.
  static std::string short_folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "slosh-XXXXXX").string();
    return mkdtemp(pattern.data()) ? pattern : "/tmp";
  }

  void finding(const std::string& what) {
    findings_ += 1;
    std::printf("FINDING: %s\n  see %s; again with --seed %llu\n", what.c_str(), options_.folder.c_str(),
                number(options_.seed));
    std::fflush(stdout);
    log_ << "FINDING: " << what << std::endl;
  }

  template <class Done>
  bool wait_for(const char* what, Done done) {
    const std::int64_t give_up = steady_now_ns() + to_nanoseconds(180.0);
    while (!done()) {
      if (steady_now_ns() > give_up) {
        finding(std::string("waited for ") + what + ", in vain");
        return false;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
  }

  bool find_links() {
    std::string hold, watch;
    const auto look = [&] {
      std::istringstream lines(test::read_text(options_.folder / "host" / "links.txt"));
      for (std::string word, text, rest; lines >> word >> text && std::getline(lines, rest);)
        (word == "hold" ? hold : watch) = text;
      return (!hold.empty() && !watch.empty()) || !host_.running();
    };
    if (!wait_for("the host's links", look)) return false;
    const Result<JoinLink> one = parse_link(hold);
    const Result<JoinLink> other = parse_link(watch);
    if (!one || !other) {
      finding("no links: " + test::read_text(options_.folder / "host" / "stderr.txt"));
      return false;
    }
    target_ = {one.value(), other.value()};
    return true;
  }

  void attack(HonestPeer& honest) {
    std::array<std::unique_ptr<Attacker>, kPeersAtOnce> attackers;
    Stranger stranger(target_.hold.addresses.front());
    std::int64_t check_ns = 0;
    const std::int64_t end_ns = begin_ns_ + to_nanoseconds(options_.seconds);
    while (steady_now_ns() < end_ns && count_ < options_.most) {
      for (std::unique_ptr<Attacker>& attacker : attackers) {
        if (!attacker || attacker->over()) {
          account(attacker.get());
          attacker = next();
        }
        attacker->turn();
      }
      stranger.send(mischief_);
      std::this_thread::sleep_for(std::chrono::microseconds(500));
      if (steady_now_ns() < check_ns) continue;
      check_ns = steady_now_ns() + to_nanoseconds(1.0);
      noise_ = stranger.sent();
      if (!check(honest.figures())) break;
    }
    for (std::unique_ptr<Attacker>& attacker : attackers) account(attacker.get());
  }

  std::unique_ptr<Attacker> next() {
    const std::uint64_t attack = options_.first + count_++;
    std::seed_seq mix{static_cast<std::uint32_t>(options_.seed),
                      static_cast<std::uint32_t>(options_.seed >> 32), static_cast<std::uint32_t>(attack),
                      static_cast<std::uint32_t>(attack >> 32)};
    std::array<std::uint32_t, 2> seed{};
    mix.generate(seed.begin(), seed.end());
    auto made = std::make_unique<Attacker>(target_, keys_[seed[0] % kKeys],
                                           seed[0] | static_cast<std::uint64_t>(seed[1]) << 32);
    // On disk before it begins: what the host fell by is among the last.
    log_ << to_seconds(steady_now_ns() - begin_ns_) << " s: attack " << attack << ", "
         << name_of(made->harm()) << std::endl;
    return made;
  }

  void account(const Attacker* attacker) {
    if (!attacker) return;
    ramp_ += attacker->ramp_work() ? 1 : 0;
    messages_ += attacker->messages();
  }

  /// Once a second. False when there is no sense in going on.
  bool check(const HonestFigures& f) {
    seconds_ += 1;
    if (!host_.running()) {
      finding("the host has ended");
      return false;
    }
    const std::string said = test::read_text(options_.folder / "host" / "stderr.txt");
    if (const std::string words = sanitizer_words(said); !words.empty()) {
      finding("the host: " + words);
      return false;
    }
    if (!f.fault.empty()) {
      finding("the honest peer: " + f.fault);
      return false;
    }
    if (f.gap > kLongestGap || f.away > kLongestAway) {
      finding("the honest peer has had no state for " + seconds_text(std::max(f.gap, f.away)));
      return false;
    }
    // A grip that was let go over a pause of the machine is its own again soon; poses are used all the while.
    const bool used = f.poses_used != poses_used_ || f.away > 0.0;
    unused_ = used ? 0 : unused_ + 1;
    poses_used_ = f.poses_used;
    if (unused_ > kLongestAway) {
      finding("the honest peer's poses have not been used for " + seconds_text(unused_));
      return false;
    }
    if (seconds_ % 10 == 0) {
      std::printf(
          "%4d s: %llu connections, %llu let in, %llu messages; honest peer: %llu poses used, %llu states\n",
          seconds_, number(count_), number(ramp_), number(messages_), number(f.poses_used), number(f.states));
      std::fflush(stdout);
    }
    return true;
  }

  const RunOptions options_;
  std::ofstream log_;
  Mischief mischief_;
  const std::string home_;
  test::Process host_;
  Target target_;
  std::vector<Identity> keys_;
  std::int64_t begin_ns_ = 0;
  std::uint64_t count_ = 0;
  std::uint64_t ramp_ = 0;
  std::uint64_t messages_ = 0;
  std::uint64_t noise_ = 0;
  std::uint64_t poses_used_ = 0;
  int seconds_ = 0;
  int unused_ = 0;  // s
  std::size_t findings_ = 0;
};

}  // namespace
}  // namespace slosh::hostile

int main(int count, char** arguments) {
  using namespace slosh::hostile;
  PeersRun run(
      run_options(count, arguments, "Hostile peers against a real host, an honest peer among them."));
  return run.go();
}
