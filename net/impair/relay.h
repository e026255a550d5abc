// A bad network in a box: passes UDP between peers and a host, late, lossy, out of order, or not at all.
//
// Listens like the host and speaks to the host from a port of its own for every peer. Runs in a thread of
// its own. For tests, and for trying slosh on the link that you fear.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sim/math/result.h"

namespace slosh {

/// What one direction does to packets. Probabilities are from 0 to 1, drawn anew for every packet.
struct Impairment {
  double delay = 0.0;           ///< s, on top of the real network's
  double jitter = 0.0;          ///< s, 0 to this much is added; the order stays
  double loss = 0.0;            ///< probability
  double burst = 1.0;           ///< packets that are lost in a row, on average; at least 1
  double duplicate = 0.0;       ///< probability
  double reorder = 0.0;         ///< probability of coming late by `reorder_delay`, behind others
  double reorder_delay = 0.01;  ///< s
  double rate = 0.0;            ///< bytes a s; 0 = no limit
  double queue = 256e3;         ///< bytes that may wait for the rate; more are lost
};

struct RelayOptions {
  std::string listen = "127.0.0.1:0";
  std::string to;  ///< the host
  Impairment up;   ///< peer → host
  Impairment down;
  std::uint64_t seed = 1;  ///< of all random numbers: the same packets at the same times fare the same
};

struct RelayStats {
  std::uint64_t passed[2] = {};   ///< up, down; duplicates count
  std::uint64_t dropped[2] = {};  ///< by loss, queue or darkness
};

class Relay {
 public:
  enum class Way : std::uint8_t { kUp, kDown };
  using Packet = std::vector<std::uint8_t>;

  /// Errors: not an address, in use.
  static Result<std::unique_ptr<Relay>> start(const RelayOptions& options);
  virtual ~Relay() = default;

  virtual std::string address() const = 0;  ///< where it listens

  // From any thread; each holds from the next packet on.
  virtual void set(const Impairment& up, const Impairment& down) = 0;
  virtual void dark(bool cable_pulled) = 0;
  /// Speaks to the host from new ports, as a NAT does that forgot.
  virtual void rebind() = 0;
  /// Keeps copies of the first `count` packets each way from now on.
  virtual void capture(std::size_t count) = 0;
  virtual std::vector<Packet> captured(Way way) const = 0;
  /// Sends a packet as if the peer that spoke last (or the host) had: whatever its bytes, at once.
  virtual void inject(Way way, const Packet& packet) = 0;
  /// May change a packet, or make it empty to lose it. Called in the relay's thread.
  virtual void tamper(std::function<void(Way, Packet&)> change) = 0;
  virtual RelayStats stats() const = 0;
};

}  // namespace slosh
