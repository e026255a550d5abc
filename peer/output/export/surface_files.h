// A fluid's surface as files that other programs read: PLY and glTF.
#pragma once

#include <string>

#include "peer/output/export/fluid_surface.h"

namespace slosh {

/// Binary little-endian PLY, z up (Blender's axes), all fluids in one mesh: x y z (m), nx ny nz, vx vy vz
/// (m/s), pressure (Pa), fluid; triangles.
std::string surface_as_ply(const SurfaceFrame& surface, const ParticleFrame& frame,
                           const ExportedFluids& fluids);

/// Binary glTF 2.0, y up (glTF's rule; Blender's importer turns it): a node, a mesh and a material a fluid
/// that is there, with the attributes _VELOCITY (m/s) and _PRESSURE (Pa). The scene's extras hold time_s.
std::string surface_as_glb(const SurfaceFrame& surface, const ParticleFrame& frame,
                           const ExportedFluids& fluids);

}  // namespace slosh
