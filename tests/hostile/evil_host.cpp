#include <array>
#include <cstring>
#include <vector>

#include "net/clock.h"
#include "net/wire/acting_fields.h"
#include "net/wire/scene_fields.h"
#include "net/wire/scene_package.h"
#include "tests/hostile/evil_guest.h"

namespace slosh::hostile {
namespace {

constexpr std::array<const char*, kTricks> kHostNames{
    "states",        "everything", "snapshots", "texts",   "stiff",   "bad welcome", "bad scene",
    "endless scene", "noise",      "streams",   "silence", "refusal", "close"};
constexpr double kSpacing = 0.01;

std::uint64_t guest_seed(std::uint64_t seed, std::uint64_t guest) {
  return std::mt19937_64(seed ^ (guest * 0x9e3779b97f4a7c15ull))();
}

}  // namespace

const char* name_of(Trick trick) {
  return kHostNames[static_cast<std::size_t>(trick)];
}

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
    case Trick::kSnapshots:
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
        const wire::SceneAt<wire::kPlainScene> packed{{unpack_scene(package).value().scene, kSpacing}};
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
      raw(guest, wire::control(wire::WorldInfo{}, nullptr, 0));  // comes before anything is agreed
      say(guest, welcome);
      return stream(guest, package, true);
    }
    case Trick::kEndlessScene: {
      wire::Welcome welcome;
      welcome.scene_bytes = m.any() % wire::kMaxSceneBytes;
      raw(guest, wire::control(wire::WorldInfo{}, nullptr, 0));  // comes before anything is agreed
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
  welcome.world = m.any();
  welcome.scene_bytes = package.size();
  welcome.particles = m.one_in(4) ? m.below(100'000'000) : 500;
  welcome.spacing = kSpacing;
  welcome.time_step = m.one_in(4) ? 1e-7 : kEvilStep;
  welcome.snapshot_rate = 60.0;
  wire::RosterEntry entry;
  entry.name = "Ana";
  entry.role = welcome.role;
  for (std::uint32_t i = 0; i < scene.grips.size(); ++i) entry.grips.push_back(i);
  wire::Roster roster;
  roster.peers.push_back(entry);
  raw(guest, wire::control(wire::WorldInfo{}, nullptr, 0));  // comes before anything is agreed
  say(guest, welcome);
  say(guest, roster);
  stream(guest, package, true);
  guest.entered = true;
  guest.patience += 1500;
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
