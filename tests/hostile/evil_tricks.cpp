#include <algorithm>

#include "net/clock.h"
#include "tests/hostile/evil_guest.h"

namespace slosh::hostile {

/// What a world says of itself, more or less.
void EvilHost::states(Guest& guest) {
  Mischief& m = *guest.mischief;
  guest.tick += 1;
  wire::Bodies bodies;
  bodies.run = guest.run;
  bodies.tick = guest.tick;
  bodies.time = kEvilStep * static_cast<double>(guest.tick);
  bodies.stamp_ns = steady_now_ns();
  bodies.rate = 1.0;
  bodies.pose_number = guest.pose_number;
  bodies.pose_stamp_ns = steady_now_ns();
  for (std::uint32_t i = 0; i < scene_.bodies.size(); ++i) {
    wire::BodyEntry entry;
    entry.body = i;
    entry.pose = scene_.bodies[i].pose;
    bodies.bodies.push_back(entry);
  }
  const bool jumps = guest.trick == Trick::kStates || guest.trick == Trick::kStiff;
  if (jumps && m.one_in(4)) {
    switch (m.below(7)) {
      case 0:
        bodies.tick = m.any() % wire::kMaxTick;
        break;
      case 1:
        bodies.time = static_cast<double>(m.below(20'000'000)) - 1.0;
        break;
      case 2:
        bodies.stamp_ns = wire::random_message<wire::ClockPing>(m.any()).sent_ns;
        break;
      case 3:
        guest.run += 1;
        break;
      case 4:
        bodies.rate = static_cast<double>(m.below(101));
        break;
      case 5:
        bodies.parts = 1 + static_cast<std::uint32_t>(m.below(256));
        bodies.part = static_cast<std::uint32_t>(m.below(bodies.parts));
        break;
      default: {
        const wire::Bodies any = wire::random_message<wire::Bodies>(m.any(), 1, 4);
        bodies.bodies = any.bodies;
        bodies.grips = any.grips;
        for (wire::BodyEntry& entry : bodies.bodies)
          entry.body %= static_cast<std::uint32_t>(scene_.bodies.size());
      }
    }
  }
  wire::Bytes bytes = wire::datagram(bodies);
  if (bytes.size() <= wire::kMaxDatagram) raw_datagram(guest, bytes);
}

void EvilHost::harm(Guest& guest) {
  Mischief& m = *guest.mischief;
  switch (guest.trick) {
    case Trick::kEverything:
      raw_datagram(guest, m.one_in(8) ? m.noise(1100) : m.datagram(wire::HostDatagrams{}));
      // One damaged control message ends it, so they are rare; any that is valid goes on.
      if (m.one_in(40)) raw(guest, m.control(wire::HostControl{}));
      return;
    case Trick::kSnapshots:
      return snapshots(guest);
    case Trick::kTexts:
      if (guest.turns % 20 != 0) return;
      switch (m.below(4)) {
        case 0:
          return raw(guest, m.with_text(wire::Notice{}, &wire::Notice::text, wire::kMaxText));
        case 1:
          return raw(guest, m.with_text(wire::Answer{}, &wire::Answer::text, wire::kMaxText));
        case 2: {
          wire::Roster roster = wire::random_message<wire::Roster>(m.any(), 1, 60);
          return say(guest, roster);
        }
        default: {
          wire::Welcome again;
          return raw(guest, m.with_text(again, &wire::Welcome::name, wire::kMaxName));
        }
      }
    case Trick::kStreams:
    case Trick::kEndlessScene:
      if (guest.turns % 4 == 0) stream(guest, m.noise(200'000), m.one_in(50));
      return;
    default:
      return;
  }
}

void EvilHost::snapshots(Guest& guest) {
  Mischief& m = *guest.mischief;
  if (guest.turns % 8 != 0) return;
  if (!guest.encoder) {
    guest.encoder = std::make_unique<SnapshotEncoder>(CodecOptions{});
    for (int i = 0; i < 500; ++i) {
      guest.snapshot.positions.emplace_back(0.01 * (i % 10), 0.01 * (i / 10 % 10), 0.01 * (i / 100));
      guest.snapshot.fluid_index.push_back(0);
    }
  }
  for (glm::vec3& position : guest.snapshot.positions) position.y += 0.001f;
  guest.snapshot.rigid.tick = guest.tick;
  guest.snapshot.rigid.time = kEvilStep * static_cast<double>(guest.tick);
  for (const Piece& piece : guest.encoder->encode(guest.snapshot, guest.run, m.one_in(8)).pieces) {
    wire::Bytes bytes = *piece.bytes;
    switch (m.below(4)) {
      case 0:
        m.turn_bits(bytes);
        break;
      case 1:
        bytes.resize(m.below(bytes.size() + 1));
        break;
      case 2: {  // the head of a piece, and noise behind it
        const wire::Bytes noise = m.noise(900);
        bytes.resize(std::min<std::size_t>(bytes.size(), 2 + m.below(24)));
        bytes.insert(bytes.end(), noise.begin(), noise.end());
        break;
      }
      default:
        break;
    }
    if (!bytes.empty() && bytes.size() <= wire::kMaxDatagram) raw_datagram(guest, bytes, Priority::kSnapshot);
  }
}

void EvilHost::leave(Guest& guest) {
  Mischief& m = *guest.mischief;
  guest.left = true;
  if (m.one_in(3)) raw(guest, m.with_text(wire::Bye{}, &wire::Bye::reason, wire::kMaxText));
  end_->close(guest.id, m.any() >> (2 + m.below(62)), m.text(700));
}

}  // namespace slosh::hostile
