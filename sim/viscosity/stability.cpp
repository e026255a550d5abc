#include "sim/viscosity/stability.h"

#include <algorithm>
#include <cmath>

#include "sim/model.h"
#include "sim/viscosity/noise.h"

namespace slosh {

namespace {

// Explicit viscosity is stable below 2/λ; λ of the roughest mode is about twice the lattice sum.
constexpr double kViscousFactor = 0.8;
// What a wall adds to that sum for the fluid's first layer, as a share of the whole lattice.
constexpr double kWallPart = 0.35;

// Σ V ∇²W over the neighbours of a rest lattice, times spacing²: the damping rate of one particle among still
// neighbours is μ/ρ · this / spacing².
template <class Kernel>
double lattice_viscosity_sum(double ratio) {
  const int reach = static_cast<int>(std::ceil(ratio));
  double sum = 0.0;
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      for (int z = -reach; z <= reach; ++z) {
        const double r = std::sqrt(static_cast<double>(x * x + y * y + z * z));
        if (r > 0.0 && r < ratio) sum += Kernel::laplacian(r, ratio);
      }
    }
  }
  return Kernel::scale(ratio) * sum;
}

// 1/(Pa·s · s): the explicit viscosity's damping rate for each Pa·s.
double viscous_rate(const Scene& scene, const Plan& plan, const FluidExtremes& fluids) {
  const double central = plan.model == ParticleModel::kPaper ? 1.0 : kCentralDrag / 3.0;
  const double lattice = with_model(plan.model, [&]<class Parts>() {
    return lattice_viscosity_sum<typename Parts::ForceKernel>(scene.support_ratio);
  });
  return central / fluids.lightest * lattice / (plan.spacing * plan.spacing);
}

// Pa·s that the roughest mode feels besides the fluid's own.
double jostling(const Plan& plan, const FluidExtremes& fluids) {
  return plan.model == ParticleModel::kCorrected ? noise_viscosity(plan, fluids.lightest) : 0.0;
}

}  // namespace

double most_viscous_body(const Scene& scene) {
  double most = 0.0;
  for (const Body& body : scene.bodies) most = std::max(most, body.dynamic_viscosity);
  return most;
}

double viscous_step(const Scene& scene, const Plan& plan, const FluidExtremes& fluids) {
  const double viscosity = jostling(plan, fluids) + fluids.most_viscous +
                           kWallPart * 0.5 * (fluids.most_viscous + most_viscous_body(scene));
  return kViscousFactor / (viscosity * viscous_rate(scene, plan, fluids));
}

double most_viscous_allowed(const Scene& scene, const Plan& plan) {
  const FluidExtremes fluids = fluid_extremes(scene);
  const double whole =
      kViscousFactor / (plan.time_step * viscous_rate(scene, plan, fluids)) - jostling(plan, fluids);
  return std::max(0.0, (whole - 0.5 * kWallPart * most_viscous_body(scene)) / (1.0 + 0.5 * kWallPart));
}

}  // namespace slosh
