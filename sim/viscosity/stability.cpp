#include "sim/viscosity/stability.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/math/lattice.h"
#include "sim/model.h"
#include "sim/passes/implicit_viscosity/implicit.h"
#include "sim/viscosity/artificial_viscosity.h"
#include "sim/viscosity/drag_shape.h"

namespace slosh {

namespace {

// Explicit viscosity is stable below 2/λ; λ of the roughest mode is about twice the lattice sum.
constexpr double kViscousFactor = 0.8;
// What is left of that sum for the fluid's first layer, and what a wall adds to it in the published model,
// whose boundary layer counts as one lattice layer.
constexpr double kHalfLattice = 0.5;
constexpr double kOneLayer = 0.85;
// Where two walls meet a particle has a quarter of a lattice and both walls. Rounding and packing leave less
// of that than an edge has: a fixed glass of 40 Pa·s around 2 Pa·s heats up at 1.05 times the flat walls'
// step, one that a hand holds at 0.85; the whole edge would be 0.68.
constexpr double kQuarterLattice = 0.25;
constexpr double kOfAnEdge = 0.7;

// Σ V shape over the neighbours of a rest lattice, times spacing²: the damping rate of one particle among
// still neighbours is μ/ρ · this / spacing².
template <class Kernel>
double lattice_viscosity_sum(double ratio, const DragShape<double>& shape) {
  double sum = 0.0;
  for_each_in_lattice(ratio, [&](int, int, int, double r) { sum += shape(Kernel::laplacian(r, ratio)); });
  return Kernel::scale(ratio) * sum;
}

// 1/(Pa·s · s): the explicit viscosity's damping rate for each Pa·s.
double viscous_rate(const Scene& scene, const Plan& plan, const FluidExtremes& fluids, DragLayer layer) {
  const double central = plan.model == ParticleModel::kPaper ? 1.0 : kCentralDrag / 3.0;
  const DragShape<double> shape = drag_shape(layer, scene.support_ratio);
  const double lattice = with_model(plan.model, [&]<class Parts>() {
    return lattice_viscosity_sum<typename Parts::ForceKernel>(scene.support_ratio, shape);
  });
  return central / fluids.lightest * lattice / (plan.spacing * plan.spacing);
}

// What a wall adds to the sum of the first layer: half of its rate, since it does not swing against the fluid
// as the fluid's own layers do.
double wall_part(const Scene& scene, const Plan& plan, DragLayer layer) {
  return corrects_gradients(plan.model) ? 0.5 * wall_drag(plan.model, scene.support_ratio, layer).rate
                                        : kOneLayer;
}

// The published model's boundary layer has less, and its steps stay as they are, to compare with.
double of_an_edge(const Plan& plan) {
  return corrects_gradients(plan.model) ? kOfAnEdge : 0.0;
}

// Pa·s, the artificial viscosity of the roughest mode.
double artificial(const Plan& plan, const FluidExtremes& fluids) {
  return corrects_gradients(plan.model) ? artificial_viscosity(plan, fluids.lightest) : 0.0;
}

double max_explicit_viscosity(const Scene& scene, const Plan& plan, DragLayer layer) {
  if (!plan.has_fluid()) return std::numeric_limits<double>::infinity();
  const double step = plan.time_step / plan.sub_steps;
  return kViscousFactor / (step * viscous_rate(scene, plan, fluid_extremes(scene), layer));
}

}  // namespace

double most_viscous_body(const Scene& scene, double most_viscous_fluid) {
  double most = 0.0;
  for (const Body& body : scene.bodies) {
    const bool of_the_fluid = body.dynamic_viscosity == kFluidsViscosity;
    most = std::max(most, of_the_fluid ? most_viscous_fluid : body.dynamic_viscosity);
  }
  return most;
}

double viscous_step(const Scene& scene, const Plan& plan, const FluidExtremes& fluids) {
  const double mean = 0.5 * (fluids.most_viscous + most_viscous_body(scene, fluids.most_viscous));
  const DragLayer layer = drag_layer(scene, plan);
  const double by_wall = wall_part(scene, plan, layer) * mean;
  const double at_walls =
      std::max(kHalfLattice * fluids.most_viscous + by_wall,
               of_an_edge(plan) * (kQuarterLattice * fluids.most_viscous + 2.0 * by_wall));
  const double viscosity = artificial(plan, fluids) + std::max(fluids.most_viscous, at_walls);
  return kViscousFactor / (viscosity * viscous_rate(scene, plan, fluids, layer));
}

double artificial_viscosity_step(const Scene& scene, const Plan& plan, const FluidExtremes& fluids) {
  const double rate = viscous_rate(scene, plan, fluids, drag_layer(scene, plan));
  return kViscousFactor / (artificial(plan, fluids) * rate);
}

double max_explicit_viscosity(const Scene& scene, const Plan& plan) {
  return max_explicit_viscosity(scene, plan, drag_layer(scene, plan));
}

double max_viscosity_allowed(const Scene& scene, const Plan& plan, DragLayer layer) {
  const FluidExtremes fluids = fluid_extremes(scene);
  const double whole =
      max_explicit_viscosity(scene, plan, layer) * (plan.implicit_viscosity ? kMaxImplicit : 1.0) -
      artificial(plan, fluids);
  const double part = wall_part(scene, plan, layer);
  const double of_bodies = most_viscous_body(scene, 0.0);
  const double at_walls = (whole - 0.5 * part * of_bodies) / (kHalfLattice + 0.5 * part);
  const double at_edges = (whole / of_an_edge(plan) - part * of_bodies) / (kQuarterLattice + part);
  const double most = std::min({whole, at_walls, at_edges});
  const bool of_the_fluid = std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const Body& body) {
    return body.dynamic_viscosity == kFluidsViscosity;
  });
  // Where walls go with the fluid both parts of Eq 9's mean rise.
  return std::max(0.0, of_the_fluid ? std::min({most, whole / (kHalfLattice + part),
                                                whole / of_an_edge(plan) / (kQuarterLattice + 2.0 * part)})
                                    : most);
}

}  // namespace slosh
