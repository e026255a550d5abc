// From particles to the fluid's surface, by OpenVDB. Its headers are in fluid_surface.cpp alone.
#pragma once

#include <string>
#include <vector>

#include "peer/output/export/particle_frame.h"

namespace slosh {

/// The closed surface of one fluid; no vertices where none of it is left. World axes, y up.
struct FluidSurface {
  std::size_t fluid = 0;              ///< into ExportedFluids::names
  std::vector<glm::vec3> positions;   ///< m
  std::vector<glm::vec3> normals;     ///< unit, out of the fluid, one a vertex
  std::vector<glm::vec3> velocities;  ///< m/s, of the particles around the vertex
  std::vector<float> pressures;       ///< Pa, likewise
  std::vector<glm::uvec3> triangles;  ///< counter-clockwise seen from outside
  double volume = 0.0;                ///< m³, enclosed
  double particle_volume = 0.0;       ///< m³: particles times spacing³, which is their mass over the density
};

struct SurfaceFrame {
  std::vector<FluidSurface> fluids;  ///< one a fluid of the scene
  std::string vdb;                   ///< an OpenVDB file, z up; empty unless it was asked for
};

/// How surfaces are made, in spacings. Balls around particles are joined, what lies between them is closed,
/// and the surface is then set back (Museth et al., Level set surfaces from particles).
constexpr double kSurfaceBall = 1.0;       ///< radius of a particle's ball at first
constexpr double kSurfaceVoxel = 1.0 / 3;  ///< of the level set
/// How far enclosed volume may be from the particles' own, as a share of it, where there are a thousand
/// particles or more, and in any case (of lone drops the grid holds less).
constexpr double kSurfaceVolumeBound = 0.01;
constexpr double kSurfaceDropBound = 0.25;

/// `with_vdb`: also the file of level sets "surface" (m, below 0 in the fluid), "velocity" and "pressure"
/// around it; in a scene of several fluids each name is followed by "_" and the fluid's. `threads`: of the
/// library's own. Where the program was built without OpenVDB: empty surfaces (can_make_surfaces() tells).
SurfaceFrame make_surfaces(const ParticleFrame& frame, const ExportedFluids& fluids, bool with_vdb,
                           int threads);

}  // namespace slosh
