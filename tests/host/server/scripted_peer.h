// A server on a network in memory, with a world that only answers, and peers that say what a test wants.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host/server/server.h"
#include "net/wire/all_messages.h"
#include "net/wire/roster_change.h"
#include "net/wire/stream_splitter.h"
#include "tests/support/memory_endpoint.h"

namespace slosh {

/// Two boxes, three grips ("left" and "right" on the first, "spoon" on the second), one fluid.
Scene served_scene();
/// Every body and grip at the origin, at rest; steps of 2 ms.
BodyMessage first_state(const Scene& scene);

/// Everything that one peer was told.
class ScriptedPeer final : public EndpointEvents {
 public:
  ScriptedPeer(MemoryNetwork& network, std::uint8_t key, const std::string& address = "192.0.2.1:50000");
  /// Over whatever network `connect` opens, whose one connection is number 1.
  explicit ScriptedPeer(const std::function<std::unique_ptr<Endpoint>(EndpointEvents&)>& connect)
      : end(connect(*this)) {}

  void hello(const wire::Token& token, const std::string& name = {},
             wire::SnapshotWish snapshots = wire::SnapshotWish::kNewest);
  template <class M>
  void say(const M& message) {
    raw(wire::control(message));
  }
  void raw(const wire::Bytes& bytes, bool end = false);
  template <class M>
  void datagram(const M& message) {
    raw_datagram(wire::datagram(message, nullptr, capabilities & wire::kOurCapabilities));
  }
  void raw_datagram(const wire::Bytes& bytes);
  /// A pose sample at x metres, engaged, the newest alone.
  void pose(std::uint32_t grip, std::uint64_t number, double x, std::int64_t stamp_ns = 1000);
  void take(std::uint32_t grip) { say(wire::GripRequest{next_request++, grip, true}); }
  void release(std::uint32_t grip) { say(wire::GripRequest{next_request++, grip, false}); }
  void close(const std::string& text = "done") { end->close(connection, 0, text); }
  /// Gone as a crashed program is.
  void vanish() { end.reset(); }

  bool in() const { return !welcomes.empty() && !closed; }
  bool noticed(const std::string& words) const;
  const wire::RosterEntry* entry(const std::string& name) const;

  std::unique_ptr<Endpoint> end;
  ConnectionId connection = 0;
  bool closed = false;
  CloseReason reason;
  std::vector<wire::Welcome> welcomes;
  std::vector<wire::Refused> refusals;
  std::vector<wire::Roster> rosters;
  std::vector<wire::RosterChange> roster_changes;  ///< which `rosters` has applied
  std::vector<wire::Answer> answers;
  std::vector<wire::WorldInfo> worlds;
  std::vector<wire::Rights> rights;
  std::vector<wire::Task> tasks;
  std::vector<wire::Cuts> cuts;
  std::vector<std::string> notices;
  std::vector<wire::ClockPong> pongs;
  std::vector<wire::Bodies> bodies;
  std::vector<wire::HandEntry> hands;
  std::vector<wire::FluidWrench> fluid;
  std::size_t snapshot_pieces = 0;
  std::size_t snapshot_bytes = 0;
  std::size_t scene_bytes = 0;
  bool scene_ended = false;
  const std::uint8_t* scene_data = nullptr;  ///< where the scene's bytes lay
  std::size_t control_bytes = 0;             ///< of payload, control messages
  std::vector<wire::ControlType> order;      ///< types of all control messages
  std::string fault;                         ///< of anything that did not decode
  std::uint32_t next_request = 1;
  wire::Capabilities capabilities = wire::kOurCapabilities;  ///< that hello() names
  wire::Bytes later;                                         ///< likewise

  void on_connected(ConnectionId id, const KeyFingerprint&, const std::string&) override { connection = id; }
  void on_stream(ConnectionId, std::int64_t stream, std::span<const std::uint8_t> bytes, bool ended) override;
  void on_datagram(ConnectionId, std::span<const std::uint8_t> bytes) override;
  void on_closed(ConnectionId, const CloseReason& why) override {
    closed = true;
    reason = why;
  }

 private:
  std::int64_t control_ = -1;
  wire::StreamSplitter splitter_;
};

/// The server's end. Time stands until go() moves it.
class ServedTest : public ::testing::Test {
 protected:
  explicit ServedTest(const ServerOptions& options = {});

  ScriptedPeer& join(std::uint8_t key, const wire::Token& token, const std::string& name = {},
                     const std::string& address = "192.0.2.1:50000");
  ScriptedPeer& join(std::uint8_t key, const std::string& name) { return join(key, hold, name); }
  /// Says hello and can do that much; nothing runs yet.
  ScriptedPeer& arrive(std::uint8_t key, const std::string& name, wire::Capabilities capabilities);
  /// Everybody runs for so long, in steps of 5 ms (or longer ones). Calls `each` at every step.
  void go(double seconds, double step = 0.005, const std::function<void()>& each = {});
  /// The host's thread would publish this.
  void publish_bodies(std::uint64_t tick, const std::vector<std::uint64_t>& pose_numbers = {},
                      std::shared_ptr<const BodyCuts> cuts = {});
  /// What the world would take now: the newest message of a grip.
  const PoseMessage& pose(std::size_t grip);

  MemoryNetwork network;
  Scene scene;
  Channel channel;
  SnapshotDesk desk;
  FluidDemand fluid_demand;
  std::vector<HostCommand> commands;
  std::unique_ptr<Server> server;
  std::unique_ptr<Endpoint> endpoint;
  std::vector<std::unique_ptr<ScriptedPeer>> peers;
  std::vector<std::string> told;
  wire::Token hold{};
  wire::Token watch{};
  wire::Token rule{};  ///< to hold, and to run the world
  std::string hold_id;
  TaskLines task;               ///< where the world's task is
  std::string refuse_commands;  ///< the world's answer to all that is asked, empty = granted
};

}  // namespace slosh
