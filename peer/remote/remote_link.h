// One peer's side of the network: joins, keeps the clock, fills the channel, comes back when contact is lost.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "net/channel.h"
#include "net/link.h"
#include "net/quic/endpoint.h"
#include "net/wire/messages.h"
#include "net/wire/stream_splitter.h"
#include "peer/remote/backoff.h"
#include "peer/remote/body_inbox.h"
#include "peer/remote/clock_sync.h"
#include "peer/remote/link_steps.h"
#include "peer/remote/pose_uplink.h"
#include "peer/remote/remote_status.h"
#include "peer/remote/snapshot_maker.h"
#include "scenes/scene.h"

namespace slosh {

/// Opens a connection to the host: connect_quic with a link's addresses, or a test's double.
using Connect =
    std::function<Result<std::unique_ptr<Endpoint>>(EndpointEvents& events, const EndpointOptions& options)>;

struct RemoteOptions {
  wire::Token token{};
  std::string name;                ///< of this person; empty = the host chooses
  std::string address;             ///< for messages: where the host is
  bool wants_grip = true;          ///< false: only looks on
  std::vector<std::string> grips;  ///< names or numbers; empty = the first free one
  /// False: the host is not asked for models of the fluid's wrench (100 kB/s a held body), as nothing here
  /// uses them.
  bool fluid_models = true;
  SnapshotMakerOptions snapshots;
  std::size_t snapshot_bytes = std::size_t{512} << 20;
  double answer_within = 5.0;                   ///< s for the first answer
  double patience = 300.0;                      ///< s of trying to come back
  std::function<std::int64_t()> now = nullptr;  ///< a test's clock; null = the steady clock
};

/// What came of joining; complete and constant once the state is kLive.
struct RemoteWorld {
  Scene scene;
  double spacing = 0.0;  ///< m
  std::unique_ptr<Channel> channel;
  std::unique_ptr<SnapshotMaker> maker;
};

/// One thread calls turn() again and again; RemoteVisit is that thread. Writes channel.bodies(), reads
/// channel.pose(i).
class RemoteLink final : public EndpointEvents {
 public:
  RemoteLink(RemoteOptions options, Connect connect, RemoteShared& shared);
  ~RemoteLink() override;

  /// Does what is due, then waits for the network until the next thing is, or wake(). False when ended.
  bool turn();
  /// Ends a turn that waits. Any thread.
  void wake();
  /// Tells the host good-bye and ends.
  void leave(const std::string& words);

  RemoteWorld& world() { return world_; }

  void on_connected(ConnectionId connection, const KeyFingerprint& key, const std::string& address) override;
  void on_stream(ConnectionId connection, std::int64_t stream, std::span<const std::uint8_t> bytes,
                 bool end) override;
  void on_datagram(ConnectionId connection, std::span<const std::uint8_t> bytes) override;
  void on_closed(ConnectionId connection, const CloseReason& reason) override;

 private:
  /// What the present connection has brought of what a live link needs.
  struct Greeting {
    bool welcome = false;
    bool roster = false;
    bool grips_asked = false;
  };
  /// What is known of the host's world, once in this link's life.
  enum class WorldStage { kNone, kScene, kBuilt };
  struct Request {
    std::uint32_t number = 0;
    wire::ControlType type{};
    std::uint32_t grip = 0;
    bool take = false;
    bool any = false;  // any grip would do
    std::string done;  // what to tell the person when it is granted
  };

  // remote_link.cpp: turns and datagrams; remote_connect.cpp: the connection.
  std::int64_t now() const;
  void try_to_connect(std::int64_t now_ns);
  /// False, and nothing happens, when the event cannot come in this step.
  bool advance(LinkEvent event);
  void lost(const CloseReason& why);
  void drop_endpoint();
  std::int64_t work(std::int64_t now_ns);
  void pump_bodies(std::int64_t now_ns);
  void pass_newest(const BodyMessage& state);
  void send(Priority priority, SharedBytes bytes);
  void ping(std::int64_t now_ns);
  void end(std::optional<Error> error, const std::string& farewell = {});
  void publish(std::int64_t now_ns);
  void note_traffic(std::int64_t now_ns);

  static constexpr double kRetryAnswer = 1.5;    // s that a try to come back waits for an answer
  static constexpr double kBusyPatience = 30.0;  // s of asking a busy host again before the first welcome

  // remote_control.cpp: what is said; remote_grips.cpp: about grips.
  void say_hello();
  wire::Fault receive(std::uint64_t type, wire::ByteView payload);
  wire::Fault on_welcome(wire::ByteView payload);
  wire::Fault on_refused(wire::ByteView payload);
  void refused(wire::RefusalCode code, const std::string& words);
  wire::Fault on_roster(wire::ByteView payload);
  wire::Fault on_roster_change(wire::ByteView payload);
  wire::Fault on_answer(wire::ByteView payload);
  wire::Fault on_world_info(wire::ByteView payload);
  wire::Fault on_rights(wire::ByteView payload);
  wire::Fault on_task(wire::ByteView payload);
  wire::Fault on_cuts(wire::ByteView payload);
  wire::Fault on_notice(wire::ByteView payload);
  void take_scene(std::span<const std::uint8_t> bytes, bool end);
  void build_world();
  void note_held();
  void go_live_if_ready(std::int64_t now_ns);
  void ask_for_grips();
  void request_grip(std::uint32_t grip, bool take, bool any);
  void request_world(const RemoteCommand& command);
  void request_parameter(const RemoteCommand& command);
  std::uint32_t remember(Request request);
  bool take_a_free_grip(bool quietly);
  void obey(const RemoteCommand& command);
  void bad_host(const wire::Fault& fault, const std::string& what);
  void notice(const std::string& text);
  std::string grip_name(std::uint32_t grip) const;
  template <class M>
  void say(const M& message) {
    if (endpoint_ && control_ >= 0)
      (void)endpoint_->send_stream(connection_, control_, wire::control(message), false);
  }

  RemoteOptions options_;
  Connect connect_;
  RemoteShared& shared_;
  RemoteWorld world_;
  RemoteStatus status_;  // this thread's; publish() copies it
  std::unique_ptr<BodyInbox> inbox_;
  std::optional<wire::Cuts> cuts_;  // that came before there was an inbox
  std::unique_ptr<PoseUplink> uplink_;
  wire::Capabilities agreed_ = 0;  // with the host of the present connection
  ClockSync clock_;
  PingSchedule pings_;
  Backoff backoff_;

  std::unique_ptr<Endpoint> endpoint_;
  std::mutex endpoint_mutex_;  // the pointer, against wake()
  ConnectionId connection_ = 0;
  std::int64_t control_ = -1;
  wire::StreamSplitter splitter_;
  wire::Bytes scene_bytes_;
  LinkStep step_ = LinkStep::kIdle;
  std::int64_t step_ns_ = 0;   // when it began
  std::int64_t began_ns_ = 0;  // the first try
  int busy_tries_ = 0;
  Greeting greeting_;
  WorldStage world_stage_ = WorldStage::kNone;
  std::optional<CloseReason> close_due_;  // the connection is over: its endpoint goes at the end of the turn
  std::int64_t pose_due_ns_ = 0;
  std::int64_t publish_due_ns_ = 0;
  std::int64_t traffic_ns_ = 0;
  std::uint64_t traffic_bytes_ = 0;
  std::uint64_t earlier_received_ = 0;  // by connections that are gone
  std::uint64_t earlier_sent_ = 0;
  struct PingSent {
    std::uint32_t number = 0;
    std::int64_t sent_ns = 0;
  };
  std::array<PingSent, 32> pings_sent_{};
  std::uint32_t next_ping_ = 1;
  std::uint32_t next_request_ = 1;
  std::vector<Request> requests_;           // not answered yet
  std::vector<std::uint32_t> grips_tried_;  // by take_a_free_grip
  std::vector<std::uint32_t> grips_had_;    // before contact was lost
};

}  // namespace slosh
