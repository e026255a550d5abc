// A frame's particles sorted into cells as wide as a reach, on the CPU: who is near whom. No GL here.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "render/frame.h"

namespace slosh {

/// An entry of Frame::particle_fluid as passes see it: bridges.h adds entries of its own, which make the
/// surface go on and have no volume.
struct FluidSample {
  std::uint8_t fluid;  ///< 255 = not drawn
  bool between;        ///< no particle
  /// What splats have for it: its whole part is the fluid.
  float index() const { return static_cast<float>(fluid) + (between ? kBetween : 0.0f); }
  static constexpr float kBetween = 0.5f;
  static constexpr std::uint8_t kFlag = 128;  ///< in Frame::particle_fluid
};
inline FluidSample fluid_sample(std::uint8_t given) {
  const bool between = given >= FluidSample::kFlag && given != 255;
  return {static_cast<std::uint8_t>(between ? given - FluidSample::kFlag : given), between};
}

class ParticleCells {
 public:
  /// Places of sorted particles that lie one after the other.
  struct Run {
    std::uint32_t first, end;
  };
  using Runs = std::array<Run, 9>;  ///< some may be empty

  /// Those that are not finite or of no fluid of the frame are left out. reach: m, above 0.
  void sort(const Frame& frame, float reach);

  float reach() const { return reach_; }
  std::uint32_t size() const { return static_cast<std::uint32_t>(source_.size()); }
  /// Who may lie within reach of a place, m, world.
  Runs around(const glm::vec3& at) const;
  /// x, y and z of sorted particles; up to kReadOn entries more may be read.
  const std::array<std::vector<float>, 3>& places() const { return at_; }
  glm::vec3 place(std::uint32_t k) const { return {at_[0][k], at_[1][k], at_[2][k]}; }
  /// Which of the frame's particles it is.
  std::uint32_t source(std::uint32_t k) const { return source_[k]; }

  static constexpr int kReadOn = 16;

 private:
  /// Chooses lowest_ and cells_ for the first `count` particles.
  void fit_cells(const Frame& frame, std::size_t count);
  glm::ivec3 cell_of(const glm::vec3& at) const;
  std::size_t row_of(int y, int z) const;

  float reach_ = 1.0f;
  glm::ivec3 lowest_{0};  // cells; who is outside counts as in the nearest
  glm::ivec3 cells_{1};
  std::vector<std::uint32_t> begin_;      // a cell each, x fastest, and the end
  std::array<std::vector<float>, 3> at_;  // sorted by cell: x, y, z, each with room behind to read on
  std::vector<std::uint32_t> source_;
  std::vector<std::uint32_t> cell_;  // scratch
};

}  // namespace slosh
