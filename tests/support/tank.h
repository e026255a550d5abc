// A tank of fluid in a box, built without files: the smallest world for experiments and benchmarks.
#pragma once

#include "scenes/scene.h"

namespace slosh::testing {

struct TankOptions {
  glm::dvec3 inner{0.2, 0.2, 0.2};  ///< m; the inner floor is at y = 0, centred in x and z
  double fill = 0.1;                ///< m
  double spacing = 0.01;            ///< m
  double rest_density = 1000.0;     ///< kg/m³
  double viscosity = 0.05;          ///< Pa·s
  double wall_viscosity = 0.0;      ///< Pa·s
};

struct Tank {
  Scene scene;
  SampledScene sampled;
};

/// An open tank whose walls are one measured fixed body. The floor and the four walls are one layer of
/// particles at the spacing; the fluid is a lattice that starts half a spacing off them.
Tank make_tank(const TankOptions& options);

/// Adds a lattice of fluid in [lower, upper] (m) to a scene under construction; returns the number of
/// particles.
int add_fluid_block(Scene& scene, SampledScene& sampled, int fluid, const glm::dvec3& lower,
                    const glm::dvec3& upper);

/// A closed box mesh with outward triangles.
TriangleMesh box_mesh(const glm::dvec3& lower, const glm::dvec3& upper);

}  // namespace slosh::testing
