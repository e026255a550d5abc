// What the console's commands do.
#include <algorithm>

#include "host/server/server.h"
#include "host/server/server_send.h"
#include "net/clock.h"

namespace slosh {

std::string Server::command(const std::string& line) {
  const Result<ConsoleCommand> parsed = parse_console(line);
  return parsed ? run(parsed.value()) : parsed.error().text();
}

std::string Server::run(const ConsoleCommand& command) {
  const auto world = [&](HostCommand what) {
    note_wish(what);
    world_.command(what, [this](const Result<bool>& done) {
      if (done) return;
      const std::string problem = done.error().text();
      mailbox_.post([this, problem] { say(problem); });
    });
    return std::string("asked for");
  };
  switch (command.verb) {
    case ConsoleVerb::kNothing:
      return {};
    case ConsoleVerb::kHelp:
      return console_help();
    case ConsoleVerb::kWho:
      return who_text();
    case ConsoleVerb::kLinks:
      return links_text();
    case ConsoleVerb::kStatus:
      return status_text();
    case ConsoleVerb::kPause:
      return world({HostAction::kPause});
    case ConsoleVerb::kContinue:
      return world({HostAction::kContinue});
    case ConsoleVerb::kReset:
      return world({HostAction::kReset});
    case ConsoleVerb::kQuit:
      quit_asked_ = true;
      return "the session ends";
    case ConsoleVerb::kLink: {
      const wire::Role role = command.watch ? wire::Role::kSpectator : wire::Role::kParticipant;
      const auto in_use = [this](const std::string& id) {
        return std::any_of(seats_.seats().begin(), seats_.seats().end(),
                           [&](const auto& entry) { return entry.second.link == id; });
      };
      const LinkRecord* link = links_.create(role, command.text, unix_now(), command.lifetime_ns, in_use);
      if (!link) return "there are " + std::to_string(kMaxLinks) + " links already. Revoke some first";
      session_dirty_ = true;
      return line_of(*link);
    }
    case ConsoleVerb::kRevoke: {
      if (!links_.revoke(command.text)) return "there is no link '" + command.text + "'. `links` lists them";
      close_link(command.text);
      session_dirty_ = true;
      return command.text + " is revoked, and whoever came in by it is out";
    }
    case ConsoleVerb::kExpire: {
      const std::int64_t at = command.lifetime_ns > 0 ? unix_now() + command.lifetime_ns : 0;
      if (!links_.set_expiry(command.text, at))
        return "there is no link '" + command.text + "'. `links` lists them";
      session_dirty_ = true;
      return command.text + (at == 0 ? " never expires"
                                     : " admits nobody new in " + duration_text(command.lifetime_ns) +
                                           "; who is in stays. Revoke it to end that too");
    }
    case ConsoleVerb::kRelease: {
      const std::optional<std::size_t> grip = index_named(world_.scene->grips, command.text);
      if (!grip)
        return "there is no grip '" + command.text + "'. There are: " + names_of(world_.scene->grips);
      const auto index = static_cast<std::uint32_t>(*grip);
      const Seat* holder = seats_.holder(index);
      if (!holder) return seats_.grip_name(index) + " is free already";
      seats_.release(*seats_.by_number(holder->number), index);
      hands_.let_go(index, now(), true);
      roster_changed();
      const std::string text = "the host took " + seats_.grip_name(index) + " from " + holder->name;
      notice_all(text);
      return text;
    }
    case ConsoleVerb::kKick: {
      Seat* seat = seats_.by_name(command.text);
      if (!seat) return "nobody here is called '" + command.text + "'. `who` lists them";
      const std::uint32_t number = seat->number;
      for (const std::uint32_t grip : seat->grips) hands_.let_go(grip, now(), true);
      if (Peer* peer = peer_of(number))
        refuse(*peer, wire::RefusalCode::kEnding, "the host closed your connection");
      seats_.remove(number);
      roster_changed();
      return command.text + " is out. Revoke their link too if they are not to come back";
    }
    case ConsoleVerb::kSet: {
      if (command.gravity) return world({HostAction::kGravityScale, 0, command.value});
      const auto& fluids = world_.scene->fluids;
      const std::optional<std::size_t> fluid = fluid_meant(fluids, command.text);
      if (!fluid) return "say which fluid: " + names_of(fluids);
      return world({HostAction::kViscosity, static_cast<std::uint32_t>(*fluid), command.value});
    }
  }
  return {};
}

void Server::close_link(const std::string& id) {
  std::vector<std::uint32_t> out;
  for (const auto& [number, seat] : seats_.seats()) {
    if (seat.link == id) out.push_back(number);
  }
  for (const std::uint32_t number : out) {
    const Seat* seat = seats_.by_number(number);
    for (const std::uint32_t grip : seat->grips) hands_.let_go(grip, now(), true);
    if (Peer* peer = peer_of(number))
      refuse(*peer, wire::RefusalCode::kRevoked, "the host has revoked the link that you came by");
    seats_.remove(number);
  }
  roster_changed();
}

std::string Server::line_of(const LinkRecord& link) const {
  std::string line = link.id + "  " + (link.role == wire::Role::kParticipant ? "to hold " : "to watch");
  line += "  for " + (link.name.empty() ? std::string("anybody") : link.name);
  if (link.revoked)
    line += ", revoked";
  else if (link.expires_ns != 0 && link.expires_ns <= unix_now())
    line += ", expired";
  else if (link.expires_ns != 0)
    line += ", expires in " + duration_text(link.expires_ns - unix_now());
  std::string users;
  for (const auto& [number, seat] : seats_.seats()) {
    if (seat.link == link.id) users.append(users.empty() ? "" : ", ").append(seat.name);
  }
  if (!users.empty())
    line += ", used by " + users;
  else if (!link.users.empty())
    line += ", used before";
  if (link_text && !link.revoked) line += "\n  " + link_text(link);
  return line;
}

std::string Server::links_text() const {
  std::string text;
  for (const LinkRecord& link : links_.links()) text.append(text.empty() ? "" : "\n").append(line_of(link));
  return text.empty() ? "there are no links. `link` makes one" : text;
}

std::string Server::who_text() const {
  std::string text;
  for (const auto& [number, seat] : seats_.seats()) {
    if (seat.left) continue;
    std::string line = seat.name + ", " + wire::kRoleNames[static_cast<std::size_t>(seat.role)];
    for (const std::uint32_t grip : seat.grips) line += ", " + seats_.grip_name(grip);
    if (!seat.connected) line += ", away for " + duration_text(now() - seat.away_since_ns);
    const auto found = by_seat_.find(number);
    if (found != by_seat_.end() && endpoint_) {
      const ConnectionStats stats = endpoint_->stats(found->second);
      const auto& peer = peers_.at(found->second);
      const PictureSink& sink = peer->pictures;
      line += ", " + peer->address + ", " + std::to_string(static_cast<int>(1e3 * stats.smoothed_rtt + 0.5)) +
              " ms, gets " +
              (sink.wanted ? kTiers[static_cast<std::size_t>(sink.control.tier())].words : "no particles");
    }
    text.append(text.empty() ? "" : "\n").append(line);
  }
  return text.empty() ? "nobody is here" : text;
}

std::string Server::status_text() const {
  const ServerFigures f = figures();
  const HostState& state = world_.state;
  char text[400];
  std::snprintf(text, sizeof text,
                "%s, run %u, gravity × %.3g; %zu with hands, %zu watching; %.1f MB sent, %llu refused, %llu "
                "damaged datagrams, %llu beyond limits",
                waits_for_hands_ ? "waiting for hands"
                : state.paused   ? "paused"
                                 : "running",
                state.run, state.gravity_scale, f.participants, f.spectators,
                1e-6 * static_cast<double>(f.bytes_sent), static_cast<unsigned long long>(f.refused),
                static_cast<unsigned long long>(f.datagram_faults),
                static_cast<unsigned long long>(f.datagrams_ignored));
  std::string all = text;
  for (std::size_t i = 0; i < state.viscosities.size() && i < world_.scene->fluids.size(); ++i) {
    std::snprintf(text, sizeof text, "\nfluid '%.60s': %.4g Pa·s", world_.scene->fluids[i].name.c_str(),
                  state.viscosities[i]);
    all += text;
  }
  return all;
}

}  // namespace slosh
