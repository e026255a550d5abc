// Heat in the fluid and from bodies of a stated temperature, how far a fluid has set, and what viscosity
// follows from both.
//
// Conduction is Cleary & Monaghan 1999's: a pair passes on heat by its difference in temperature and the
// harmonic mean of its conductivities, so that what one gets the other loses. It falls off with h − r, scaled
// such that a lattice passes on the stated conductivity. A body's particles are those that press; one of them
// counts as much as makes the surface, not the layer behind it, have the body's temperature.
#pragma once

#include <cmath>
#include <vector>

#include "scenes/scene.h"
#include "sim/math/host_device.h"

namespace slosh {

struct Plan;

/// What the particles of one fluid share; a probe's conducts nothing.
struct HeatKind {
  float capacity = 1.0f;                                               ///< J/K of a particle
  float conductivity = 0.0f;                                           ///< W/(m·K)
  float temperature = 20.0f;                                           ///< °C, at the start
  float cure = 0.0f;                                                   ///< at the start
  float sets_above = 1e30f, sets_below = -1e30f, melts_above = 1e30f;  ///< °C
  float setting = 0.0f, melting = 0.0f;                                ///< 1/s
  float log_of_set = 0.0f;  ///< of how many times the viscosity it has when it has set
  float bond = 0.0f;        ///< N for each unit of a bond's strain (passes/bonds/bonds.h)
  float tears_at = 0.0f;    ///< strain
  int points = 0;
  float at[kMaxViscosityPoints] = {};         ///< °C, rising
  float log_times[kMaxViscosityPoints] = {};  ///< of the viscosity there over that of the start
};

struct HeatConstants {
  std::vector<HeatKind> kinds;  ///< as RunConstants::kinds; empty without kHeat
  std::vector<float> bodies;    ///< °C, one a body; not a number: none
  float pair_scale = 0.0f;      ///< 1/m² · m: a pair passes conductivity · this · (h − r) · ΔT, W
  float wall_scale = 0.0f;      ///< the same with a wall particle, times its share (wall_share)
  float share_unit = 0.0f;      ///< SurfaceParticle::pressure, or volume, of one lattice particle
  float bond_lengths = 0.0f;    ///< m (passes/bonds/bonds.h)
  bool by_volume = false;       ///< kPaper: a wall particle's share is its volume's
  bool one = true;              ///< all fluids conduct alike
};

/// Whether anything of a scene will change its temperature or set. `scene`: as it starts.
bool passes_heat(const Scene& scene);

/// Of a fluid in a scene, Pa·s: as it is, and where the scene passes heat over all that it may come to.
struct ViscosityRange {
  double least, most;
};
ViscosityRange viscosity_range(const Scene& scene, const Fluid& fluid);

/// Conduction is so slow that many steps are taken in one: as many as come to kHeatTime, s, or to what
/// explicit conduction allows. At a time, a single precision temperature would not notice what it gets.
inline constexpr double kHeatTime = 0.01;
int heat_steps(const Scene& scene, const Plan& plan);
/// s, the longest step at which conduction stays stable.
double conduction_step(const Scene& scene, const Plan& plan);

HeatConstants heat_constants(const Scene& scene, const Plan& plan);

/// Pa·s. `viscosity`: ParticleKind's; `temperature`: °C; `cure`: 0–1.
SLOSH_HD inline float thickness_of(const HeatKind& k, float viscosity, float temperature, float cure) {
  float log_times = cure * k.log_of_set;
  if (k.points > 0) {
    int i = 0;
    while (i < k.points && k.at[i] < temperature) ++i;
    if (i == 0) {
      log_times += k.log_times[0];
    } else if (i == k.points) {
      log_times += k.log_times[k.points - 1];
    } else {
      const float share = (temperature - k.at[i - 1]) / (k.at[i] - k.at[i - 1]);
      log_times += k.log_times[i - 1] + share * (k.log_times[i] - k.log_times[i - 1]);
    }
  }
  return log_times == 0.0f ? viscosity : viscosity * std::exp(log_times);
}

/// After `dt` s at `temperature`, °C.
SLOSH_HD inline float cure_after(const HeatKind& k, float temperature, float cure, float dt) {
  float rate = 0.0f;
  if (temperature >= k.melts_above)
    rate = -k.melting;
  else if (temperature >= k.sets_above || temperature <= k.sets_below)
    rate = k.setting;
  const float after = cure + rate * dt;
  return after < 0.0f ? 0.0f : after > 1.0f ? 1.0f : after;
}

/// W/(m·K) between two: the harmonic mean.
template <class Real>
SLOSH_HD Real between(Real a, Real b) {
  return Real(2.0f) * a * b / (a + b + Real(1e-30f));
}

}  // namespace slosh
