// What the console's commands do.
#include <algorithm>
#include <array>

#include "host/server/server.h"
#include "host/server/server_send.h"
#include "net/clock.h"
#include "net/text/name.h"

namespace slosh {

Outcome Server::command(const std::string& line) {
  const Result<ConsoleCommand> parsed = parse_console(line);
  return parsed ? run(parsed.value()) : Outcome{false, parsed.error().text()};
}

Outcome Server::run(const ConsoleCommand& command) {
  const Outcome no_link{false, "there is no link '" + command.text + "'. `links` lists them"};
  switch (command.verb) {
    case ConsoleVerb::kNothing:
    case ConsoleVerb::kTake:  // a peer's
      return {true, {}};
    case ConsoleVerb::kHelp:
      return {true, console_help(Console::kHost)};
    case ConsoleVerb::kWho:
      return {true, who_text()};
    case ConsoleVerb::kLinks:
      return {true, links_text()};
    case ConsoleVerb::kStatus:
      return {true, status_text()};
    case ConsoleVerb::kLog:
      return {true, deeds_.text()};
    case ConsoleVerb::kRole:
      return give_role(command.text, command.role);
    case ConsoleVerb::kPause:
      return tell_world({HostAction::kPause});
    case ConsoleVerb::kContinue:
      return tell_world({HostAction::kContinue});
    case ConsoleVerb::kReset:
      return tell_world({HostAction::kReset});
    case ConsoleVerb::kQuit:
      quit_asked_ = true;
      return {true, "the run ends"};
    case ConsoleVerb::kLink:
      return make_link(command);
    case ConsoleVerb::kRevoke:
      if (!links_.revoke(command.text)) return no_link;
      close_link(command.text);
      state_dirty_ = true;
      return {true, command.text + " is revoked, and whoever came in by it is out"};
    case ConsoleVerb::kExpire: {
      const std::int64_t at = command.lifetime_ns > 0 ? unix_now() + command.lifetime_ns : 0;
      if (!links_.set_expiry(command.text, at)) return no_link;
      state_dirty_ = true;
      return {true, command.text + (at == 0 ? " never expires"
                                            : " admits nobody new in " + duration_text(command.lifetime_ns) +
                                                  "; who is in stays. Revoke it to end that too")};
    }
    case ConsoleVerb::kRelease:
      return release(command.text);
    case ConsoleVerb::kKick:
      return kick(command);
    case ConsoleVerb::kUnban:
      if (!bans_.lift(name_skeleton(command.text)))
        return {false, "nobody called '" + command.text + "' is kept out. `who` lists them"};
      state_dirty_ = true;
      return {true, command.text + " may come in again"};
    case ConsoleVerb::kBring:
    case ConsoleVerb::kRemove: {
      const std::size_t thing = find_thing(*world_.scene, command.text);
      if (thing == thing_count(*world_.scene)) return {false, no_thing_text(command.text, *world_.scene)};
      return tell_world({command.verb == ConsoleVerb::kBring ? HostAction::kAppear : HostAction::kTakeAway,
                         static_cast<std::uint32_t>(thing)});
    }
    case ConsoleVerb::kSet: {
      if (command.what == SetWish::What::kGravity)
        return tell_world({HostAction::kGravityScale, 0, command.value});
      if (command.what == SetWish::What::kStiffness) {
        const std::optional<std::size_t> grip = one_meant(world_.scene->grips, command.text);
        if (!grip) return {false, "say which grip: " + names_of(world_.scene->grips)};
        return tell_world({HostAction::kGripStiffness, static_cast<std::uint32_t>(*grip), command.value});
      }
      const auto& fluids = world_.scene->fluids;
      const std::optional<std::size_t> fluid = one_meant(fluids, command.text);
      if (!fluid) return {false, "say which fluid: " + names_of(fluids)};
      return tell_world({HostAction::kViscosity, static_cast<std::uint32_t>(*fluid), command.value});
    }
  }
  return {};
}

Outcome Server::make_link(const ConsoleCommand& command) {
  const auto in_use = [this](const std::string& id) {
    return std::any_of(seats_.seats().begin(), seats_.seats().end(),
                       [&](const auto& entry) { return entry.second.link == id; });
  };
  const std::string name = clean_name(command.text);
  if (name.empty() && !command.text.empty())
    return {false,
            "'" + command.text + "' is no name that can be told from others. Letters and digits make one"};
  const LinkRecord* link = links_.create(command.role, name, unix_now(), command.lifetime_ns, in_use);
  if (!link) return {false, "there are " + std::to_string(kMaxLinks) + " links already. Revoke some first"};
  state_dirty_ = true;
  return {true, line_of(*link)};
}

Outcome Server::release(const std::string& grip_text) {
  const std::optional<std::size_t> grip = index_named(world_.scene->grips, grip_text);
  if (!grip) return {false, no_grip_text(grip_text, world_.scene->grips)};
  const auto index = static_cast<std::uint32_t>(*grip);
  const Seat* holder = seats_.holder(index);
  if (!holder) return {false, seats_.grip_name(index) + " is free already"};
  seats_.release(*seats_.by_number(holder->number), index);
  hands_.let_go(index, now(), true);
  roster_changed();
  const std::string text = "the host took " + seats_.grip_name(index) + " from " + holder->name;
  notice_all(text);
  return {true, text};
}

Outcome Server::kick(const ConsoleCommand& command) {
  const Seat* seat = seats_.by_name(command.text);
  if (!seat) return {false, "nobody here is called '" + command.text + "'. `who` lists them"};
  const std::string name = seat->name;
  const bool banned = command.lifetime_ns > 0;
  const std::string time = duration_text(command.lifetime_ns);
  if (banned) bans_.add(seat->key, name, unix_now() + command.lifetime_ns);
  state_dirty_ = true;
  put_out(seat->number, banned ? wire::RefusalCode::kBanned : wire::RefusalCode::kEnding,
          banned ? "the host has put you out for " + time : "the host closed your connection");
  return {true, banned ? name + " is out, and their key is kept out for " + time
                       : name +
                             " is out. `kick NAME for 10m` also keeps their key out, and revoking their link "
                             "everybody who comes by it"};
}

void Server::put_out(std::uint32_t number, wire::RefusalCode code, const std::string& text) {
  const Seat* seat = seats_.by_number(number);
  for (const std::uint32_t grip : seat->grips) hands_.let_go(grip, now(), true);
  if (Peer* peer = peers_.of_seat(number)) refuse(*peer, code, text);
  seats_.remove(number);
  roster_changed();
}

void Server::close_link(const std::string& id) {
  std::vector<std::uint32_t> out;
  for (const auto& [number, seat] : seats_.seats()) {
    if (seat.link == id) out.push_back(number);
  }
  for (const std::uint32_t number : out)
    put_out(number, wire::RefusalCode::kRevoked, "the host has revoked the link that you came by");
}

std::string Server::line_of(const LinkRecord& link) const {
  constexpr std::array kTo{"to hold ", "to watch", "to run  "};
  std::string line = link.id + "  " + kTo[static_cast<std::size_t>(link.role)];
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
  if (text.empty()) text = "there are no links. `link` makes one";
  return text + bans_text();
}

std::string Server::who_text() const {
  std::string text;
  for (const auto& [number, seat] : seats_.seats()) {
    if (seat.left) continue;
    std::string line = seat.name + ", " + wire::kRoleNames[static_cast<std::size_t>(wire_role(seat.role))];
    if (seat.role == LinkRole::kRun) line += ", may run the world";
    for (const std::uint32_t grip : seat.grips) line += ", " + seats_.grip_name(grip);
    if (!seat.connected) line += ", away for " + duration_text(now() - seat.away_since_ns);
    const Peer* peer = peers_.of_seat(number);
    if (peer && endpoint_) {
      const ConnectionStats stats = endpoint_->stats(peer->id);
      line += ", " + peer->address + ", " + std::to_string(static_cast<int>(1e3 * stats.smoothed_rtt + 0.5)) +
              " ms, gets " + snapshots_.words_of(peer->id);
    }
    text.append(text.empty() ? "" : "\n").append(line);
  }
  return (text.empty() ? "nobody is here" : text) + bans_text();
}

std::string Server::bans_text() const {
  std::string text;
  for (const BanRecord& ban : bans_.bans()) {
    if (ban.until_ns > unix_now())
      text += "\n" + ban.name + ", kept out for another " + duration_text(ban.until_ns - unix_now());
  }
  return text;
}

std::string Server::status_text() const {
  const ServerFigures f = figures();
  const HostState& state = switches_.state();
  char text[400];
  std::snprintf(text, sizeof text,
                "%s, run %u, gravity × %.3g; %zu with hands, %zu watching; %.1f MB sent, %llu refused, %llu "
                "damaged datagrams, %llu beyond limits",
                switches_.waits_for_hands() ? "waiting for hands"
                : state.paused              ? "paused"
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
  for (std::size_t i = 0; i < state.grip_stiffness.size() && i < world_.scene->grips.size(); ++i) {
    if (state.grip_stiffness[i] == 1.0) continue;
    std::snprintf(text, sizeof text, "\ngrip '%.60s': stiffness × %.3g", world_.scene->grips[i].name.c_str(),
                  state.grip_stiffness[i]);
    all += text;
  }
  return all;
}

}  // namespace slosh
