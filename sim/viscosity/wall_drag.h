// How strong the viscous force of a no-slip wall must be for fluid to stand still at the surface.
#pragma once

#include "scenes/scene.h"
#include "sim/plan.h"

namespace slosh {

/// Where the fluid's first layer stands off it.
inline constexpr double kFirstLayer = 0.5;

/// Which of a wall's particles exert viscous forces.
enum class DragLayer {
  kBehind,   ///< those that press, behind the surface (walls/wall_inset.h)
  kSurface,  ///< others, on the surface itself
};

/// The corrected model's walls drag from the surface itself: the viscous pair force is central, and from
/// behind the surface that line is mostly across it (tests/notebook/2026-11-25-viscous-force-at-walls.md).
/// Where all fluids and bodies are thin (artificial_viscosity.h), artificial viscosity exceeds theirs and the
/// second layer is not worth its time; so too in the published model. `scene`: as it starts, since boundary
/// layers stay for the run.
DragLayer drag_layer(const Scene& scene, const Plan& plan);

/// Of a flat wall at the spacing against a lattice of fluid, in units of the damping rate that a particle has
/// among the still neighbours of a whole lattice.
struct WallDrag {
  double layered = 1.0;  ///< factor() where all fluid at the wall lies in layers
  double even = 1.0;     ///< and where all of it lies evenly
  double rate = 0.0;     ///< of a particle of the first layer by the wall: across and along it together
  /// The share of the fluid that lies evenly at a flat wall and at a ball of a few spacings, 0 to 1.
  double evenly_flat = 0.0, evenly_at_balls = 0.0;

  /// What the volume of a boundary particle, its area times the spacing, counts. `convexity`: the surface's
  /// mean curvature times the spacing, 0 (flat or concave) and above.
  double factor(double convexity) const;
};

/// Factors are such that in a linear shear, u = γ · (distance from the surface), the fluid within reach of
/// the layer passes on the stress that layers of fluid pass on to each other. Fluid at a flat wall lies
/// mostly in layers, at a ball of a few spacings more of it evenly; from behind the surface layers alone
/// count. Only the support ratio, drag_shape(), the surface and pressure projection decide it. Models that do
/// not correct gradients keep 1.
WallDrag wall_drag(ParticleModel model, double support_ratio, DragLayer layer);

/// What the volume of a particle on a surface along which fluid slides counts (mirror_drag.h): such that
/// evenly lying fluid which stretches along a flat wall and is pressed together across it loses by the wall
/// the power that it and its mirror image would take from each other, half of it for either (in layers that
/// would be six tenths as much). At a support ratio of 2 a particle of the first layer then has 0.36 of the
/// damping rate of a whole lattice by it, less than the half of that lattice that it lacks: no step is
/// shortened. 0 where walls do not drag from the surface.
double mirror_factor(double support_ratio, DragLayer layer);

}  // namespace slosh
