// What a visit to a remote world tells the threads that show it, and what they ask of it.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "net/wire/messages.h"
#include "peer/remote/body_inbox.h"
#include "scenes/task.h"
#include "sim/math/result.h"

namespace slosh {

enum class LinkState {
  kConnecting,    ///< nobody answered yet
  kJoining,       ///< the host answered; the scene is on its way
  kLive,          ///< bodies and snapshots come
  kReconnecting,  ///< contact was lost; tried again and again
  kEnded,
};

struct LinkNumbers {
  double round_trip = 0.0;   ///< s, the transport's
  double clock_error = 0.0;  ///< s, bound
  double body_delay = 0.0;   ///< s that the device loop lives behind the host
  double send_loss = 0.0;    ///< share of our datagrams that were never acknowledged
  std::uint64_t bytes_received = 0;
  std::uint64_t bytes_sent = 0;
  double receive_rate = 0.0;        ///< bytes a s, lately
  std::uint64_t poses = 0;          ///< distinct samples sent
  std::uint64_t bad_datagrams = 0;  ///< that did not decode
  std::uint64_t reconnects = 0;
  std::uint64_t clock_steps = 0;
  BodyInboxCounts bodies;
};

struct RemoteStatus {
  LinkState state = LinkState::kConnecting;
  wire::Welcome welcome;                 ///< from kJoining on
  std::vector<wire::RosterEntry> peers;  ///< who is here
  std::vector<bool> held;                ///< our grips, one a grip of the scene
  wire::WorldInfo world;
  wire::Rights rights;  ///< what we may ask of it; of a host that does not say: all, where we may take hold
  TaskLines task;       ///< of the host's scene; empty where it has none, or does not say
  WorldMoment moment;   ///< where the host's world stands
  double world_time = 0.0;  ///< simulated s of the host's world now
  LinkNumbers numbers;
  std::int64_t lost_ns = 0;    ///< when contact was lost, while reconnecting
  std::int64_t live_ns = 0;    ///< when the link first was live; 0 = not yet
  std::optional<Error> error;  ///< kEnded: set when that was not as wished
  std::string farewell;        ///< kEnded: the host's words
};

struct RemoteCommand {
  enum class Kind {
    kGrip,       ///< take or release `grip`
    kFreeGrip,   ///< take the first free one
    kNextGrip,   ///< let go of all that is held, else take the first free one
    kWorld,      ///< do `action`
    kParameter,  ///< set `parameter`
    kThing,      ///< bring thing `index`, or without `take` take it away; of a world of one's own
  } kind = Kind::kGrip;
  std::uint32_t grip = 0;
  bool take = true;
  wire::WorldAction action = wire::WorldAction::kPause;
  wire::Parameter parameter = wire::Parameter::kGravityScale;
  std::uint32_t index = 0;  ///< fluid, grip or thing
  double value = 0.0;       ///< Pa·s, or times the scene's
};

/// Between the network's thread and the others. Everything under the mutex.
struct RemoteShared {
  mutable std::mutex mutex;
  std::condition_variable changed;
  RemoteStatus status;
  std::vector<std::string> notices;  ///< for people, not yet shown
  std::vector<RemoteCommand> commands;
};

/// What to tell the person once a command of kind kWorld or kParameter was carried out.
std::string done_text(const RemoteCommand& command, const Scene& scene);

/// A grip's stiffness is its holder's to set, and that of a free one theirs who run the world.
bool may_set_stiffness(const RemoteStatus& status, std::size_t grip);

/// "reconnecting for 3 s", "rtt 61 ms, delay 12 ms".
std::string connection_text(const RemoteStatus& status, double picture_delay, std::int64_t now_ns);
/// People but oneself who are connected: not those who left, nor whose contact is lost.
std::size_t others_here(const RemoteStatus& status);
/// A line a person: "Ana: left_hand", "Ben (away)", "Cyd looks on"; at most `most` of them, and how many
/// more.
std::string people_text(const RemoteStatus& status, const std::vector<std::string>& grip_names,
                        std::size_t most = 8);

}  // namespace slosh
