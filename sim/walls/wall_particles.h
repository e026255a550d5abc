// The surface particles of rigid bodies (paper, section 4.1): collected once, in the bodies' own frames.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.h"
#include "sim/passes/pressure_force/pair_pressure.h"
#include "sim/plan.h"
#include "sim/viscosity/wall_drag.h"
#include "sim/walls/mirror_planes.h"

namespace slosh {

/// One particle of a body, as it stays for the run.
struct SurfaceParticle {
  glm::vec3 position;  ///< m, mesh frame
  std::uint16_t body;  ///< index into Scene::bodies
  float pressure;      ///< kPaper: Pa, Eq 7 at the body's constant density; corrects_gradients(): how many
                       ///< lattice particles it stands for, about two
  float volume;        ///< m³, of its viscous force (WallDrag::factor is in it)
  float viscosity;     ///< Pa·s
  float reach;         ///< m, within which it meets fluid: the support radius, less LayerParticle::lacks
  MirrorPlane
      mirror;  ///< world axes: of a fixed free-slip body, where surfaces drag (passes/walls/mirror_drag.h)
};

/// The particles of the bodies whose motion is `motion`, body by body; none when the plan has no boundary
/// pass.
/// Behind those of a body that cuts make something of (is_cut) there is room for more: nobody().
std::vector<SurfaceParticle> surface_particles(const Scene& scene, const SampledScene& sampled,
                                               const Plan& plan, BodyMotion motion);

/// Those of a body that moves, with another surface and field than the scene's: a piece. Without room.
/// `drags`: drag_layer() of the scene as it started.
std::vector<SurfaceParticle> particles_of_piece(const Scene& scene, const Plan& plan, DragLayer drags,
                                                std::size_t body, const SurfaceSamples& surface,
                                                const DistanceFieldView& field);

/// Fills room that `body` does not use: nowhere near any fluid.
SurfaceParticle nobody(std::size_t body);
inline constexpr float kNobodysPlace =
    1e6f;  ///< m, on each axis: farther than anything, and its square is finite
inline bool is_nobody(const SurfaceParticle& p) {
  return p.position.x == kNobodysPlace;
}

}  // namespace slosh
