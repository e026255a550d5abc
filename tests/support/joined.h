// What a peer that has joined knows: what its console is tried with.
#pragma once

#include "peer/remote/remote_status.h"
#include "scenes/scene.h"

namespace slosh::test {

/// Two grips, the second held, two fluids and one other person.
struct Joined {
  Joined() {
    for (const char* name : {"left", "right hand"}) scene.grips.emplace_back().name = name;
    for (const char* name : {"water", "honey"}) scene.fluids.emplace_back().name = name;
    status.state = LinkState::kLive;
    status.held = {false, true};
    status.world.viscosities = {0.001, 5.0};
    status.peers = {{0, "Ana", wire::Role::kParticipant, true, {1}}};
  }
  Scene scene;
  RemoteStatus status;
};

}  // namespace slosh::test
