// Two ends of a QUIC link in one thread, for tests: what each was told, and running both until something
// has happened.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "net/clock.h"
#include "net/quic/client.h"
#include "net/quic/endpoint.h"

namespace slosh::testing {

using Bytes = std::vector<std::uint8_t>;

/// Writes down what an endpoint tells.
class Recorder : public EndpointEvents {
 public:
  void on_connected(ConnectionId connection, const KeyFingerprint& key, const std::string& address) override {
    connected.push_back(connection);
    keys.push_back(key);
    addresses.push_back(address);
  }
  void on_stream(ConnectionId, std::int64_t stream, std::span<const std::uint8_t> bytes, bool end) override {
    Bytes& all = streams[stream];
    all.insert(all.end(), bytes.begin(), bytes.end());
    if (end) ended[stream] = true;
  }
  void on_datagram(ConnectionId, std::span<const std::uint8_t> bytes) override {
    datagrams.emplace_back(bytes.begin(), bytes.end());
  }
  void on_closed(ConnectionId connection, const CloseReason& reason) override {
    closed.push_back(connection);
    reasons.push_back(reason);
  }
  void on_migrated(ConnectionId, const std::string& address) override { migrated.push_back(address); }

  std::vector<ConnectionId> connected;
  std::vector<KeyFingerprint> keys;
  std::vector<std::string> addresses;
  std::map<std::int64_t, Bytes> streams;
  std::map<std::int64_t, bool> ended;
  std::vector<Bytes> datagrams;
  std::vector<ConnectionId> closed;
  std::vector<CloseReason> reasons;
  std::vector<std::string> migrated;
};

/// Takes turns at the ends until `done`, at most `seconds`. False when it never was.
inline bool run_until(const std::vector<Endpoint*>& ends, const std::function<bool()>& done,
                      double seconds = 20.0) {
  const std::int64_t give_up = steady_now_ns() + to_nanoseconds(seconds);
  while (!done()) {
    if (steady_now_ns() > give_up) return false;
    for (Endpoint* end : ends) end->run_once(steady_now_ns() + 500'000);
  }
  return true;
}

/// Runs the ends for a time.
inline void run_for(const std::vector<Endpoint*>& ends, double seconds) {
  const std::int64_t until = steady_now_ns() + to_nanoseconds(seconds);
  run_until(
      ends, [&] { return steady_now_ns() >= until; }, seconds + 20.0);
}

inline SharedBytes shared(Bytes bytes) {
  return std::make_shared<const Bytes>(std::move(bytes));
}

/// A host and a peer that are connected, over `via` if given.
struct Pair {
  explicit Pair(const EndpointOptions& options = {}, const std::string& listen = "127.0.0.1:0")
      : host_identity(Identity::generate()), peer_identity(Identity::generate()), settings(options) {
    auto made = listen_quic(listen, host_identity, host_events, options);
    if (!made) {
      problem = made.error().text();
      return;
    }
    host = std::move(made.value());
  }
  void connect(const std::vector<std::string>& addresses) {
    auto made = connect_quic(addresses, host_identity.fingerprint(), peer_identity, peer_events, settings);
    if (!made) {
      problem = made.error().text();
      return;
    }
    peer = std::move(made.value());
  }
  void connect() { connect({host->local_address()}); }
  bool establish() {
    connect();
    return run([&] { return connected(); });
  }
  bool connected() const { return !host_events.connected.empty() && !peer_events.connected.empty(); }
  bool run(const std::function<bool()>& done, double seconds = 20.0) {
    return peer ? run_until({host.get(), peer.get()}, done, seconds) : run_until({host.get()}, done, seconds);
  }
  ConnectionId at_host() const { return host_events.connected.back(); }
  ConnectionId at_peer() const { return peer_events.connected.back(); }

  Identity host_identity;
  Identity peer_identity;
  EndpointOptions settings;
  Recorder host_events;
  Recorder peer_events;
  std::unique_ptr<Endpoint> host;
  std::unique_ptr<Endpoint> peer;
  std::string problem;
};

}  // namespace slosh::testing
