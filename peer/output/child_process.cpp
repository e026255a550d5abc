#include "peer/output/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>

#include "net/text/clean.h"

namespace slosh {
namespace {

constexpr std::size_t kMaxSaid = 400;  // bytes of what a child said that an error repeats

/// A file in memory rather than a pipe: nobody has to read along for the child not to stop.
int memory_file(const char* name) {
  return memfd_create(name, MFD_CLOEXEC);
}

/// Everything that a file holds; closes it.
std::string take_all(int& file) {
  if (file < 0) return {};
  std::string text(static_cast<std::size_t>(std::max<off_t>(0, lseek(file, 0, SEEK_END))), '\0');
  std::size_t at = 0;
  while (at < text.size()) {
    const ssize_t got = pread(file, text.data() + at, text.size() - at, static_cast<off_t>(at));
    if (got <= 0 && errno != EINTR) break;
    at += got > 0 ? static_cast<std::size_t>(got) : 0;
  }
  text.resize(at);
  close(file);
  file = -1;
  return text;
}

std::string last_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  const std::size_t line = text.rfind('\n');
  return line == std::string::npos ? text : text.substr(line + 1);
}

}  // namespace

bool program_there(const std::string& name) {
  const char* const path = std::getenv("PATH");
  std::stringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access(((folder.empty() ? "." : folder) + "/" + name).c_str(), X_OK) == 0) return true;
  return false;
}

ChildProcess::ChildProcess(std::string name, pid_t pid, int input, int written, int said)
    : name_(std::move(name)), pid_(pid), input_(input), written_(written), said_(said) {}

ChildProcess::~ChildProcess() {
  (void)finish();
}

Result<std::unique_ptr<ChildProcess>> ChildProcess::start(const std::vector<std::string>& arguments) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    return Error{arguments[0], std::generic_category().message(errno), "Close other programs"};
  int written = memory_file("child-stdout");
  int said = memory_file("child-stderr");

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, written, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, said, STDERR_FILENO);
  posix_spawnattr_t how;
  posix_spawnattr_init(&how);
  posix_spawnattr_setflags(&how, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  posix_spawnattr_setpgroup(&how, 0);
  sigset_t defaults;
  sigemptyset(&defaults);
  for (const int ignored_here : {SIGPIPE, SIGXFSZ}) sigaddset(&defaults, ignored_here);
  posix_spawnattr_setsigdefault(&how, &defaults);

  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  pid_t pid = -1;
  const int failed = posix_spawnp(&pid, argv[0], &files, &how, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&how);
  close(ends[0]);
  if (failed != 0) {
    close(ends[1]);
    for (const int file : {written, said}) {
      if (file >= 0) close(file);
    }
    return Error{arguments[0], std::string("cannot be started: ") + std::generic_category().message(failed),
                 "Install it (the launcher ./slosh does)"};
  }
  return std::unique_ptr<ChildProcess>(new ChildProcess(arguments[0], pid, ends[1], written, said));
}

bool ChildProcess::write(const void* data, std::size_t bytes) {
  const char* from = static_cast<const char*>(data);
  while (bytes > 0 && input_ >= 0) {
    const ssize_t done = ::write(input_, from, bytes);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    from += done;
    bytes -= static_cast<std::size_t>(done);
  }
  return bytes == 0;
}

bool ChildProcess::over() const {
  if (pid_ < 0) return true;
  siginfo_t seen{};
  // Left to be waited for: finish() wants its status.
  return waitid(P_PID, static_cast<id_t>(pid_), &seen, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         seen.si_pid == pid_;
}

void ChildProcess::ask_to_end() const {
  if (pid_ >= 0) kill(pid_, SIGTERM);
}

Result<bool> ChildProcess::finish() {
  if (pid_ < 0) return true;
  if (input_ >= 0) close(input_);
  input_ = -1;
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  output_ = take_all(written_);
  const std::string said = last_line(take_all(said_));
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return true;
  std::string what = "failed";
  if (WIFSIGNALED(status)) what = std::string("was ended by a signal (") + strsignal(WTERMSIG(status)) + ")";
  if (!said.empty()) what += ": " + clean_text(said, kMaxSaid);
  return Error{name_, what, "Check the disk's free space and the folder"};
}

}  // namespace slosh
