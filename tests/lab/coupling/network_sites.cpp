#include "tests/lab/coupling/network_sites.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>

namespace slosh {
namespace {

constexpr const char* kWire = "wire";

int reap(pid_t pid) {
  int status = -1;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

/// Runs a program; its output and errors to `said`.
int run_program(const std::vector<std::string>& command, std::string& said) {
  int out[2];
  if (pipe2(out, O_CLOEXEC) != 0) return -1;
  std::vector<char*> argv;
  for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  const pid_t pid = fork();
  if (pid == 0) {
    dup2(out[1], STDOUT_FILENO);
    dup2(out[1], STDERR_FILENO);
    execvp(argv[0], argv.data());
    _exit(127);
  }
  close(out[1]);
  char buffer[512];
  for (ssize_t got; (got = read(out[0], buffer, sizeof buffer)) > 0;)
    said.append(buffer, static_cast<std::size_t>(got));
  close(out[0]);
  const int status = reap(pid);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : " ") + word;
  return all;
}

}  // namespace

NetworkSites::NetworkSites(std::vector<std::string> names) : names_(std::move(names)) {
  if (!build()) release();
}

NetworkSites::~NetworkSites() {
  release();
}

bool NetworkSites::build() {
  // What this process may do itself, else what it may do as root of a namespace of users.
  if (!hold(kWire, {"unshare", "--net"})) {
    const std::string without = problem_;
    problem_.clear();
    own_users_ = true;
    if (!hold(kWire, {"unshare", "--map-root-user", "--net"})) {
      problem_ = without + "; " + problem_;
      return false;
    }
  }
  for (const std::string& name : names_) {
    std::vector<std::string> unshare{"unshare", "--net"};
    if (own_users_) {
      const std::vector<std::string> as_its_root{"nsenter", "--preserve-credentials", "--user", "--target",
                                                 std::to_string(holders_.front().pid)};
      unshare.insert(unshare.begin(), as_its_root.begin(), as_its_root.end());
    }
    if (!hold(name, unshare)) return false;
  }
  if (!run(kWire, "ip link set lo up")) return false;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const std::string n = std::to_string(i);
    // A veth pair's other end may be put into its namespace at once.
    if (!run(kWire, "ip link add site" + n + " type veth peer name eth0 netns " +
                        std::to_string(holders_[i + 1].pid)) ||
        !run(kWire, "ip addr add 10.77." + n + ".1/24 dev site" + n) ||
        !run(kWire, "ip link set site" + n + " up") ||
        !run(names_[i], "ip addr add 10.77." + n + ".2/24 dev eth0") ||
        !run(names_[i], "ip link set eth0 up") || !run(names_[i], "ip link set lo up")) {
      return false;
    }
  }
  return true;
}

bool NetworkSites::hold(const std::string& site, const std::vector<std::string>& unshare) {
  // "cat" tells that the namespace is there by giving back a letter, and ends when nobody can write to it any
  // more.
  int line[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, line) != 0) {
    problem_ = "no pair of sockets could be made";
    return false;
  }
  std::vector<std::string> words = unshare;
  words.push_back("cat");
  std::vector<char*> argv;
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  const pid_t pid = fork();
  if (pid == 0) {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(line[1], stream);
    execvp(argv[0], argv.data());
    std::perror(argv[0]);
    _exit(127);
  }
  close(line[1]);
  holders_.push_back({site, pid, line[0]});
  std::string said(256, '\0');
  ssize_t got = send(line[0], "+", 1, MSG_NOSIGNAL);  // it may have ended already
  if (got == 1) got = recv(line[0], said.data(), said.size(), 0);
  said.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  if (said == "+") return true;
  problem_ = joined(words) + ": " + said.substr(0, said.find('\n'));
  close(line[0]);
  reap(pid);
  holders_.pop_back();
  return false;
}

bool NetworkSites::run(const std::string& site, const std::string& command) {
  std::string said;
  if (run_program(at(site, {"sh", "-c", command}), said) == 0) return true;
  problem_ = command + " at " + site + ": " + said.substr(0, said.find('\n'));
  return false;
}

void NetworkSites::release() {
  for (const Holder& holder : holders_) close(holder.keep);
  for (const Holder& holder : holders_) reap(holder.pid);
  holders_.clear();
}

int NetworkSites::number(const std::string& site) const {
  return static_cast<int>(std::find(names_.begin(), names_.end(), site) - names_.begin());
}

std::vector<std::string> NetworkSites::at(const std::string& site, std::vector<std::string> command) const {
  const auto holder =
      std::find_if(holders_.begin(), holders_.end(), [&](const Holder& each) { return each.site == site; });
  if (holder == holders_.end()) return command;
  std::vector<std::string> all{"nsenter", "--target", std::to_string(holder->pid), "--net"};
  if (own_users_) all.insert(all.end(), {"--user", "--preserve-credentials"});
  all.push_back("--");
  all.insert(all.end(), command.begin(), command.end());
  return all;
}

std::string NetworkSites::address(const std::string& site) const {
  return "10.77." + std::to_string(number(site)) + ".2";
}

std::string NetworkSites::wire_address(const std::string& site) const {
  return "10.77." + std::to_string(number(site)) + ".1";
}

}  // namespace slosh
