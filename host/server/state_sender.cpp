#include "host/server/state_sender.h"

#include <algorithm>

#include "net/clock.h"
#include "net/wire/fluid_wrench.h"

namespace slosh {
namespace {

constexpr std::int64_t kHandsEvery = 1'900'000;       // ns
constexpr std::int64_t kStandingEvery = 100'000'000;  // ns between two sendings of bodies that stand still

}  // namespace

void StateSender::send_bodies(SeatTable& seats, std::int64_t now_ns) {
  const bool fresh = channel_.bodies().update();
  for (Coded& coded : coded_) coded.stale = coded.stale || fresh;
  if (fresh) fluid_coded_.assign(channel_.bodies().front().fluid_models.size(), nullptr);
  ask_for_fluid(seats);
  if (peers_.nobody_sits()) return;
  const BodyMessage& message = channel_.bodies().front();
  const bool standing = !fresh && now_ns - bodies_sent_ns_ >= kStandingEvery;
  if (!fresh && !standing) return;
  bodies_sent_ns_ = now_ns;
  peers_.each_in([&](Peer& peer) {
    const std::int64_t every =
        to_nanoseconds(1.0 / (peer.participant ? rates_.participant : rates_.spectator));
    if (!standing && message.rate > 0.0 && now_ns < peer.next_bodies_ns) return;
    peer.next_bodies_ns = std::max(peer.next_bodies_ns, now_ns - every) + every;
    const Seat& seat = *seats.by_number(peer.seat);
    send_fluid(peer, seat, message);
    std::uint64_t number = 0;
    std::int64_t stamp = 0;
    for (const std::uint32_t grip : seat.grips) {
      if (grip >= message.pose_numbers.size()) continue;
      const HandTable::Used used = hands_.used(grip, message.pose_numbers[grip]);
      if (used.number == 0 || (number != 0 && used.stamp_ns <= stamp)) continue;
      number = used.number;
      stamp = used.stamp_ns;
    }
    for (const SharedBytes& bytes : parts_for(peer).to(number, stamp))
      endpoint_->send_datagram(peer.id, Priority::kState, bytes);
  });
}

void StateSender::ask_for_fluid(SeatTable& seats) {
  if (!fluid_demand_) return;
  std::uint64_t grips = 0;
  peers_.each_in([&](const Peer& peer) {
    if (!(peer.agreed & wire::kFluidWrenches)) return;
    for (const std::uint32_t grip : seats.by_number(peer.seat)->grips) grips |= std::uint64_t{1} << grip;
  });
  fluid_demand_->want(grips);
}

void StateSender::send_fluid(const Peer& peer, const Seat& seat, const BodyMessage& message) {
  if (!(peer.agreed & wire::kFluidWrenches)) return;
  for (std::size_t i = 0; i < message.fluid_models.size(); ++i) {
    const FluidWrenchModel& model = message.fluid_models[i];
    const auto on_it = [&](std::uint32_t grip) {
      return grip < grip_bodies_.size() && grip_bodies_[grip] == static_cast<int>(model.body);
    };
    if (std::none_of(seat.grips.begin(), seat.grips.end(), on_it)) continue;
    SharedBytes& bytes = fluid_coded_[i];
    if (!bytes)
      bytes = std::make_shared<const wire::Bytes>(wire::datagram(wire::to_message(model, message.run)));
    endpoint_->send_datagram(peer.id, Priority::kState, bytes);
    fluid_models_sent_ += 1;
  }
}

/// Coded for a peer's capabilities, when the first such peer is due.
BodyParts& StateSender::parts_for(const Peer& peer) {
  const wire::Capabilities agreed = peer.agreed & (wire::kCouplings | wire::kHolds);
  auto coded = std::find_if(coded_.begin(), coded_.end(), [&](const Coded& c) { return c.agreed == agreed; });
  if (coded == coded_.end()) coded = coded_.insert(coded_.end(), {agreed, BodyParts(scene_, agreed), true});
  if (coded->stale) {
    const BodyMessage& message = channel_.bodies().front();
    std::vector<std::uint64_t> numbers(message.pose_numbers.size());
    for (std::size_t g = 0; g < numbers.size() && g < hands_.size(); ++g)
      numbers[g] = hands_.used(g, message.pose_numbers[g]).number;
    coded->parts.set(message, numbers);
  }
  coded->stale = false;
  return coded->parts;
}

void StateSender::forward(const Peer& from, const wire::PoseSample& sample, std::int64_t now_ns) {
  std::int64_t& next = next_hands_ns_[sample.grip];
  if (now_ns < next) return;
  next = std::max(next, now_ns - kHandsEvery) + kHandsEvery;
  wire::Hands hands;
  hands.hands.push_back(
      {sample.grip, now_ns, sample.pose, sample.twist, sample.engaged != wire::HoldsOn::kNo});
  to_other_hands(from.seat, hands);
}

void StateSender::let_go(std::uint32_t seat, const wire::Hands& hands) {
  if (!hands.hands.empty()) to_other_hands(seat, hands);
}

void StateSender::to_other_hands(std::uint32_t but_seat, const wire::Hands& hands) {
  SharedBytes bytes;
  peers_.each_in([&](const Peer& other) {
    if (!other.participant || other.seat == but_seat) return;
    if (!bytes) bytes = std::make_shared<const wire::Bytes>(wire::datagram(hands));
    endpoint_->send_datagram(other.id, Priority::kPose, bytes);
  });
}

}  // namespace slosh
