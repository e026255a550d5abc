#include "host/server/hands.h"

#include <algorithm>

#include "net/clock.h"
#include "net/engagement.h"
#include "net/grip_start.h"

namespace slosh {
namespace {

// Two clocks drift apart by less than this, s a s.
constexpr double kDrift = 2e-4;
// ns: an older sample is a clock that was set anew, not a delay.
constexpr std::int64_t kOldest = 5'000'000'000;

}  // namespace

HandTable::HandTable(const Scene& scene, Channel& channel) : channel_(channel) {
  for (std::size_t i = 0; i < scene.grips.size(); ++i) {
    GripHand hand;
    hand.start = grip_start(scene, i);
    hand.body = scene.grips[i].body;
    hand.known.resize(kRemembered);
    grips_.push_back(std::move(hand));
  }
}

void HandTable::publish(std::size_t grip, const PoseMessage& message) {
  grips_[grip].last = message.pose;
  grips_[grip].engaged = message.engaged;
  grips_[grip].energy = message.energy;
  PoseMessage& up = channel_.pose(grip).back();
  up = message;
  up.hold = grips_[grip].hold;
  channel_.pose(grip).publish();
}

void HandTable::put_on_stand(std::size_t grip, const Pose& pose, std::int64_t now_ns, bool kept) {
  GripHand& hand = grips_[grip];
  hand.stand = true;
  hand.kept = kept;
  hand.hold += 1;
  PoseMessage message;
  message.device = static_cast<std::uint32_t>(grip);
  message.stamp_ns = now_ns;
  message.pose = pose;
  message.engaged = true;
  message.stand = true;
  // What stands still puts nothing in; what whom it stands for put in stays. Without it the balance that
  // others share (HeldBody) went by all of that, and came back by it with the hand.
  message.counted = true;
  message.energy = hand.energy;
  message.number = hand.base + hand.newest;
  publish(grip, message);
}

void HandTable::stand_all(std::int64_t now_ns) {
  for (std::size_t i = 0; i < grips_.size(); ++i) {
    if (!grips_[i].held) put_on_stand(i, grips_[i].start, now_ns, false);
  }
}

void HandTable::carry_on(const BodySnapshot& bodies, std::int64_t now_ns, const std::vector<bool>& awaited) {
  for (std::size_t i = 0; i < grips_.size() && i < bodies.grips.size(); ++i) {
    const GripState& grip = bodies.grips[i];
    const bool was_held = glm::length(grip.on_hand.force) + glm::length(grip.on_hand.torque) > 0.0;
    if (was_held)
      put_on_stand(i, grip.handle, now_ns, i >= awaited.size() || awaited[i]);
    else
      let_go(i, now_ns, true);
  }
}

void HandTable::taken(std::size_t grip, std::int64_t now_ns) {
  GripHand& hand = grips_[grip];
  hand.held = true;
  hand.base += hand.newest + 1;
  hand.newest = hand.first = hand.seen = hand.answered = 0;
  hand.delivery = {};
  hand.begun = false;
  hand.received_ns = now_ns;
  if (!hand.stand) hand.hold += 1;
}

void HandTable::let_go(std::size_t grip, std::int64_t now_ns, bool also_stand) {
  GripHand& hand = grips_[grip];
  hand.held = false;
  hand.answered = 0;
  if (hand.stand && !hand.kept && !also_stand) return;
  PoseMessage message;
  message.device = static_cast<std::uint32_t>(grip);
  message.stamp_ns = now_ns;
  message.pose = hand.last;
  message.lost = true;
  message.stand = hand.stand;
  hand.stand = false;
  message.energy = hand.energy;
  message.number = hand.base + hand.newest;
  publish(grip, message);
}

/// Whether somebody else holds the same body whose samples come.
bool HandTable::another_is_fresh(std::size_t grip, std::int64_t now_ns) const {
  for (std::size_t i = 0; i < grips_.size(); ++i) {
    const GripHand& other = grips_[i];
    if (i != grip && other.body == grips_[grip].body && other.held && other.newest > 0 &&
        now_ns - other.received_ns <= to_nanoseconds(kHoldAnew))
      return true;
  }
  return false;
}

void HandTable::lose(std::size_t grip, std::int64_t now_ns) {
  GripHand& hand = grips_[grip];
  hand.answered = 0;
  if (hand.stand) return;
  if (!hand.engaged || another_is_fresh(grip, now_ns)) return let_go(grip, now_ns);
  hand.held = false;
  put_on_stand(grip, hand.last, now_ns, true);
}

bool HandTable::count(GripHand& hand, std::uint64_t number) {
  if (hand.first == 0) {
    hand.first = hand.newest = number;
    hand.seen = 1;
  } else if (number > hand.newest) {
    const std::uint64_t ahead = number - hand.newest;
    hand.seen = ahead < 64 ? hand.seen << ahead | 1 : 1;
    hand.newest = number;
  } else {
    const std::uint64_t behind = hand.newest - number;
    if (behind >= 64 || number < hand.first) return false;
    if (!(hand.seen >> behind & 1)) hand.delivery.received += 1;
    hand.seen |= std::uint64_t{1} << behind;
    return false;
  }
  hand.delivery.received += 1;
  hand.delivery.expected = hand.newest - hand.first + 1;
  return true;
}

std::int64_t HandTable::on_our_clock(GripHand& hand, std::int64_t stamp_ns, std::int64_t now_ns) {
  const std::int64_t offset = now_ns - stamp_ns;
  const bool anew = hand.delivery.received <= 1 || offset - hand.clock_offset_ns > kOldest;
  const std::int64_t drifted =
      hand.clock_offset_ns +
      static_cast<std::int64_t>(kDrift * static_cast<double>(now_ns - hand.received_ns));
  hand.clock_offset_ns = anew ? offset : std::min(offset, drifted);
  hand.received_ns = now_ns;
  return stamp_ns + hand.clock_offset_ns;
}

bool HandTable::sample(const wire::PoseSample& sample, std::int64_t now_ns, bool counted) {
  if (sample.grip >= grips_.size()) return false;
  GripHand& hand = grips_[sample.grip];
  // 0 stands for "none yet" in what comes back to the peer.
  if (sample.number == 0 || !count(hand, sample.number)) return false;
  hand.held = true;
  hand.known[sample.number % kRemembered] = {sample.number, sample.stamp_ns};
  // Each holder's count begins somewhere; the grip's goes on.
  if (!hand.begun) hand.before = hand.energy - sample.energy;
  hand.begun = true;
  const std::int64_t stamp_ns = on_our_clock(hand, sample.stamp_ns, now_ns);
  if (sample.engaged == wire::HoldsOn::kUnfelt) {
    hand.answered = sample.number;
    return true;
  }
  PoseMessage message;
  message.device = sample.grip;
  message.stamp_ns = stamp_ns;
  message.time = sample.time;
  message.pose = sample.pose;
  message.twist = sample.twist;
  message.engaged = sample.engaged == wire::HoldsOn::kYes;
  message.number = hand.base + sample.number;
  message.counted = counted;
  message.energy = std::clamp(hand.before + sample.energy, -wire::kMaxEnergy, wire::kMaxEnergy);
  if (hand.stand) {
    if (!message.engaged) return true;
    hand.stand = false;
    hand.hold += 1;
  }
  publish(sample.grip, message);
  if (message.engaged) end_stands_beside(sample.grip, now_ns);
  return true;
}

/// Whoever holds the body carries it: a stand beside them is a hand that never disengages. Who has taken a
/// grip there and is not felt yet keeps theirs, and so does who may come back.
void HandTable::end_stands_beside(std::size_t grip, std::int64_t now_ns) {
  for (std::size_t i = 0; i < grips_.size(); ++i) {
    const GripHand& other = grips_[i];
    if (i != grip && other.body == grips_[grip].body && other.stand && !other.held && !other.kept)
      let_go(i, now_ns, true);
  }
}

HandTable::Used HandTable::used(std::size_t grip, std::uint64_t pose_number) const {
  const GripHand& hand = grips_[grip];
  const std::uint64_t number = std::max(pose_number - std::min(pose_number, hand.base), hand.answered);
  if (number == 0) return {};
  const Used& known = hand.known[number % kRemembered];
  return known.number == number ? known : Used{};
}

}  // namespace slosh
