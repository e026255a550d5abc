#include "tests/hostile/evil_host.h"

#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "net/clock.h"
#include "net/wire/scene_fields.h"
#include "net/wire/scene_package.h"

namespace slosh::hostile {
namespace {

constexpr std::array<const char*, kTricks> kNames{
    "states",        "everything", "pictures", "texts",   "stiff",   "bad welcome", "bad scene",
    "endless scene", "noise",      "streams",  "silence", "refusal", "close"};
constexpr double kSpacing = 0.01;
constexpr double kStep = 0.002;

std::uint64_t guest_seed(std::uint64_t seed, std::uint64_t guest) {
  return std::mt19937_64(seed ^ (guest * 0x9e3779b97f4a7c15ull))();
}

}  // namespace

const char* name_of(Trick trick) {
  return kNames[static_cast<std::size_t>(trick)];
}

struct EvilHost::Guest {
  ConnectionId id = 0;
  std::int64_t control = -1;
  wire::StreamSplitter splitter;
  std::unique_ptr<Mischief> mischief;  // from Hello on
  Trick trick = Trick::kSilence;
  bool entered = false;
  bool left = false;
  std::uint64_t tick = 100;
  std::uint32_t run = 0;
  std::uint64_t turns = 0;
  std::uint64_t patience = 0;  // turns until it is sent away
  std::uint64_t pose_number = 0;
  std::unique_ptr<SnapshotEncoder> encoder;
  Snapshot snapshot;
};

EvilHost::EvilHost(const Scene& scene, std::uint64_t seed)
    : scene_(scene), seed_(seed), began_ns_(steady_now_ns()) {
  auto made = listen_quic("127.0.0.1:0", identity_, *this);
  if (made)
    end_ = std::move(made.value());
  else
    problem_ = made.error().text();
}

EvilHost::~EvilHost() = default;

Trick EvilHost::trick(std::uint64_t guest) const {
  return static_cast<Trick>(guest_seed(seed_, guest) % kTricks);
}

std::string EvilHost::link(std::uint64_t guest) const {
  JoinLink link;
  link.addresses = {end_->local_address()};
  link.host = identity_.fingerprint();
  std::memcpy(link.token.data(), &guest, sizeof guest);
  return format_link(link).value();
}

void EvilHost::on_connected(ConnectionId id, const KeyFingerprint&, const std::string&) {
  guests_[id] = std::make_unique<Guest>();
  guests_[id]->id = id;
}

void EvilHost::on_stream(ConnectionId id, std::int64_t stream, std::span<const std::uint8_t> bytes, bool) {
  const auto found = guests_.find(id);
  if (found == guests_.end()) return;
  Guest& guest = *found->second;
  guest.control = stream;
  (void)guest.splitter.feed(bytes, [&](std::uint64_t type, wire::ByteView payload) -> wire::Fault {
    wire::Hello hello;
    if (type != static_cast<std::uint64_t>(wire::ControlType::kHello) || wire::decode(payload, hello) ||
        guest.mischief) {
      return {};
    }
    std::uint64_t number = 0;
    std::memcpy(&number, hello.token.data(), sizeof number);
    guest.trick = trick(number);
    guest.mischief = std::make_unique<Mischief>(guest_seed(seed_, number));
    guest.patience = 200 + guest.mischief->below(1500);
    came_ += 1;
    greet(guest);
    return {};
  });
}

void EvilHost::on_datagram(ConnectionId id, std::span<const std::uint8_t> bytes) {
  const auto found = guests_.find(id);
  if (found == guests_.end() || bytes.empty()) return;
  Guest& guest = *found->second;
  wire::Poses poses;
  if (bytes[0] == static_cast<std::uint8_t>(wire::DatagramType::kPoses) &&
      !wire::decode(bytes.subspan(1), poses) && !poses.samples.empty()) {
    guest.pose_number = poses.samples.front().number;
  }
  wire::ClockPing ping;
  if (!guest.entered || bytes[0] != static_cast<std::uint8_t>(wire::DatagramType::kClockPing) ||
      wire::decode(bytes.subspan(1), ping)) {
    return;
  }
  wire::ClockPong pong;
  pong.number = ping.number;
  pong.ping_sent_ns = ping.sent_ns;
  pong.received_ns = pong.sent_ns = steady_now_ns();
  if (guest.mischief->one_in(6)) pong = wire::random_message<wire::ClockPong>(guest.mischief->any());
  raw_datagram(guest, wire::datagram(pong));
}

void EvilHost::on_closed(ConnectionId id, const CloseReason&) {
  guests_.erase(id);
}

void EvilHost::turn() {
  end_->run_once(steady_now_ns() + 1'000'000);
  // What it does may close a connection, and its guest goes: by number.
  std::vector<ConnectionId> ids;
  for (const auto& [id, guest] : guests_) ids.push_back(id);
  for (const ConnectionId id : ids) {
    const auto found = guests_.find(id);
    if (found == guests_.end() || !found->second->mischief || found->second->left) continue;
    Guest& guest = *found->second;
    guest.turns += 1;
    if (guest.entered) states(guest);
    harm(guest);
    if (guest.turns > guest.patience) leave(guest);
  }
}

void EvilHost::greet(Guest& guest) {
  Mischief& m = *guest.mischief;
  switch (guest.trick) {
    case Trick::kStates:
    case Trick::kEverything:
    case Trick::kPictures:
    case Trick::kTexts:
    case Trick::kStreams:
      return enter(guest, scene_);
    case Trick::kStiff: {
      Scene stiff = scene_;
      for (Grip& grip : stiff.grips) {
        grip.stiffness = 1e6;
        grip.damping = m.one_in(2) ? 1e4 : 0.0;
        grip.rotational_stiffness = 1e4;
        grip.rotational_damping = m.one_in(2) ? 1e3 : 0.0;
      }
      return enter(guest, stiff);
    }
    case Trick::kBadWelcome: {
      const auto damaged = [&](const auto& message) {
        using M = std::decay_t<decltype(message)>;
        raw(guest, m.enveloped(static_cast<std::uint64_t>(M::kType), m.payload(message)));
      };
      damaged(wire::random_message<wire::WorldInfo>(m.any()));
      damaged(wire::random_message<wire::Welcome>(m.any()));
      damaged(wire::random_message<wire::Roster>(m.any()));
      const Result<wire::Bytes> package = pack_scene(scene_, kSpacing, SceneParts::kSeen);
      return stream(guest, package.value(), true);
    }
    case Trick::kBadScene: {
      wire::Bytes package = pack_scene(scene_, kSpacing, SceneParts::kSeen).value();
      if (m.one_in(2)) {
        // As it is, so that the damage reaches the fields and not only zstd.
        const wire::PackedScene packed{unpack_scene(package).value().scene, kSpacing};
        package = {1, 0};
        const wire::Bytes fields = wire::damaged_message(packed, m.below(3000)).bytes;
        package.insert(package.end(), fields.begin(), fields.end());
      }
      if (m.one_in(2)) m.turn_bits(package);
      if (m.one_in(4)) package.resize(m.below(package.size()));
      wire::Welcome welcome;
      welcome.name = "Ana";
      welcome.role = wire::Role::kParticipant;
      welcome.scene_bytes = m.one_in(4) ? m.any() % wire::kMaxSceneBytes : package.size();
      say(guest, wire::WorldInfo{});
      say(guest, welcome);
      return stream(guest, package, true);
    }
    case Trick::kEndlessScene: {
      wire::Welcome welcome;
      welcome.scene_bytes = m.any() % wire::kMaxSceneBytes;
      say(guest, wire::WorldInfo{});
      say(guest, welcome);
      return;
    }
    case Trick::kNoise:
      for (std::size_t left = 1 + m.below(5); left > 0; --left) raw(guest, m.noise(4000));
      return;
    case Trick::kSilence:
      guest.patience += 4000;
      return;
    case Trick::kRefusal: {
      wire::Refused refused;
      refused.code = static_cast<wire::RefusalCode>(m.below(wire::kRefusalCodes));
      raw(guest, m.with_text(refused, &wire::Refused::text, wire::kMaxText));
      guest.patience = m.below(200);
      return;
    }
    case Trick::kClose:
      guest.patience = 0;
      return;
  }
}

void EvilHost::enter(Guest& guest, const Scene& scene) {
  Mischief& m = *guest.mischief;
  const wire::Bytes package = pack_scene(scene, kSpacing, SceneParts::kSeen).value();
  wire::Welcome welcome;
  welcome.role = m.one_in(6) ? wire::Role::kSpectator : wire::Role::kParticipant;
  welcome.name = "Ana";
  welcome.session = m.any();
  welcome.scene_bytes = package.size();
  welcome.particles = m.one_in(4) ? m.below(100'000'000) : 500;
  welcome.spacing = kSpacing;
  welcome.time_step = m.one_in(4) ? 1e-7 : kStep;
  welcome.picture_rate = 60.0;
  wire::RosterEntry entry;
  entry.name = "Ana";
  entry.role = welcome.role;
  for (std::uint32_t i = 0; i < scene.grips.size(); ++i) entry.grips.push_back(i);
  wire::Roster roster;
  roster.peers.push_back(entry);
  say(guest, wire::WorldInfo{});
  say(guest, welcome);
  say(guest, roster);
  stream(guest, package, true);
  guest.entered = true;
  guest.patience += 1500;
}

/// What a world says of itself, more or less.
void EvilHost::states(Guest& guest) {
  Mischief& m = *guest.mischief;
  guest.tick += 1;
  wire::Bodies bodies;
  bodies.run = guest.run;
  bodies.tick = guest.tick;
  bodies.time = kStep * static_cast<double>(guest.tick);
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
    case Trick::kPictures:
      return pictures(guest);
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

void EvilHost::pictures(Guest& guest) {
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
  guest.snapshot.rigid.time = kStep * static_cast<double>(guest.tick);
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

void EvilHost::raw(Guest& guest, const wire::Bytes& bytes) {
  if (guest.control >= 0) end_->send_stream(guest.id, guest.control, bytes, false);
  messages_ += 1;
}

void EvilHost::raw_datagram(Guest& guest, const wire::Bytes& bytes, Priority priority) {
  end_->send_datagram(guest.id, priority, std::make_shared<const wire::Bytes>(bytes));
  messages_ += 1;
}

void EvilHost::stream(Guest& guest, const wire::Bytes& bytes, bool end) {
  const std::int64_t stream = end_->open_stream(guest.id, false);
  if (stream >= 0) end_->send_stream(guest.id, stream, bytes, end);
  messages_ += 1;
}

}  // namespace slosh::hostile
