// The world moving: owns all state, steps it by the plan, hands out snapshots.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "sim/backend.h"
#include "sim/math/cut_plane.h"
#include "sim/math/dense.h"
#include "sim/math/result.h"
#include "sim/plan.h"
#include "sim/snapshot.h"

namespace slosh {

constexpr double kMaxGravityScale = 2.0;
/// World::set_grip_stiffness: times the scene's.
constexpr double kMinGripStiffness = 0.05;
constexpr double kMaxGripStiffness = 4.0;

/// One handle's input for one step, in the order of Scene::grips.
struct HandleInput {
  Pose pose;             ///< world
  Twist twist;           ///< world
  bool engaged = false;  ///< false: the grip is disengaged, no coupling
  double scale = 1.0;    ///< 0–1, ramps the coupling in on engaging
};

/// Time of each pass of a step, s: wall time; of an engine's passes on a GPU the GPU's own, as the newest
/// timed sub-step had them, which overlap with the others. A fused pass is in the one whose loop runs it.
struct StepTimes {
  std::array<double, kPassCount> pass{};
  double total = 0.0;  ///< wall time of the whole step

  double& operator[](PassId id) { return pass[static_cast<std::size_t>(id)]; }
  double operator[](PassId id) const { return pass[static_cast<std::size_t>(id)]; }
  StepTimes& operator+=(const StepTimes& other) {
    for (std::size_t i = 0; i < kPassCount; ++i) pass[i] += other.pass[i];
    total += other.total;
    return *this;
  }
};

struct WorldOptions {
  int threads = 0;  ///< of the CPU backend; 0 = all cores
  Backend backend = Backend::kAuto;
  /// The fluid lies as an earlier world's came to rest, not in the lattice that volumes are filled with: it
  /// has expanded already (passes/rest_density/rest_density.h). As a lattice it would sag and bounce for 0.2
  /// s.
  bool settled = false;
  int gpu = 0;  ///< of the CUDA backend, from 0 as CUDA counts
};

/// Sums over the fluid, for checks and the summary (double precision).
struct Diagnostics {
  std::uint64_t particles = 0;   ///< still in the world
  std::uint64_t retired = 0;     ///< out of the world since the start: spilled and lost
  std::uint64_t spilled = 0;     ///< left the domain over its edge
  std::uint64_t lost = 0;        ///< not finite; where walls do not hold (Plan::walls_hold) all that left the
                                 ///< domain too: it may have gone through one
  double mass = 0.0;             ///< kg
  glm::dvec3 momentum{0.0};      ///< kg·m/s
  glm::dvec3 center{0.0};        ///< m, centre of mass
  double kinetic_energy = 0.0;   ///< J
  double max_speed = 0.0;        ///< m/s
  double max_compression = 0.0;  ///< largest ρ/ρ⁰ − 1
  std::uint64_t clamped = 0;     ///< how often particles were kept from passing a wall, since the start
  // With PassId::kHeat, else 0:
  double heat = 0.0;                    ///< J, over what the fluid has at 0 °C
  double heat_from_bodies = 0.0;        ///< J, that it was given by bodies since the start
  double coldest = 0.0, hottest = 0.0;  ///< °C
  double cure = 0.0;                    ///< 0–1: how far it has set, mean over its mass
  glm::dvec3 clamp_impulse{0.0};  ///< kg·m/s, what that took from the fluid in the last step and bodies get
                                  ///< in the next
};

/// Pa·s (World::settle). Half a second after its release from its lattice, half a spacing off every wall,
/// fluid of 50, 200 and 1000 Pa·s had not closed that gap around a ball of 1.5 spacings, and a hand that
/// turned the ball felt 4, 20 and 31 % too little.
inline constexpr double kMaxSettlingViscosity = 5.0;

/// The simulated world. One thread calls it; it uses `threads` cores inside. The same inputs give the same
/// state bitwise whatever the thread count; a GPU's differ from the CPU's by rounding.
class World {
 public:
  /// `scene` and `sampled` are copied as needed; neither must outlive the call. kCuda counts as kAuto here:
  /// make_world is for who must know.
  World(const Scene& scene, const SampledScene& sampled, Plan plan, WorldOptions options = {});
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// Advances by plan().time_step. `handles` has one entry a grip; missing ones count as not engaged.
  void step(std::span<const HandleInput> handles);

  /// Lets the world come to rest before the run, for who asks for it (Scene::settle): fluid finds its level,
  /// then bodies their place in the hands that hold them, all damped, over `seconds` of simulated time (half
  /// of it with the bodies where the scene has them). `handles` as for step, standing still; without any, no
  /// body moves. Neither time() nor tick() advances. What the fluid starts with, a velocity, a head, an
  /// unstable layering, is lost. 0 does nothing. `stopped` is asked each step: where it says true the world
  /// is left as it is by then, for who ends anyway. Fluid thicker than kMaxSettlingViscosity settles as if it
  /// had that: it finds the same place sooner. With a `longest` above `seconds` it goes on until what hands
  /// feel is steady (Steadiness), at most to `longest`. Returns how long it took, s.
  double settle(double seconds, std::span<const HandleInput> handles = {}, bool (*stopped)() = nullptr,
                double longest = 0.0);

  const Plan& plan() const;
  double time() const;  ///< s
  std::uint64_t tick() const;
  std::size_t fluid_count() const;     ///< all that there is room for, in the world or out of it
  std::size_t boundary_count() const;  ///< body particles
  const StepTimes& times() const;      ///< of the last step
  /// Of a free body as it is now, cut or whole, in its mesh frame; 0 kg of any other.
  MassProperties mass(std::size_t body) const;

  /// Fills without allocating once the vectors have grown.
  void fill(BodySnapshot& out) const;
  /// `with_shell` marks what is seen from outside (sim/shell.h); else Snapshot::shell is emptied.
  void fill(Snapshot& out, bool with_shell = false) const;
  /// The same without a shell, but particles that are on a GPU may stay there until Snapshot::complete(), by
  /// whichever thread, so that the next step does not wait for them.
  void fill_later(Snapshot& out) const;
  /// From now on snapshots also say where the GPU that steps the particles has them (Snapshot::on_gpu), for
  /// six of them at a time. False where no GPU steps them. Errors, with everything as it was: its driver
  /// shares nothing.
  Result<bool> share_particles();
  /// Pa, one a fluid particle by id, by Eq 7 from its density in the last step (at the start: 0), without
  /// what damps impacts; NaN for what has left the world, for all when the GPU failed. About a millisecond
  /// for 32 768.
  void fill_pressures(std::vector<float>& out) const;
  /// °C, and 0–1 how far each has set, one a fluid particle by id: those of the start where the plan passes
  /// no heat; NaN where fill_pressures has it. As long.
  void fill_heat(std::vector<float>& temperatures, std::vector<float>& cures) const;
  /// m/s, one a fluid particle by id, half a step behind the positions (leap-frog); NaN where fill_pressures
  /// has it. As long.
  void fill_velocities(std::vector<glm::vec3>& out) const;

  /// Appends everything that moves or can be changed, so that a world of the same scene, spacing and plan
  /// goes on from it: on the CPU bitwise. About 33 bytes a particle; 0.5 ms for 32 768. Error: the GPU
  /// failed.
  Result<bool> save(std::vector<std::uint8_t>& out) const;
  /// Takes over what save() wrote, on either backend. Errors, with the world as it was: other bytes, cut off,
  /// another scene, spacing or version, a value that cannot be.
  Result<bool> restore(std::span<const std::uint8_t> saved);

  /// Brings what is away, by its number (thing_count): a body to where the scene has it, or its keys by now;
  /// of a fluid volume one filling, as far as bodies and fluid leave it free. Takes a few ms. Errors, with
  /// the world as it was: no such thing, it is there, or stands for good; something is in its place; the
  /// volume's particles are all in the world (FluidVolume::fillings).
  Result<bool> appear(std::size_t thing);
  /// Takes a body or the particles of a fluid volume out of the world; they may come again. With a `region`
  /// (index into Scene::regions) those of a volume that are in it. Errors likewise: no such thing, or it is
  /// not there.
  Result<bool> take_away(std::size_t thing, int region = -1);

  /// Cuts a body (Body::pieces) along a plane in its mesh frame. The part that grips and joints are on keeps
  /// its number, without any the larger one; the other comes into the world as a body that was away, whose
  /// number is returned. Both go on as the whole moved: mass, momentum and angular momentum stay to rounding.
  /// Takes a few ms. Errors, with the world as it was: it cannot be cut, or is not there; no piece of it is
  /// left; the plane misses it; a part would be thinner than particles are apart; grips and joints are on
  /// both.
  Result<std::size_t> cut(std::size_t body, const CutPlane& plane);

  /// From the next step on. Errors: no such fluid in the world, or the time step would not be stable with it
  /// (then with the largest value that is). `pascal_seconds` >= 0.
  Result<bool> set_viscosity(std::size_t fluid, double pascal_seconds);
  /// Times the scene's gravity, 0 to kMaxGravityScale. Errors as above.
  Result<bool> set_gravity_scale(double scale);
  /// Springs of a grip's coupling, straight and turning, times the scene's: kMinGripStiffness to
  /// kMaxGripStiffness. The dampers stay. It is gone over to from the next step on, by kGripStiffnessPace,
  /// so that what hangs there is not thrown. Errors: no such grip, beyond these, or a spring of more than a
  /// scene may have (10⁶ N/m, 10⁴ N·m/rad).
  Result<bool> set_grip_stiffness(std::size_t grip, double scale);
  /// As it was set, one a grip.
  std::span<const double> grip_stiffness() const;
  double viscosity(std::size_t fluid) const;  ///< Pa·s; 0 for a fluid that is not there
  double gravity_scale() const;

  /// The fluid's wrench on each body in the last sub-step alone, about its centre of mass (BodyState::fluid
  /// is the mean over the step); nothing before a step and after restore().
  std::span<const Wrench> fluid_wrenches() const;
  /// What that loses for each unit of the body's twist with the fluid held as it is, linear first, angular
  /// after, about the centre of mass: N·s/m, N·s, N·m·s. Symmetric, positive semidefinite, one a body; empty
  /// where the plan has neither kBodyDrag nor kImplicitViscosity.
  std::span<const Matrix6> drags() const;

  std::uint32_t take_status();  ///< StatusBits since the last call, then cleared
  std::uint64_t hash() const;   ///< of positions, velocities and body states, by particle id
  Diagnostics diagnostics() const;
  std::string backend() const;  ///< where the particles live, in words: "CPU, 2 threads", "CUDA, NVIDIA H200"
  std::string failure() const;  ///< why kStatusDeviceLost was set, in CUDA's words; empty while all is well

  struct Impl;  ///< world_parts.h; for the passes

 private:
  explicit World(std::unique_ptr<Impl> impl);
  friend Result<World> make_world(const Scene& scene, const SampledScene& sampled, Plan plan,
                                  WorldOptions options);
  std::unique_ptr<Impl> impl_;
};

/// A world on the backend that `options` names. Errors: no GPU, or too little memory, for kCuda; an endless
/// plan.
Result<World> make_world(const Scene& scene, const SampledScene& sampled, Plan plan,
                         WorldOptions options = {});

}  // namespace slosh
