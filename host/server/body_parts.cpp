#include "host/server/body_parts.h"

#include <algorithm>

namespace slosh {
namespace {

// The head's longest coding and the type byte; what is left is for entries.
constexpr std::size_t kHead = 70;
constexpr std::size_t kRoom = wire::kMaxDatagram - kHead;
constexpr std::size_t kBodyEntry = 2 + 28 + 24 + 12 + 24;
constexpr std::size_t kGripEntry = 1 + 28 + 24 + 7 + 1 + 4 + 1 + 4;

/// A head ends with the counts of two empty lists; the entries take their place.
constexpr std::size_t kEmptyLists = 2;

}  // namespace

BodyParts::BodyParts(const Scene& scene, wire::Capabilities agreed) : agreed_(agreed) {
  for (const Body& body : scene.bodies) sent_.push_back(moves(body.motion) || body.measured);
}

void BodyParts::set(const BodyMessage& message, const std::vector<std::uint64_t>& numbers) {
  const BodySnapshot& bodies = message.bodies;
  header_.run = message.run;
  header_.tick = bodies.tick;
  header_.time = bodies.time;
  header_.stamp_ns = message.stamp_ns;
  header_.rate = message.rate;
  header_.status = bodies.status;
  shared_.clear();
  tails_.clear();

  wire::Bodies part;
  std::size_t left = kRoom;
  const auto close_part = [&] {
    wire::Bytes whole;
    wire::encode(part, whole, agreed_);
    wire::Bytes head;
    wire::Bodies empty = part;
    empty.bodies.clear();
    empty.grips.clear();
    wire::encode(empty, head, agreed_);
    tails_.emplace_back(whole.begin() + static_cast<std::ptrdiff_t>(head.size() - kEmptyLists), whole.end());
    part.bodies.clear();
    part.grips.clear();
    left = kRoom;
  };
  const auto need = [&](std::size_t bytes) {
    if (left < bytes) close_part();
    left -= bytes;
  };
  for (std::size_t i = 0; i < bodies.bodies.size() && i < sent_.size() && i < wire::kMaxBodies; ++i) {
    if (!sent_[i]) continue;
    need(kBodyEntry);
    const BodyState& state = bodies.bodies[i];
    part.bodies.push_back(
        {static_cast<std::uint32_t>(i), state.pose, state.twist, state.center_of_mass, state.fluid});
  }
  for (std::size_t i = 0; i < bodies.grips.size() && i < wire::kMaxGrips; ++i) {
    need(kGripEntry);
    wire::GripEntry& entry = part.grips.emplace_back();
    entry.grip = static_cast<std::uint32_t>(i);
    entry.handle = bodies.grips[i].handle;
    entry.on_hand = bodies.grips[i].on_hand;
    entry.stiffness = bodies.grips[i].stiffness;
    if (i < numbers.size()) entry.pose_number = numbers[i];
    if (i >= message.hands.size()) continue;
    entry.counted = message.hands[i].counted;
    entry.energy = message.hands[i].energy;
    entry.stand = message.hands[i].stand;
  }
  close_part();
}

void BodyParts::code(std::uint64_t pose_number, std::int64_t pose_stamp_ns, std::vector<SharedBytes>& out) {
  out.clear();
  header_.pose_number = pose_number;
  header_.pose_stamp_ns = pose_stamp_ns;
  header_.parts = static_cast<std::uint32_t>(tails_.size());
  for (std::size_t i = 0; i < tails_.size(); ++i) {
    header_.part = static_cast<std::uint32_t>(i);
    auto bytes = std::make_shared<wire::Bytes>(wire::datagram(header_));
    bytes->resize(bytes->size() - kEmptyLists);
    bytes->insert(bytes->end(), tails_[i].begin(), tails_[i].end());
    out.push_back(std::move(bytes));
  }
}

const std::vector<SharedBytes>& BodyParts::to(std::uint64_t pose_number, std::int64_t pose_stamp_ns) {
  if (pose_number != 0 || pose_stamp_ns != 0) {
    code(pose_number, pose_stamp_ns, own_);
    return own_;
  }
  if (shared_.empty()) code(0, 0, shared_);
  return shared_;
}

}  // namespace slosh
