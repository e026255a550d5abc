// Who may wait at the door: connections from their handshake until they have said Hello.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "net/quic/endpoint.h"

namespace slosh {

struct AdmissionLimits {
  std::size_t a_site = 256;     ///< connections of one site, in or not
  std::size_t strangers = 128;  ///< connections that have not said Hello, of keys that have no seat
  double hello_patience = 3.0;  ///< s until a connection must have said Hello
};

/// Counts by site_of(), and decides who must go. Nobody who has said Hello is ever turned out, nor a key that
/// has a seat, whatever strangers do: of strangers the one that waits longest goes, of the site that has most
/// of them waiting. One thread; knows no clock.
class Admission {
 public:
  explicit Admission(const AdmissionLimits& limits) : limits_(limits) {}

  struct Verdict {
    bool enters = false;               ///< false: too many come from its site
    std::optional<ConnectionId> goes;  ///< who makes room
  };
  /// A handshake is over. `known`: its key has a seat.
  Verdict arrive(ConnectionId connection, const KeyFingerprint& key, const std::string& address, bool known,
                 std::int64_t now_ns);
  /// It said Hello and is in.
  void admit(ConnectionId connection);
  void forget(ConnectionId connection);
  /// Those that have said nothing for too long.
  std::vector<ConnectionId> late(std::int64_t now_ns) const;
  std::size_t strangers() const { return strangers_; }

 private:
  struct Guest {
    KeyFingerprint key{};
    std::string site;
    std::int64_t since_ns = 0;
    bool known = false;
    bool in = false;
  };
  struct Site {
    std::size_t all = 0;
    std::size_t strangers = 0;
  };
  std::optional<ConnectionId> oldest_stranger(const std::string& site) const;

  AdmissionLimits limits_;
  std::map<ConnectionId, Guest> guests_;  // by number: older ones first
  std::map<std::string, Site> sites_;
  std::size_t strangers_ = 0;
};

}  // namespace slosh
