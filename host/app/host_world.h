// The world of `slosh host`: a scene that starts, or a checkpoint that goes on.
#pragma once

#include <optional>

#include "host/app/host_options.h"
#include "host/host.h"
#include "host/keep/checkpoint.h"
#include "host/server/server_state.h"
#include "peer/app/prepare.h"

namespace slosh {

struct HostedWorld {
  Prepared prepared;
  std::optional<World> world;  ///< moved into the host
  std::size_t particles = 0;
  HostState state;
  bool waits = false;                       ///< it has not begun: it waits for hands
  std::vector<std::uint8_t> start;          ///< World::save of what a reset goes back to
  std::optional<ServerState> server_state;  ///< of a checkpoint that has its secrets
  keep::HostPlace place;                    ///< of a checkpoint: where its host was reached
};

/// Loads a scene, settles it where it asks for that, or reads a checkpoint. Errors: anything of these.
Result<HostedWorld> make_hosted_world(const HostVerbOptions& options, Progress& progress);

}  // namespace slosh
