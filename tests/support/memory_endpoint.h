// A network within the process, for tests: one end that listens and any number that connect, with delay, loss
// and a rate where asked for.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <random>
#include <string>
#include <vector>

#include "net/quic/endpoint.h"

namespace slosh {

/// Of each direction of each connection. Streams lose nothing and keep their order.
struct MemoryLink {
  double delay = 0.0;             ///< s, one way
  double jitter = 0.0;            ///< s, added to datagrams, evenly from 0 up; they may overtake each other
  double loss = 0.0;              ///< share of the datagrams, 0–1
  double bytes_per_second = 0.0;  ///< of datagrams; 0 = no limit
};

enum class MemoryClock {
  kManual,  ///< stands until advance(); run_once() hands over what is due and returns at once
  kSteady,  ///< the steady clock; run_once() waits, for ends that have threads of their own
};

/// Must outlive its endpoints. Any thread; each endpoint belongs to one, as real ones do.
class MemoryNetwork {
 public:
  explicit MemoryNetwork(MemoryClock clock = MemoryClock::kManual, const MemoryLink& link = {},
                         std::uint64_t seed = 1);
  ~MemoryNetwork();

  /// The one end that others connect to. `key` is what they see.
  std::unique_ptr<Endpoint> listen(EndpointEvents& events, const KeyFingerprint& key = {},
                                   const EndpointOptions& options = {});
  /// One connection to the end that listens. `address` is what that end is told. Where nobody listens,
  /// on_closed follows.
  std::unique_ptr<Endpoint> connect(EndpointEvents& events, const KeyFingerprint& key,
                                    const std::string& address = "192.0.2.1:50000",
                                    const EndpointOptions& options = {});

  std::int64_t now_ns() const;
  void advance(double seconds);  ///< kManual only
  /// From now on, for every connection, or for those of one connected endpoint.
  void set_link(const MemoryLink& link);
  void set_link(const Endpoint& connected, const MemoryLink& link);
  /// Pulls (or plugs in) that endpoint's cable: nothing passes, and after the idle timeout both ends are
  /// told.
  void set_dark(const Endpoint& connected, bool dark);

  struct Impl;

 private:
  std::shared_ptr<Impl> impl_;
};

}  // namespace slosh
