// The fluid at one moment, as it is written for other programs.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace slosh {

/// What all frames of a run have in common.
struct ExportedFluids {
  double spacing = 0.0;            ///< m between particles; each stands for spacing³
  std::vector<std::string> names;  ///< one a fluid, as the scene has them
  std::vector<glm::vec3> colors;   ///< linear RGB, 0–1, one a fluid
};

/// One entry a particle that is still in the world, in the order of `id`. World axes, y up.
struct ParticleFrame {
  std::uint64_t number = 0;           ///< from 0
  double time = 0.0;                  ///< simulated s since the run began
  std::vector<glm::vec3> positions;   ///< m
  std::vector<glm::vec3> velocities;  ///< m/s
  std::vector<float> pressures;       ///< Pa, by Eq 7
  std::vector<std::uint32_t> ids;     ///< the same particle has the same one in every frame
  std::vector<std::uint8_t> fluids;   ///< into ExportedFluids::names

  std::size_t size() const { return positions.size(); }
};

/// Ours (y up, as glTF) to Blender's axes (z up), as Blender's glTF importer turns them.
inline glm::vec3 z_up(const glm::vec3& v) {
  return {v.x, -v.z, v.y};
}

/// The other way.
inline glm::vec3 y_up(const glm::vec3& v) {
  return {v.x, v.z, -v.y};
}

}  // namespace slosh
