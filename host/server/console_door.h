// Where console lines of other programs come in: a Unix socket that only its owner may open.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host/server/outcome.h"
#include "sim/math/result.h"

namespace slosh {

/// $XDG_RUNTIME_DIR/slosh, else /tmp/slosh-UID: where running hosts have their sockets.
std::filesystem::path console_folder();
std::filesystem::path console_socket(std::uint16_t port);
/// Ports of the hosts that have a socket there (a host that crashed leaves one).
std::vector<std::uint16_t> console_ports();

/// Sends one line to the host of that port and returns what came of it. Errors: no such host, no answer.
Result<Outcome> ask_console(std::uint16_t port, const std::string& line);

/// The host's end. One thread.
class ConsoleDoor {
 public:
  using Answer = std::function<Outcome(const std::string& line)>;

  /// Errors: the folder is somebody else's, the socket cannot be made.
  static Result<std::unique_ptr<ConsoleDoor>> open(std::uint16_t port);
  ~ConsoleDoor();
  ConsoleDoor(const ConsoleDoor&) = delete;
  ConsoleDoor& operator=(const ConsoleDoor&) = delete;

  /// Waits for lines at most so long, or until `also` (a file descriptor, −1 for none) has something to read,
  /// and answers those that came.
  void serve(int wait_ms, int also, const Answer& answer);

 private:
  ConsoleDoor() = default;
  struct Caller {
    int fd = -1;
    std::string line;
  };
  bool receive(Caller& caller, const Answer& answer);

  std::filesystem::path path_;
  int listening_ = -1;
  std::vector<Caller> callers_;
};

}  // namespace slosh
