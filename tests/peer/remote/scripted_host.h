// A host that does as the test says, over the network in memory, on a clock that the test moves.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "net/clock.h"
#include "net/wire/messages.h"
#include "net/wire/scene_package.h"
#include "net/wire/stream_splitter.h"
#include "peer/remote/remote_link.h"
#include "tests/support/memory_endpoint.h"

namespace slosh::test {

constexpr double kHostStep = 0.002;  // s

/// Two grips on one free body, no fluid.
inline Scene shared_scene() {
  Scene scene;
  scene.name = "shared";
  TriangleMesh& mesh = scene.meshes.emplace_back();
  mesh.positions = {{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}, {0, 0, 0.1f}};
  mesh.normals.assign(4, {0, 1, 0});
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  scene.bodies.resize(1);
  Body& body = scene.bodies[0];
  body.name = "beam";
  body.mesh = 0;
  body.motion = BodyMotion::kFree;
  body.mass.mass = 1.0;
  body.mass.inertia = glm::dmat3(0.01);
  for (const char* name : {"left", "right"}) {
    Grip grip;
    grip.name = name;
    grip.body = 0;
    scene.grips.push_back(grip);
  }
  scene.domain_min = glm::dvec3(-1.0);
  scene.domain_max = glm::dvec3(1.0);
  return scene;
}

/// Answers hello with a welcome, the scene, a roster; grants every grip; echoes pings; sends bodies. Each of
/// these can be switched off or replaced.
class ScriptedHost final : public EndpointEvents {
 public:
  explicit ScriptedHost(MemoryNetwork& network) : network_(network), endpoint_(network.listen(*this)) {
    package = pack_scene(shared_scene(), 0.01, SceneParts::kSeen).value();
  }

  // What it does.
  bool welcomes = true;
  bool sends_scene = true;
  bool answers_pings = true;
  bool sends_bodies = true;
  wire::Bytes package;
  std::function<void(const wire::Hello&)> on_hello;  // in place of the welcome
  std::function<std::optional<std::string>(const wire::GripRequest&)> refuse_grip;
  std::string refuse_parameters;  // in these words, when not empty
  std::uint64_t world = 42;
  std::uint32_t run = 0;
  double clock_ahead = 500.0;  // s, of the peer's clock
  double time = 3.0;           // simulated s

  // What it saw.
  ConnectionId connection = 0;
  int connections = 0;
  std::vector<wire::Hello> hellos;
  std::vector<wire::GripRequest> grip_requests;
  std::vector<wire::WorldRequest> world_requests;
  std::vector<wire::ParameterRequest> parameter_requests;
  std::vector<wire::PoseSample> poses;
  int datagrams = 0;
  bool said_bye = false;
  bool closed = false;
  wire::Roster roster{{{3, "Ana", wire::Role::kParticipant, true, {}}}};

  std::int64_t now_ns() const { return network_.now_ns() + to_nanoseconds(clock_ahead); }
  Endpoint& endpoint() { return *endpoint_; }
  void turn() {
    if (!endpoint_) return;  // it has crashed
    endpoint_->run_once(network_.now_ns());
    if (connection == 0 || !sends_bodies || hellos.empty()) return;
    wire::Bodies m;
    m.run = run;
    m.tick = static_cast<std::uint64_t>(time / kHostStep + 0.5);
    m.time = time;
    m.stamp_ns = now_ns();
    m.rate = 1.0;
    m.bodies.resize(1);
    m.bodies[0].pose.position.x = time;
    send(m);
  }
  template <class M>
  void send(const M& message) {
    raw_datagram(wire::datagram(message));
  }
  void raw_datagram(const wire::Bytes& bytes) {
    endpoint_->send_datagram(connection, Priority::kState,
                             std::make_shared<const std::vector<std::uint8_t>>(bytes));
  }
  template <class M>
  void say(const M& message) {
    raw_control(wire::control(message));
  }
  void raw_control(const wire::Bytes& bytes) { endpoint_->send_stream(connection, control_, bytes, false); }
  void welcome() {
    wire::Welcome m;
    m.peer = 3;
    m.role = wire::Role::kParticipant;
    m.name = "Ana";
    m.world = world;
    m.scene_bytes = package.size();
    m.particles = 0;
    m.spacing = 0.01;
    m.time_step = kHostStep;
    m.snapshot_rate = 60.0;
    say(m);
    say(roster);
    wire::WorldInfo info;
    info.run = run;
    say(info);
    say(wire::Rights{true, true, true});
  }
  void send_scene() {
    const std::int64_t stream = endpoint_->open_stream(connection, false);
    endpoint_->send_stream(connection, stream, package, true);
  }
  void crash() {
    endpoint_.reset();
    connection = 0;
  }
  void come_back() { endpoint_ = network_.listen(*this); }

  void on_connected(ConnectionId id, const KeyFingerprint&, const std::string&) override {
    connection = id;
    connections += 1;
    control_ = -1;
    closed = false;
    splitter_ = {};
  }
  void on_stream(ConnectionId, std::int64_t stream, std::span<const std::uint8_t> bytes, bool) override {
    control_ = stream;
    (void)splitter_.feed(
        bytes, [this](std::uint64_t type, wire::ByteView payload) { return receive(type, payload); });
  }
  void on_datagram(ConnectionId, std::span<const std::uint8_t> bytes) override {
    datagrams += 1;
    const wire::ByteView payload = bytes.subspan(1);
    if (bytes[0] == static_cast<std::uint8_t>(wire::DatagramType::kClockPing) && answers_pings) {
      wire::ClockPing ping;
      if (wire::decode(payload, ping)) return;
      wire::ClockPong pong;
      pong.number = ping.number;
      pong.ping_sent_ns = ping.sent_ns;
      pong.received_ns = pong.sent_ns = now_ns();
      send(pong);
    }
    wire::Poses m;
    if (bytes[0] == static_cast<std::uint8_t>(wire::DatagramType::kPoses) && !wire::decode(payload, m)) {
      poses.insert(poses.end(), m.samples.begin(), m.samples.end());
    }
  }
  void on_closed(ConnectionId, const CloseReason&) override {
    closed = true;
    connection = 0;
  }

 private:
  wire::Fault receive(std::uint64_t type, wire::ByteView payload) {
    switch (static_cast<wire::ControlType>(type)) {
      case wire::ControlType::kHello: {
        wire::Hello hello;
        if (wire::Fault fault = wire::decode(payload, hello)) return fault;
        hellos.push_back(hello);
        if (on_hello) {
          on_hello(hello);
          return {};
        }
        if (welcomes) welcome();
        if (sends_scene) send_scene();
        return {};
      }
      case wire::ControlType::kGripRequest: {
        wire::GripRequest request;
        if (wire::Fault fault = wire::decode(payload, request)) return fault;
        grip_requests.push_back(request);
        const std::optional<std::string> refusal = refuse_grip ? refuse_grip(request) : std::nullopt;
        if (!refusal) {
          std::vector<std::uint32_t>& mine = roster.peers.front().grips;
          std::erase(mine, request.grip);
          if (request.take) mine.push_back(request.grip);
          say(roster);
        }
        wire::Answer answer;
        answer.request = request.request;
        answer.granted = !refusal;
        answer.text = refusal.value_or("");
        say(answer);
        return {};
      }
      case wire::ControlType::kWorldRequest: {
        wire::WorldRequest request;
        if (wire::Fault fault = wire::decode(payload, request)) return fault;
        world_requests.push_back(request);
        return {};
      }
      case wire::ControlType::kParameterRequest: {
        wire::ParameterRequest request;
        if (wire::Fault fault = wire::decode(payload, request)) return fault;
        parameter_requests.push_back(request);
        say(wire::Answer{request.request, refuse_parameters.empty(), refuse_parameters});
        return {};
      }
      case wire::ControlType::kBye:
        said_bye = true;
        return {};
      default:
        return {"type", "unexpected"};
    }
  }

  MemoryNetwork& network_;
  std::unique_ptr<Endpoint> endpoint_;
  std::int64_t control_ = -1;
  wire::StreamSplitter splitter_;
};

/// A peer's link and the host that it joins, turned together.
/// What a host answers that is too busy for another connection.
class BusyHost final : public Endpoint {
 public:
  explicit BusyHost(EndpointEvents& events) : events_(events) {}
  void run_once(std::int64_t) override {
    if (!std::exchange(told_, true))
      events_.on_closed(1, {true, 0, "too many are knocking", CloseCause::kBusy});
  }
  void wake() override {}
  bool send_datagram(ConnectionId, Priority, SharedBytes) override { return false; }
  std::int64_t open_stream(ConnectionId, bool) override { return -1; }
  bool send_stream(ConnectionId, std::int64_t, std::span<const std::uint8_t>, bool) override { return false; }
  void close(ConnectionId, std::uint64_t, const std::string&) override {}
  ConnectionStats stats(ConnectionId) const override { return {}; }
  EndpointStats endpoint_stats() const override { return {}; }
  std::string local_address() const override { return "192.0.2.1:50000"; }

 private:
  EndpointEvents& events_;
  bool told_ = false;
};

struct Together {
  MemoryNetwork network;
  ScriptedHost host{network};
  RemoteShared shared;
  std::unique_ptr<RemoteLink> link;
  Endpoint* peer_end = nullptr;  // the newest
  int connects = 0;
  int busy_answers = 0;  // so many tries find the host busy

  explicit Together(const MemoryLink& wire = {0.010, 0.0, 0.0, 0.0}, RemoteOptions options = {}) {
    network.set_link(wire);
    options.address = "192.0.2.9:4433";
    options.now = [this] { return network.now_ns(); };
    const Connect connect = [this](EndpointEvents& events,
                                   const EndpointOptions& endpoint) -> Result<std::unique_ptr<Endpoint>> {
      connects += 1;
      if (busy_answers > 0 && busy_answers-- > 0) return std::unique_ptr<Endpoint>(new BusyHost(events));
      std::unique_ptr<Endpoint> made =
          network.connect(events, KeyFingerprint{1}, "192.0.2.1:50000", endpoint);
      peer_end = made.get();
      return made;
    };
    link = std::make_unique<RemoteLink>(std::move(options), connect, shared);
  }

  /// Goes on for `seconds`, or until `done`; true when that came.
  bool run(double seconds, const std::function<bool()>& done = [] { return false; }) {
    for (double passed = 0.0; passed < seconds; passed += 0.001) {
      network.advance(0.001);
      host.time += 0.001;
      host.turn();
      (void)link->turn();
      if (done()) return true;
    }
    return false;
  }
  bool run_until(LinkState state, double seconds = 8.0) {
    return run(seconds, [&] { return status().state == state; });
  }
  RemoteStatus status() const {
    const std::lock_guard lock(shared.mutex);
    return shared.status;
  }
  std::string notices() {
    const std::lock_guard lock(shared.mutex);
    std::string all;
    for (const std::string& notice : shared.notices) all += notice + "\n";
    return all;
  }
  void ask(const RemoteCommand& command) {
    const std::lock_guard lock(shared.mutex);
    shared.commands.push_back(command);
  }
  /// What a device loop would post.
  void post(std::size_t grip) {
    PoseMessage& m = link->world().channel->pose(grip).back();
    m.stamp_ns = network.now_ns();
    m.device = static_cast<std::uint32_t>(grip);
    m.engaged = true;
    link->world().channel->pose(grip).publish();
  }
  const BodyMessage& bodies() {
    link->world().channel->bodies().update();
    return link->world().channel->bodies().front();
  }
};

}  // namespace slosh::test
