#include "tests/support/terminal.h"

#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>

namespace slosh::test {

Terminal::Terminal(const std::vector<std::string>& arguments, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  winsize size{};
  size.ws_col = 200;
  size.ws_row = 50;
  pid_ = forkpty(&fd_, nullptr, nullptr, &size);
  if (pid_ != 0) return;
  setenv("TERM", "xterm", 1);
  setenv("SLOSH_SETTINGS", "none", 0);
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  if (chdir(folder.c_str()) != 0) _exit(125);
  execvp(argv[0], argv.data());
  _exit(127);
}

Terminal::~Terminal() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    int status = 0;
    while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
  }
  if (fd_ >= 0) close(fd_);
}

void Terminal::type(const std::string& keys) const {
  std::size_t done = 0;
  while (done < keys.size()) {
    const ssize_t some = write(fd_, keys.data() + done, keys.size() - done);
    if (some <= 0) return;
    done += static_cast<std::size_t>(some);
  }
}

bool Terminal::read_some(int wait_ms) {
  pollfd waiting{fd_, POLLIN, 0};
  if (over_ || poll(&waiting, 1, wait_ms) <= 0) return false;
  char buffer[4096];
  const ssize_t got = read(fd_, buffer, sizeof buffer);
  if (got <= 0) {
    over_ = true;  // Linux answers EIO once nobody has the other side open
    return false;
  }
  screen_.append(buffer, static_cast<std::size_t>(got));
  return true;
}

const std::string& Terminal::screen() {
  while (read_some(0)) {
  }
  return screen_;
}

bool Terminal::shows(const std::string& text, std::size_t from) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(4);
  while (screen_.find(text, from) == std::string::npos) {
    if (over_ || std::chrono::steady_clock::now() > end) return false;
    read_some(50);
  }
  return true;
}

bool Terminal::echoes() const {
  termios now{};
  return tcgetattr(fd_, &now) == 0 && (now.c_lflag & (ICANON | ECHO)) == (ICANON | ECHO);
}

int Terminal::wait() {
  while (!over_) read_some(1000);
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace slosh::test
