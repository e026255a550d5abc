// Bodies to everybody, hands to everybody else who has hands: as datagrams, at each peer's own pace.
#pragma once

#include <deque>
#include <vector>

#include "host/fluid_demand.h"
#include "host/server/body_parts.h"
#include "host/server/hands.h"
#include "host/server/peer_table.h"
#include "host/server/roster.h"

namespace slosh {

/// Hz at most that bodies are sent at.
struct BodyRates {
  double participant = 500.0;
  double spectator = 60.0;
};

/// One thread, the network's.
class StateSender {
 public:
  /// All must outlive it.
  StateSender(const Scene& scene, Channel& channel, const HandTable& hands, const PeerTable& peers,
              BodyRates rates, FluidDemand* fluid_demand)
      : channel_(channel),
        hands_(hands),
        peers_(peers),
        rates_(rates),
        fluid_demand_(fluid_demand),
        scene_(scene) {
    next_hands_ns_.resize(scene.grips.size());
    for (const Grip& grip : scene.grips) grip_bodies_.push_back(grip.body);
  }
  void use(Endpoint& endpoint) { endpoint_ = &endpoint; }

  /// The newest state of the channel to whoever is due for it, with the ack of their own samples; before it
  /// the fluid's wrenches on what they hold, to who understands them.
  void send_bodies(SeatTable& seats, std::int64_t now_ns);
  /// A sample that went to the world, to the others who have hands; at most about 500 times a second a grip.
  void forward(const Peer& from, const wire::PoseSample& sample, std::int64_t now_ns);
  /// The others see these hands let go.
  void let_go(std::uint32_t seat, const wire::Hands& hands);
  /// What was sent last, or will be.
  const BodyMessage& newest() const { return channel_.bodies().front(); }
  std::uint64_t fluid_models_sent() const { return fluid_models_sent_; }

 private:
  void ask_for_fluid(SeatTable& seats);
  void send_fluid(const Peer& peer, const Seat& seat, const BodyMessage& message);
  BodyParts& parts_for(const Peer& peer);
  void to_other_hands(std::uint32_t but_seat, const wire::Hands& hands);

  Channel& channel_;
  const HandTable& hands_;
  const PeerTable& peers_;
  BodyRates rates_;
  FluidDemand* fluid_demand_;
  /// The newest state, coded for whoever agreed to the same.
  struct Coded {
    wire::Capabilities agreed;
    BodyParts parts;
    bool stale;
  };
  const Scene& scene_;
  std::deque<Coded> coded_;
  std::vector<int> grip_bodies_;          // one a grip
  std::vector<SharedBytes> fluid_coded_;  // one a model of the channel's state; empty = not coded yet
  std::uint64_t fluid_models_sent_ = 0;
  Endpoint* endpoint_ = nullptr;
  std::vector<std::int64_t> next_hands_ns_;  // one a grip: when it may be passed on again
  std::int64_t bodies_sent_ns_ = 0;
};

}  // namespace slosh
