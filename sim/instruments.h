// What is measured of a world besides what moves it: levels, masses, where fluid is that should not be.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scenes/scene.h"
#include "sim/world.h"

namespace slosh {

/// The world at one moment.
struct Measurement {
  double time = 0.0;            ///< simulated s
  Diagnostics fluid;            ///< sums, with what was spilled and lost
  std::uint64_t in_solids = 0;  ///< particles whose centre is inside a body, deeper than a twentieth of a
                                ///< spacing (a drop alone lies on the surface), each counted once
  std::vector<std::uint64_t> in_body;  ///< the same, one a body
  std::vector<double> levels;          ///< m along up, one a gauge; NaN where no fluid is over or under it
  std::vector<double> pressures;       ///< Pa at the place of each gauge; NaN where it is not in fluid
  std::vector<double> masses;          ///< kg, one a region
  std::vector<double> fluid_masses;    ///< kg, one a region and fluid: region · fluids + fluid
};

/// Where the fluid's surface is on the line through `at` along `up` (unit), m along up: from above down to
/// where the smoothed volume of the particles (reach of two spacings) passes a half. NaN where there is no
/// fluid. A plane surface is read right whatever way it leans.
double fluid_level(const Snapshot& snapshot, const glm::dvec3& at, const glm::dvec3& up, double spacing);

/// Reads a world and changes nothing. Keeps copies of what it needs of the scene. One thread.
class Instruments {
 public:
  Instruments(const Scene& scene, const SampledScene& sampled);
  Instruments(const Instruments&) = delete;
  Instruments& operator=(const Instruments&) = delete;

  /// The particles in region `r` at the last measure(), by number.
  std::span<const std::uint32_t> inside(std::size_t r) const { return in_region_[r]; }
  const Snapshot& picture() const { return snapshot_; }  ///< of the last measure()
  double spacing() const { return spacing_; }            ///< m

  /// Valid until the next call. Copies every particle's place: about 2 ms for 100 000 and a few bodies.
  const Measurement& measure(const World& world);

 private:
  struct Solid {
    int body;  // that carries it; −1 = none
    Pose pose;
    const DistanceField* field;
  };
  /// Calls found(i) for the particles that are more than `deeper` m inside.
  template <class Found>
  void find_inside(const Solid& solid, double deeper, Found&& found) const;
  double pressure(const glm::dvec3& at) const;

  glm::dvec3 up_{0.0, 1.0, 0.0};
  double spacing_;
  std::vector<double> particle_mass_;  // one a fluid
  std::vector<DistanceField> body_fields_;
  std::vector<DistanceField> region_fields_;
  std::vector<Solid> bodies_;
  std::vector<Solid> regions_;
  std::vector<Gauge> gauges_;
  Snapshot snapshot_;
  std::vector<float> pressures_;  // one a particle
  std::vector<char> inside_;      // one a particle
  std::vector<std::vector<std::uint32_t>> in_region_;
  Measurement result_;
};

}  // namespace slosh
