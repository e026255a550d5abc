// What a World is made of, and its sub-step.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sim/bodies/body_system.h"
#include "sim/live_changes.h"
#include "sim/particle_engine.h"
#include "sim/saved_state.h"
#include "sim/world.h"

namespace slosh {

/// Who moves in a sub-step.
enum class TakePart { kFluid, kHeld, kAll };

struct World::Impl {
  Impl(const Scene& scene_in, const SampledScene& sampled, Plan plan_in, WorldOptions options_in);
  /// Error: the backend that was asked for is not there.
  std::optional<Error> start(const SampledScene& sampled);
  const Plan& plan() const { return constants.plan; }
  /// What a live change means for everybody who has a copy of it.
  void take_parameters();
  /// No fluid is thicker than `most`, Pa·s, from now on; whether one was.
  bool thin_fluids(double most);
  /// World::settle, with fluids as they are.
  double come_to_rest(double seconds, std::span<const HandleInput> handles, bool (*stopped)(),
                      double longest);
  /// Relaxes the fluid's rest density (pressure/rest_density.h).
  void calibrate_rest_density(double dt);
  SubStep sub_step(int index) const;
  void begin_step();
  /// The fluid, and the bodies as far as they take part. Where the viscous force needs the velocities of the
  /// bodies' solve, or walls move, it waits for it; else it goes on while they are solved (on a GPU).
  void run(const SubStep& step, TakePart part);
  void solve_viscosity(const SubStep& step, bool moving, bool held_only);
  void solve_pressure(const SubStep& step, bool moving, bool held_only, bool with_drag);
  void take_drags();
  /// Where the bodies will be, as far as that is known before their solve.
  std::span<const RigidBody> expected(const SubStep& step, bool moving);
  void solve_bodies(const SubStep& step, bool held_only, bool with_drag);
  void report(const SubStep& step);

  Scene scene;
  WorldOptions options;
  RunConstants constants;
  BodySystem bodies;
  LiveChanges live;
  std::unique_ptr<ParticleEngine> engine;
  std::vector<RigidBody> ahead;  // expected()
  std::vector<Wrench> found;     // by the fluid in the last sub-step, one a body
  std::vector<BodyDrag> drags;   // with kBodyDrag, one a body
  std::vector<Matrix6> drag_matrices;
  std::vector<ViscousBody> viscous_bodies;  // with kImplicitViscosity, one a body
  std::vector<Wrench> wrenches;             // their means over the last step
  std::size_t fluid_count = 0;              // without probes
  std::vector<std::uint8_t> fluid_of;       // index into scene.fluids, by id
  std::size_t boundary_count = 0;
  std::uint32_t status = 0;  // of bodies and inputs; the engine has its own
  std::uint64_t tick = 0;
  StepTimes times;
  double gravity_scale = 1.0;
  double age;           // s, as pressure/rest_density.h counts it; no further than kSettlingTime
  bool packed = false;  // the engine has the relaxed rest density, which stays
  StateFrame frame;
};

}  // namespace slosh
