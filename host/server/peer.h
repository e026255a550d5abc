// One connection to the host, from its first packet to its last.
#pragma once

#include <cstdint>
#include <string>

#include "host/server/token_bucket.h"
#include "net/quic/endpoint.h"
#include "net/wire/stream_splitter.h"

namespace slosh {

/// What one connection may do a second. Twice what an honest peer does at its busiest; a peer far beyond is
/// dropped, so that no other feels it.
struct PeerLimits {
  TokenBucket requests{20.0, 60.0};       ///< control messages that are answered
  TokenBucket excess{10.0, 240.0};        ///< control messages beyond those, before it is dropped
  TokenBucket datagrams{2500.0, 2500.0};  ///< that are looked at
  TokenBucket flood{1000.0, 20000.0};     ///< datagrams beyond those, before it is dropped
  TokenBucket faults{1.0, 30.0};          ///< datagrams that do not decode, before it is dropped
  TokenBucket claims{50.0, 1000.0};       ///< poses for a grip of another's, before it is dropped
};

struct Peer {
  ConnectionId id = 0;
  KeyFingerprint key{};
  std::string address;
  std::int64_t received_ns = 0;  ///< last datagram
  std::int64_t control_stream = -1;
  wire::StreamSplitter splitter;
  PeerLimits limits;

  bool in = false;    ///< said Hello and was let in
  bool gone = false;  ///< closed or closing: nothing more is sent or taken
  std::uint32_t seat = 0;
  wire::Capabilities agreed = 0;
  bool participant = false;
  bool scene_sent = false;
  bool silent = false;  ///< holds a grip and has sent nothing for a while: the others were told
  bool warned_claim = false;
  bool warned_requests = false;
  std::int64_t refusal_line_due_ns = 0;  ///< when the terminal is told again of a wish that was refused
  std::int64_t next_bodies_ns = 0;
};

}  // namespace slosh
