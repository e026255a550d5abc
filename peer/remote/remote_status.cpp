#include "peer/remote/remote_status.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "net/clock.h"

namespace slosh {

std::string done_text(const RemoteCommand& command, const Scene& scene) {
  if (command.kind == RemoteCommand::Kind::kWorld) {
    constexpr std::array kDone{"you paused the world", "the world goes on", "the world is back at its start"};
    return kDone[static_cast<std::size_t>(command.action)];
  }
  if (command.kind == RemoteCommand::Kind::kThing)
    return thing_name(scene, command.index) + (command.take ? " is there" : " is away");
  char text[160];
  if (command.parameter == wire::Parameter::kGravityScale) {
    std::snprintf(text, sizeof text, "gravity is %.3g times the scene's now", command.value);
    return text;
  }
  if (command.parameter == wire::Parameter::kGripStiffness) {
    const std::string grip =
        command.index < scene.grips.size() ? scene.grips[command.index].name : std::to_string(command.index);
    std::snprintf(text, sizeof text, "the hold on '%.60s' is %.3g times as stiff as the scene has it now",
                  grip.c_str(), command.value);
    return text;
  }
  const std::string name =
      command.index < scene.fluids.size() ? scene.fluids[command.index].name : std::to_string(command.index);
  std::snprintf(text, sizeof text, "the viscosity of '%.60s' is %.4g Pa·s now", name.c_str(), command.value);
  return text;
}

bool may_set_stiffness(const RemoteStatus& status, std::size_t grip) {
  if (!status.rights.stiffness) return false;
  if (grip < status.held.size() && status.held[grip]) return true;
  const bool taken =
      std::any_of(status.peers.begin(), status.peers.end(), [&](const wire::RosterEntry& entry) {
        return std::find(entry.grips.begin(), entry.grips.end(), grip) != entry.grips.end();
      });
  return status.rights.run && !taken;
}

std::string connection_text(const RemoteStatus& status, double picture_delay, std::int64_t now_ns) {
  char text[160] = "";
  switch (status.state) {
    case LinkState::kConnecting:
      return "connecting";
    case LinkState::kJoining:
      return "joining";
    case LinkState::kEnded:
      return "ended";
    case LinkState::kReconnecting:
      std::snprintf(text, sizeof text, "contact lost, reconnecting for %.0f s",
                    to_seconds(now_ns - status.lost_ns));
      return text;
    case LinkState::kLive:
      break;
  }
  std::snprintf(text, sizeof text, "rtt %.0f ms, hands %.0f ms and pictures %.0f ms behind, %.0f kB/s",
                1e3 * status.numbers.round_trip, 1e3 * status.numbers.body_delay, 1e3 * picture_delay,
                1e-3 * status.numbers.receive_rate);
  return text;
}

std::size_t others_here(const RemoteStatus& status) {
  return static_cast<std::size_t>(std::count_if(
      status.peers.begin(), status.peers.end(),
      [&](const wire::RosterEntry& entry) { return entry.connected && entry.peer != status.welcome.peer; }));
}

std::string people_text(const RemoteStatus& status, const std::vector<std::string>& grip_names,
                        std::size_t most) {
  std::string text;
  std::size_t shown = 0;
  for (const wire::RosterEntry& entry : status.peers) {
    if (shown == most) {
      text += "and " + std::to_string(status.peers.size() - shown) + " more\n";
      break;
    }
    shown += 1;
    text += entry.name;
    if (entry.peer == status.welcome.peer) text += " (you)";
    if (!entry.connected) text += " (away)";
    std::string grips;
    for (const std::uint32_t grip : entry.grips) {
      if (grip >= grip_names.size()) continue;
      grips += (grips.empty() ? ": " : ", ") + grip_names[grip];
    }
    text += grips.empty() && entry.role == wire::Role::kSpectator ? " looks on" : grips;
    text += "\n";
  }
  if (!text.empty()) text.pop_back();
  return text;
}

}  // namespace slosh
