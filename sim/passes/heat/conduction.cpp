#include "sim/passes/heat/conduction.h"

#include <algorithm>
#include <limits>

#include "sim/math/lattice.h"
#include "sim/passes/bonds/bonds.h"
#include "sim/passes/pressure_force/pair_pressure.h"
#include "sim/plan.h"
#include "sim/walls/wall_inset.h"

namespace slosh {
namespace {

// Σ f(x, r) over a cubic lattice.
template <class F>
double lattice_sum(double ratio, F&& f) {
  double sum = 0.0;
  for_each_in_lattice(ratio, [&](int x, int, int, double r) { sum += f(x, r); });
  return sum;
}

// Σ (h − r), spacings, over a plane square lattice `height` away, mean over where one stands over it.
double plane_sum(double height, double ratio) {
  double sum = 0.0;
  for_each_in_layer(height, ratio, [&](double, double, double r) { sum += ratio - r; });
  return sum / (kPlacesOverLayer * kPlacesOverLayer);
}

// What a conductivity of 1 passes on in a lattice for each unit of h − r, spacings.
double pair_share(double ratio) {
  return 2.0 / lattice_sum(ratio, [ratio](int x, double r) { return x * x * (ratio - r); });
}

// How many times a wall's layer counts: then what fluid of a linear temperature gets from a flat wall is what
// its own layers pass on.
double wall_factor(double ratio, double behind) {
  double passed = 0.0;
  for (int n = 0; n < static_cast<int>(std::ceil(ratio)); ++n)
    passed += (0.5 + n) * plane_sum(behind + 0.5 + n, ratio);
  return passed > 0.0 ? 1.0 / (pair_share(ratio) * passed) : 0.0;
}

double layer_depth(const Plan& plan) {
  return plan.model == ParticleModel::kPaper ? 0.0 : wall_inset(plan.support_radius / plan.spacing);
}

bool is_there(const Scene& scene, std::size_t fluid) {
  return std::any_of(scene.fluid_volumes.begin(), scene.fluid_volumes.end(),
                     [&](const FluidVolume& v) { return static_cast<std::size_t>(v.fluid) == fluid; });
}

HeatKind heat_kind(const Fluid& fluid, double spacing) {
  const Heat& heat = fluid.heat;
  const auto rate = [](double seconds) { return seconds > 0.0 ? static_cast<float>(1.0 / seconds) : 0.0f; };
  const auto within = [](double celsius) { return static_cast<float>(std::clamp(celsius, -1e30, 1e30)); };
  HeatKind k;
  k.capacity = static_cast<float>(heat.capacity * fluid.rest_density * std::pow(spacing, 3));
  k.conductivity = static_cast<float>(heat.conductivity);
  k.temperature = static_cast<float>(heat.temperature);
  k.cure = heat.starts_set ? 1.0f : 0.0f;
  k.sets_above = within(heat.sets_above);
  k.sets_below = within(heat.sets_below);
  k.melts_above = within(heat.melts_above);
  k.setting = rate(heat.sets_in);
  k.melting = rate(heat.melts_in);
  k.log_of_set = static_cast<float>(std::log(heat.set_times));
  k.bond = static_cast<float>(bond_stiffness(heat.modulus, spacing));
  k.tears_at = static_cast<float>(heat.tears_at);
  for (const Heat::Point& point : heat.viscosity) {
    k.at[k.points] = static_cast<float>(point.temperature);
    k.log_times[k.points++] = static_cast<float>(std::log(point.times));
  }
  return k;
}

}  // namespace

bool passes_heat(const Scene& scene) {
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  const auto take = [&](double celsius) {
    lowest = std::min(lowest, celsius);
    highest = std::max(highest, celsius);
  };
  bool sets = false;
  for (std::size_t f = 0; f < scene.fluids.size(); ++f) {
    if (!is_there(scene, f)) continue;
    take(scene.fluids[f].heat.temperature);
    sets |= scene.fluids[f].heat.sets();
  }
  if (lowest > highest) return false;  // no fluid
  for (const Body& body : scene.bodies)
    if (body.temperature) take(*body.temperature);
  return sets || lowest < highest;
}

ViscosityRange viscosity_range(const Scene& scene, const Fluid& fluid) {
  ViscosityRange range{fluid.dynamic_viscosity, fluid.dynamic_viscosity};
  if (!passes_heat(scene)) return range;
  for (const Heat::Point& point : fluid.heat.viscosity) {
    range.least = std::min(range.least, fluid.dynamic_viscosity * point.times);
    range.most = std::max(range.most, fluid.dynamic_viscosity * point.times);
  }
  range.least *= std::min(fluid.heat.set_times, 1.0);
  range.most *= std::max(fluid.heat.set_times, 1.0);
  return range;
}

double conduction_step(const Scene& scene, const Plan& plan) {
  // The roughest mode decays at twice a particle's own rate; the rest is room for a wall.
  constexpr double kRoom = 0.4;
  const double ratio = plan.support_radius / plan.spacing;
  const double of_fluid = lattice_sum(ratio, [ratio](int, double r) { return ratio - r; });
  const double of_wall = wall_factor(ratio, layer_depth(plan)) * plane_sum(layer_depth(plan) + 0.5, ratio);
  double fastest = 0.0;  // m²/s
  for (std::size_t f = 0; f < scene.fluids.size(); ++f) {
    const Fluid& fluid = scene.fluids[f];
    if (is_there(scene, f))
      fastest = std::max(fastest, fluid.heat.conductivity / (fluid.rest_density * fluid.heat.capacity));
  }
  if (fastest == 0.0) return std::numeric_limits<double>::infinity();
  return kRoom * plan.spacing * plan.spacing / (fastest * pair_share(ratio) * (of_fluid + of_wall));
}

int heat_steps(const Scene& scene, const Plan& plan) {
  const double longest = std::min(kHeatTime, conduction_step(scene, plan));
  return std::max(1, static_cast<int>(longest / plan.time_step * (1.0 + 1e-9)));
}

HeatConstants heat_constants(const Scene& scene, const Plan& plan) {
  const double ratio = plan.support_radius / plan.spacing;
  HeatConstants c;
  for (const Fluid& fluid : scene.fluids) c.kinds.push_back(heat_kind(fluid, plan.spacing));
  for (const Body& body : scene.bodies) {
    if (body.point_probe) c.kinds.push_back({});
    c.bodies.push_back(
        static_cast<float>(body.temperature.value_or(std::numeric_limits<double>::quiet_NaN())));
  }
  for (std::size_t f = 1; f < scene.fluids.size(); ++f)
    c.one &= c.kinds[f].conductivity == c.kinds[0].conductivity;
  c.one &= c.kinds.size() == scene.fluids.size();  // probes conduct nothing
  c.pair_scale = static_cast<float>(pair_share(ratio));
  c.wall_scale = static_cast<float>(pair_share(ratio) * wall_factor(ratio, layer_depth(plan)));
  c.bond_lengths = static_cast<float>(bond_lengths(plan.spacing));
  c.by_volume = plan.model == ParticleModel::kPaper;
  c.share_unit = c.by_volume ? static_cast<float>(std::pow(plan.spacing, 3)) : kWallShare;
  return c;
}

}  // namespace slosh
