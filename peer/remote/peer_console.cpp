#include "peer/remote/peer_console.h"

#include <cstdio>
#include <limits>

#include "net/console_verbs.h"
#include "net/console_words.h"

namespace slosh {
namespace {

constexpr std::size_t kEverybody = std::numeric_limits<std::size_t>::max();

PeerLine say(const std::string& text) {
  PeerLine line;
  line.text = text;
  return line;
}

PeerLine ask(const RemoteCommand& command) {
  PeerLine line;
  line.commands.push_back(command);
  return line;
}

PeerLine world(wire::WorldAction action) {
  RemoteCommand command;
  command.kind = RemoteCommand::Kind::kWorld;
  command.action = action;
  return ask(command);
}

/// `connection`: the line before all others; may be empty.
std::string status_lines(const RemoteStatus& status, const Scene& scene, const std::string& connection) {
  char text[160];
  std::snprintf(text, sizeof text, "the world is at %.2f s%s, gravity × %.3g", status.world_time,
                status.world.paused ? ", paused" : "", status.world.gravity_scale);
  std::string all = connection + (connection.empty() ? "" : "\n") + text;
  for (std::size_t i = 0; i < status.world.viscosities.size() && i < scene.fluids.size(); ++i) {
    std::snprintf(text, sizeof text, "\nfluid '%.60s': %.4g Pa·s", scene.fluids[i].name.c_str(),
                  status.world.viscosities[i]);
    all += text;
  }
  for (std::size_t i = 0; i < status.world.grip_stiffness.size() && i < scene.grips.size(); ++i) {
    if (status.world.grip_stiffness[i] == 1.0) continue;
    std::snprintf(text, sizeof text, "\ngrip '%.60s': stiffness × %.3g", scene.grips[i].name.c_str(),
                  status.world.grip_stiffness[i]);
    all += text;
  }
  return all;
}

std::string everybody(const RemoteStatus& status, const Scene& scene) {
  std::vector<std::string> grips;
  for (const Grip& grip : scene.grips) grips.push_back(grip.name);
  return people_text(status, grips, kEverybody);
}

PeerLine take(const std::vector<std::string>& words, const Scene& scene) {
  RemoteCommand command;
  command.kind = RemoteCommand::Kind::kFreeGrip;
  if (words.size() == 1) return ask(command);
  const std::optional<std::size_t> grip = index_named(scene.grips, words[1]);
  if (!grip) return say(no_grip_text(words[1], scene.grips));
  command.kind = RemoteCommand::Kind::kGrip;
  command.grip = static_cast<std::uint32_t>(*grip);
  return ask(command);
}

PeerLine release(const std::vector<std::string>& words, const RemoteStatus& status, const Scene& scene) {
  RemoteCommand command;
  command.take = false;
  if (words.size() == 2) {
    const std::optional<std::size_t> grip = index_named(scene.grips, words[1]);
    if (!grip) return say(no_grip_text(words[1], scene.grips));
    command.grip = static_cast<std::uint32_t>(*grip);
    return ask(command);
  }
  PeerLine line;
  for (std::uint32_t i = 0; i < status.held.size(); ++i) {
    if (!status.held[i]) continue;
    command.grip = i;
    line.commands.push_back(command);
  }
  if (line.commands.empty()) line.text = "you hold nothing";
  return line;
}

PeerLine set(const std::vector<std::string>& words, const Scene& scene) {
  const Result<SetWish> wish = parse_set(words);
  if (!wish) return say(wish.error().text());
  RemoteCommand command;
  command.kind = RemoteCommand::Kind::kParameter;
  command.value = wish.value().value;
  // Beyond these the message itself would bring the value into range, and something else would be granted.
  double least = 0.0;
  double most = wire::kMaxViscosity;
  const char* unit = "Pa·s";
  const std::string& which = wish.value().which;
  switch (wish.value().what) {
    case SetWish::What::kGravity:
      command.parameter = wire::Parameter::kGravityScale;
      most = wire::kMaxGravityScale;
      unit = "times the scene's gravity";
      break;
    case SetWish::What::kViscosity: {
      command.parameter = wire::Parameter::kFluidViscosity;
      const std::optional<std::size_t> fluid = one_meant(scene.fluids, which);
      if (!fluid) return say("say which fluid: " + names_of(scene.fluids));
      command.index = static_cast<std::uint32_t>(*fluid);
      break;
    }
    case SetWish::What::kStiffness: {
      command.parameter = wire::Parameter::kGripStiffness;
      least = wire::kMinGripStiffness;
      most = wire::kMaxGripStiffness;
      unit = "times the scene's stiffness";
      const std::optional<std::size_t> grip = one_meant(scene.grips, which);
      if (!grip) return say("say which grip: " + names_of(scene.grips));
      command.index = static_cast<std::uint32_t>(*grip);
      break;
    }
  }
  char text[120];
  if (command.value > most) {
    std::snprintf(text, sizeof text, "%.6g is too much: at most %.6g %s", command.value, most, unit);
    return say(text);
  }
  if (command.value < least) {
    std::snprintf(text, sizeof text, "%.6g is too little: at least %.6g %s", command.value, least, unit);
    return say(text);
  }
  return ask(command);
}

PeerLine come_or_go(ConsoleVerb verb, const std::string& name, const Scene& scene) {
  RemoteCommand command;
  command.kind = RemoteCommand::Kind::kThing;
  command.take = verb == ConsoleVerb::kBring;
  command.index = static_cast<std::uint32_t>(find_thing(scene, name));
  return command.index == thing_count(scene) ? say(no_thing_text(name, scene)) : ask(command);
}

PeerLine line_of(Console console, std::string_view typed, const RemoteStatus& status, const Scene& scene,
                 const std::string& connection) {
  const Result<std::vector<std::string>> split = console_words(typed);
  if (!split) return say(split.error().text());
  const std::vector<std::string>& words = split.value();
  const Result<ConsoleVerb> verb = console_verb(console, words);
  if (!verb) return say(verb.error().text());
  switch (verb.value()) {
    case ConsoleVerb::kHelp:
      return say(console_help(console));
    case ConsoleVerb::kWho:
      return say(everybody(status, scene));
    case ConsoleVerb::kTake:
      return take(words, scene);
    case ConsoleVerb::kRelease:
      return release(words, status, scene);
    case ConsoleVerb::kPause:
      return world(wire::WorldAction::kPause);
    case ConsoleVerb::kContinue:
      return world(wire::WorldAction::kContinue);
    case ConsoleVerb::kReset:
      return world(wire::WorldAction::kReset);
    case ConsoleVerb::kSet:
      return set(words, scene);
    case ConsoleVerb::kBring:
    case ConsoleVerb::kRemove:
      return come_or_go(verb.value(), words[1], scene);
    case ConsoleVerb::kStatus:
      return say(status_lines(status, scene, connection));
    case ConsoleVerb::kQuit: {
      PeerLine line;
      line.quit = true;
      return line;
    }
    default:
      return {};
  }
}

}  // namespace

PeerLine peer_line(std::string_view typed, const RemoteStatus& status, const Scene& scene,
                   double picture_delay, std::int64_t now_ns) {
  return line_of(Console::kPeer, typed, status, scene, connection_text(status, picture_delay, now_ns));
}

PeerLine own_world_line(std::string_view typed, const wire::WorldInfo& world, double time,
                        const Scene& scene) {
  RemoteStatus status;
  status.world = world;
  status.world_time = time;
  return line_of(Console::kPlay, typed, status, scene, "");
}

}  // namespace slosh
