// Particles as files that other programs read: PLY and VTU.
#pragma once

#include <string>
#include <vector>

#include "peer/output/export/particle_frame.h"

namespace slosh {

/// Binary little-endian PLY, z up (Blender's axes): x y z (m), vx vy vz (m/s), pressure (Pa), fluid, id. The
/// comments say the time, the units, the spacing and which fluid is which.
std::string particles_as_ply(const ParticleFrame& frame, const ExportedFluids& fluids);

/// VTK's XML unstructured grid, y up (the axes of the run's tables): a vertex a particle; point data
/// velocity, pressure, fluid, id; field data TimeValue.
std::string particles_as_vtu(const ParticleFrame& frame, const ExportedFluids& fluids);

/// ParaView's index over numbered VTU files: `files[i]` at `times[i]` s.
std::string vtu_collection(const std::vector<std::string>& files, const std::vector<double>& times);

/// Appends a number in the machine's byte order, which has to be little-endian.
template <class Number>
void append_number(std::string& out, Number number) {
  out.append(reinterpret_cast<const char*>(&number), sizeof number);
}
inline void append_vector(std::string& out, const glm::vec3& v) {
  out.append(reinterpret_cast<const char*>(&v), sizeof v);
}

/// The header lines of a PLY file that both particles and surfaces begin with: format, then comments.
std::string ply_beginning(double time, const ExportedFluids& fluids);

}  // namespace slosh
