// Particles that lie as a fluid's do, for pictures of which the right answer is known.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace slosh::score {

/// Particles at `spacing` in [low, high] below the height `surface(x, z)`, jittered off their lattice and
/// then pushed apart, as a fluid's are. The same seed gives the same particles.
template <class Surface>
std::vector<glm::vec3> make_fluid(const glm::vec3& low, const glm::vec3& high, float spacing,
                                  Surface surface);
std::vector<glm::vec3> jitter_lattice(const glm::vec3& low, const glm::vec3& high, float spacing,
                                      std::uint32_t seed);
void relax(std::vector<glm::vec3>& points, float spacing, const glm::vec3& low, const glm::vec3& high,
           int iterations);

template <class Surface>
std::vector<glm::vec3> make_fluid(const glm::vec3& low, const glm::vec3& high, float spacing,
                                  Surface surface) {
  std::vector<glm::vec3> points = jitter_lattice(low, high, spacing, 1);
  std::erase_if(points, [&](const glm::vec3& p) { return p.y > surface(p.x, p.z); });
  relax(points, spacing, low, high, 8);
  return points;
}

}  // namespace slosh::score
