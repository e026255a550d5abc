#include "peer/remote/peer_console.h"

#include <cstdio>
#include <limits>

#include "net/console_words.h"
#include "net/wire/text.h"

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

std::string status_lines(const RemoteStatus& status, const Scene& scene, double picture_delay,
                         std::int64_t now_ns) {
  char text[160];
  std::snprintf(text, sizeof text, "the world is at %.2f s%s, gravity × %.3g", status.world_time,
                status.world.paused ? ", paused" : "", status.world.gravity_scale);
  std::string all = connection_text(status, picture_delay, now_ns) + "\n" + text;
  for (std::size_t i = 0; i < status.world.viscosities.size() && i < scene.fluids.size(); ++i) {
    std::snprintf(text, sizeof text, "\nfluid '%.60s': %.4g Pa·s", scene.fluids[i].name.c_str(),
                  status.world.viscosities[i]);
    all += text;
  }
  return all;
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
  command.parameter =
      wish.value().gravity ? wire::Parameter::kGravityScale : wire::Parameter::kFluidViscosity;
  // Beyond these the message itself would bring the value into range, and something else would be granted.
  const double most = wish.value().gravity ? wire::kMaxGravityScale : wire::kMaxViscosity;
  if (command.value > most) {
    char text[120];
    std::snprintf(text, sizeof text, "%.6g is too much: at most %.6g %s", command.value, most,
                  wish.value().gravity ? "times the scene's gravity" : "Pa·s");
    return say(text);
  }
  if (!wish.value().gravity) {
    const std::optional<std::size_t> fluid = fluid_meant(scene.fluids, wish.value().fluid);
    if (!fluid) return say("say which fluid: " + names_of(scene.fluids));
    command.index = static_cast<std::uint32_t>(*fluid);
  }
  return ask(command);
}

}  // namespace

PeerLine peer_line(std::string_view typed, const RemoteStatus& status, const Scene& scene,
                   double picture_delay, std::int64_t now_ns) {
  const Result<std::vector<std::string>> split = console_words(typed);
  if (!split) return say(split.error().text());
  const std::vector<std::string>& words = split.value();
  if (words.empty()) return {};
  const std::string& verb = words[0];
  if (verb == "set") return set(words, scene);
  const bool with_grip = verb == "take" || verb == "release";
  if (words.size() > (with_grip ? 2u : 1u))
    return say(verb + (with_grip ? " needs one grip or none. Put a name of several words in quotes"
                                 : " stands alone. Type help for what may be said"));
  if (verb == "take") return take(words, scene);
  if (verb == "release") return release(words, status, scene);
  if (verb == "help") return say(peer_console_help());
  if (verb == "who") {
    std::vector<std::string> grips;
    for (const Grip& grip : scene.grips) grips.push_back(grip.name);
    return say(people_text(status, grips, kEverybody));
  }
  if (verb == "status") return say(status_lines(status, scene, picture_delay, now_ns));
  if (verb == "pause") return world(wire::WorldAction::kPause);
  if (verb == "continue") return world(wire::WorldAction::kContinue);
  if (verb == "reset") return world(wire::WorldAction::kReset);
  if (verb == "quit") {
    PeerLine line;
    line.quit = true;
    return line;
  }
  return say("'" + wire::clean_text(verb, 40) + "' means nothing here. Type help for what may be said");
}

const char* peer_console_help() {
  return "who                            who is here and holds what\n"
         "take [GRIP]                    take hold of a grip, or of the first free one\n"
         "release [GRIP]                 let go of a grip, or of all that you hold\n"
         "pause, continue, reset         the world, for everybody\n"
         "set viscosity [FLUID] X        Pa·s, while the world runs\n"
         "set gravity X                  times the scene's, 0 to 2\n"
         "status                         how the network and the world do\n"
         "quit                           leave";
}

}  // namespace slosh
