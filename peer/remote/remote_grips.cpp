// What a peer asks for: grips, the world, its parameters. A part of RemoteLink.
#include <algorithm>
#include <array>
#include <cstdio>

#include "net/console_words.h"
#include "peer/remote/remote_link.h"

namespace slosh {
namespace {

constexpr std::size_t kMaxRequests = 64;  // that a host left without an answer

}  // namespace

std::string RemoteLink::grip_name(std::uint32_t grip) const {
  return grip < world_.scene.grips.size() ? world_.scene.grips[grip].name : std::to_string(grip);
}

void RemoteLink::ask_for_grips() {
  greeting_.grips_asked = true;
  // A name that the scene lacks is wrong whoever comes, also to a seat that was kept.
  std::vector<std::uint32_t> wished;
  for (const std::string& wish : options_.grips) {
    const std::optional<std::size_t> grip = index_named(world_.scene.grips, wish);
    if (!grip) return end(Error{"--grip", no_grip_text(wish, world_.scene.grips), {}});
    wished.push_back(static_cast<std::uint32_t>(*grip));
  }
  if (!options_.wants_grip) return;
  if (status_.welcome.role != wire::Role::kParticipant) {
    if (!wished.empty() && status_.live_ns == 0) notice("this link is for watching: --grip is of no use");
    return;
  }
  if (status_.live_ns != 0) {
    // Back again: what is not ours any more is asked for once more.
    for (const std::uint32_t grip : grips_had_) {
      if (!status_.held[grip]) request_grip(grip, true, false);
    }
    return;
  }
  const bool kept = std::find(status_.held.begin(), status_.held.end(), true) != status_.held.end();
  if (wished.empty()) {
    if (kept) return;
    if (!world_.scene.grips.empty() && !take_a_free_grip(false)) {
      notice("no grip is free: you look on until one is");
    }
    return;
  }
  for (const std::uint32_t grip : wished) {
    if (!status_.held[grip]) request_grip(grip, true, false);
  }
}

void RemoteLink::request_grip(std::uint32_t grip, bool take, bool any) {
  if (requests_.size() > kMaxRequests) return;
  const std::string what =
      std::string(take ? "you hold grip '" : "you let go of grip '") + grip_name(grip) + "'";
  wire::GripRequest request;
  request.request = remember({0, wire::ControlType::kGripRequest, grip, take, any, what});
  request.grip = grip;
  request.take = take;
  say(request);
}

void RemoteLink::request_world(const RemoteCommand& command) {
  if (requests_.size() > kMaxRequests) return;
  wire::WorldRequest request;
  request.request =
      remember({0, wire::ControlType::kWorldRequest, 0, false, false, done_text(command, world_.scene)});
  request.action = command.action;
  say(request);
}

void RemoteLink::request_parameter(const RemoteCommand& command) {
  if (requests_.size() > kMaxRequests) return;
  if (command.parameter == wire::Parameter::kGripStiffness && !(agreed_ & wire::kGripStiffnesses)) {
    notice("this host is of an earlier version, and its grips are as stiff as the scene has them");
    return;
  }
  wire::ParameterRequest request;
  request.request =
      remember({0, wire::ControlType::kParameterRequest, 0, false, false, done_text(command, world_.scene)});
  request.parameter = command.parameter;
  request.index = command.index;
  request.value = command.value;
  say(request);
}

/// Until its answer comes; returns its number.
std::uint32_t RemoteLink::remember(Request request) {
  request.number = next_request_++;
  requests_.push_back(std::move(request));
  return requests_.back().number;
}

/// Asks for the first grip that nobody holds and that was not refused before.
bool RemoteLink::take_a_free_grip(bool quietly) {
  if (!quietly) grips_tried_.clear();
  for (std::uint32_t grip = 0; grip < world_.scene.grips.size(); ++grip) {
    const bool tried = std::find(grips_tried_.begin(), grips_tried_.end(), grip) != grips_tried_.end();
    const bool taken =
        std::any_of(status_.peers.begin(), status_.peers.end(), [&](const wire::RosterEntry& entry) {
          return std::find(entry.grips.begin(), entry.grips.end(), grip) != entry.grips.end();
        });
    if (tried || taken) continue;
    grips_tried_.push_back(grip);
    request_grip(grip, true, true);
    return true;
  }
  return false;
}

void RemoteLink::obey(const RemoteCommand& command) {
  if (step_ != LinkStep::kLive) {
    notice("not now: there is no contact with the host");
    return;
  }
  switch (command.kind) {
    case RemoteCommand::Kind::kGrip:
      request_grip(command.grip, command.take, false);
      return;
    case RemoteCommand::Kind::kNextGrip: {
      // One key for both: let go of what is held, else take what is free.
      bool let_go = false;
      for (std::uint32_t i = 0; i < status_.held.size(); ++i) {
        if (!status_.held[i]) continue;
        request_grip(i, false, false);
        let_go = true;
      }
      if (!let_go && !take_a_free_grip(false)) notice("no grip is free");
      return;
    }
    case RemoteCommand::Kind::kFreeGrip:
      if (!take_a_free_grip(false)) notice("no grip is free");
      return;
    case RemoteCommand::Kind::kWorld:
      request_world(command);
      return;
    case RemoteCommand::Kind::kParameter:
      request_parameter(command);
      return;
    case RemoteCommand::Kind::kThing:
      return;  // of a world of one's own alone
  }
}

}  // namespace slosh
