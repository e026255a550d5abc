// What may be typed at a running `join`, `watch` or `play`, and what each line asks of the world.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "peer/remote/remote_status.h"
#include "scenes/scene.h"

namespace slosh {

/// What a line comes to.
struct PeerLine {
  std::string text;  ///< the answer at once, several lines or none; no line feed at the end
  std::vector<RemoteCommand> commands;  ///< for RemoteVisit::ask; their answers come as notices
  bool quit = false;
};

/// Understands one line. The words are those of the host's console where both have them. What only the host
/// can know (may this link do that, is the grip free, does the viscosity fit the time step) is left to it.
/// `picture_delay` in s. Any bytes may come.
PeerLine peer_line(std::string_view typed, const RemoteStatus& status, const Scene& scene,
                   double picture_delay, std::int64_t now_ns);

/// The same at a world in this process: nobody else is in it, and every grip has its hand. `world` and `time`
/// (simulated s) as they are. The commands are only of kinds kWorld and kParameter.
PeerLine own_world_line(std::string_view typed, const wire::WorldInfo& world, double time,
                        const Scene& scene);

}  // namespace slosh
