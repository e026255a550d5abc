#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <system_error>
#include <vector>

#include "net/text/clean.h"
#include "peer/app/devices.h"
#include "peer/devices/hardware.h"
#include "peer/output/child_process.h"
#include "peer/output/whole_file.h"

namespace slosh {
namespace {

/// The command that puts the rule there, word by word, without sudo.
std::vector<std::string> install_command(const std::string& file) {
  std::error_code none;
  std::vector<std::string> words{std::filesystem::read_symlink("/proc/self/exe", none).string(), "devices",
                                 "--install-udev-rule"};
  if (file != kUdevRuleFile) {
    words.emplace_back("--rule-file");
    words.push_back(std::filesystem::absolute(file, none).string());
  }
  return words;
}

std::string in_one_line(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + word;
  return clean_text(line, 4000);
}

/// At this terminal, which a password may be asked on: sudo's own words are seen as they are. Its exit code,
/// or 128 and the signal; −1: it cannot be started.
int run_at_terminal(const std::vector<std::string>& words) {
  std::vector<char*> argv;
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  pid_t pid = -1;
  if (posix_spawnp(&pid, argv[0], nullptr, nullptr, argv.data(), environ) != 0) return -1;
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Whether udev took the new rule up; where it did not, a device has to be plugged in again.
bool udev_took_it() {
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"udevadm", "control", "--reload"}, {"udevadm", "trigger", "--settle"}}) {
    Result<std::unique_ptr<ChildProcess>> child = ChildProcess::start(command);
    if (!child || !child.value()->finish()) return false;
  }
  return true;
}

bool someone_says_yes(const char* question) {
  std::printf("%s [y/N] ", question);
  std::fflush(stdout);
  std::string answer;
  return std::getline(std::cin, answer) && !answer.empty() && (answer[0] == 'y' || answer[0] == 'Y');
}

bool may_write(const std::string& file) {
  // It is put there whole, by its folder.
  const std::string folder = std::filesystem::path(file).parent_path().string();
  return access(folder.empty() ? "." : folder.c_str(), W_OK) == 0;
}

}  // namespace

int install_rule(const std::string& file) {
  const Result<bool> written = write_whole(file, udev_rule());
  if (!written) {
    std::printf("%s", udev_rule().c_str());
    return fail({file, "the rule above cannot be written there",
                 "As root, save it there and run `udevadm control --reload && udevadm trigger`; for example: "
                 "sudo " +
                     in_one_line(install_command(file))});
  }
  (void)chmod(file.c_str(), S_IRUSR | S_IWUSR | S_IRGRP | S_IROTH);
  std::printf("Written: %s\n", clean_text(file, kMaxTextBytes).c_str());
  if (file != kUdevRuleFile) return kExitOk;
  std::printf(udev_took_it()
                  ? "udev has taken it up.\n"
                  : "Run `udevadm control --reload && udevadm trigger`, or plug the devices in again.\n");
  return kExitOk;
}

bool offer_rule(const std::string& file) {
  std::vector<std::string> command = install_command(file);
  const bool writes = may_write(file);
  if (!writes) command.insert(command.begin(), "sudo");
  const std::string line = in_one_line(command);
  std::printf("\nThe rule that lets whoever sits here open them (%s):\n%s\nPut it there, once, by:\n    %s\n",
              clean_text(file, kMaxTextBytes).c_str(), udev_rule().c_str(), line.c_str());
  if (isatty(STDIN_FILENO) == 0 || isatty(STDOUT_FILENO) == 0) return false;
  if (!writes && !program_there("sudo")) {
    std::printf("That needs root, and there is no sudo here: as root, run what follows the word.\n");
    return false;
  }
  if (!someone_says_yes(writes ? "Do that now?" : "Do that now? sudo may ask for your password."))
    return false;
  const int code = run_at_terminal(command);
  if (code == 0) return true;
  (void)fail({"sudo",
              code < 0 ? "cannot be started"
                       : "it ended with " + std::to_string(code) + ", and the rule is not in place",
              "As root, save the rule above as " + clean_text(file, kMaxTextBytes) +
                  " and run `udevadm control --reload && udevadm trigger`"});
  return false;
}

}  // namespace slosh
