#include "peer/remote/pose_uplink.h"

#include <algorithm>

namespace slosh {
namespace {

wire::HoldsOn holds_on(const PoseMessage& message, wire::Capabilities agreed) {
  if (!message.engaged) return wire::HoldsOn::kNo;
  const bool waits = !message.felt && (agreed & wire::kFeltHands) != 0;
  return waits ? wire::HoldsOn::kUnfelt : wire::HoldsOn::kYes;
}

wire::PoseSample sample_of(const PoseMessage& message, std::uint32_t grip, std::uint64_t number,
                           wire::Capabilities agreed) {
  wire::PoseSample sample;
  sample.grip = grip;
  sample.number = number;
  sample.stamp_ns = message.stamp_ns;
  sample.time = message.time;
  sample.pose = message.pose;
  sample.twist = message.twist;
  sample.engaged = holds_on(message, agreed);
  sample.energy = message.energy;
  return sample;
}

/// What a host would refuse, and our connection with it, is not sent: a device that is out of the world.
bool can_be_sent(const wire::PoseSample& s) {
  const auto within = [](const glm::dvec3& v, double limit) {
    return std::abs(v.x) <= limit && std::abs(v.y) <= limit && std::abs(v.z) <= limit;
  };
  return within(s.pose.position, wire::kMaxPosition) && within(s.twist.linear, wire::kMaxSpeed) &&
         within(s.twist.angular, wire::kMaxSpeed) && s.time >= -1.0 && s.time <= wire::kMaxTime &&
         std::abs(s.energy) <= wire::kMaxEnergy;
}

}  // namespace

PoseUplink::Reading PoseUplink::reading(std::size_t grip, std::uint64_t number) const {
  if (grip >= hands_.size() || number == 0) return {};
  const Reading& known = hands_[grip].known[number % kRemembered];
  return known.number == number ? known : Reading{};
}

void PoseUplink::resolve(BodyMessage& state, const std::vector<bool>& held) const {
  for (std::size_t g = 0; g < state.hands.size() && g < held.size(); ++g) {
    if (!held[g]) continue;
    const Reading read = reading(g, state.hands[g].number);
    state.hands[g].read_ns = read.stamp_ns;
    state.hands[g].time = read.time;
  }
}

SharedBytes PoseUplink::make(const std::vector<bool>& held, wire::Capabilities agreed) {
  bool anything_new = false;
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    Hand& hand = hands_[i];
    if (i >= held.size() || !held[i]) {
      hand.last.clear();
      continue;
    }
    channel_.pose(i).update();
    const PoseMessage& message = channel_.pose(i).front();
    if (message.stamp_ns == hand.last_stamp_ns || message.stamp_ns == 0) continue;
    hand.last_stamp_ns = message.stamp_ns;
    const wire::PoseSample sample = sample_of(message, static_cast<std::uint32_t>(i), hand.next, agreed);
    if (!can_be_sent(sample)) continue;
    hand.known[hand.next % kRemembered] = {hand.next, sample.stamp_ns, sample.time};
    hand.next += 1;
    hand.last.push_front(sample);
    if (hand.last.size() > kPoseSends) hand.last.pop_back();
    numbered_ += 1;
    anything_new = true;
  }
  if (!anything_new) return nullptr;

  // The newest of every hand first: when they do not all fit, the oldest repeats stay away.
  wire::Poses poses;
  std::size_t bytes = 2;  // type and count
  for (std::size_t age = 0; age < kPoseSends; ++age) {
    for (const Hand& hand : hands_) {
      if (age >= hand.last.size() || poses.samples.size() >= wire::kMaxPoseRepeats) continue;
      const std::size_t size = wire::encoded(hand.last[age], agreed).size();
      if (bytes + size > wire::kMaxDatagram) continue;
      bytes += size;
      poses.samples.push_back(hand.last[age]);
    }
  }
  return std::make_shared<const std::vector<std::uint8_t>>(wire::datagram(poses, nullptr, agreed));
}

}  // namespace slosh
