// Somebody else's world, in a Python program: a peer with hands that the program moves.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "net/channel.h"
#include "peer/haptics/servo.h"
#include "peer/haptics/shared_handle.h"
#include "peer/python/arrays.h"
#include "peer/python/interrupts.h"
#include "peer/remote/kept_state.h"
#include "peer/remote/remote_visit.h"

namespace slosh::python {

struct RemoteProgramOptions {
  std::string name;
  std::vector<std::string> grips;
  bool watch = false;
  bool particles = true;
  std::filesystem::path key;  ///< file; empty = a key for this visit alone
  double timeout = 10.0;      ///< s until the world is there
};

/// Everything with Python's lock; waiting lets go of it. Poses go out and forces come in on threads of their
/// own, as in slosh join.
class RemoteProgram {
 public:
  /// Joins and waits until the world is there. Raises slosh.Error.
  RemoteProgram(const std::string& link, const RemoteProgramOptions& options);
  ~RemoteProgram();

  const Scene& scene() const { return *scene_; }
  std::shared_ptr<Scene> shared_scene() const { return scene_; }
  double spacing() const { return spacing_; }
  /// Raises where the visit ended otherwise than it should.
  RemoteStatus status();
  /// The newest state that this peer's loop has.
  BodyMessage newest();
  /// Particles and bodies at one moment, a little behind; null before the first came.
  SnapshotPointer picture();

  std::size_t grip(const py::object& name_or_number) const;
  /// A person's hand on a grip of ours: smoothly to a pose; by keys; None: back to the scene's script.
  void hold(const py::object& grip, const py::object& source);
  Pose handle(std::size_t grip);
  void take(const py::object& grip, bool take);
  void ask(const RemoteCommand& command) { visit().ask(command); }
  std::vector<std::string> notices() { return visit().take_notices(); }
  /// Samples of every 2 ms of simulated time since the call before, oldest first.
  std::vector<ServoSample> samples();
  /// Waits so many s, as long as the visit lasts.
  void wait(double seconds);
  void leave();

 private:
  RemoteVisit& visit();
  void run();
  void wait_for_a_grip();
  void follow_grips(const RemoteStatus& status);
  std::unique_ptr<Device> make_hand(std::size_t grip);

  std::shared_ptr<Scene> scene_;
  double spacing_ = 0.0;
  std::unique_ptr<RemoteVisit> visit_;
  std::unique_ptr<Servo> servo_;
  SnapshotPointer picture_;

  std::mutex mutex_;  // what follows, and the servo's devices
  KeptState newest_;
  std::vector<std::shared_ptr<SharedHandle>> lent_;  // one a grip
  std::vector<std::vector<PoseKey>> keys_;           // what each hand plays where it is not moved
  std::vector<bool> has_device_;

  std::thread loop_;
  std::atomic<bool> stop_{false};
};

}  // namespace slosh::python
