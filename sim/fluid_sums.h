// The sums of Diagnostics, particle by particle, in double precision.
#pragma once

#include <algorithm>

#include "sim/run_constants.h"
#include "sim/world.h"

namespace slosh {

class FluidSums {
 public:
  /// `constants` must outlive this.
  explicit FluidSums(const RunConstants& constants) : constants_(constants) {}

  /// One particle that is still in the world; probes are left out.
  void add(std::uint8_t kind_index, const glm::dvec3& x, const glm::dvec3& v, float volume) {
    const ParticleKind& kind = constants_.kinds[kind_index];
    if (kind.probe) return;
    const double mass = kind.mass;
    ++sums_.particles;
    sums_.mass += mass;
    sums_.momentum += mass * v;
    sums_.center += mass * x;
    sums_.kinetic_energy += 0.5 * mass * glm::dot(v, v);
    sums_.max_speed = std::max(sums_.max_speed, glm::length(v));
    sums_.max_compression = std::max<double>(sums_.max_compression, constants_.rest_volume / volume - 1.0);
  }

  /// Of the same particle, with kHeat. `temperature`: °C; `from_bodies`: J.
  void add_heat(std::uint8_t kind_index, double temperature, double cure, double from_bodies) {
    if (constants_.kinds[kind_index].probe) return;
    sums_.heat += constants_.heat.kinds[kind_index].capacity * temperature;
    sums_.heat_from_bodies += from_bodies;
    sums_.cure += constants_.kinds[kind_index].mass * cure;
    sums_.coldest = warm_ ? std::min(sums_.coldest, temperature) : temperature;
    sums_.hottest = warm_ ? std::max(sums_.hottest, temperature) : temperature;
    warm_ = true;
  }

  /// What bodies have still to be given, and how often particles were put back.
  void add(const ImpulseSums& impulses) {
    for (std::size_t b = 0; b + 1 < impulses.size(); b += kImpulseWords) {
      for (int i = 0; i < 3; ++i)
        sums_.clamp_impulse[i] +=
            static_cast<double>(impulses[b + static_cast<std::size_t>(i)]) * constants_.impulse_units.linear;
    }
    if (!impulses.empty()) sums_.clamped = static_cast<std::uint64_t>(impulses.back());
  }

  /// `started`: fluid particles at the start; `broken`: ParticleState's.
  Diagnostics finish(std::size_t started, std::uint64_t broken) const {
    Diagnostics d = sums_;
    if (d.mass > 0.0) d.center /= d.mass;
    if (d.mass > 0.0) d.cure /= d.mass;
    d.retired = started - d.particles;
    d.lost = constants_.plan.walls_hold() ? std::min(broken, d.retired) : d.retired;
    d.spilled = d.retired - d.lost;
    return d;
  }

 private:
  const RunConstants& constants_;
  Diagnostics sums_;
  bool warm_ = false;
};

}  // namespace slosh
