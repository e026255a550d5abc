// A host over real QUIC that means harm: each guest gets a trick of its own.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "net/codec/snapshot_codec.h"
#include "net/link.h"
#include "net/quic/endpoint.h"
#include "net/wire/stream_splitter.h"
#include "scenes/scene.h"
#include "tests/hostile/mischief.h"

namespace slosh::hostile {

enum class Trick {
  kStates,        ///< comes in as with any host, then states of the world of any content, at any rate
  kEverything,    ///< the same, then everything a host may say, valid and damaged
  kSnapshots,     ///< the same, then pieces of snapshots, damaged
  kTexts,         ///< the same, then notices, names and a farewell with escapes
  kStiff,         ///< a scene whose grips are as stiff as they may be, and bodies that jump
  kBadWelcome,    ///< a Welcome, Roster or WorldInfo that is damaged
  kBadScene,      ///< a scene that is damaged, in one field or in its bits
  kEndlessScene,  ///< one that does not end
  kNoise,         ///< noise on the control stream
  kStreams,       ///< streams that nobody asked for
  kSilence,
  kRefusal,  ///< with escapes in its words
  kClose,    ///< at once, with escapes in its words
};
constexpr std::size_t kTricks = 13;
const char* name_of(Trick trick);

class EvilHost final : public EndpointEvents {
 public:
  /// `scene` is what it pretends to host.
  EvilHost(const Scene& scene, std::uint64_t seed);
  ~EvilHost() override;

  /// Why it does not listen; empty when it does.
  const std::string& problem() const { return problem_; }
  /// A link for guest number `guest`, who gets the trick that the seed has for this number.
  std::string link(std::uint64_t guest) const;
  Trick trick(std::uint64_t guest) const;
  /// Waits for the network a little and does its harm.
  void turn();
  std::uint64_t messages() const {
    return messages_;
  }                                               ///< control messages, datagrams, and pieces of streams
  std::uint64_t guests() const { return came_; }  ///< who said Hello

  void on_connected(ConnectionId id, const KeyFingerprint&, const std::string&) override;
  void on_stream(ConnectionId id, std::int64_t stream, std::span<const std::uint8_t> bytes, bool) override;
  void on_datagram(ConnectionId id, std::span<const std::uint8_t> bytes) override;
  void on_closed(ConnectionId id, const CloseReason&) override;

 private:
  struct Guest;
  void greet(Guest& guest);
  void enter(Guest& guest, const Scene& scene);
  void harm(Guest& guest);
  void states(Guest& guest);
  void snapshots(Guest& guest);
  void leave(Guest& guest);
  void raw(Guest& guest, const wire::Bytes& bytes);
  void raw_datagram(Guest& guest, const wire::Bytes& bytes, Priority priority = Priority::kState);
  void stream(Guest& guest, const wire::Bytes& bytes, bool end);
  template <class M>
  void say(Guest& guest, const M& message) {
    raw(guest, wire::control(message));
  }

  const Scene& scene_;
  const std::uint64_t seed_;
  const std::int64_t began_ns_;
  Identity identity_ = Identity::generate();
  std::unique_ptr<Endpoint> end_;
  std::map<ConnectionId, std::unique_ptr<Guest>> guests_;
  std::uint64_t messages_ = 0;
  std::uint64_t came_ = 0;
  std::string problem_;
};

}  // namespace slosh::hostile
