#include "tests/host/server/scripted_peer.h"

#include "net/clock.h"

namespace slosh {
namespace {

template <class M>
void keep(std::vector<M>& all, const M& message) {
  all.push_back(message);
}

}  // namespace

BodyMessage first_state(const Scene& scene) {
  BodyMessage message;
  message.time_step = 0.002;
  message.bodies.bodies.resize(scene.bodies.size());
  message.bodies.grips.resize(scene.grips.size());
  message.pose_numbers.resize(scene.grips.size());
  return message;
}

Scene served_scene() {
  Scene scene;
  scene.name = "served";
  scene.fluids.push_back({});
  scene.fluids[0].name = "water";
  for (int i = 0; i < 3; ++i) {
    Body body;
    body.name = "body " + std::to_string(i);
    body.motion = i < 2 ? BodyMotion::kFree : BodyMotion::kFixed;
    body.pose.position = {0.1 * i, 0.5, 0.0};
    scene.bodies.push_back(body);
  }
  for (const char* name : {"left", "right", "spoon"}) {
    Grip grip;
    grip.name = name;
    grip.body = scene.grips.size() < 2 ? 0 : 1;
    grip.pose.position = {0.05, 0.0, 0.0};
    scene.grips.push_back(grip);
  }
  return scene;
}

ScriptedPeer::ScriptedPeer(MemoryNetwork& network, std::uint8_t key, const std::string& address) {
  KeyFingerprint fingerprint{};
  fingerprint.fill(key);
  end = network.connect(*this, fingerprint, address);
}

void ScriptedPeer::raw(const wire::Bytes& bytes, bool ended) {
  if (control_ < 0) control_ = end->open_stream(1, true);
  end->send_stream(1, control_, bytes, ended);
}

void ScriptedPeer::raw_datagram(const wire::Bytes& bytes) {
  end->send_datagram(1, Priority::kPose, std::make_shared<const wire::Bytes>(bytes));
}

void ScriptedPeer::hello(const wire::Token& token, const std::string& name, wire::SnapshotWish snapshots) {
  say(wire::Hello{wire::kProtocolVersion, token, name, snapshots, capabilities, later});
}

void ScriptedPeer::pose(std::uint32_t grip, std::uint64_t number, double x, std::int64_t stamp_ns) {
  wire::PoseSample sample;
  sample.grip = grip;
  sample.number = number;
  sample.stamp_ns = stamp_ns;
  sample.pose.position = {x, 0.5, 0.0};
  sample.engaged = wire::HoldsOn::kYes;
  datagram(wire::Poses{{sample}});
}

bool ScriptedPeer::noticed(const std::string& words) const {
  for (const std::string& notice : notices) {
    if (notice.find(words) != std::string::npos) return true;
  }
  return false;
}

const wire::RosterEntry* ScriptedPeer::entry(const std::string& name) const {
  if (rosters.empty()) return nullptr;
  for (const wire::RosterEntry& each : rosters.back().peers) {
    if (each.name == name) return &each;
  }
  return nullptr;
}

void ScriptedPeer::on_stream(ConnectionId, std::int64_t stream, std::span<const std::uint8_t> bytes,
                             bool ended) {
  if (stream != control_) {
    scene_bytes += bytes.size();
    scene_data = bytes.data();
    scene_ended = scene_ended || ended;
    return;
  }
  const wire::Fault found = splitter_.feed(bytes, [&](std::uint64_t type, wire::ByteView payload) {
    control_bytes += payload.size();
    order.push_back(static_cast<wire::ControlType>(type));
    const auto take = [&]<class M>(const M& message) {
      if constexpr (std::is_same_v<M, wire::Welcome>) keep(welcomes, message);
      if constexpr (std::is_same_v<M, wire::Refused>) keep(refusals, message);
      if constexpr (std::is_same_v<M, wire::Roster>) keep(rosters, message);
      if constexpr (std::is_same_v<M, wire::RosterChange>) {
        keep(roster_changes, message);
        rosters.push_back(rosters.back());
        wire::apply(message, rosters.back().peers);
      }
      if constexpr (std::is_same_v<M, wire::Answer>) keep(answers, message);
      if constexpr (std::is_same_v<M, wire::WorldInfo>) keep(worlds, message);
      if constexpr (std::is_same_v<M, wire::Rights>) keep(rights, message);
      if constexpr (std::is_same_v<M, wire::Task>) keep(tasks, message);
      if constexpr (std::is_same_v<M, wire::Cuts>) keep(cuts, message);
      if constexpr (std::is_same_v<M, wire::Notice>) keep(notices, message.text);
    };
    return wire::dispatch(wire::HostControl{}, type, payload, take, capabilities & wire::kOurCapabilities);
  });
  if (found) fault = found.text();
}

void ScriptedPeer::on_datagram(ConnectionId, std::span<const std::uint8_t> bytes) {
  if (!bytes.empty() && bytes[0] == static_cast<std::uint8_t>(wire::DatagramType::kSnapshotPiece)) {
    snapshot_pieces += 1;
    snapshot_bytes += bytes.size();
    return;
  }
  const wire::Fault found = wire::dispatch_datagram(
      wire::HostDatagrams{}, bytes,
      [&]<class M>(const M& message) {
        if constexpr (std::is_same_v<M, wire::ClockPong>) keep(pongs, message);
        if constexpr (std::is_same_v<M, wire::Bodies>) keep(bodies, message);
        if constexpr (std::is_same_v<M, wire::FluidWrench>) keep(fluid, message);
        if constexpr (std::is_same_v<M, wire::Hands>)
          hands.insert(hands.end(), message.hands.begin(), message.hands.end());
      },
      capabilities & wire::kOurCapabilities);
  if (found) fault = found.text();
}

ServedTest::ServedTest(const ServerOptions& given)
    : scene(served_scene()), channel(scene.grips.size(), first_state(scene), 1 << 20) {
  ServerOptions options = given;
  options.clock = [this] { return network.now_ns(); };
  options.tell = [this](const std::string& line) { told.push_back(line); };
  ServedWorld world;
  world.scene = &scene;
  world.package = wire::Bytes(5000, 7);
  world.channel = &channel;
  world.desk = &desk;
  world.fluid_demand = &fluid_demand;
  world.spacing = 0.01;
  world.time_step = 0.002;
  world.task = [this] { return task; };
  world.state.viscosities = {0.001};
  world.state.paused = options.hands_to_start > 0;
  world.command = [this](const HostCommand& command, const HostAnswer& answer) {
    commands.push_back(command);
    if (answer)
      answer(refuse_commands.empty() ? Result<bool>(true) : Result<bool>(Error{"", refuse_commands, ""}));
  };
  server = std::make_unique<Server>(std::move(world), options);
  endpoint = network.listen(*server);
  server->use(*endpoint);
  const LinkRecord* link = server->links().create(LinkRole::kHold, {}, 1);
  hold = link->token;
  hold_id = link->id;
  watch = server->links().create(LinkRole::kWatch, {}, 1)->token;
  rule = server->links().create(LinkRole::kRun, {}, 1)->token;
}

ScriptedPeer& ServedTest::join(std::uint8_t key, const wire::Token& token, const std::string& name,
                               const std::string& address) {
  peers.push_back(std::make_unique<ScriptedPeer>(network, key, address));
  peers.back()->hello(token, name);
  ScriptedPeer& peer = *peers.back();
  go(0.1);
  return peer;
}

ScriptedPeer& ServedTest::arrive(std::uint8_t key, const std::string& name, wire::Capabilities capabilities) {
  ScriptedPeer& peer = *peers.emplace_back(std::make_unique<ScriptedPeer>(network, key));
  peer.capabilities = capabilities;
  peer.hello(hold, name);
  return peer;
}

void ServedTest::go(double seconds, double step, const std::function<void()>& each) {
  const std::int64_t until = network.now_ns() + to_nanoseconds(seconds);
  while (network.now_ns() < until) {
    network.advance(std::min(step, to_seconds(until - network.now_ns()) + 1e-9));
    if (each) each();
    for (const auto& peer : peers) {
      if (peer->end) peer->end->run_once(0);
    }
    endpoint->run_once(0);
    server->turn();
    for (const auto& peer : peers) {
      if (peer->end) peer->end->run_once(0);
    }
  }
}

void ServedTest::publish_bodies(std::uint64_t tick, const std::vector<std::uint64_t>& pose_numbers,
                                std::shared_ptr<const BodyCuts> cuts) {
  BodyMessage& message = channel.bodies().back();
  message = first_state(scene);
  message.bodies.tick = tick;
  message.bodies.cuts = std::move(cuts);
  message.bodies.time = 0.002 * static_cast<double>(tick);
  message.rate = 1.0;
  message.stamp_ns = network.now_ns();
  for (std::size_t i = 0; i < pose_numbers.size(); ++i) message.pose_numbers[i] = pose_numbers[i];
  channel.bodies().publish();
}

const PoseMessage& ServedTest::pose(std::size_t grip) {
  channel.pose(grip).update();
  return channel.pose(grip).front();
}

}  // namespace slosh
