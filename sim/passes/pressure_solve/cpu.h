// Pressures that keep fluid from being compressed, on the CPU (passes/pressure_solve/solved_state.h has the
// system).
#pragma once

#include <span>
#include <vector>

#include "sim/cpu/passes.h"
#include "sim/passes/implicit_viscosity/implicit.h"
#include "sim/passes/pressure_solve/cpu_pairs.h"
#include "sim/passes/pressure_solve/limits.h"

namespace slosh {

/// Whom pressure acts between, in the order of their cells.
struct PressedSides {
  FluidParticles& fluid;
  const BoundaryParticles& moving;
  std::span<const RigidBody> bodies;  ///< as they were when `moving` was placed
  const FluidPress& press;            ///< from the density pass
};

/// Conjugate gradients over the particles that press. Keeps its memory from one solve to the next.
class PressureSolver {
 public:
  /// Adds to `fluid.fx…`, N, what the last step's pressures, `fluid.solved`, push each by.
  void push_by_last(const PassContext& context, ThreadTeam& team, const PressedSides& sides);
  /// `fluid.fx…` hold all forces, N, without gravity, with those of push_by_last(), and get what the
  /// pressures found over `dt` s differ by; so do `fluid.solved` and `wrenches`, one a body, of the bodies in
  /// `moving`, about their centres of mass. Bitwise identical whatever the threads.
  PressureReport solve(const PassContext& context, ThreadTeam& team, const PressedSides& sides, double dt,
                       std::span<const ViscousBody> bodies, std::span<Wrench> wrenches);

 private:
  // What 1 Pa of a particle puts on a body, and its velocity on the particle's flow.
  struct Touch {
    std::uint32_t particle = 0;
    int body = 0;
    Vector6 push{};
  };
  // What one solve works on.
  struct Work {
    const PassContext& context;
    ThreadTeam& team;
    const PressedSides& sides;
    float dt;
    std::span<const ViscousBody> bodies;
    std::size_t fluid = 0;  // particles
  };
  struct Sums {
    double left = 0.0;     // residual² over the system's diagonal
    double step = 0.0;     // residual · preconditioned residual
    double turned = 0.0;   // the same with the residual before
    double clipped = 0.0;  // what pressures went below 0 by, squared, times the diagonal
    double squares = 0.0;  // residual²
    double pressing = 0.0;
  };

  void find_touches(const Work& work);
  void begin(const Work& work);
  void begin_bodies(const Work& work);
  void find_diagonal(const Work& work);
  void follow(const Work& work, double keep);
  void press(const Work& work, std::size_t p, float pressure);
  template <class F>
  void for_each_pushed(const Work& work, F&& f) const;
  template <class F>
  double sum_over_flows(const Work& work, F&& f);
  void push(const Work& work);
  double multiply(const Work& work);
  Sums look(const Work& work);
  Sums advance(const Work& work, double length);
  void undo_clips(const Work& work);
  void add_forces(const Work& work);
  void finish(const Work& work, std::span<Wrench> wrenches);
  Sums total() const;

  std::vector<float> flow_;       // Q v − V⁰ e/dt, m³/s: wanted 0 where it presses, not below 0 elsewhere
  std::vector<float> inverse_;    // of the system's diagonal
  std::vector<float> pressure_;   // Pa
  std::vector<float> residual_;   // −flow_ of those that press
  std::vector<float> product_;    // the system times the direction
  std::vector<float> clipped_;    // Pa, what was cut off below 0 and flow_ does not know of
  std::vector<float> direction_;  // Pa
  std::vector<PressureTensor> pressing_;           // the direction times each one's tensor of 1 Pa
  std::vector<Vector4> velocity_;                  // m/s; in w 1/mass
  std::vector<Touch> touches_;                     // in the order of the particles
  std::vector<std::vector<Touch>> found_touches_;  // by chunk of runs
  std::vector<std::uint32_t> first_touch_;         // of each particle, and one more
  std::vector<Matrix6> factors_;                   // Cholesky of the bodies' inertia
  std::vector<Vector6> twists_;
  std::vector<double> parts_;  // of a sum, in a fixed order
  std::vector<Sums> sums_;     // likewise
};

}  // namespace slosh
