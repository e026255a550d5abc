// How strongly a wall must drag for fluid to stand still at the surface.
#pragma once

#include "scenes/scene.h"
#include "sim/plan.h"

namespace slosh {

/// Where the particles by which a wall presses sit behind the surface, in spacings
/// (walls/wall_particles.cpp).
inline constexpr double kWallInset = 0.7;
/// Where the fluid's first layer stands off it.
inline constexpr double kFirstLayer = 0.5;

/// Which of a wall's particles drag.
enum class DragSheet {
  kBehind,   ///< those that press, kWallInset behind the surface
  kSurface,  ///< others, on the surface itself
};

/// The corrected model's walls drag from the surface itself: drag goes along the line between two particles,
/// and from behind the surface that line is mostly across it. (One sheet kWallInset behind has to drag six
/// times as strongly to hold flat fluid, damps four times as fast across the surface as along it, and lets go
/// of strongly curved ones: a ball of 1.5 spacings lost 31 to 41 % of its drag.) Where all fluids and bodies
/// are thin (noise.h), drag on jostling is more than theirs and the second sheet not worth its time; so too
/// in the other models. `scene`: as it starts, since the sheets stay for the run.
DragSheet drag_sheet(const Scene& scene, const Plan& plan);

/// Of a flat wall at the spacing against a lattice of fluid, in units of the damping rate that a particle has
/// among the still neighbours of a whole lattice.
struct WallDrag {
  double factor = 1.0;  ///< what the volume of a dragging particle, its area times the spacing, counts
  double rate = 0.0;    ///< of a particle of the first layer by the wall: across and along it together
};

/// `factor` is such that in a linear shear, u = γ · (distance from the surface), the fluid within reach of
/// the sheet passes on the stress that layers of fluid pass on to each other. Fluid at a wall lies half in
/// layers, half evenly: on the surface the mean of both counts; from behind it layers alone. Nothing but the
/// support ratio and the kernel decide it. Models other than kCorrected keep 1.
WallDrag wall_drag(ParticleModel model, double support_ratio, DragSheet sheet);

}  // namespace slosh
