#include "host/app/host_supervisor.h"

#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>

#include "net/clock.h"
#include "peer/app/verbs.h"

namespace slosh {
namespace {

constexpr std::int64_t kOneWish = 500'000'000;  // ns within which a second signal is the first's echo
constexpr std::int64_t kHeardWithin =
    300'000'000;  // ns in which a child that was signalled says that it ends

// The descriptor of the page that both see, for the process that is started.
constexpr const char* kSupervisorVariable = "SLOSH_REINS";

void keep_path(const std::string& path, char* room, std::size_t longest) {
  // Longer ones no file can have.
  const std::size_t length = path.size() <= longest ? path.size() : 0;
  std::memcpy(room, path.data(), length);
  room[length] = '\0';
}

SupervisorControl* map_supervisor_control(int descriptor) {
  void* page = mmap(nullptr, sizeof(SupervisorControl), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  return page == MAP_FAILED ? nullptr : static_cast<SupervisorControl*>(page);
}

void unmap_supervisor_control(SupervisorControl* supervision) {
  munmap(supervision, sizeof(SupervisorControl));
}

/// The page, and the word of it that a child inherits.
class SharedSupervisorControl {
 public:
  SharedSupervisorControl() : descriptor_(memfd_create("slosh-host", 0)) {
    if (descriptor_ < 0 || ftruncate(descriptor_, sizeof(SupervisorControl)) != 0) return;
    void* page = map_supervisor_control(descriptor_);
    if (!page) return;
    supervision_ = new (page) SupervisorControl;
    // Now and not in the child, which a fork leaves with one thread and perhaps somebody else's locks.
    setenv(kSupervisorVariable, std::to_string(descriptor_).c_str(), 1);
  }
  ~SharedSupervisorControl() {
    if (supervision_) unmap_supervisor_control(supervision_);
    if (descriptor_ >= 0) close(descriptor_);
    unsetenv(kSupervisorVariable);
  }
  SharedSupervisorControl(const SharedSupervisorControl&) = delete;
  SharedSupervisorControl& operator=(const SharedSupervisorControl&) = delete;
  SupervisorControl* get() const { return supervision_; }

 private:
  int descriptor_;
  SupervisorControl* supervision_ = nullptr;
};

/// What this process was started with.
std::vector<std::string> command_line() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(file, word, '\0');) words.push_back(word);
  return words;
}

/// The terminal as it was found: a child that dies leaves it as it needed it.
class TerminalKeeper {
 public:
  TerminalKeeper() : is_terminal_(tcgetattr(STDIN_FILENO, &before_) == 0) {}
  void restore() const {
    if (is_terminal_ && tcgetpgrp(STDIN_FILENO) == getpgrp()) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }

 private:
  termios before_{};
  bool is_terminal_;
};

/// Signals that wait until they are asked for, so that none comes between a look and a sleep.
class HeldSignals {
 public:
  HeldSignals() {
    sigemptyset(&held_);
    signal(SIGCHLD, SIG_DFL);  // who started us may have passed it over, and that is inherited
    for (const int each : {SIGINT, SIGTERM, SIGHUP, SIGCHLD}) sigaddset(&held_, each);
    sigprocmask(SIG_BLOCK, &held_, &before_);
  }
  ~HeldSignals() { release(); }
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;
  void release() const { sigprocmask(SIG_SETMASK, &before_, nullptr); }
  /// The next one; si_signo is 0 when none came for a second.
  siginfo_t wait() const {
    siginfo_t info{};
    const timespec second{1, 0};
    while (sigtimedwait(&held_, &info, &second) < 0) {
      if (errno != EINTR) return siginfo_t{};
    }
    return info;
  }

 private:
  sigset_t held_{}, before_{};
};

/// Passes on what somebody sent to this process; who signalled all of them has reached the child already.
void pass_on(const siginfo_t& info, pid_t child, const SupervisorControl& supervision) {
  if (info.si_code == SI_KERNEL) return;  // the terminal's, which goes to both
  const std::int64_t until = steady_now_ns() + kHeardWithin;
  const bool again = supervision.ending();
  while (!again && steady_now_ns() < until) {
    if (supervision.ending()) return;
    sleep_until_ns(steady_now_ns() + 10'000'000);
  }
  kill(child, info.si_signo);
}

struct End {
  int status = 0;    // as waitpid says
  std::string hung;  // what hung, when it was ended for that
};

End outlive(pid_t child, const HeldSignals& signals, const SupervisorControl& supervision,
            const HangLimits& limits) {
  End end;
  HangWatch world(limits.world);
  HangWatch network(limits.network);
  bool stopped = false;
  std::int64_t heard_ns = 0;
  while (true) {
    const siginfo_t info = signals.wait();
    const bool asked = info.si_signo != SIGCHLD && info.si_signo != 0;
    // timeout(1) and its like signal a program and then its group: that is one wish, not two.
    if (asked && (heard_ns == 0 || steady_now_ns() - heard_ns > kOneWish)) pass_on(info, child, supervision);
    if (asked) heard_ns = steady_now_ns();
    int status = 0;
    while (waitpid(child, &status, WNOHANG | WUNTRACED | WCONTINUED) == child) {
      if (WIFEXITED(status) || WIFSIGNALED(status)) {
        end.status = status;
        return end;
      }
      stopped = WIFSTOPPED(status);
    }
    if (stopped) {
      world.pass_over();
      network.pass_over();
    }
    if (info.si_signo != 0 || stopped || !end.hung.empty()) continue;
    const bool world_hangs = world.look(supervision.pulse());
    const bool network_hangs = network.look(supervision.network_pulse());
    if (world_hangs) end.hung = "its world hung for " + std::to_string(limits.world) + " s";
    if (network_hangs) end.hung = "its network hung for " + std::to_string(limits.network) + " s";
    if (!end.hung.empty()) kill(child, SIGKILL);
  }
}

bool asks_for_the_end(int signal_number) {
  return signal_number == SIGINT || signal_number == SIGTERM || signal_number == SIGHUP ||
         signal_number == SIGQUIT;
}

void say(const std::string& line) {
  // The status line of the one that died may stand there.
  std::fprintf(stderr, "%sslosh: %s\n", isatty(STDERR_FILENO) ? "\r\033[K" : "", line.c_str());
}

}  // namespace

void SupervisorControl::can_carry_on_from(const std::string& checkpoint) {
  if (checkpoint.empty() || checkpoint.size() > kLongestPath) return;
  std::memcpy(checkpoint_, checkpoint.c_str(), checkpoint.size() + 1);
  ready_.store(true, std::memory_order_release);
}

std::string SupervisorControl::checkpoint() const {
  return ready_.load(std::memory_order_acquire) ? checkpoint_ : std::string();
}

void SupervisorControl::restart(const HostVerbOptions& next) {
  ready_.store(false, std::memory_order_relaxed);
  pulse_.store(0, std::memory_order_relaxed);
  network_pulse_.store(0, std::memory_order_relaxed);
  ending_.store(false, std::memory_order_relaxed);
  restarts_ = next.restarts;
  keep_path(next.resume, resume_, kLongestPath);
  keep_path(next.record, record_, kLongestPath);
}

HostVerbOptions SupervisorControl::to_run(const HostVerbOptions& typed) const {
  if (restarts_ == 0) return typed;
  HostVerbOptions next = restarted(typed, resume_, restarts_);
  next.record = record_;  // the name that the supervisor has said
  return next;
}

std::unique_ptr<SupervisorControl, void (*)(SupervisorControl*)> inherited_supervisor_control() {
  std::unique_ptr<SupervisorControl, void (*)(SupervisorControl*)> supervision(nullptr,
                                                                               unmap_supervisor_control);
  const char* said = std::getenv(kSupervisorVariable);
  if (!said) return supervision;
  int descriptor = -1;
  const char* end = said + std::strlen(said);
  const auto [rest, failure] = std::from_chars(said, end, descriptor);
  unsetenv(kSupervisorVariable);
  struct stat page{};
  // Somebody's own variable of that name is none of ours.
  const bool ours = failure == std::errc() && rest == end && descriptor > STDERR_FILENO &&
                    fstat(descriptor, &page) == 0 && S_ISREG(page.st_mode) && page.st_nlink == 0 &&
                    page.st_size == sizeof(SupervisorControl);
  if (!ours) return supervision;
  supervision.reset(map_supervisor_control(descriptor));
  close(descriptor);
  return supervision;
}

bool RestartBudget::take(std::int64_t now_ns) {
  while (!taken_.empty() && now_ns - taken_.front() >= kWithin_ns) taken_.pop_front();
  if (taken() >= kMax) return false;
  taken_.push_back(now_ns);
  return true;
}

HostVerbOptions restarted(const HostVerbOptions& options, const std::string& checkpoint, int restarts) {
  HostVerbOptions next = options;
  next.resume = next.checkpoint = checkpoint;
  next.listen.clear();
  next.restarts = restarts;
  if (!options.record.empty()) {
    const std::filesystem::path first = options.record;
    std::error_code code;
    int number = restarts;
    do {
      const std::string name = first.stem().string() + "-" + std::to_string(++number);
      next.record = (first.parent_path() / (name + first.extension().string())).string();
    } while (std::filesystem::exists(next.record, code));
  }
  return next;
}

HostBody again_from_the_start() {
  // All made here: the child, which a fork left with one thread, is to take nothing that has a lock.
  struct Command {
    std::vector<std::string> words = command_line();
    std::vector<char*> arguments;
  };
  const auto command = std::make_shared<Command>();
  for (std::string& word : command->words) command->arguments.push_back(word.data());
  command->arguments.push_back(nullptr);
  return [command](const HostVerbOptions&, SupervisorControl*) -> int {
    execv("/proc/self/exe", command->arguments.data());
    say(std::string("the host's own process cannot be started: ") + std::strerror(errno) +
        ". Run it in this one with --no-supervisor");
    return kExitFailed;
  };
}

int supervise_host(const HostVerbOptions& options, const HostBody& body, const HangLimits& limits) {
  const SharedSupervisorControl shared;
  if (!shared.get()) {
    say(std::string("no memory to look after the host with: ") + std::strerror(errno) +
        ". Run it in this process with --no-supervisor");
    return kExitFailed;
  }
  SupervisorControl& supervision = *shared.get();
  const TerminalKeeper terminal;
  const pid_t parent = getpid();
  RestartBudget budget;
  HostVerbOptions now = options;
  while (true) {
    supervision.restart(now);
    std::fflush(nullptr);  // else the child would say it once more
    const HeldSignals signals;
    const pid_t child = fork();
    if (child == 0) {
      signals.release();
      // Nobody can stop a child whose supervisor was killed, and its port would stay taken.
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      const int code = getppid() == parent ? body(now, &supervision) : kExitFailed;
      std::fflush(nullptr);
      _exit(code);  // not exit(): the parent's handlers are not the child's
    }
    if (child < 0) {
      signals.release();
      say(std::string("the host's own process cannot be started: ") + std::strerror(errno) +
          ". Run it in this one with --no-supervisor");
      return kExitFailed;
    }
    const End end = outlive(child, signals, supervision, limits);
    const int status = end.status;
    terminal.restore();
    if (WIFEXITED(status)) return WEXITSTATUS(status);
    const int ended_by = WTERMSIG(status);
    if (asks_for_the_end(ended_by)) return 128 + ended_by;
    const std::string fault = !end.hung.empty() ? end.hung : std::string(strsignal(ended_by));
    const std::string checkpoint = supervision.checkpoint();
    if (checkpoint.empty()) {
      say("the host died (" + fault + ") before its world was saved");
      return 128 + ended_by;
    }
    if (supervision.ending()) {
      say("the host died (" + fault + ") while it ended. Carry on with ./slosh host --resume " + checkpoint);
      return 128 + ended_by;
    }
    if (!budget.take(steady_now_ns())) {
      say("the host died (" + fault + ") once more after " + std::to_string(RestartBudget::kMax) +
          " restarts within a minute, and is not started again. Its world is in " + checkpoint +
          ": ./slosh host --resume " + checkpoint);
      return 128 + ended_by;
    }
    now = restarted(options, checkpoint, now.restarts + 1);
    say("the host died (" + fault + "); it is started again from " + checkpoint +
        (now.record.empty() ? "" : ", and records to " + now.record + " from here on"));
  }
}

}  // namespace slosh
