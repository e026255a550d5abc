// What the window draws over the picture so that things can be read off it: particles by what they do, axes,
// a scale.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "peer/view/orbit_camera.h"
#include "sim/snapshot.h"

namespace slosh {

/// What the fluid is seen as.
enum class ParticleView : std::uint8_t { kSurface, kSpeed, kPressure, kFluid, kVelocity, kCount };

/// 1, 2 or 5 times a power of ten: the largest that is at most `length` > 0.
double round_length(double length);
/// A length in the unit that one would say it in: "50 mm", "1 m".
std::string length_text(double metres);
/// Blue (0) over green to yellow (1), which also reads in grey.
glm::vec3 speed_color(float share);

/// On the drawing thread.
class Measures {
 public:
  ParticleView particles = ParticleView::kSurface;
  bool axes = false;

  /// The next in turn; its name.
  const char* next_particles();
  /// A new snapshot. Velocities are ways between two of them over the time between them, so they are there
  /// from the second on, and not where the world started again.
  void record(const Snapshot& snapshot);
  /// m/s, one a particle of the newest snapshot; empty where none are known.
  const std::vector<glm::vec3>& velocities() const { return velocities_; }
  /// Dear ImGui calls, behind the panels. `picture` in pixels; `pressures` in Pa, one a particle, or null.
  void draw(const Snapshot& newest, const std::vector<float>* pressures, const OrbitCamera& camera,
            const glm::ivec2& picture);

 private:
  void draw_particles(const Snapshot& newest, const OrbitCamera& camera, const glm::ivec2& picture);
  /// What colours the particles, one each: a speed in m/s or a pressure in Pa; empty where nothing is known.
  std::vector<float> values_of(const Snapshot& newest, const std::vector<float>* pressures) const;

  std::vector<float> values_;
  std::vector<glm::vec3> before_;
  double time_ = -1.0;
  std::vector<glm::vec3> velocities_;
  float top_ = 0.0f;  // of values_, the colours' end
};

}  // namespace slosh
