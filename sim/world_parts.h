// What a World is made of, and its sub-step.
#pragma once

#include <array>
#include <future>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sim/bodies/body_system.h"
#include "sim/live_changes.h"
#include "sim/particle_engine.h"
#include "sim/passes/pass.h"
#include "sim/saved_state.h"
#include "sim/world.h"

namespace slosh {

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
  SubStep sub_step(int index) const;
  void begin_step();
  /// The passes of a sub-step's schedule.
  void run(const SubStep& step);
  std::vector<PassId> schedule_of(TakePart part) const;
  void make_schedules();
  /// The engine's part of a pass, `after`: where the bodies end the sub-step.
  void run_on_engine(PassId id, const SubStep& step, std::span<const RigidBody> after);
  void run_on_engine(PassId id, const SubStep& step) { run_on_engine(id, step, bodies.bodies()); }
  /// Where the bodies will be, as far as that is known: where they are, once they moved.
  std::span<const RigidBody> bodies_after(const SubStep& step);
  BodyForces body_forces(const SubStep& step) const;
  /// With kHeat: whether this sub-step is the one in so many steps that passes it.
  bool passes_heat_in(const SubStep& step) const {
    return step.elapsed == 0.0 && tick % static_cast<std::uint64_t>(plan().heat_steps) == 0;
  }
  Result<bool> bring_body(std::size_t body);
  /// What the two parts of a cut have: all that takes long of it.
  struct Parts {
    PieceShape rest, off;
    std::vector<SurfaceParticle> of_rest, of_off;
  };
  /// What parts() works with, its own.
  struct CutOrder {
    std::size_t body = 0;
    CutPlane plane;
    std::vector<CutPlane> planes;  // of the body before the cut
    Scene scene;                   // bodies and support ratio alone
    Plan plan;
    DragLayer drags = DragLayer::kBehind;
    bool held = false;  // the part within the plane keeps the number, even where it is the smaller one
  };
  static Result<Parts> parts(const CutBodies& cuts, const CutOrder& order);
  CutOrder order(std::size_t body, const CutPlane& plane) const;
  Result<std::size_t> cut_body(std::size_t body, CutPlane plane);
  /// At a step's end: bodies that blades have gone through.
  void cut_through();
  /// What a body will be cut into that a blade is in is found meanwhile on another thread, since the plane is
  /// known: so that no step waits for it.
  void plan_cut();
  /// Which side of the plane keeps the body's number. Error: grips and joints are on both.
  Result<CutPlane> side_that_stays(std::size_t body, const CutPlane& plane) const;
  /// The particles of a piece, as many as there is room for. Error: they are more.
  Result<std::vector<SurfaceParticle>> particles_of(std::size_t body, const PieceShape& shape) const;
  /// The engine goes on with that surface of the body.
  void reshape(std::size_t body, const PieceShape& shape, std::span<const SurfaceParticle> particles,
               const glm::dvec3& recentred);
  /// A body with the planes that a saved world has.
  struct Reshaping {
    std::size_t body = 0;
    PieceShape shape;
    std::vector<SurfaceParticle> particles;
  };
  /// Of those whose planes are others than now; their masses go into the state. Errors: planes or blades that
  /// cannot be.
  Result<std::vector<Reshaping>> shapes_of(SavedState& state) const;
  /// A body that was cut is whole again.
  void make_whole(std::size_t body);
  Result<bool> fill_volume(std::size_t volume);
  Result<bool> empty_volume(std::size_t volume, int region);
  std::vector<glm::vec3> free_places(const FillingIds& ids, const Pose& to_now,
                                     const std::vector<glm::vec3>& others) const;
  void add_particle(std::uint32_t id, const glm::vec3& at, const glm::vec3& velocity,
                    ParticleState& particles) const;
  /// The engine goes on with these particles, of which `changed` (ids, rising) came or went.
  void put(const ParticleState& particles, const ImpulseSums& walls,
           const std::vector<std::uint32_t>& changed);
  void take_drags();
  glm::dvec3 gravity() const { return gravity_scale * scene.gravity; }
  void report(const SubStep& step);

  Scene scene;
  WorldOptions options;
  RunConstants constants;
  BodySystem bodies;
  LiveChanges live;
  std::unique_ptr<ParticleEngine> engine;
  std::array<std::vector<PassId>, 3> schedules;  // one a TakePart
  std::vector<RigidBody> ahead;                  // bodies_after()
  std::vector<Wrench> found;                     // by the fluid in the last sub-step, one a body
  std::vector<BodyDrag> drags;                   // with kBodyDrag, one a body
  std::vector<Matrix6> drag_matrices;
  std::vector<ViscousBody> viscous_bodies;  // with kImplicitViscosity, one a body
  std::vector<Wrench> wrenches;             // their means over the last step
  std::size_t fluid_count = 0;              // without probes
  std::vector<std::uint8_t> fluid_of;       // index into scene.fluids, by id
  std::size_t boundary_count = 0;
  /// Of a body's particles among those that move: the first, and how many.
  struct Slots {
    std::size_t first = 0, count = 0;
  };
  struct Ahead {
    std::size_t body = 0;
    CutPlane plane;
    std::vector<CutPlane> planes;
    std::future<Result<Parts>> parts;  // of bodies' CutBodies: before those are gone it is over
  };
  std::optional<Ahead> cut_ahead;
  std::shared_ptr<const BodyCuts> cuts_told;  // BodySnapshot::cuts
  DragLayer drags_from = DragLayer::kBehind;  // of the scene as it started
  std::vector<Slots> piece_slots;             // one a body, where any may be cut
  std::vector<FillingIds> fillings;           // one a fluid volume, and where its particles come
  std::vector<glm::vec3> filling_places;      // m, world, as the scene has its bodies; one an id
  std::vector<DistanceField> region_fields;
  std::int64_t waiting = 0;  // particles out of the world, neither spilled nor lost
  std::uint32_t status = 0;  // of bodies and inputs; the engine has its own
  std::uint64_t tick = 0;
  StepTimes times;
  double gravity_scale = 1.0;
  double age;           // s, as passes/rest_density/rest_density.h counts it; no further than kSettlingTime
  bool packed = false;  // the engine has the relaxed rest density, which stays
  StateFrame frame;
};

}  // namespace slosh
