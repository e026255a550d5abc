// What may be asked of the world, by whom, how much of it in a time; and what is told of it.
#include <array>

#include "host/server/server.h"
#include "host/server/server_send.h"
#include "net/clock.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr std::int64_t kRefusalEvery = 10'000'000'000;  // ns between two lines about one guest's refusals

/// "paused the world", or as what somebody wants: "pause the world".
std::string words_of(const HostCommand& command, bool done, const Scene& scene) {
  const auto name = [&](const auto& things) {
    return command.index < things.size() ? things[command.index].name : std::to_string(command.index);
  };
  switch (command.action) {
    case HostAction::kPause:
      return done ? "paused the world" : "pause the world";
    case HostAction::kContinue:
      return done ? "lets the world go on" : "let the world go on";
    case HostAction::kReset:
      return "set the world back to its start";
    case HostAction::kGravityScale:
      return format("set gravity to %.3g times the scene's", command.value);
    case HostAction::kViscosity:
      return format("set the viscosity of '%.40s' to %.4g Pa·s", name(scene.fluids).c_str(), command.value);
    case HostAction::kAppear:
    case HostAction::kTakeAway: {
      const std::string which = command.index < thing_count(scene) ? thing_name(scene, command.index) : "";
      const char* verb = command.action == HostAction::kAppear ? "bring" : "take away";
      const char* past = command.action == HostAction::kAppear ? "brought" : "took away";
      return format("%s '%.40s'", done ? past : verb, which.c_str());
    }
    case HostAction::kGripStiffness:
      break;
  }
  return format("set the hold on '%.40s' to %.3g times the scene's stiffness", name(scene.grips).c_str(),
                command.value);
}

bool is_parameter(HostAction action) {
  return action == HostAction::kGravityScale || action == HostAction::kViscosity ||
         action == HostAction::kGripStiffness;
}

}  // namespace

wire::Rights Server::rights_of(const Seat& seat) const {
  const bool run = seat.role == LinkRole::kRun;
  return {run, run && !options_.lock_parameters, may_hold(seat.role) && !options_.lock_parameters};
}

void Server::send_rights(Peer& peer, const Seat& seat) {
  if (peer.agreed & wire::kLinkRights) send(peer, rights_of(seat));
}

/// Why the one on this seat may not do that, and who can let them; empty where they may.
std::string Server::not_theirs(const Seat& seat, const HostCommand& command) const {
  const std::string own_link = "link '" + seat.name + "' run";
  if (!may_hold(seat.role))
    return "this link is for watching; who changes the world comes by one with the role run. Whoever hosts "
           "makes one "
           "by typing: " +
           own_link;
  if (options_.lock_parameters && is_parameter(command.action))
    return "here only the host sets viscosity, gravity and stiffness";
  if (command.action != HostAction::kGripStiffness) {
    if (seat.role == LinkRole::kRun) return {};
    return "what everybody feels (pause, continue, reset, gravity, viscosity) is for the host, and for links "
           "with the "
           "role run; yours is to hold. Whoever hosts gives the role by typing: role " +
           seat.link + " run, or makes a link of your own: " + own_link;
  }
  const Seat* holder = seats_.holder(command.index);
  if (holder == &seat || (!holder && seat.role == LinkRole::kRun)) return {};
  const std::string grip = seats_.grip_name(command.index);
  return holder ? grip + " is held by " + holder->name + ": its stiffness is theirs to set, and the host's"
                : "take hold of " + grip + " first: its stiffness is its holder's to set, and the host's";
}

void Server::refuse_wish(Peer& peer, std::uint32_t request, const HostCommand& command,
                         const std::string& why) {
  answer(peer, request, false, why);
  const std::string line = name_of(peer) + " may not " + words_of(command, false, *world_.scene);
  deeds_.note(line, unix_now());
  if (now() < peer.refusal_line_due_ns) return;
  peer.refusal_line_due_ns = now() + kRefusalEvery;
  if (options_.tell) options_.tell(line);
}

void Server::ask_world(Peer& peer, std::uint32_t request, const HostCommand& command) {
  const Seat& seat = *seats_.by_number(peer.seat);
  std::string problem = not_theirs(seat, command);
  if (problem.empty()) problem = budget_.spend(peer.key, command, switches_.state(), now());
  if (!problem.empty()) return refuse_wish(peer, request, command, problem);
  switches_.note_wish(command);
  const ConnectionId connection = peer.id;
  const std::string did = seat.name + " " + words_of(command, true, *world_.scene);
  world_.command(command, [this, connection, request, did](const Result<bool>& done) {
    const std::string refused = done ? std::string() : done.error().text();
    mailbox_.post([this, connection, request, did, refused] {
      Peer* asker = peers_.find(connection);
      if (asker) answer(*asker, request, refused.empty(), refused);
      if (refused.empty()) notice_all(did, false, asker);
    });
  });
}

Outcome Server::tell_world(const HostCommand& command) {
  switches_.note_wish(command);
  const std::string did = "the host " + words_of(command, true, *world_.scene);
  world_.command(command, [this, did](const Result<bool>& done) {
    const std::string refused = done ? std::string() : done.error().text();
    mailbox_.post([this, did, refused] { refused.empty() ? notice_all(did) : say(refused); });
  });
  return {true, "asked for"};
}

wire::Fault Server::handle(Peer& peer, const wire::WorldRequest& request) {
  constexpr std::array kActions{HostAction::kPause, HostAction::kContinue, HostAction::kReset};
  ask_world(peer, request.request, {kActions[static_cast<std::size_t>(request.action)]});
  return {};
}

wire::Fault Server::handle(Peer& peer, const wire::ParameterRequest& request) {
  const auto& grips = world_.scene->grips;
  const auto& fluids = world_.scene->fluids;
  switch (request.parameter) {
    case wire::Parameter::kGravityScale:
      ask_world(peer, request.request, {HostAction::kGravityScale, 0, request.value});
      break;
    case wire::Parameter::kGripStiffness:
      if (request.index < grips.size())
        ask_world(peer, request.request, {HostAction::kGripStiffness, request.index, request.value});
      else
        answer(peer, request.request, false, no_grip_text(std::to_string(request.index), grips));
      break;
    case wire::Parameter::kFluidViscosity:
      if (request.index < fluids.size())
        ask_world(peer, request.request, {HostAction::kViscosity, request.index, request.value});
      else
        answer(peer, request.request, false,
               "there is no fluid " + std::to_string(request.index) + "; this scene has " +
                   std::to_string(fluids.size()));
      break;
  }
  return {};
}

Outcome Server::give_role(const std::string& id, LinkRole role) {
  const LinkRecord* link = links_.find(id);
  if (!link) return {false, "there is no link '" + id + "'. `links` lists them"};
  if (!may_hold(link->role))
    return {false, id + " is a link to watch, and stays one. `link NAME run` makes another"};
  links_.set_role(id, role);
  state_dirty_ = true;
  const std::string may =
      role == LinkRole::kRun ? " may run the world" : " may hold, and no longer run the world";
  for (const auto& [number, one] : seats_.seats()) {
    if (one.link != id || one.role == role) continue;
    Seat& seat = *seats_.by_number(number);
    seat.role = role;
    if (Peer* peer = peers_.of_seat(number)) send_rights(*peer, seat);
    notice_all(seat.name + may + " now");
  }
  return {true, "whoever comes by " + id + may};
}

}  // namespace slosh
