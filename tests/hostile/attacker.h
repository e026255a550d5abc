// A client over real QUIC that means harm: one connection, one kind of harm, then gone in one of several
// ways.
#pragma once

#include <memory>
#include <string>

#include "net/link.h"
#include "net/quic/endpoint.h"
#include "tests/hostile/mischief.h"

namespace slosh::hostile {

/// What there is to attack, and by which links one comes in.
struct Target {
  JoinLink hold;
  JoinLink watch;
};

enum class Harm {
  kSilent,     ///< says nothing
  kHalfOpen,   ///< is gone before the handshake is done
  kGarbage,    ///< bytes on the control stream that are no message
  kControl,    ///< control messages, valid and damaged
  kDatagrams,  ///< datagrams, valid and damaged
  kOutOfTurn,  ///< messages before Hello, Hello twice, the host's own messages
  kThief,      ///< asks for every grip, moves those of others, far away
  kTexts,      ///< names and farewells with escapes
  kDatagramFlood,
  kRequestFlood,
  kStreams,          ///< opens as many streams as it can and fills them
  kMoving,           ///< changes its address all the time
  kLongLength,       ///< a control message that never ends
  kStalled,          ///< comes in, then reads nothing
  kFeedback,         ///< feedback about snapshots that never were
  kLooksOnAndTakes,  ///< a watcher who asks for what only participants may do
  kWrongToken,
};
constexpr std::size_t kHarms = 17;
const char* name_of(Harm harm);

class Attacker final : public EndpointEvents {
 public:
  /// The same seed does the same, as far as the network's timing lets it.
  Attacker(const Target& target, const Identity& identity, std::uint64_t seed);

  /// Does a little, never waits.
  void turn();
  bool over() const { return end_ == nullptr; }
  Harm harm() const { return harm_; }
  bool ramp_work() const { return ramp_; }
  std::uint64_t messages() const { return messages_; }     ///< control messages and datagrams sent
  const std::string& problem() const { return problem_; }  ///< why it could not even begin

  void on_connected(ConnectionId id, const KeyFingerprint&, const std::string&) override;
  void on_stream(ConnectionId, std::int64_t stream, std::span<const std::uint8_t> bytes, bool) override;
  void on_datagram(ConnectionId, std::span<const std::uint8_t>) override {}
  void on_closed(ConnectionId, const CloseReason&) override { closed_ = true; }

 private:
  void act();
  void leave();
  void hello(const std::string& name = {});
  void raw(const wire::Bytes& bytes, bool end = false);
  void raw_datagram(const wire::Bytes& bytes);
  template <class M>
  void say(const M& message) {
    raw(wire::control(message));
  }

  Mischief mischief_;
  Harm harm_;
  wire::Token token_{};
  std::unique_ptr<Endpoint> end_;
  ConnectionId connection_ = 0;
  std::int64_t control_ = -1;
  std::int64_t until_ns_ = 0;
  std::int64_t stalled_until_ns_ = 0;
  std::uint64_t acts_left_ = 0;
  std::uint64_t turns_left_ = 0;  // of a handshake that is not finished
  std::uint64_t number_ = 0;
  std::uint64_t messages_ = 0;
  bool closed_ = false;
  bool ramp_ = false;
  std::string problem_;
};

}  // namespace slosh::hostile
