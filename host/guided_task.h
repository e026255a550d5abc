// A scene's guided task in a running world: which step it is at, and when each was done.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "sim/instruments.h"
#include "sim/world.h"

namespace slosh {

/// A task at some moment.
struct TaskState {
  struct Done {
    double took = 0.0;  ///< s
    bool late = false;
    std::vector<double> measured{};  ///< of its goal's leaves (leaves_of), as it was met
  };
  std::vector<Done> done;  ///< the steps that are, in order
  double begun = 0.0;      ///< simulated s at which the step after them began
  double now = 0.0;        ///< simulated s
  double held = 0.0;       ///< s that its goal has held on
  double measured = 0.0;   ///< of `asked`, in its unit; NaN where it cannot be told
  const Goal* asked =
      nullptr;  ///< what is measured: of several the first that keeps the step from being done
};

/// One thread; the scene must outlive it.
class GuidedTask {
 public:
  /// s, simulated, from one look at the world to the next.
  static constexpr double kEvery = 0.05;

  GuidedTask(const Scene& scene, const SampledScene& sampled);

  /// After each step, and before the first; true where the state is another then. A world whose time went
  /// back begins the task anew.
  bool follow(const World& world);
  /// Before the first look: these steps are done, in so many s each; the next begins then.
  void carry_on(const std::vector<double>& took);
  const TaskState& state() const { return state_; }
  /// kg of fluid that is in no region of the scene, or has left the world (by its mean particle's mass).
  double spilled(const World& world);

 private:
  double measure(const Goal& goal) const;
  bool met(const Goal& goal) const;
  /// The first leaf that keeps `goal` from being met; the first one where it is.
  const Goal* asked_of(const Goal& goal) const;
  double pieces_of(int body) const;
  double measure_region(const Goal& goal) const;
  void look(const World& world);

  const Scene& scene_;
  Instruments instruments_;
  glm::dvec3 up_{0.0, 1.0, 0.0};
  BodySnapshot bodies_;
  const Measurement* fluid_ = nullptr;       // where the step's goal asks for it
  std::vector<float> temperatures_, cures_;  // likewise, one a particle
  double next_ = 0.0;
  std::vector<TaskState::Done> carried_;  // steps that were done before the first look
  bool begun_ = false;
  bool was_met_ = false;  // at the look before
  TaskState state_;
};

}  // namespace slosh
