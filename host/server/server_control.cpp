// The control stream: who is let in, and what they may ask for.
#include <algorithm>

#include "host/server/server.h"
#include "host/server/server_send.h"
#include "net/clock.h"
#include "net/wire/all_messages.h"

namespace slosh {
namespace {

template <class M>
constexpr bool kIsRequest = requires(const M& m) { m.request; };

}  // namespace

wire::Fault Server::control_message(Peer& peer, std::uint64_t type, wire::ByteView payload) {
  const bool hello = type == static_cast<std::uint64_t>(wire::ControlType::kHello);
  if (peer.in == hello) return {"type", hello ? "Hello came a second time" : "something came before Hello"};
  const bool too_many = !peer.limits.requests.take(now());
  if (too_many && !peer.limits.excess.take(now())) {
    refuse(peer, wire::RefusalCode::kTooMuch, "you asked for more than anybody could want");
    return {};
  }
  return wire::dispatch(
      wire::PeerControl{}, type, payload,
      [&]<class M>(const M& message) -> wire::Fault {
        if constexpr (kIsRequest<M>) {
          if (too_many) {
            answer(peer, message.request, false, "too many requests at once; wait a moment");
            return {};
          }
        }
        return handle(peer, message);
      },
      peer.agreed);
}

wire::Fault Server::handle(Peer& peer, const wire::Hello& hello) {
  if (hello.version != wire::kProtocolVersion) {
    refuse(peer, wire::RefusalCode::kVersion,
           "the host speaks version " + std::to_string(wire::kProtocolVersion) + " and you speak version " +
               std::to_string(hello.version) + ". Both need the same slosh");
    return {};
  }
  if (const std::int64_t until = bans_.until(peer.key, unix_now()); until != 0) {
    refuse(peer, wire::RefusalCode::kBanned,
           "the host has put you out for another " + duration_text(until - unix_now()));
    return {};
  }
  const LinkVerdict verdict = links_.check(hello.token, peer.key, unix_now());
  const Seat* kept = seats_.by_key(peer.key);
  const LinkRecord* link = verdict.link;
  // Who lost contact comes back by the same link even when it has expired meanwhile.
  if (!link && verdict.code == wire::RefusalCode::kExpired && kept) link = links_.find(kept->link);
  if (!link) {
    refuse(peer, verdict.code, verdict.text);
    return {};
  }
  if (const std::string problem = seats_.full(peer.key, link->role); !problem.empty()) {
    refuse(peer, wire::RefusalCode::kFull, problem);
    return {};
  }
  if (kept) replace(*kept);
  const std::string id = link->id;
  const std::string& wish = link->name.empty() ? hello.name : link->name;
  const SeatTable::Arrival arrival =
      seats_.arrive(peer.key, link->role, wish, id, links_.reserved_names(id, unix_now()));
  if (!arrival.seat) {
    refuse(peer, wire::RefusalCode::kFull, arrival.text);
    return {};
  }
  links_.note_use(id, peer.key);
  state_dirty_ = true;
  snapshots_.add(peer.id, wire_role(link->role), hello.snapshots);
  peer.agreed = hello.capabilities & wire::kOurCapabilities;
  welcome(peer, *arrival.seat, arrival.restored);
  return {};
}

void Server::replace(const Seat& seat) {
  Peer* before = peers_.of_seat(seat.number);
  if (!before) return;
  part(*before);
  lose_all(seat);
  peers_.stand_up(seat.number);
  const std::string text = "you came again from elsewhere, and this connection is closed";
  if (before->control_stream >= 0)
    send_bytes(*endpoint_, *before, wire::control(wire::Refused{wire::RefusalCode::kReplaced, text}));
  endpoint_->close(before->id, close_code(wire::RefusalCode::kReplaced), text);
}

void Server::welcome(Peer& peer, Seat& seat, bool restored) {
  admission_.admit(peer.id);
  endpoint_->admit(peer.id);
  peer.in = true;
  peers_.sit(peer, seat.number);
  peer.participant = may_hold(seat.role);
  peer.received_ns = now();
  past_.joins += 1;
  // A program that was started anew numbers its samples anew.
  for (const std::uint32_t grip : seat.grips) {
    hands_.taken(grip, now());
    faults_told_[grip] = 0;
  }

  wire::Welcome message;
  message.peer = seat.number;
  message.role = wire_role(seat.role);
  message.name = seat.name;
  message.world = world_number_;
  message.scene_bytes = package_->size();
  message.particles = world_.particles;
  message.spacing = world_.spacing;
  message.time_step = world_.time_step;
  message.snapshot_rate = kTierSnapshotRate;
  message.restored = restored;
  message.capabilities = peer.agreed;
  send(peer, message);
  const wire::Roster roster = seats_.message();
  roster_told_.whole(roster);
  send(peer, roster);
  send(peer, switches_.message());
  send_rights(peer, seat);
  if (!task_told_.title.empty() && (peer.agreed & wire::kTasks)) send(peer, task_message(task_told_));
  if (cuts_told_ && (peer.agreed & wire::kBodyCuts))
    send(peer, wire::to_message(*cuts_told_, states_.newest().run));
  if (switches_.waits_for_hands() && !peer.gone) send(peer, wire::Notice{switches_.waiting_text()});
  send_scene(peer);
  if (peer.gone) return;
  snapshots_.watch(peer.id, now());
  notice_all(seat.name + (restored              ? " is back"
                          : may_hold(seat.role) ? " is here"
                                                : " is watching"),
             !may_hold(seat.role), &peer);
  roster_changed();
  start_if_held();
}

void Server::send_task() {
  task_asked_ns_ = now();
  const TaskLines lines = world_.task();
  if (lines == task_told_) return;
  task_told_ = lines;
  send_all(task_message(lines), false, nullptr, wire::kTasks);
}

void Server::send_cuts() {
  const BodyMessage& newest = states_.newest();
  if (newest.bodies.cuts == cuts_told_) return;
  cuts_told_ = newest.bodies.cuts;
  // Of a run that begins all bodies are whole.
  if (cuts_told_) send_all(wire::to_message(*cuts_told_, newest.run), false, nullptr, wire::kBodyCuts);
}

void Server::send_scene(Peer& peer) {
  if (peer.scene_sent || peer.gone) return;
  const std::int64_t stream = endpoint_->open_stream(peer.id, false);
  if (stream < 0) return;  // tried again soon
  peer.scene_sent = true;
  if (endpoint_->send_shared(peer.id, stream, package_, true)) return;
  lose(peer, Parting::kPutOut);
  endpoint_->close(peer.id, close_code(wire::RefusalCode::kTooMuch),
                   "the scene does not fit into the buffer");
}

void Server::answer(Peer& peer, std::uint32_t request, bool granted, const std::string& text) {
  send(peer, wire::Answer{request, granted, wire::clean_text(text, wire::kMaxText)});
}

wire::Fault Server::handle(Peer& peer, const wire::GripRequest& request) {
  Seat& seat = *seats_.by_number(peer.seat);
  if (request.take && is_gone(request.grip)) {
    answer(peer, request.request, false,
           seats_.grip_name(request.grip) + " is on a body that left the world, until the world is set back");
    return {};
  }
  const bool held = request.take && seats_.holder(request.grip) == &seat;
  const Outcome outcome = request.take ? seats_.take(seat, request.grip) : seats_.release(seat, request.grip);
  answer(peer, request.request, outcome.granted, outcome.text);
  if (!outcome.granted || held || peer.gone) return {};
  deeds_.note(seat.name + (request.take ? " took " : " let go of ") + seats_.grip_name(request.grip),
              unix_now());
  if (request.take) {
    peer.received_ns = now();
    hands_.taken(request.grip, now());
    faults_told_[request.grip] = 0;
    start_if_held();
  } else {
    hands_.let_go(request.grip, now());
  }
  roster_changed();
  return {};
}

bool Server::is_gone(std::uint32_t grip) const {
  const std::vector<Grip>& grips = world_.scene->grips;
  if (grip >= grips.size()) return false;
  const auto body = static_cast<std::size_t>(grips[grip].body);
  return body < gone_.size() && gone_[body] != 0;
}

void Server::body_gone(std::size_t body, const std::string& words) {
  if (body >= gone_.size()) gone_.resize(body + 1, 0);
  gone_[body] = 1;
  for (std::uint32_t grip = 0; grip < hands_.size(); ++grip) {
    if (!is_gone(grip)) continue;
    if (const Seat* holder = seats_.holder(grip)) seats_.release(*seats_.by_number(holder->number), grip);
    hands_.let_go(grip, now(), true);
  }
  roster_changed();
  notice_all(words + kGoneAdvice);
}

void Server::start_if_held() {
  std::size_t held = 0;
  for (std::uint32_t grip = 0; grip < hands_.size(); ++grip) held += seats_.holder(grip) ? 1 : 0;
  if (!switches_.starts_with(held, hands_.size())) return;
  world_.command({HostAction::kContinue}, {});
  notice_all("the world starts");
}

wire::Fault Server::handle(Peer& peer, const wire::Bye& bye) {
  (void)bye;
  lose(peer, Parting::kLeft);
  return {};
}

void Server::world_changed(const HostCommand& change, const HostState& state) {
  switches_.told(state);
  if (change.action == HostAction::kReset) {
    hands_.stand_all(now());
    gone_.clear();
  }
  send_all(switches_.message());
}

}  // namespace slosh
