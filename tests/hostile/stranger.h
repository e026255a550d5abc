// Somebody who speaks no QUIC at all, or only looks as if: packets that are noise or begin like a handshake.
#pragma once

#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

#include "net/quic/address.h"
#include "tests/hostile/mischief.h"

namespace slosh::hostile {

class Stranger {
 public:
  explicit Stranger(const std::string& host) {
    const auto addresses = quic::resolve(host);
    if (!addresses) return;
    const quic::Address& address = addresses.value().front();
    socket_ = socket(address.any.sa_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (connect(socket_, &address.any, address.length) != 0) problem_ = true;
  }
  ~Stranger() {
    if (socket_ >= 0) close(socket_);
  }
  Stranger(const Stranger&) = delete;
  Stranger& operator=(const Stranger&) = delete;

  void send(Mischief& mischief) {
    if (socket_ < 0 || problem_) return;
    wire::Bytes packet = mischief.noise(1400);
    if (packet.size() > 8 && mischief.one_in(2)) {  // a long header of version 1, of every type
      packet[0] = static_cast<std::uint8_t>(0xc0 | mischief.below(64));
      packet[1] = packet[2] = packet[3] = 0;
      packet[4] = 1;
      packet[5] = static_cast<std::uint8_t>(mischief.below(22));
    }
    (void)!::send(socket_, packet.data(), packet.size(), MSG_NOSIGNAL);
    sent_ += 1;
  }
  std::uint64_t sent() const { return sent_; }

 private:
  int socket_ = -1;
  bool problem_ = false;
  std::uint64_t sent_ = 0;
};

}  // namespace slosh::hostile
