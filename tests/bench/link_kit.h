// Two ends of a link in one thread, for benchmarks: what they count, how they meet, how a link is told in a
// line.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "net/clock.h"
#include "net/quic/endpoint.h"

namespace slosh::bench {

using Bytes = std::vector<std::uint8_t>;

/// How a link fares, in a line; `t` in s.
inline void tell(double t, const ConnectionStats& stats) {
  std::printf(
      "    %5.1f s  window %7.1f kB, in flight %7.1f kB, %7.1f kB/s, RTT %5.1f ms (at least %.1f);"
      " snapshot pieces: %llu sent, %llu dropped; %llu lost\n",
      t, 1e-3 * static_cast<double>(stats.window), 1e-3 * static_cast<double>(stats.in_flight),
      1e-3 * stats.delivery_rate, 1e3 * stats.smoothed_rtt, 1e3 * stats.min_rtt,
      static_cast<unsigned long long>(stats.datagrams_sent[2]),
      static_cast<unsigned long long>(stats.datagrams_dropped[2]),
      static_cast<unsigned long long>(stats.datagrams_lost));
  std::fflush(stdout);
}

inline double thread_cpu() {
  timespec used{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

inline double percentile(std::vector<double>& values, double part) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

struct Quiet : EndpointEvents {
  void on_connected(ConnectionId connection, const KeyFingerprint&, const std::string&) override {
    connections.push_back(connection);
  }
  void on_stream(ConnectionId, std::int64_t, std::span<const std::uint8_t>, bool) override {}
  void on_datagram(ConnectionId, std::span<const std::uint8_t>) override { ++received; }
  void on_closed(ConnectionId, const CloseReason& reason) override {
    std::fprintf(stderr, "a connection ended: %s\n", reason.text.c_str());
  }
  std::vector<ConnectionId> connections;
  std::uint64_t received = 0;
};

inline SharedBytes filled(std::size_t size) {
  return std::make_shared<const Bytes>(size, std::uint8_t{0xa5});
}

/// One after the other until both ends are there. False = not within 20 s.
inline bool meet(Endpoint& host, const Quiet& at_host, Endpoint& peer, const Quiet& at_peer) {
  const std::size_t wanted = at_host.connections.size() + 1;
  const std::int64_t give_up = steady_now_ns() + 20 * kNanosecondsPerSecond;
  while (at_host.connections.size() < wanted || at_peer.connections.empty()) {
    if (steady_now_ns() > give_up) return false;
    host.run_once(steady_now_ns() + 200'000);
    peer.run_once(steady_now_ns() + 200'000);
  }
  return true;
}

}  // namespace slosh::bench
