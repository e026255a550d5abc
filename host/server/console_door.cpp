#include "host/server/console_door.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "host/server/console.h"

namespace slosh {
namespace {

// An answer's first line: programs go by it, people by what follows.
constexpr std::string_view kGranted = "done\n";
constexpr std::string_view kNotGranted = "not done\n";

constexpr std::size_t kMaxCallers = 8;
constexpr int kPatience_ms = 8000;

std::string system_words() {
  return std::generic_category().message(errno);
}

bool address_of(const std::filesystem::path& path, sockaddr_un& address) {
  const std::string text = path.string();
  if (text.size() >= sizeof address.sun_path) return false;
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, text.c_str(), text.size() + 1);
  return true;
}

// In /tmp anybody could have made it first and listen in.
bool is_ours(const std::filesystem::path& folder) {
  struct stat info = {};
  return lstat(folder.c_str(), &info) == 0 && S_ISDIR(info.st_mode) && info.st_uid == geteuid() &&
         (info.st_mode & 077) == 0;
}

}  // namespace

std::filesystem::path console_folder() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime && *runtime == '/') return std::filesystem::path(runtime) / "slosh";
  return "/tmp/slosh-" + std::to_string(geteuid());
}

std::filesystem::path console_socket(std::uint16_t port) {
  return console_folder() / ("host-" + std::to_string(port) + ".sock");
}

std::vector<std::uint16_t> console_ports() {
  std::vector<std::uint16_t> ports;
  std::error_code code;
  for (const auto& entry : std::filesystem::directory_iterator(console_folder(), code)) {
    const std::string name = entry.path().filename().string();
    std::uint16_t port = 0;
    if (!name.starts_with("host-") || !name.ends_with(".sock")) continue;
    const char* end = name.data() + name.size() - 5;
    const auto [at, error] = std::from_chars(name.data() + 5, end, port);
    if (error == std::errc() && at == end) ports.push_back(port);
  }
  std::sort(ports.begin(), ports.end());
  return ports;
}

Result<Outcome> ask_console(std::uint16_t port, const std::string& line) {
  const std::filesystem::path path = console_socket(port);
  const Error nobody{"", "no host answers on port " + std::to_string(port),
                     "Is it running, and as this user?"};
  sockaddr_un address{};
  if (!is_ours(console_folder()) || !address_of(path, address)) return nobody;
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return Error{path.string(), system_words(), ""};
  if (connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    ::close(fd);
    return nobody;
  }
  const std::string sent = line + "\n";
  std::string answer;
  bool complete = send(fd, sent.data(), sent.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(sent.size());
  while (complete) {
    pollfd waiting{fd, POLLIN, 0};
    char buffer[4096];
    const ssize_t got = poll(&waiting, 1, kPatience_ms) > 0 ? read(fd, buffer, sizeof buffer) : -1;
    if (got == 0) break;
    if (got < 0)
      complete = false;
    else
      answer.append(buffer, static_cast<std::size_t>(got));
  }
  ::close(fd);
  Outcome outcome;
  outcome.granted = answer.starts_with(kGranted);
  const std::size_t mark = outcome.granted ? kGranted.size() : kNotGranted.size();
  if (!complete || (!outcome.granted && !answer.starts_with(kNotGranted)))
    return Error{path.string(), "the host did not answer", "Try again"};
  outcome.text = answer.substr(mark);
  if (outcome.text.ends_with('\n')) outcome.text.pop_back();
  return outcome;
}

Result<std::unique_ptr<ConsoleDoor>> ConsoleDoor::open(std::uint16_t port) {
  const std::filesystem::path folder = console_folder();
  mkdir(folder.c_str(), 0700);
  if (!is_ours(folder))
    return Error{folder.string(), "is not a folder of yours alone", "Remove it, or set XDG_RUNTIME_DIR"};
  std::unique_ptr<ConsoleDoor> door(new ConsoleDoor);
  door->path_ = console_socket(port);
  sockaddr_un address{};
  if (!address_of(door->path_, address))
    return Error{door->path_.string(), "is too long for a socket", "Set XDG_RUNTIME_DIR to a shorter path"};
  // The port is ours, so a socket of its name is left from a host that is gone.
  unlink(door->path_.c_str());
  door->listening_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (door->listening_ < 0 ||
      bind(door->listening_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      chmod(door->path_.c_str(), 0600) != 0 || listen(door->listening_, 8) != 0) {
    return Error{door->path_.string(), "cannot be made: " + system_words(), ""};
  }
  return door;
}

ConsoleDoor::~ConsoleDoor() {
  for (const Caller& caller : callers_) ::close(caller.fd);
  if (listening_ < 0) return;
  ::close(listening_);
  unlink(path_.c_str());
}

// False when this caller is done with.
bool ConsoleDoor::receive(Caller& caller, const Answer& answer) {
  char buffer[512];
  const ssize_t got = recv(caller.fd, buffer, sizeof buffer, MSG_DONTWAIT);
  if (got < 0) return errno == EAGAIN || errno == EINTR;
  if (got == 0) return false;
  caller.line.append(buffer, static_cast<std::size_t>(got));
  const std::size_t end = caller.line.find('\n');
  if (end == std::string::npos) return caller.line.size() <= kMaxConsoleLine;
  const Outcome outcome = answer(caller.line.substr(0, end));
  const std::string said = std::string(outcome.granted ? kGranted : kNotGranted) + outcome.text + "\n";
  std::size_t sent = 0;
  while (sent < said.size()) {
    pollfd waiting{caller.fd, POLLOUT, 0};
    if (poll(&waiting, 1, 200) <= 0) break;
    const ssize_t some = send(caller.fd, said.data() + sent, said.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (some <= 0) break;
    sent += static_cast<std::size_t>(some);
  }
  return false;
}

void ConsoleDoor::serve(int wait_ms, int also, const Answer& answer) {
  std::vector<pollfd> waiting;
  waiting.push_back({listening_, POLLIN, 0});
  for (const Caller& caller : callers_) waiting.push_back({caller.fd, POLLIN, 0});
  waiting.push_back({also, POLLIN, 0});
  if (poll(waiting.data(), waiting.size(), wait_ms) <= 0) return;
  for (std::size_t i = callers_.size(); i-- > 0;) {
    if (waiting[i + 1].revents == 0 || receive(callers_[i], answer)) continue;
    ::close(callers_[i].fd);
    callers_.erase(callers_.begin() + static_cast<std::ptrdiff_t>(i));
  }
  if (waiting[0].revents == 0) return;
  const int fd = accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
  if (fd >= 0 && callers_.size() < kMaxCallers)
    callers_.push_back({fd, {}});
  else if (fd >= 0)
    ::close(fd);
}

}  // namespace slosh
