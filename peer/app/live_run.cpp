#include "peer/app/live_run.h"

namespace slosh {
namespace {

RemoteCommand to_world(wire::WorldAction action) {
  RemoteCommand command;
  command.kind = RemoteCommand::Kind::kWorld;
  command.action = action;
  return command;
}

}  // namespace

Rates LiveRun::note_rates() {
  Rates rates = world_rates();
  if (hands()) hands()->note(rates);
  rates_.add(rates);
  return rates;
}

void LiveRun::pause(bool paused) {
  ask(to_world(paused ? wire::WorldAction::kPause : wire::WorldAction::kContinue), false);
}

void LiveRun::start_again() {
  ask(to_world(wire::WorldAction::kReset), false);
}

void LiveRun::change_grip() {
  RemoteCommand command;
  command.kind = RemoteCommand::Kind::kNextGrip;
  ask(command, false);
}

void LiveRun::change(const LiveWish& wish) {
  RemoteCommand command;
  command.kind = RemoteCommand::Kind::kParameter;
  command.index = static_cast<std::uint32_t>(wish.index);
  command.value = wish.value;
  switch (wish.kind) {
    case LiveWish::Kind::kViscosity:
      command.parameter = wire::Parameter::kFluidViscosity;
      break;
    case LiveWish::Kind::kGravityScale:
      command.parameter = wire::Parameter::kGravityScale;
      break;
    case LiveWish::Kind::kGripStiffness:
      command.parameter = wire::Parameter::kGripStiffness;
      break;
    case LiveWish::Kind::kPace:
    case LiveWish::Kind::kFilter:
      return;  // not the world's
  }
  ask(command, false);
}

std::string LiveRun::hear(const std::string& line) {
  const PeerLine heard = understand(line);
  for (const RemoteCommand& command : heard.commands) ask(command, true);
  if (heard.quit) request_stop();
  return heard.text;
}

}  // namespace slosh
