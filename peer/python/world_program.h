// A world that a Python program steps, with a hand for each of its grips.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/keep/recording.h"
#include "host/task_tap.h"
#include "peer/python/hand.h"
#include "peer/python/interrupts.h"
#include "peer/python/moment.h"
#include "peer/python/run_table.h"
#include "scenes/sample.h"
#include "sim/instruments.h"
#include "sim/world.h"

namespace slosh::python {

struct WorldProgramOptions {
  py::object spacing;  ///< None: the scene's own, else its coarsest; "auto": measured; m
  std::string backend = "auto";
  int threads = 0;
  py::object hands;  ///< None, or a mapping of grips to what hold() takes
  bool settle = true;
};

/// Everything with Python's lock, which the long calls let go of while the world moves. Meanwhile every other
/// call is refused in words: a world is one thread's at a time, and what it calls may read it but not step
/// it.
class WorldProgram {
 public:
  /// Samples, plans, settles. Raises slosh.Error, ValueError.
  WorldProgram(std::shared_ptr<const Scene> scene, const WorldProgramOptions& options);

  std::size_t grip(const py::object& name_or_number) const;     ///< raises KeyError with the names
  std::size_t body(const py::object& name_or_number) const;     ///< likewise
  std::size_t fluid(const py::object& name_or_number) const;    ///< likewise
  std::uint32_t thing(const py::object& name_or_number) const;  ///< a body or fluid volume (thing_name)

  void hold(const py::object& grip, const py::object& source);
  void step(long steps);
  Run run(double seconds, bool real_time, long every, const py::object& on_step);
  void settle(std::optional<double> seconds);
  /// Back to where it began, at time 0: as it was made, or settled last. Hands and changed parameters stay.
  void reset();

  /// For reading; not while another thread steps.
  const World& world() const {
    refuse_while_moving();
    return *world_;
  }
  /// A viscosity or gravity, from the next step on.
  void change(const HostCommand& command);
  void restore(const std::string& saved);
  /// The name of what comes off.
  std::string cut(const py::object& name_or_number, const glm::dvec3& normal, double offset);
  const Scene& scene() const { return *scene_; }
  std::shared_ptr<const Scene> shared_scene() const { return scene_; }
  const SampledScene& sampled() const { return sampled_; }
  Backend backend() const { return backend_; }
  const std::string& spacing_reason() const { return spacing_reason_; }

  const std::shared_ptr<Moment>& snapshot() { return moments_.snapshot(world()); }
  const std::shared_ptr<Moment>& velocities() { return moments_.velocities(world()); }
  const std::shared_ptr<Moment>& pressures() { return moments_.pressures(world()); }
  const BodySnapshot& bodies();
  const Measurement& measure();
  /// The scene's guided task, followed as it is stepped; null where it has none.
  const TaskTap* task() const { return task_.get(); }

  /// Recordings: slosh replay, slosh.Recording and slosh.replay() read them.
  void record(const std::filesystem::path& file);
  void stop_recording();

 private:
  double choose_spacing_of(const WorldProgramOptions& options);
  void refuse_while_moving() const;
  void refuse_while_recorded(const char* what) const;
  void begin_move();
  void let_read();
  std::span<const HandleInput> inputs();
  void one_step(std::span<const HandleInput> hands);
  void follow_task();
  struct Moving;

  std::shared_ptr<const Scene> scene_;
  Backend backend_ = Backend::kCpu;
  std::string spacing_reason_;
  SampledScene sampled_;
  std::optional<World> world_;
  std::vector<Hand> hands_;
  std::vector<HandleInput> inputs_;
  std::vector<std::uint8_t> start_;  // World::save of what a reset goes back to
  std::unique_ptr<Instruments> instruments_;
  std::unique_ptr<keep::RecordingWriter> recording_;
  std::unique_ptr<TaskTap> task_;
  Moments moments_;
  BodySnapshot bodies_;
  bool bodies_known_ = false;
  std::uint32_t status_ = 0;  // of the steps since the run began
  std::uint32_t resets_ = 0;
  bool in_call_ = false;  // step, run or settle is under way
  bool moving_ = false;   // and has let go of Python's lock
};

/// The index that a name or a number stands for. Raises KeyError with the nearest name and all of them.
std::size_t index_of(const py::object& name_or_number, const std::vector<std::string>& names,
                     const char* what);

}  // namespace slosh::python
