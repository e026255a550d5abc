#include "hosted_test.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <sstream>

#include "tests/support/comes.h"

namespace slosh::test {

int free_port() {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof at;
  const bool bound = bind(socket, reinterpret_cast<const sockaddr*>(&at), sizeof at) == 0 &&
                     getsockname(socket, reinterpret_cast<sockaddr*>(&at), &size) == 0;
  close(socket);
  return bound ? ntohs(at.sin_port) : 0;
}

void HostedTest::SetUp() {
  std::filesystem::remove_all(test_folder());
  // Short, for a socket's name has to fit into 108 bytes.
  std::string pattern = (std::filesystem::temp_directory_path() / "slosh-XXXXXX").string();
  ASSERT_NE(mkdtemp(pattern.data()), nullptr);
  home_ = pattern;
}

void HostedTest::TearDown() {
  if (!home_.empty()) std::filesystem::remove_all(home_);
}

std::vector<std::string> HostedTest::command(const std::vector<std::string>& arguments) const {
  const std::string home = home_.string();
  std::vector<std::string> all{"env", "XDG_STATE_HOME=" + home, "XDG_DATA_HOME=" + home,
                               "XDG_RUNTIME_DIR=" + home, program()};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return all;
}

std::string HostedTest::link(const std::string& kind) const {
  std::istringstream lines(read_text(folder("host") / "links.txt"));
  std::string word, text, rest;
  while (lines >> word >> text && std::getline(lines, rest)) {
    if (word == kind) return text;
  }
  return {};
}

std::unique_ptr<Process> HostedTest::run(const std::string& name,
                                         const std::vector<std::string>& arguments) const {
  return std::make_unique<Process>(command(arguments), folder(name));
}

bool HostedTest::hosting(Process& host) const {
  return comes([&] { return !link("watch").empty() || !host.running(); }) && host.running();
}

}  // namespace slosh::test
