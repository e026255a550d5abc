#include "peer/output/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace slosh {
namespace {

std::string last_line(int file) {
  const off_t size = lseek(file, 0, SEEK_END);
  const off_t from = std::max<off_t>(0, size - 400);
  std::string text(static_cast<std::size_t>(size - from), '\0');
  const ssize_t got = pread(file, text.data(), text.size(), from);
  text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  const std::size_t line = text.rfind('\n');
  return line == std::string::npos ? text : text.substr(line + 1);
}

}  // namespace

ChildProcess::ChildProcess(std::string name, pid_t pid, int input, int log)
    : name_(std::move(name)), pid_(pid), input_(input), log_(log) {}

ChildProcess::~ChildProcess() {
  (void)finish();
}

Result<std::unique_ptr<ChildProcess>> ChildProcess::start(const std::vector<std::string>& arguments) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    return Error{arguments[0], std::generic_category().message(errno), "Close other programs"};
  // A file in memory rather than a pipe: nobody has to read along for the child not to stop.
  const int log = memfd_create("child-log", MFD_CLOEXEC);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, log, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, log, STDERR_FILENO);
  posix_spawnattr_t how;
  posix_spawnattr_init(&how);
  posix_spawnattr_setflags(&how, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  posix_spawnattr_setpgroup(&how, 0);
  sigset_t defaults;
  sigemptyset(&defaults);
  sigaddset(&defaults, SIGPIPE);
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
    if (log >= 0) close(log);
    return Error{arguments[0], std::string("cannot be started: ") + std::generic_category().message(failed),
                 "Install it (the launcher ./slosh does)"};
  }
  return std::unique_ptr<ChildProcess>(new ChildProcess(arguments[0], pid, ends[1], log));
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

Result<bool> ChildProcess::finish() {
  if (pid_ < 0) return true;
  if (input_ >= 0) close(input_);
  input_ = -1;
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  const std::string said = log_ >= 0 ? last_line(log_) : std::string();
  if (log_ >= 0) close(log_);
  log_ = -1;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return true;
  return Error{name_, said.empty() ? "failed" : "failed: " + said,
               "Check the disk's free space and the folder"};
}

}  // namespace slosh
