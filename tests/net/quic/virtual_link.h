// A host and a peer of ours, and a bad network between them, on a clock that the test moves: minutes pass in
// a second, and the same every time but for what keys and random ids change. The sockets are real.
#pragma once

#include <sys/socket.h>
#include <unistd.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "net/impair/fate.h"
#include "net/quic/address.h"
#include "tests/net/quic/ends.h"

namespace slosh::testing {

class VirtualLink {
 public:
  explicit VirtualLink(const Impairment& up, const Impairment& down, std::uint64_t seed = 1)
      : fates_{Fate(up, seed), Fate(down, seed + 1)} {
    EndpointOptions options;
    options.clock = [this] { return now_ns; };
    options.queue_datagrams[0] = 8;  // as a peer's
    options.keep_alive = 0.5;
    const Identity key = Identity::generate();
    host = std::move(listen_quic("127.0.0.1:0", key, host_events, options).value());
    host_address_ = resolved(host->local_address());
    for (int& descriptor : sockets_) descriptor = open_socket();
    quic::Address near;
    near.length = sizeof(near.v6);
    getsockname(sockets_[0], &near.any, &near.length);
    peer = std::move(
        connect_quic({near.text()}, key.fingerprint(), Identity::generate(), peer_events, options).value());
  }
  ~VirtualLink() {
    for (const int descriptor : sockets_) close(descriptor);
  }
  VirtualLink(const VirtualLink&) = delete;

  /// Half a millisecond passes.
  void step() {
    now_ns += 500'000;
    peer->run_once(now_ns);
    if (!stands) carry(0);
    host->run_once(now_ns);
    if (!stands) carry(1);
    deliver();
  }
  bool until(const std::function<bool()>& done, double seconds = 30.0) {
    for (double passed = 0.0; passed < seconds; passed += 0.5e-3) {
      if (done()) return true;
      step();
    }
    return done();
  }
  bool connect() {
    return until([&] { return !host_events.connected.empty() && !peer_events.connected.empty(); });
  }
  ConnectionId at_host() const { return host_events.connected.back(); }
  ConnectionId at_peer() const { return peer_events.connected.back(); }
  void set(const Impairment& up, const Impairment& down) { fates_[0].set(up), fates_[1].set(down); }

  std::int64_t now_ns = kNanosecondsPerSecond;
  bool stands = false;  ///< what is sent waits, as far as the sockets' buffers reach
  Recorder host_events;
  Recorder peer_events;
  std::unique_ptr<Endpoint> host;
  std::unique_ptr<Endpoint> peer;
  std::uint64_t dropped[2] = {};  // up, down
  std::uint64_t carried[2] = {};

 private:
  static int open_socket() {
    const int descriptor = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    quic::Address any = quic::resolve("127.0.0.1:0").value().front();
    bind(descriptor, &any.any, any.length);
    return descriptor;
  }
  /// A peer that comes from another port does so at the host too, and what was sent to the old one is lost.
  void follow(const quic::Address& from) {
    if (peer_address_.length != 0 && !(from == peer_address_)) {
      close(sockets_[1]);
      sockets_[1] = open_socket();
      std::erase_if(under_way_, [](const auto& entry) { return entry.second.way == 1; });
    }
    peer_address_ = from;
  }
  static quic::Address resolved(const std::string& text) { return quic::resolve(text).value().front(); }

  /// What one end has sent gets its fate. 0 is from the peer, 1 from the host.
  void carry(int way) {
    std::uint8_t buffer[2048];
    for (;;) {
      quic::Address from;
      from.length = sizeof(from.v6);
      const ssize_t size = recvfrom(sockets_[way], buffer, sizeof(buffer), 0, &from.any, &from.length);
      if (size < 0) return;
      if (way == 0) follow(from);
      const Fate::Verdict verdict = fates_[way].judge(static_cast<std::size_t>(size), now_ns);
      carried[way] += 1;
      dropped[way] += verdict.copies == 0 ? 1 : 0;
      for (int copy = 0; copy < verdict.copies; ++copy)
        under_way_.emplace(verdict.due_ns, Packet{way, Bytes(buffer, buffer + size)});
    }
  }
  void deliver() {
    while (!under_way_.empty() && under_way_.begin()->first <= now_ns) {
      const Packet& packet = under_way_.begin()->second;
      const quic::Address& to = packet.way == 0 ? host_address_ : peer_address_;
      sendto(sockets_[1 - packet.way], packet.bytes.data(), packet.bytes.size(), 0, &to.any, to.length);
      under_way_.erase(under_way_.begin());
    }
  }

  struct Packet {
    int way;
    Bytes bytes;
  };
  Fate fates_[2];
  int sockets_[2] = {};  // towards the peer, towards the host
  quic::Address host_address_;
  quic::Address peer_address_;
  std::multimap<std::int64_t, Packet> under_way_;
};

}  // namespace slosh::testing
