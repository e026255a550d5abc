// Implicit viscosity on the CPU (passes/implicit_viscosity/implicit.h).
#pragma once

#include <span>
#include <vector>

#include "sim/cpu/passes.h"
#include "sim/passes/implicit_viscosity/implicit.h"
#include "sim/passes/pair_viscosity/row_viscosity.h"

namespace slosh {

/// Whom viscosity acts between, in the order of their cells.
struct DragSides {
  FluidParticles& fluid;
  const BoundaryParticles& fixed;
  BodySurface& moving;
  std::span<const RigidBody> bodies;  ///< as they were when `moving` was placed
  const FluidViscosity& drag;         ///< from the force pass
};

/// Conjugate gradients over the fluid and the bodies that move. Keeps its memory from one solve to the next.
class ViscousSolver {
 public:
  /// `fluid.fx…` hold all other forces, N, without gravity, and get the viscous force over `dt` s;
  /// `wrenches`, one a body, get the drag on those that move, about their centres of mass, and on the fixed
  /// ones that `measured` marks. Bitwise identical whatever the threads. For models with DragRule::kCentral.
  ViscousReport solve(const PassContext& context, ThreadTeam& team, const DragSides& sides, double dt,
                      std::span<const ViscousBody> bodies, const std::vector<char>& measured,
                      std::span<Wrench> wrenches);
  /// By the last solve(), one a body: what the drag on it loses for each unit of its twist while the fluid
  /// stays as it is; of those that move.
  const std::vector<BodyDrag>& drags() const { return drags_; }

 private:
  struct Unknown {
    Matrix6 factor{};  // Cholesky of inertia + dt · drag
    Vector6 change{}, residual{}, direction{}, product{};
  };
  // What one solve works on.
  struct Work {
    const PassContext& context;
    ThreadTeam& team;
    const DragSides& sides;
    float dt;
    std::span<const ViscousBody> bodies;
    const std::vector<char>& measured;
    std::size_t fluid = 0, surface = 0;  // particles
  };
  struct Sums {
    double left = 0.0;     // mass · (residual/mass)²
    double changed = 0.0;  // mass · change²
    double step = 0.0;     // residual · product
  };

  void write_body_rows(const Work& work);
  void find_blocks(const Work& work);
  double begin(const Work& work);
  void begin_bodies(const Work& work);
  double precondition_bodies(const Work& work);
  void follow(const Work& work, double keep);
  template <class F>
  double sum_over_dragged(const Work& work, F&& f);
  double multiply(const Work& work);
  Sums advance(const Work& work, double length);
  void finish(const Work& work, std::span<Wrench> wrenches);
  void add_fixed(const Work& work, std::span<Wrench> wrenches);

  void carry_surface(const Work& work, std::span<const Twist> twists);
  void sum_over_bodies(const Work& work);

  std::vector<Vector4> change_, residual_, product_;  // of the fluid's particles
  std::vector<Vector4> direction_;                    // and behind them of the moving bodies'
  Column<float> end_x_, end_y_, end_z_;               // the velocities found, where fixed bodies are measured
  std::vector<Vector4> places_;                       // m, as direction_
  std::vector<Symmetric<float>> block_;  // the inverse of its own block, one a particle of the fluid
  PairRows body_rows_;                   // of the moving bodies' particles, numbered as direction_
  std::vector<Symmetric<float>> rate_;   // of the moving bodies' particles, N·s for each m/s
  std::vector<Unknown> unknowns_;        // one a body
  std::vector<glm::vec3> on_surface_;    // N·s, one a particle of the moving bodies
  std::vector<BodyDrag> drags_;          // one a body
  std::vector<Wrench> on_bodies_;        // N·s, one a body
  std::vector<double> parts_;            // of a sum, in a fixed order
  std::vector<Sums> sums_;               // likewise
  std::vector<Twist> twists_;
};

}  // namespace slosh
