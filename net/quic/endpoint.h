// One UDP socket (or two: IPv4 and IPv6) with its QUIC connections, as the rest of slosh sees it.
//
// One thread owns an endpoint: it calls run_once() and everything else but wake(), and gets the events from
// inside run_once(). ngtcp2 stays behind this page.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/math/result.h"

namespace slosh {

/// SHA-256 of a certificate's SubjectPublicKeyInfo: who somebody is.
using KeyFingerprint = std::array<std::uint8_t, 32>;

/// An Ed25519 key pair with a self-signed certificate made from it in memory.
class Identity {
 public:
  static Identity generate();
  /// From private_key() of an earlier one. Errors: not an Ed25519 key.
  static Result<Identity> from_private_key(std::span<const std::uint8_t> key);
  std::vector<std::uint8_t> private_key() const;  ///< PKCS #8 DER; keep it secret
  const KeyFingerprint& fingerprint() const;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  std::shared_ptr<const Impl> impl_;
};

/// Order of sending when the link is full: pose before state before snapshot. Streams come last, but get one
/// packet after every fifteen snapshots.
enum class Priority : std::uint8_t { kPose, kState, kSnapshot };
constexpr int kPriorities = 3;

using ConnectionId = std::uint64_t;  ///< never 0, never used twice in an endpoint's life
using SharedBytes = std::shared_ptr<const std::vector<std::uint8_t>>;

struct ConnectionStats {
  double smoothed_rtt = 0.0;     ///< s
  double rtt_variance = 0.0;     ///< s
  double min_rtt = 0.0;          ///< s
  std::uint64_t window = 0;      ///< bytes that may be in flight
  std::uint64_t in_flight = 0;   ///< bytes
  double delivery_rate = 0.0;    ///< bytes a s, the most of the last seconds; 0 = not known yet
  std::uint64_t bytes_sent = 0;  ///< of UDP payload
  std::uint64_t bytes_received = 0;
  std::uint64_t datagrams_sent[kPriorities] = {};
  std::uint64_t datagrams_dropped[kPriorities] = {};  ///< from a full queue, oldest first
  std::uint64_t datagrams_lost = 0;                   ///< sent and never acknowledged
  std::uint64_t migrations = 0;
};

/// What a connection's end means to who wants it.
enum class CloseCause : std::uint8_t {
  kClosed,    ///< one side closed it, and said why
  kNoAnswer,  ///< there never was one: nothing came from there
  kBusy,      ///< the host has no room or no time now: trying again helps, with the same link
  kTimedOut,  ///< nothing was heard for too long
  kLost,      ///< the other side has started anew and knows it no more
  kRefused,   ///< key, protocol or encryption do not agree: trying again is no use
  kBroken,    ///< somebody broke the rules of QUIC
};

/// Who ended a connection, in words.
struct CloseReason {
  bool by_peer = false;
  std::uint64_t code = 0;  ///< application error code, or 0
  std::string text;        ///< "timed out", "the host's key is not the one in the link", …
  CloseCause cause = CloseCause::kClosed;
};

/// What an endpoint tells its owner. Called from run_once(); may call back into the endpoint.
class EndpointEvents {
 public:
  virtual ~EndpointEvents() = default;
  /// The handshake is confirmed by both sides. `key` is the other's.
  virtual void on_connected(ConnectionId connection, const KeyFingerprint& key,
                            const std::string& address) = 0;
  virtual void on_stream(ConnectionId connection, std::int64_t stream, std::span<const std::uint8_t> bytes,
                         bool end) = 0;
  virtual void on_datagram(ConnectionId connection, std::span<const std::uint8_t> bytes) = 0;
  /// Nothing of this connection follows.
  virtual void on_closed(ConnectionId connection, const CloseReason& reason) = 0;
  /// The other side now sends from elsewhere.
  virtual void on_migrated(ConnectionId connection, const std::string& address) {
    (void)connection, (void)address;
  }
};

struct EndpointOptions {
  double idle_timeout = 5.0;            ///< s without a packet after which a connection is gone
  double keep_alive = 1.0;              ///< s between packets at the longest
  double handshake_timeout = 5.0;       ///< s
  std::size_t max_connections = 512;    ///< of a host
  std::size_t max_strangers = 512;      ///< of those, not admitted: a newcomer takes the place of one of them
  double handshakes_per_second = 25.0;  ///< begun by one site (IPv4 address, IPv6 /64); twice that at once
  double handshakes_in_all = 100.0;     ///< a s, begun by all sites that nobody was admitted from lately
  std::size_t queue_datagrams[kPriorities] = {64, 64, 512};  ///< a connection's; the oldest go first
  std::size_t stream_buffer = 80u << 20;  ///< bytes of unacknowledged stream data a connection may hold
  std::function<std::int64_t()> clock;    ///< ns; empty = the steady one. With one, run_once() never waits
};

/// In-memory counters of what an endpoint refused before it kept any state.
struct EndpointStats {
  std::uint64_t retries_sent = 0;
  std::uint64_t packets_ignored = 0;  ///< not QUIC, unknown connection, bad Retry token, too many at once
  std::uint64_t handshakes_failed = 0;
  std::uint64_t handshakes_put_off = 0;  ///< too many at once; the other side asks again by itself
  std::uint64_t strangers_put_out = 0;   ///< for a newcomer, with CloseCause::kBusy at the other side
  std::size_t connections = 0;
  std::size_t strangers = 0;  ///< of those, not admitted
};

class Endpoint {
 public:
  virtual ~Endpoint() = default;

  /// Waits for packets, timers and wake() at most until `deadline_ns` (steady clock), handles what there is,
  /// sends what is queued, returns.
  virtual void run_once(std::int64_t deadline_ns) = 0;
  /// Ends a run_once() that waits. Any thread, also a signal handler.
  virtual void wake() = 0;

  /// Queues a datagram of at most wire::kMaxDatagram bytes; the oldest of its priority goes when the queue is
  /// full. False when the connection is gone or the datagram too long. The bytes may be shared by many.
  virtual bool send_datagram(ConnectionId connection, Priority priority, SharedBytes bytes) = 0;
  /// -1 when none can be opened (yet). One-way streams are the host's alone.
  virtual std::int64_t open_stream(ConnectionId connection, bool both_ways) = 0;
  /// Queues stream bytes; false when the connection is gone or its buffer is full.
  virtual bool send_stream(ConnectionId connection, std::int64_t stream, std::span<const std::uint8_t> bytes,
                           bool end) = 0;
  /// The same without a copy, where the endpoint can: it holds on to the bytes, which many connections may
  /// share, until they are acknowledged.
  virtual bool send_shared(ConnectionId connection, std::int64_t stream, SharedBytes bytes, bool end) {
    return send_stream(connection, stream, *bytes, end);
  }
  /// Sends what is queued on streams first, as far as the window lets it, then closes. `text` reaches the
  /// other side. Nothing but on_closed() comes of the connection after this.
  virtual void close(ConnectionId connection, std::uint64_t code, const std::string& text) = 0;

  // Who is a stranger, for a host. Every connection is one until the layer above has let its owner in.
  // Strangers never take the place of those who are in, nor of each other's sites: when all their places are
  // taken, a newcomer gets that of the oldest of the site that has the most.
  /// `connection` belongs to somebody who was let in. Their site is trusted for an hour: its next handshakes
  /// are not held back by what others begin.
  virtual void admit(ConnectionId connection) { (void)connection; }
  /// From now on who has a key for which `known` says so counts as let in from the end of the handshake.
  /// Called from run_once().
  virtual void set_known_keys(std::function<bool(const KeyFingerprint&)> known) { (void)known; }

  virtual ConnectionStats stats(ConnectionId connection) const = 0;
  virtual EndpointStats endpoint_stats() const = 0;
  virtual std::string local_address() const = 0;  ///< "127.0.0.1:4433", "[::]:4433"

  /// Goes on from a new socket, as after a change of network. A peer's endpoint does so by itself when the
  /// network fails it. False when there is nothing to move.
  virtual bool rebind() { return false; }
};

/// Listens at "HOST:PORT" or "[IPv6]:PORT" ("0.0.0.0:0" takes any port; "[::]:PORT" takes IPv4 too). Every
/// first packet is answered with a Retry token and no state. Errors: not an address, in use, not allowed.
Result<std::unique_ptr<Endpoint>> listen_quic(const std::string& address, const Identity& identity,
                                              EndpointEvents& events, const EndpointOptions& options = {});

/// Whether listen_quic would get that address now. Errors: its own.
Result<bool> can_listen(const std::string& address);

/// Connects to the first of `addresses` that answers (all tried at once) with the key `host`. Returns before
/// the handshake; on_connected or on_closed follow. One connection an endpoint. Errors: not an address, no
/// socket.
Result<std::unique_ptr<Endpoint>> connect_quic(const std::vector<std::string>& addresses,
                                               const KeyFingerprint& host, const Identity& identity,
                                               EndpointEvents& events, const EndpointOptions& options = {});

}  // namespace slosh
