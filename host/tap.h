// Who listens to a host from inside its loop: a recording, a checkpoint, the network.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/pose_fault.h"
#include "net/channel.h"
#include "sim/world.h"

namespace slosh {

/// What may be asked of a running world.
enum class HostAction : std::uint8_t {
  kPause,
  kContinue,
  kReset,          ///< back to the start; live parameters stay
  kViscosity,      ///< index: fluid; value: Pa·s
  kGravityScale,   ///< value: times the scene's, 0–2
  kGripStiffness,  ///< index: grip; value: times the scene's (World::set_grip_stiffness)
  kAppear,         ///< index: thing (World::appear)
  kTakeAway,  ///< index: thing; value: 1 + the region in which it goes, 0 = everywhere (World::take_away)
};

struct HostCommand {
  HostAction action = HostAction::kPause;
  std::uint32_t index = 0;
  double value = 0.0;
};

/// The world's switches as they are.
struct HostState {
  bool paused = false;
  std::uint32_t run = 0;  ///< rises by one with every reset
  double gravity_scale = 1.0;
  std::vector<double> viscosities;     ///< Pa·s, one a fluid
  std::vector<double> grip_stiffness;  ///< times the scene's, one a grip
  std::vector<double> task_done{};     ///< s, of the guided task's steps that are done: of a checkpoint alone
};

/// Does to a world what a command asks, but for pause, continue and reset, which are its host's: nothing.
Result<bool> change_world(World& world, const HostCommand& command);

/// The switches of a world of so many fluids; who runs it knows whether it stands and how often it was reset.
HostState state_of(const World& world, std::size_t fluids, bool paused, std::uint32_t run);

/// What a step starts from, one entry a grip each.
struct StepInput {
  std::span<const HandleInput> hands;
  /// The newest message that was taken in; its stamp_ns says which. device is right even where none came yet.
  std::span<const PoseMessage> poses;
};

/// Called on the host's thread, between or right after steps: what takes long here makes the world late. What
/// is handed over is valid for the call alone; the world may be read and saved, not changed.
class HostTap {
 public:
  virtual ~HostTap() = default;
  /// Once, before the first step.
  virtual void on_start(const World& world, const HostState& state) { (void)world, (void)state; }
  /// world.tick() is the step's number.
  virtual void before_step(const World& world, const StepInput& input) { (void)world, (void)input; }
  virtual void after_step(const World& world) { (void)world; }
  /// Again and again, every few ms, while the world stands.
  virtual void while_standing(const World& world) { (void)world; }
  /// A pose of this grip was not used. As often as poses come: whoever tells people, tells them once.
  virtual void on_refused_pose(std::uint32_t grip, PoseFault fault) { (void)grip, (void)fault; }
  /// A body has left the world for good; `words` say which, when and where. Once, until the world is set
  /// back.
  virtual void on_gone_body(std::size_t body, const std::string& words) { (void)body, (void)words; }
  /// Body states, and a snapshot where one was due, are in the channel: wake whoever sends them.
  virtual void after_publish() {}
  /// After a command that was granted; the channel has the world as it is now.
  virtual void after_change(const World& world, const HostCommand& change, const HostState& state) {
    (void)world, (void)change, (void)state;
  }
  /// Once, after the last step.
  virtual void on_end(const World& world) { (void)world; }
};

}  // namespace slosh
