#include "host/server/server.h"

#include <algorithm>
#include <utility>

#include "host/server/server_send.h"
#include "net/clock.h"
#include "net/grip_start.h"
#include "net/random.h"
#include "net/site.h"

namespace slosh {
namespace {

constexpr std::int64_t kRosterEvery = 50'000'000;  // ns between two rosters: comings may come in crowds
constexpr std::int64_t kTaskEvery = 250'000'000;   // ns
constexpr std::int64_t kCheckEvery = 50'000'000;   // ns between two looks at who is late
constexpr std::int64_t kLongestNap = 50'000'000;   // ns
constexpr std::int64_t kStrangerLineEvery = 10'000'000'000;  // ns between two lines about strangers

std::vector<std::string> grip_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Grip& grip : scene.grips) names.push_back(grip.name);
  return names;
}

LastingClock make_unix_clock(const ServerOptions& options) {
  // A test's clock moves everything.
  const auto or_own = [&](const LastingClock::Source& given, const LastingClock::Source& own) {
    return given ? given : options.clock ? options.clock : own;
  };
  return LastingClock(or_own(options.unix_clock, unix_now_ns), or_own(options.elapsed_clock, boot_now_ns));
}

std::uint64_t random_number() {
  std::array<std::uint8_t, 8> raw{};
  fill_random(raw);
  std::uint64_t number = 0;
  for (const std::uint8_t byte : raw) number = number << 8 | byte;
  return number;
}

}  // namespace

Server::Server(ServedWorld world, ServerOptions options)
    : world_(std::move(world)),
      options_(std::move(options)),
      package_(std::make_shared<const wire::Bytes>(std::move(world_.package))),
      unix_(make_unix_clock(options_)),
      seats_(grip_names(*world_.scene), options_.limits),
      admission_(options_.admission),
      hands_(*world_.scene, *world_.channel),
      states_(*world_.scene, *world_.channel, hands_, peers_, options_.bodies, world_.fluid_demand),
      snapshots_(world_.desk),
      switches_(world_.state, options_.hands_to_start),
      faults_told_(world_.scene->grips.size()),
      world_number_(random_number()) {
  if (!options_.clock) options_.clock = [] { return steady_now_ns(); };
  hands_.stand_all(now());
}

Server::~Server() {
  mailbox_.set_wake({});
}

void Server::use(Endpoint& endpoint) {
  endpoint_ = &endpoint;
  endpoint.set_known_keys([this](const KeyFingerprint& key) { return seats_.by_key(key) != nullptr; });
  states_.use(endpoint);
  snapshots_.use(endpoint);
  mailbox_.set_wake([&endpoint] { endpoint.wake(); });
}

void Server::set_identity(wire::Bytes private_key, std::uint16_t port) {
  private_key_ = std::move(private_key);
  port_ = port;
  state_dirty_ = true;
}

void Server::restore(const ServerState& state) {
  world_number_ = state.world;
  unix_.not_before(state.seen_ns);
  links_.restore(state.links);
  bans_.restore(state.bans);
  seats_.restore(state.seats, now());
  std::vector<bool> awaited;
  for (std::uint32_t grip = 0; grip < hands_.size(); ++grip)
    awaited.push_back(seats_.holder(grip) != nullptr);
  hands_.carry_on(world_.channel->bodies().front().bodies, now(), awaited);
  state_dirty_ = true;
}

void Server::notice_all(const std::string& text, bool participants_only, const Peer* but) {
  say(text);
  send_all(wire::Notice{text}, participants_only, but);
}

void Server::on_connected(ConnectionId connection, const KeyFingerprint& key, const std::string& address) {
  const auto turn_away = [&](ConnectionId whom, wire::RefusalCode code, const char* text) {
    past_.refused += 1;
    endpoint_->close(whom, close_code(code), text);
  };
  if (ending_) return turn_away(connection, wire::RefusalCode::kEnding, "the host is ending");
  const Admission::Verdict verdict =
      admission_.arrive(connection, key, address, seats_.by_key(key) != nullptr, now());
  if (!verdict.enters)
    return turn_away(connection, wire::RefusalCode::kFull, "too many connections come from your address");
  if (verdict.goes) {
    if (Peer* idle = peers_.find(*verdict.goes)) {
      part(*idle);
      turn_away(idle->id, wire::RefusalCode::kBusy, "others came while nothing was said yet");
    }
  }
  auto peer = std::make_unique<Peer>();
  peer->id = connection;
  peer->key = key;
  peer->address = address;
  peer->received_ns = now();
  peers_.add(std::move(peer));
}

void Server::on_stream(ConnectionId connection, std::int64_t stream, std::span<const std::uint8_t> bytes,
                       bool end) {
  Peer* peer = peers_.find(connection);
  if (!peer) return;
  if (peer->control_stream < 0 && stream % 4 == 0) peer->control_stream = stream;
  if (stream != peer->control_stream)
    return refuse(*peer, wire::RefusalCode::kBadMessage, "only one stream, both ways, may be opened");
  wire::Fault fault = peer->splitter.feed(bytes, [&](std::uint64_t type, wire::ByteView payload) {
    return peer->gone ? wire::Fault{} : control_message(*peer, type, payload);
  });
  if (!fault && end) fault = peer->splitter.finish();
  if (peer->gone) return;
  if (fault) return refuse(*peer, wire::RefusalCode::kBadMessage, fault.text());
  if (end) lose(*peer, Parting::kLeft);
}

void Server::on_closed(ConnectionId connection, const CloseReason& reason) {
  Peer* peer = peers_.find(connection);
  if (!peer) return;
  if (peer->in) say(name_of(*peer) + ": connection closed: " + reason.text);
  lose(*peer, Parting::kLostContact);
}

void Server::refuse(Peer& peer, wire::RefusalCode code, const std::string& text) {
  if (peer.gone) return;
  const std::string words = wire::clean_text(text, wire::kMaxText);
  send(peer, wire::Refused{code, words});
  past_.refused += 1;
  if (peer.in)
    say(name_of(peer) + " is refused: " + words);
  else
    say_of_stranger(peer.address + " is refused: " + words);
  lose(peer, Parting::kPutOut);
  endpoint_->close(peer.id, close_code(code), words);
}

// Anybody can knock, as often as they like: the crowd gets one line now and then.
void Server::say_of_stranger(const std::string& line) {
  if (now() < stranger_line_due_ns_) {
    strangers_unsaid_ += 1;
    return;
  }
  say(line);
  stranger_line_due_ns_ = now() + kStrangerLineEvery;
}

void Server::let_go_all(const Seat& seat) {
  for (const std::uint32_t grip : seat.grips) hands_.let_go(grip, now());
  hide_hands(seat);
}

/// Contact is lost.
void Server::lose_all(const Seat& seat) {
  for (const std::uint32_t grip : seat.grips) hands_.lose(grip, now());
  hide_hands(seat);
}

/// To the others the hands are nowhere.
void Server::hide_hands(const Seat& seat) {
  wire::Hands hands;
  for (const std::uint32_t grip : seat.grips)
    hands.hands.push_back({grip, now(), grip_start(*world_.scene, grip), Twist{}, false});
  states_.let_go(seat.number, hands);
}

void Server::part(Peer& peer) {
  peer.gone = true;
  past_.bytes_sent += endpoint_->stats(peer.id).bytes_sent;
  admission_.forget(peer.id);
  snapshots_.forget(peer.id);
}

// The connection is over for us. The seat stays for a while; its grips wait only for who lost contact.
void Server::lose(Peer& peer, Parting parting) {
  if (peer.gone) return;
  part(peer);
  if (parting == Parting::kLeft) endpoint_->close(peer.id, 0, "goodbye");
  if (!peer.in) return;
  peers_.stand_up(peer.seat);
  Seat* seat = seats_.by_number(peer.seat);
  if (!seat) return;
  std::string text = seat->name;
  if (parting == Parting::kLostContact) {
    lose_all(*seat);
    seats_.lose(*seat, now());
    text = "contact with " + text + " is lost";
    if (!seat->grips.empty()) text += "; what they hold is kept for them for a minute";
  } else {
    let_go_all(*seat);
    seats_.leave(*seat, now());
    text += parting == Parting::kLeft ? " has left" : " was put out";
  }
  notice_all(text, !may_hold(seat->role));
  roster_changed();
}

void Server::turn() {
  mailbox_.run_all();
  if (now() - checked_ns_ >= kCheckEvery) check_patience();
  states_.send_bodies(seats_, now());
  send_cuts();
  snapshots_.send(now());
  snapshots_.judge(now());
  if (roster_dirty_ && now() - roster_sent_ns_ >= kRosterEvery) {
    roster_dirty_ = false;
    roster_sent_ns_ = now();
    send_roster();
  }
  if (world_.task && now() - task_asked_ns_ >= kTaskEvery) send_task();
  if (state_dirty_) save_state();
  peers_.sweep();
}

void Server::send_roster() {
  const wire::Roster roster = seats_.message();
  const wire::RosterChange change = roster_told_.change(roster);
  std::vector<Peer*> whole;
  std::vector<Peer*> changes;
  peers_.each_in(
      [&](Peer& peer) { (peer.agreed & wire::kRosterChanges ? changes : whole).push_back(&peer); });
  // Who reads too slowly goes, which others are told by the next change.
  const bool nothing = change.changed.empty() && change.gone.empty();
  for (Peer* peer : whole) send(*peer, roster);
  for (Peer* peer : changes) {
    if (!nothing) send(*peer, change);
  }
}

std::int64_t Server::next_turn_ns() const {
  if (snapshots_.sending()) return now();
  std::int64_t next = now() + kLongestNap;
  if (roster_dirty_) next = std::min(next, roster_sent_ns_ + kRosterEvery);
  return next;
}

void Server::check_patience() {
  checked_ns_ = now();
  if (strangers_unsaid_ > 0 && now() >= stranger_line_due_ns_)
    say_of_stranger(std::to_string(std::exchange(strangers_unsaid_, 0)) + " more strangers were refused");
  for (const ConnectionId id : admission_.late(now())) {
    if (Peer* peer = peers_.find(id))
      refuse(*peer, wire::RefusalCode::kTimedOut, "nothing was said for too long after connecting");
  }
  for (const auto& [id, peer] : peers_.all()) {
    if (peer->gone || !peer->in) continue;
    if (!peer->scene_sent) send_scene(*peer);
    const Seat& seat = *seats_.by_number(peer->seat);
    const bool quiet = now() - peer->received_ns > to_nanoseconds(options_.silence);
    if (quiet && !peer->silent && !seat.grips.empty()) {
      peer->silent = true;
      // The world's gate knows by itself: a silent hand comes to rest, and gives way to those whose updates
      // come.
      hide_hands(seat);
      notice_all(seat.name + " is not heard any more; what they hold waits for them", false, peer.get());
    } else if (!quiet && peer->silent) {
      peer->silent = false;
      notice_all(seat.name + " is heard again", false, peer.get());
    }
  }
  if (bans_.expire(unix_now())) state_dirty_ = true;
  for (const Seat& seat : seats_.expire(now())) {
    for (const std::uint32_t grip : seat.grips) {
      if (!seats_.holder(grip)) hands_.let_go(grip, now(), true);
    }
    if (!seat.left) {
      notice_all(seat.name + " did not come back; the seat is free", !may_hold(seat.role));
    }
    roster_changed();
  }
}

void Server::save_state() {
  state_dirty_ = false;
  ServerState state{private_key_,     world_number_, port_,     links_.links(),
                    seats_.records(), bans_.bans(),  unix_now()};
  wire::Bytes blob = wire::encoded(state);
  const std::lock_guard lock(state_mutex_);
  state_blob_ = std::move(blob);
}

wire::Bytes Server::state_blob() const {
  const std::lock_guard lock(state_mutex_);
  return state_blob_;
}

void Server::end(const std::string& why) {
  ending_ = true;
  for (const auto& [id, peer] : peers_.all()) {
    if (peer->gone) continue;
    part(*peer);
    if (peer->control_stream >= 0)
      send_bytes(*endpoint_, *peer, wire::control(wire::Refused{wire::RefusalCode::kEnding, why}));
    endpoint_->close(id, close_code(wire::RefusalCode::kEnding), why);
  }
  peers_.all_stand_up();
  for (std::uint32_t grip = 0; grip < hands_.size(); ++grip) hands_.let_go(grip, now());
  peers_.sweep();
}

void Server::on_start(const World& world, const HostState& state) {
  BodySnapshot bodies;
  world.fill(bodies);
  std::vector<char> gone;
  for (const BodyState& body : bodies.bodies) gone.push_back(body.gone && !body.away());
  mailbox_.post([this, state, gone] {
    switches_.told(state);
    gone_ = gone;
  });
}

void Server::on_gone_body(std::size_t body, const std::string& words) {
  mailbox_.post([this, body, words] { body_gone(body, words); });
}

void Server::after_change(const World&, const HostCommand& change, const HostState& state) {
  mailbox_.post([this, change, state] { world_changed(change, state); });
}

void Server::on_refused_pose(std::uint32_t grip, PoseFault fault) {
  const std::uint32_t bit = 1u << static_cast<unsigned>(fault);
  if (grip >= faults_told_.size() || (faults_told_[grip].fetch_or(bit) & bit) != 0) return;
  mailbox_.post([this, grip, fault] {
    const Seat* holder = seats_.holder(grip);
    Peer* peer = holder ? peers_.of_seat(holder->number) : nullptr;
    if (peer)
      send(*peer,
           wire::Notice{"your poses for " + seats_.grip_name(grip) + " are not used: " + words_of(fault)});
  });
}

int Server::tier_of(std::uint32_t seat) const {
  const Peer* peer = peers_.of_seat(seat);
  return peer ? snapshots_.tier_of(peer->id) : -1;
}

ServerFigures Server::figures() const {
  ServerFigures figures = past_;
  std::string watching;
  for (const auto& [number, seat] : seats_.seats()) {
    if (!seat.connected) continue;
    if (!may_hold(seat.role)) {
      figures.spectators += 1;
      continue;
    }
    figures.participants += 1;
    if (!figures.who.empty()) figures.who += ", ";
    figures.who += seat.name;
    for (const std::uint32_t grip : seat.grips) {
      figures.who += (grip == seat.grips.front() ? " (" : ", ") + world_.scene->grips[grip].name;
      figures.samples_received += hands_.delivery(grip).received;
      figures.samples_expected += hands_.delivery(grip).expected;
    }
    if (!seat.grips.empty()) figures.who += ")";
  }
  if (figures.spectators > 0) {
    if (!figures.who.empty()) figures.who += ", ";
    figures.who += std::to_string(figures.spectators) + " watching";
  }
  figures.fluid_models_sent = states_.fluid_models_sent();
  figures.frames_sent = snapshots_.frames_sent();
  figures.frames_withheld = snapshots_.frames_withheld();
  for (const auto& [id, peer] : peers_.all()) {
    if (!peer->gone && endpoint_) figures.bytes_sent += endpoint_->stats(id).bytes_sent;
  }
  return figures;
}

}  // namespace slosh
