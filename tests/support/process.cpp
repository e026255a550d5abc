#include "tests/support/process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace slosh::test {

Process::Process(const std::vector<std::string>& arguments, const std::filesystem::path& folder)
    : folder_(folder) {
  std::filesystem::create_directories(folder);
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const std::string out = (folder / "stdout.txt").string();
  const std::string err = (folder / "stderr.txt").string();
  pid_ = fork();
  if (pid_ != 0) return;
  // The child.
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  setenv("SLOSH_SETTINGS", "none", 0);  // nobody's own settings change a test
  const int in = open("/dev/null", O_RDONLY);
  const int to_out = open(out.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0644);
  const int to_err = open(err.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0644);
  if (chdir(folder.c_str()) != 0) _exit(125);
  dup2(in, STDIN_FILENO);
  dup2(to_out, STDOUT_FILENO);
  dup2(to_err, STDERR_FILENO);
  execvp(argv[0], argv.data());
  _exit(127);
}

Process::~Process() {
  if (ended_ || pid_ <= 0) return;
  kill(pid_, SIGKILL);
  while (waitpid(pid_, &status_, 0) < 0 && errno == EINTR) {
  }
}

void Process::signal(int number) const {
  kill(pid_, number);
}

bool Process::running() {
  rusage used{};
  if (!ended_ && wait4(pid_, &status_, WNOHANG, &used) == pid_) {
    ended_ = true;
    peak_kb_ = used.ru_maxrss;
  }
  return !ended_;
}

Outcome Process::wait() {
  if (!ended_) {
    rusage used{};
    while (wait4(pid_, &status_, 0, &used) < 0 && errno == EINTR) {
    }
    ended_ = true;
    peak_kb_ = used.ru_maxrss;
  }
  const int code = WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
  return {code, read_text(folder_ / "stdout.txt"), read_text(folder_ / "stderr.txt"), peak_kb_};
}

std::string read_text(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace slosh::test
