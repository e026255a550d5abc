// The host's side of the network: who may join, who holds what, what is sent to whom.
//
// One thread owns it, the network's: it calls everything here that does not say "any thread". It waits for
// nobody: the world answers through the mailbox, snapshots come coded from the desk. Each part has a class
// with its own state: the door (Admission), who sits where (SeatTable), what moves the grips (HandTable),
// what goes out in datagrams (StateSender, SnapshotSender), the world's switches (WorldSwitches). Here is
// what joins them.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "host/host.h"
#include "host/server/admission.h"
#include "host/server/bans.h"
#include "host/server/console.h"
#include "host/server/deed_log.h"
#include "host/server/effect_budget.h"
#include "host/server/hands.h"
#include "host/server/lasting_clock.h"
#include "host/server/links.h"
#include "host/server/mailbox.h"
#include "host/server/peer_table.h"
#include "host/server/roster.h"
#include "host/server/server_state.h"
#include "host/server/snapshot_desk.h"
#include "host/server/snapshot_sender.h"
#include "host/server/state_sender.h"
#include "host/server/world_switches.h"
#include "net/quic/endpoint.h"
#include "net/wire/roster_change.h"

namespace slosh {

struct ServerOptions {
  RosterLimits limits;
  AdmissionLimits admission;
  double silence = 0.5;  ///< s without a datagram after which others are told so
  BodyRates bodies;
  bool lock_parameters =
      false;  ///< only the console sets viscosity, gravity and stiffness, whatever a link says
  std::size_t hands_to_start = 1;       ///< grips that must be taken before the world starts; 0 = it runs
  LastingClock::Source unix_clock;      ///< Unix time; empty = `clock` where that is given, else the system's
  LastingClock::Source elapsed_clock;   ///< goes on while suspended; empty = likewise
  std::function<std::int64_t()> clock;  ///< ns; empty = the steady clock
  std::function<void(const std::string&)> tell;  ///< lines for whoever runs the host; may be empty
};

/// The world as the server sees it.
struct ServedWorld {
  const Scene* scene = nullptr;  ///< must outlive the server
  wire::Bytes package;           ///< pack_scene(…, kSeen); the server keeps one copy for all connections
  Channel* channel = nullptr;    ///< the server writes poses and reads bodies
  SnapshotDesk* desk = nullptr;
  FluidDemand* fluid_demand = nullptr;  ///< the server says whose wrenches are wanted; null = nobody's
  std::function<void(const HostCommand&, HostAnswer)> command;  ///< Host::post; answers on any thread
  std::function<TaskLines()> task;  ///< where the scene has one, else empty; asked on the server's thread
  HostState state;
  std::uint64_t particles = 0;
  double spacing = 0.0;    ///< m
  double time_step = 0.0;  ///< s
};

/// For the live line, the summary and the benchmarks.
struct ServerFigures {
  std::size_t participants = 0;  ///< connected
  std::size_t spectators = 0;
  std::uint64_t bytes_sent = 0;
  std::uint64_t joins = 0;
  std::uint64_t refused = 0;
  std::uint64_t datagram_faults = 0;
  std::uint64_t datagrams_ignored = 0;  ///< beyond a peer's limit
  std::uint64_t samples_received = 0;   ///< distinct poses of present holders, and how many they numbered
  std::uint64_t samples_expected = 0;
  std::uint64_t fluid_models_sent = 0;  ///< FluidWrench datagrams
  std::uint64_t frames_sent = 0;
  std::uint64_t frames_withheld = 0;
  std::string who;  ///< "Ana (left), Ben (right), 3 watching"
};

class Server final : public EndpointEvents, public HostTap {
 public:
  Server(ServedWorld world, ServerOptions options);
  ~Server() override;

  /// Before anything else; must outlive the server's use.
  void use(Endpoint& endpoint);
  /// Carries on an earlier run: links, seats (all away since now), the world's number. Before the first
  /// turn().
  void restore(const ServerState& state);

  /// After every run_once: what came from the world goes out, and what is due is done.
  void turn();
  /// When the next turn is due if nothing happens; ns of the clock.
  std::int64_t next_turn_ns() const;
  /// Tells everybody and closes every connection; then a few more run_once to let it out.
  void end(const std::string& why);
  bool empty() const { return peers_.empty(); }

  /// One line of the console to what came of it: `granted` is false where nothing was done or found.
  Outcome command(const std::string& line);
  bool quit_asked() const { return quit_asked_; }

  LinkRegistry& links() { return links_; }
  /// Unix time as links and bans go by it, ns.
  std::int64_t unix_now() const { return unix_.now(); }
  const SeatTable& seats() const { return seats_; }
  ServerFigures figures() const;
  std::uint64_t world_number() const { return world_number_; }
  int tier_of(std::uint32_t seat) const;  ///< −1: not here, or gets no snapshots

  Mailbox& mailbox() { return mailbox_; }  ///< any thread posts
  /// Any thread: what a checkpoint keeps, as of the last change, coded.
  wire::Bytes state_blob() const;
  /// Makes state_blob() that of this moment. The server's thread, or before the first turn().
  void save_state();
  void set_identity(wire::Bytes private_key, std::uint16_t port);
  /// Text of a link for people, from its token; set by who knows the addresses.
  std::function<std::string(const LinkRecord&)> link_text;

  // EndpointEvents
  void on_connected(ConnectionId connection, const KeyFingerprint& key, const std::string& address) override;
  void on_stream(ConnectionId connection, std::int64_t stream, std::span<const std::uint8_t> bytes,
                 bool end) override;
  void on_datagram(ConnectionId connection, std::span<const std::uint8_t> bytes) override;
  void on_closed(ConnectionId connection, const CloseReason& reason) override;

  // HostTap, on the host's thread
  void on_start(const World& world, const HostState& state) override;
  void after_publish() override { mailbox_.wake(); }
  void after_change(const World& world, const HostCommand& change, const HostState& state) override;
  void on_gone_body(std::size_t body, const std::string& words) override;
  void on_refused_pose(std::uint32_t grip, PoseFault fault) override;

 private:
  std::int64_t now() const { return options_.clock(); }
  const std::string& name_of(const Peer& peer) { return seats_.by_number(peer.seat)->name; }
  void say(const std::string& line) {
    deeds_.note(line, unix_now());
    if (options_.tell) options_.tell(line);
  }
  template <class M>
  void send(Peer& peer, const M& message);
  template <class M>
  void send_all(const M& message, bool participants_only = false, const Peer* but = nullptr,
                wire::Capabilities behind = 0);
  void notice_all(const std::string& text, bool participants_only = false, const Peer* but = nullptr);
  void refuse(Peer& peer, wire::RefusalCode code, const std::string& text);
  void say_of_stranger(const std::string& line);
  /// How somebody went.
  enum class Parting { kLostContact, kLeft, kPutOut };
  void lose(Peer& peer, Parting parting);
  /// Nothing more is sent or taken.
  void part(Peer& peer);
  /// The connection that a person had before this one goes without a word to the others.
  void replace(const Seat& seat);
  void let_go_all(const Seat& seat);
  void lose_all(const Seat& seat);
  void hide_hands(const Seat& seat);
  void send_roster();
  void send_task();
  void send_cuts();
  void roster_changed() { roster_dirty_ = state_dirty_ = true; }

  // server_control.cpp
  wire::Fault control_message(Peer& peer, std::uint64_t type, wire::ByteView payload);
  wire::Fault handle(Peer& peer, const wire::Hello& hello);
  wire::Fault handle(Peer& peer, const wire::GripRequest& request);
  wire::Fault handle(Peer& peer, const wire::Bye& bye);
  void welcome(Peer& peer, Seat& seat, bool restored);
  void send_scene(Peer& peer);
  void answer(Peer& peer, std::uint32_t request, bool granted, const std::string& text);
  void world_changed(const HostCommand& change, const HostState& state);
  void start_if_held();
  void body_gone(std::size_t body, const std::string& words);
  bool is_gone(std::uint32_t grip) const;

  // server_authority.cpp
  wire::Fault handle(Peer& peer, const wire::WorldRequest& request);
  wire::Fault handle(Peer& peer, const wire::ParameterRequest& request);
  wire::Rights rights_of(const Seat& seat) const;
  void send_rights(Peer& peer, const Seat& seat);
  std::string not_theirs(const Seat& seat, const HostCommand& command) const;
  void refuse_wish(Peer& peer, std::uint32_t request, const HostCommand& command, const std::string& why);
  /// A guest's wish: granted by role and budget, carried out, answered, told.
  void ask_world(Peer& peer, std::uint32_t request, const HostCommand& command);
  /// The console's.
  Outcome tell_world(const HostCommand& command);
  Outcome give_role(const std::string& id, LinkRole role);

  // server_traffic.cpp
  void handle(Peer& peer, const wire::Poses& poses);
  void handle(Peer& peer, const wire::ClockPing& ping);
  void handle(Peer& peer, const wire::SnapshotFeedback& feedback);
  void claimed(Peer& peer, std::uint32_t grip);

  // server_console.cpp
  Outcome run(const ConsoleCommand& command);
  Outcome make_link(const ConsoleCommand& command);
  Outcome release(const std::string& grip_text);
  Outcome kick(const ConsoleCommand& command);
  std::string bans_text() const;
  /// The seat is given up, its grips are let go, its connection is closed.
  void put_out(std::uint32_t number, wire::RefusalCode code, const std::string& text);
  std::string who_text() const;
  std::string links_text() const;
  std::string status_text() const;
  std::string line_of(const LinkRecord& link) const;
  void close_link(const std::string& id);

  void check_patience();

  ServedWorld world_;
  ServerOptions options_;
  Endpoint* endpoint_ = nullptr;
  SharedBytes package_;
  mutable LastingClock unix_;
  LinkRegistry links_;
  BanList bans_;
  SeatTable seats_;
  PeerTable peers_;
  Admission admission_;
  HandTable hands_;
  StateSender states_;
  SnapshotSender snapshots_;
  WorldSwitches switches_;
  EffectBudget budget_;
  DeedLog deeds_;
  Mailbox mailbox_;
  /// One a grip, bits by PoseFault: kinds that its holder was told of. The host's thread sets them, ours
  /// clears.
  std::vector<std::atomic<std::uint32_t>> faults_told_;
  std::vector<char> gone_;  // one a body: it left the world
  std::uint64_t world_number_ = 0;
  std::uint16_t port_ = 0;
  wire::Bytes private_key_;
  wire::RosterTold roster_told_;
  bool roster_dirty_ = false;
  std::int64_t roster_sent_ns_ = 0;
  TaskLines task_told_;
  std::shared_ptr<const BodyCuts> cuts_told_;
  std::int64_t task_asked_ns_ = 0;
  std::int64_t checked_ns_ = 0;
  bool quit_asked_ = false;
  bool ending_ = false;
  std::int64_t stranger_line_due_ns_ = 0;
  std::size_t strangers_unsaid_ = 0;

  ServerFigures past_;  // of connections that are gone
  mutable std::mutex state_mutex_;
  wire::Bytes state_blob_;  // under the mutex
  bool state_dirty_ = true;
};

}  // namespace slosh
