// How the viscous force between two particles falls off with their distance.
#pragma once

#include "sim/math/kernels.h"
#include "sim/viscosity/wall_drag.h"

namespace slosh {

/// Eq 9 has the viscosity kernel's ∇²W, and so have the models that do not correct gradients and thin fluid
/// (DragLayer::kBehind), where artificial viscosity dominates. Thick fluid has a shape of its own, for two
/// reasons (tests/notebook/2026-11-25-shape-of-the-viscous-pair-force.md):
///
/// - Fluid at rest lies in a lattice, and at a support ratio of 2 ∇²W passes on 0.89 of a strain along the
///   lattice's axes and 1.055 of a shear. What is nearer counts more here, so that both are 1.00; where
///   particles lie in no lattice both shapes pass on 0.99 to 1.01 of either. At ratios of 2.25 and more
///   neither shape is better.
/// - Fluid that flows along itself lies in layers that slide over each other, and those pass on 0.96 in the
///   mean over where one lies over the next. The shape makes up for that.
///
/// `support_radius`: m.
DragShape<double> drag_shape(DragLayer layer, double support_radius);

}  // namespace slosh
